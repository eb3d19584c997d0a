//! Watertight ray–triangle intersection in lanes: Woop, Benthin and Wald, *Watertight Ray/Triangle Intersection*, JCGT
//! 2(1), 2013.
//!
//! Neighbours see the same bits of the ends of their common edge, and the edge function of one is the exact negative of the
//! other's, since `a·d − b·c` is written as two rounded products and one rounded difference: a fused operation here would
//! open cracks.

use super::ray::WalkRay;
use crate::flat::{BLOCK, TriangleBlock};
use crate::math::lanes::Lanes;
use crate::trace::spawn::gamma;

/// Hits of a block's lanes; lanes that hit nothing hold anything.
pub(crate) struct Candidates {
    pub(crate) t: [f32; BLOCK],
    /// Edge functions opposite the second and third vertex, and the sum of all three.
    e1: [f32; BLOCK],
    e2: [f32; BLOCK],
    det: [f32; BLOCK],
}

impl Candidates {
    pub(crate) const NONE: Candidates = Candidates {
        t: [0.0; BLOCK],
        e1: [0.0; BLOCK],
        e2: [0.0; BLOCK],
        det: [0.0; BLOCK],
    };

    /// The barycentric weights of the second and third vertex of all of them.
    #[inline(always)]
    pub(super) fn all_weights<L: Lanes>(&self) -> [L; 2] {
        let det = L::load(&self.det);
        [L::load(&self.e1) / det, L::load(&self.e2) / det]
    }

    /// The barycentric weights of a lane's second and third vertex.
    #[inline(always)]
    pub(crate) fn weights(&self, lane: usize) -> [f32; 2] {
        [
            self.e1[lane] / self.det[lane],
            self.e2[lane] / self.det[lane],
        ]
    }
}

/// Where the vertices of `L::N` triangles come from.
pub(crate) trait Corners<L> {
    /// A coordinate of one of their vertices.
    fn load(&self, vertex: usize, axis: usize) -> L;
    /// The vertices of one of them.
    fn vertices(&self, lane: usize) -> [[f32; 3]; 3];
}

/// The triangles of a block from a lane on.
#[derive(Clone, Copy)]
pub(super) struct FromLane<'a>(pub(super) &'a TriangleBlock, pub(super) usize);

impl<L: Lanes> Corners<L> for FromLane<'_> {
    #[inline(always)]
    fn load(&self, vertex: usize, axis: usize) -> L {
        L::load(&self.0.v[vertex][axis][self.1..])
    }

    #[inline(always)]
    fn vertices(&self, lane: usize) -> [[f32; 3]; 3] {
        let (v, lane) = (&self.0.v, self.1 + lane);
        [
            [v[0][0][lane], v[0][1][lane], v[0][2][lane]],
            [v[1][0][lane], v[1][1][lane], v[1][2][lane]],
            [v[2][0][lane], v[2][1][lane], v[2][2][lane]],
        ]
    }
}

/// Vertices relative to the ray's origin, sheared along it: `p[vertex]` is x, y and z before scaling by 1 / d[kz].
struct Sheared<L> {
    p: [[L; 3]; 3],
}

/// Edge functions and their sum.
struct Edges<L> {
    e: [L; 3],
    det: L,
}

/// Whether the edge functions do not differ in sign.
#[inline(always)]
fn inside<L: Lanes>(e: [L; 3]) -> L::Mask {
    let zero = L::splat(0.0);
    let least = e[0].min(e[1]).min(e[2]);
    let greatest = e[0].max(e[1]).max(e[2]);
    zero.le(least) | greatest.le(zero)
}

