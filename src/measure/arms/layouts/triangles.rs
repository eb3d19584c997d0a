//! The leaf test of triangles in any layout: the product's watertight test, but for where the vertices come from.

use super::{Best, Child, Primitives, first};
use crate::flat::{BLOCK, TriangleBlock};
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::WalkRay;
use crate::trace::kernels::triangle::{Edges, Sheared, in_front};

/// Vertices in some layout.
pub(in super::super) trait Vertices {
    /// The lanes that triangles are tested in, on a machine of lanes `L`.
    type Tested<L: Lanes>: Lanes;
    /// Where some triangles are: found once, so that what is checked is checked once, too.
    type Place<'a>: Copy
    where
        Self: 'a;
    /// The `L::N` triangles from `slot` on.
    fn place<L: Lanes>(&self, slot: usize) -> Self::Place<'_>;
    /// A coordinate of one of their vertices; beyond the last slot, anything.
    fn load<L: Lanes>(place: Self::Place<'_>, vertex: usize, axis: usize) -> L;
    /// Primitive index; `u32::MAX` in unused slots.
    fn prim(&self, slot: usize) -> u32;
    /// Bytes of all of them.
    fn bytes(&self) -> usize;
}

/// Triangles with their vertices in some layout.
pub(in super::super) struct Triangles<V>(pub(in super::super) V);

/// Hits of some lanes; lanes that hit nothing hold anything.
struct Candidates {
    t: [f32; BLOCK],
    u: [f32; BLOCK],
    v: [f32; BLOCK],
}

impl<V: Vertices> Primitives for Triangles<V> {
    type Tested<L: Lanes> = V::Tested<L>;

    #[inline(always)]
    fn test<L: Lanes>(
        &self,
        leaf: Child,
        ray: &WalkRay<V::Tested<L>>,
        any: bool,
        best: &mut Best,
    ) -> bool {
        let lanes = <V::Tested<L> as Lanes>::N;
        let mut found = Candidates {
            t: [0.0; BLOCK],
            u: [0.0; BLOCK],
            v: [0.0; BLOCK],
        };
        let mut at = 0;
        while at < leaf.slots {
            let slot = (leaf.first + at) as usize;
            let mut hit = hits(ray, &self.0, slot, best.t, &mut found) & first(leaf.slots - at);
            while hit != 0 {
                let lane = hit.trailing_zeros() as usize & (BLOCK - 1);
                hit &= hit - 1;
                if any && found.t[lane] < best.t {
                    return true;
                }
                best.offer(Best {
                    t: found.t[lane],
                    u: found.u[lane],
                    v: found.v[lane],
                    prim: self.0.prim(slot + lane),
                });
            }
            at += lanes as u32;
        }
        false
    }

    fn count(&self, leaf: Child) -> u64 {
        let used = |slot: &u32| self.0.prim(*slot as usize) != u32::MAX;
        (leaf.first..leaf.first + leaf.slots).filter(used).count() as u64
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

/// Tests the `L::N` triangles from `slot` on; returns the lanes that hit. The rules are those of the product's
/// `kernels::triangle`.
#[inline(always)]
fn hits<L: Lanes, V: Vertices>(
    ray: &WalkRay<L>,
    from: &V,
    slot: usize,
    limit: f32,
    out: &mut Candidates,
) -> u32 {
    let place = from.place::<L>(slot);
    let sheared = sheared::<L, V>(ray, place);
    let Edges { e, det } = sheared.edges();
    let zero = L::splat(0.0);
    let positive = zero.le(e[0]) & zero.le(e[1]) & zero.le(e[2]);
    let negative = e[0].le(zero) & e[1].le(zero) & e[2].le(zero);
    let inside = (positive | negative) & zero.lt(det.abs());
    if L::bits(inside) == 0 {
        return 0;
    }
    let z = [
        sheared.p[0][2] * ray.shear[2],
        sheared.p[1][2] * ray.shear[2],
        sheared.p[2][2] * ray.shear[2],
    ];
    let t = (e[0] * z[0] + e[1] * z[1] + e[2] * z[2]) / det;
    let bound = sheared.t_error(e, z) / det.abs();
    let [min, max] = corners::<L, V>(place);
    let own = ray.box_of(min, max);
    let clamped = t.min(own.far).max(own.near).max(zero);
    clamped.store(&mut out.t);
    (e[1] / det).store(&mut out.u);
    (e[2] / det).store(&mut out.v);
    let counts = inside & own.near.le(own.far) & clamped.le(L::splat(limit));
    let mut hits = L::bits(counts & bound.lt(t) & zero.lt(clamped));
    let mut doubtful = L::bits(counts & t.abs().le(bound));
    while doubtful != 0 {
        let lane = doubtful.trailing_zeros() as usize & (BLOCK - 1);
        doubtful &= doubtful - 1;
        if in_front(ray.origin_dir, &alone(from, slot + lane), 0) {
            out.t[lane] = out.t[lane].max(f32::MIN_POSITIVE);
            hits |= 1 << lane;
        }
    }
    hits
}

/// Vertices relative to the ray's origin, sheared along it.
#[inline(always)]
fn sheared<L: Lanes, V: Vertices>(ray: &WalkRay<L>, place: V::Place<'_>) -> Sheared<L> {
    let [kx, ky, kz] = ray.axes;
    let mut p = [[L::splat(0.0); 3]; 3];
    for (vertex, out) in p.iter_mut().enumerate() {
        let z = V::load::<L>(place, vertex, kz) - ray.origin[kz];
        let x = V::load::<L>(place, vertex, kx) - ray.origin[kx];
        let y = V::load::<L>(place, vertex, ky) - ray.origin[ky];
        *out = [x + ray.shear[0] * z, y + ray.shear[1] * z, z];
    }
    Sheared { p }
}

/// The triangles' own boxes.
#[inline(always)]
fn corners<L: Lanes, V: Vertices>(place: V::Place<'_>) -> [[L; 3]; 2] {
    let [mut min, mut max] = [[L::splat(0.0); 3]; 2];
    for axis in 0..3 {
        let a: L = V::load(place, 0, axis);
        let b = V::load(place, 1, axis);
        let c = V::load(place, 2, axis);
        min[axis] = a.min(b).min(c);
        max[axis] = a.max(b).max(c);
    }
    [min, max]
}

/// A block with one triangle in its first lane, for the rare case that needs f64.
#[inline(always)]
fn alone<V: Vertices>(from: &V, slot: usize) -> TriangleBlock {
    let place = from.place::<f32>(slot);
    let mut block = TriangleBlock {
        v: [[[0.0; BLOCK]; 3]; 3],
        prim: [u32::MAX; BLOCK],
    };
    for (vertex, axes) in block.v.iter_mut().enumerate() {
        for (axis, lanes) in axes.iter_mut().enumerate() {
            lanes[0] = V::load::<f32>(place, vertex, axis);
        }
    }
    block
}