/// Tests `L::N` triangles against a ray, or a triangle against `L::N` rays; returns the lanes that hit, in bits from 0 on.
/// `out` is written from element `at` on, unless nothing can hit; then the t of a lane that does not hit is infinite.
///
/// A hit is in front of the origin if its box is, or else if f64 says so ([`in_front`]). Its t is clamped into the widened
/// slab interval of the triangle's own box (a candidate whose interval is empty is none), raised to `floor`, and at most
/// `limit`.
#[inline(always)]
pub(crate) fn test<L: Lanes, C: Corners<L>>(
    ray: &WalkRay<L>,
    corners: &C,
    at: usize,
    [floor, limit]: [L; 2],
    out: &mut Candidates,
) -> u32 {
    let sheared = Sheared::new(ray, corners);
    let Edges { e, det } = sheared.edges();
    let zero = L::splat(0.0);
    let inside = inside(e) & zero.lt(det.abs());
    if L::bits(inside) == 0 {
        return 0;
    }
    let z = [
        sheared.p[0][2] * ray.shear[2],
        sheared.p[1][2] * ray.shear[2],
        sheared.p[2][2] * ray.shear[2],
    ];
    let t = (e[0] * z[0] + e[1] * z[1] + e[2] * z[2]) / det;
    let own = own_box(ray, corners);
    let clamped = t.min(own.far).max(own.near).max(floor);
    let counts = inside & own.near.le(own.far) & clamped.le(limit);
    L::select(counts, clamped, L::splat(f32::INFINITY)).store(&mut out.t[at..]);
    e[1].store(&mut out.e1[at..]);
    e[2].store(&mut out.e2[at..]);
    det.store(&mut out.det[at..]);
    let mut hits = L::bits(counts & zero.lt(own.near));
    let mut doubtful = L::bits(counts & own.near.le(zero));
    while doubtful != 0 {
        let lane = doubtful.trailing_zeros() as usize & (BLOCK - 1);
        doubtful &= doubtful - 1;
        if in_front(ray.lane(lane), corners.vertices(lane)) {
            out.t[at + lane] = out.t[at + lane].max(f32::MIN_POSITIVE);
            hits |= 1 << lane;
        } else {
            out.t[at + lane] = f32::INFINITY;
        }
    }
    hits
}

/// The sign of t in f64, where the triangle's box is not in front of the origin: whether the ray goes towards the
/// triangle's plane. A function of the ray and the triangle alone, like every rule of what a hit is.
///
/// Rejecting every such t would lose the rays that leave a surface close to an edge for the neighbour across it;
/// accepting it would let rays meet the triangle that they leave, from which `offset_origin` moves them by more than f64
/// rounds.
#[inline(always)]
fn in_front([origin, dir]: [[f32; 3]; 2], v: [[f32; 3]; 3]) -> bool {
    let from = |start: [f32; 3], end: [f32; 3]| {
        [0, 1, 2].map(|axis| f64::from(end[axis]) - f64::from(start[axis]))
    };
    let [a, b, way] = [from(v[0], v[1]), from(v[0], v[2]), from(origin, v[0])];
    let normal = [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ];
    let along = |p: [f64; 3]| p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2];
    along(way) * along(dir.map(f64::from)) > 0.0
}

impl<L: Lanes> Sheared<L> {
    #[inline(always)]
    fn new<C: Corners<L>>(ray: &WalkRay<L>, corners: &C) -> Sheared<L> {
        let [kx, ky, kz] = [
            ray.axes[0] as usize,
            ray.axes[1] as usize,
            ray.axes[2] as usize,
        ];
        let zero = L::splat(0.0);
        let mut p = [[zero; 3]; 3];
        for (vertex, out) in p.iter_mut().enumerate() {
            let z = corners.load(vertex, kz) - ray.origin[kz];
            let x = corners.load(vertex, kx) - ray.origin[kx];
            let y = corners.load(vertex, ky) - ray.origin[ky];
            *out = [x + ray.shear[0] * z, y + ray.shear[1] * z, z];
        }
        Sheared { p }
    }

    #[inline(always)]
    fn edge_functions(&self) -> [L; 3] {
        let [a, b, c] = self.p;
        [
            b[0] * c[1] - b[1] * c[0],
            c[0] * a[1] - c[1] * a[0],
            a[0] * b[1] - a[1] * b[0],
        ]
    }

    #[inline(always)]
    fn edges(&self) -> Edges<L> {
        let e = self.edge_functions();
        Edges {
            e,
            det: e[0] + e[1] + e[2],
        }
    }

    /// Bound on the rounding error of Σ e z, the numerator of t: after pbrt-v4's Triangle::Intersect (Pharr, Jakob and
    /// Humphreys, *Physically Based Rendering*, 4th ed., §6.8.3), but with z before scaling in the error of x and y, so
    /// that it holds for directions of any length.
    #[inline(always)]
    fn t_error(&self, e: [L; 3], z: [L; 3]) -> L {
        let [a, b, c] = self.p;
        let x = largest([a[0], b[0], c[0]]);
        let y = largest([a[1], b[1], c[1]]);
        let depth = largest([a[2], b[2], c[2]]);
        let [z, e] = [largest(z), largest(e)];
        let [g2, g3, g5] = [L::splat(gamma(2)), L::splat(gamma(3)), L::splat(gamma(5))];
        let x_error = g5 * (x + depth);
        let y_error = g5 * (y + depth);
        let z_error = g3 * z;
        let e_error = L::splat(2.0) * (g2 * x * y + y_error * x + x_error * y);
        L::splat(3.0) * (g3 * e * z + e_error * z + z_error * e)
    }
}

#[inline(always)]
fn largest<L: Lanes>(x: [L; 3]) -> L {
    x[0].abs().max(x[1].abs()).max(x[2].abs())
}

/// The widened slab interval of the triangle's own box.
#[inline(always)]
fn own_box<L: Lanes, C: Corners<L>>(ray: &WalkRay<L>, corners: &C) -> super::ray::Interval<L> {
    let zero = L::splat(0.0);
    let [mut min, mut max] = [[zero; 3]; 2];
    for axis in 0..3 {
        let (a, b, c) = (
            corners.load(0, axis),
            corners.load(1, axis),
            corners.load(2, axis),
        );
        min[axis] = a.min(b).min(c);
        max[axis] = a.max(b).max(c);
    }
    ray.box_of(min, max)
}

/// Bound on |t − t*| of a hit, for tests: `t` as computed before clamping, t* exact for the same f32 numbers.
///
/// The numerator's bound and that of the sum of the edge functions, over the latter; but never more than the depth of the
/// triangle, since both t and t* are means of its vertices' depths. Infinite when the edge functions are all error.
#[must_use]
pub fn t_error_bound(vertices: [[f32; 3]; 3], origin: [f32; 3], dir: [f32; 3]) -> f32 {
    let mut block = TriangleBlock {
        v: [[[0.0; BLOCK]; 3]; 3],
        prim: [0; BLOCK],
    };
    for (k, vertex) in vertices.iter().enumerate() {
        for axis in 0..3 {
            block.v[k][axis] = [vertex[axis]; BLOCK];
        }
    }
    let Some(ray) = WalkRay::<f32>::new(origin, dir) else {
        return f32::INFINITY;
    };
    let sheared = Sheared::new(&ray, &FromLane(&block, 0));
    let Edges { e, det } = sheared.edges();
    let z = sheared.p.map(|p| p[2] * ray.shear[2]);
    let numerator = sheared.t_error(e, z);
    let unit_depths = [1.0; 3];
    let denominator = sheared.t_error(e, unit_depths);
    let t = (e[0] * z[0] + e[1] * z[1] + e[2] * z[2]) / det;
    let left = det.abs() - denominator;
    let first = if left > 0.0 {
        (numerator + t.abs() * denominator) / left
    } else {
        f32::INFINITY
    };
    let [low, high] = z
        .iter()
        .fold([f32::INFINITY, f32::NEG_INFINITY], |[l, h], &z| {
            [l.min(z), h.max(z)]
        });
    first.min((high - low) + gamma(5) * largest(z))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rays at edges and corners, where rounding moves t out of the box most often. The same holds for boxes of nodes, which
    /// contain it: so that no tree can cull what another finds.
    #[test]
    fn t_lies_in_the_interval_of_its_own_box() {
        let mut state = 1u64;
        let mut unit = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / 8_388_608.0 - 1.0
        };
        let (mut hits, mut clamped) = (0, 0);
        for case in 0..300_000i32 {
            let mut block = TriangleBlock {
                v: [[[0.0; BLOCK]; 3]; 3],
                prim: [0; BLOCK],
            };
            for lanes in block.v.as_flattened_mut() {
                *lanes = [unit(); BLOCK];
            }
            // An edge in a side of the box, which the ray nearly lies in.
            let side = case as usize % 3;
            block.v[1][side] = block.v[0][side];
            let corners = FromLane(&block, 0);
            let [a, b, _] = Corners::<f32>::vertices(&corners, 0);
            let along = if case % 2 == 0 { 0.0 } else { unit().abs() };
            let [mut origin, mut dir] = [[0.0; 3]; 2];
            for axis in 0..3 {
                origin[axis] = match axis == side {
                    true => a[axis] + unit() * 0.1f32.powi(4 + case % 4),
                    false => 4.0 * unit(),
                };
                dir[axis] = a[axis] + along * (b[axis] - a[axis]) - origin[axis];
            }
            let ray = WalkRay::<f32>::new(origin, dir).expect("a ray");
            let mut found = Candidates::NONE;
            if test(&ray, &corners, 0, [0.0, f32::MAX], &mut found) == 0 {
                continue;
            }
            let own = own_box(&ray, &corners);
            let t = found.t[0];
            assert!(own.near <= t && t <= own.far, "{origin:?} {dir:?}: {t}");
            let sheared = Sheared::new(&ray, &corners);
            let Edges { e, det } = sheared.edges();
            let z = sheared.p.map(|p| p[2] * ray.shear[2]);
            let raw = (e[0] * z[0] + e[1] * z[1] + e[2] * z[2]) / det;
            hits += 1;
            clamped += usize::from(raw < own.near || own.far < raw);
        }
        assert!(
            hits > 100_000 && clamped > 0,
            "{clamped} of {hits} were clamped"
        );
    }
}
