//! `Hits::err`: how far, along the geometric normal, the position that the surface stage computes may be from the surface,
//! as the next ray's test sees it. The positions are those of [`crate::trace::spawn`]; of hits beside an edge they are moved
//! first ([`super::inward`]).

use super::batch::{MOST_LANES, load};
use super::inward;
use super::walk::Best;
use crate::flat::{BLOCK, FlatScene, Instance, Spheres, Triangles};
use crate::math::lanes::{Lanes, WideLanes};
use crate::trace::Hits;
use crate::trace::spawn::{
    gamma, instance_normal, instance_point, triangle_normal, triangle_point, triangle_vertices,
};

/// Two roundings to f32, where one happens: p is rounded once; the other half is slack for the rounding of this bound.
const ROUNDING: f32 = f32::EPSILON;

/// Error of the f32 estimate of p, `o + t d`, in the bound: 2⁻⁴⁴ of its terms, twice 2⁻²³ · 2⁻²² being too small to matter
/// unless p itself is near 0.
const ESTIMATE: f32 = 1.0 / (1u64 << 44) as f32;

/// Error of a component of the unit normal estimated in f32, relative to (|o| + |t d| + |C|) / r.
const NORMAL: f32 = 4.0 * f32::EPSILON;

/// f64 terms, 2⁻⁵⁰ (|C| + r): the reprojection and the next ray's `c = oc·oc − r²` round a handful of numbers of that size
/// by 2⁻⁵³.
const WIDE: f32 = 1.0 / (1u64 << 50) as f32;

/// A direction that leaves by less than an f32 normal's error, 2⁻²³, may point inward by as much: at a distance of
/// r 2⁻⁴⁶ from the sphere it still passes.
const GRAZING: f32 = 1.0 / (1u64 << 46) as f32;

/// The bound for a sphere: p is reprojected in f64 to C + r n, then rounded to f32. Σ |nᵢ| ulp(pᵢ) with the normal and the
/// position estimated in f32 lanes, and what happens in f64.
#[inline(always)]
pub(super) fn sphere_error<L: Lanes>(
    [origin, dir]: [[L; 3]; 2],
    t: L,
    center: [L; 3],
    radius: L,
) -> L {
    let one = L::splat(1.0);
    let inv_radius = one / radius;
    let mut err = L::splat(GRAZING) * radius;
    let mut size = radius;
    for axis in 0..3 {
        let along = t * dir[axis];
        let p = origin[axis] + along;
        let terms = origin[axis].abs() + along.abs();
        let beside = (p - center[axis]).abs();
        let doubt = L::splat(NORMAL) * (terms + center[axis].abs());
        let normal = ((beside + doubt) * inv_radius).min(one);
        err = err + normal * (L::splat(ROUNDING) * p.abs() + L::splat(ESTIMATE) * terms);
        size = size + center[axis].abs();
    }
    err + L::splat(WIDE) * size
}

/// The bound for a hit on a sphere or an instance, and the hit's weights; called once per ray, for the hit that stands.
#[inline(always)]
pub(super) fn hit_error(scene: &FlatScene, ray: [[f32; 3]; 2], hit: &Best) -> (f32, [f32; 2]) {
    let weights = [hit.u, hit.v];
    if hit.prim & Spheres::TAG != 0 {
        let i = (hit.prim & !Spheres::TAG) as usize;
        let [x, y, z] = scene.spheres.center(i);
        let center = [x as f32, y as f32, z as f32];
        let err = sphere_error(ray, hit.t, center, scene.spheres.radius(i) as f32);
        return (err, weights);
    }
    let instance = &scene.instances[hit.instance as usize];
    let local = &scene.local[instance.geometry as usize];
    let v = triangle_vertices(&local.triangles, hit.prim);
    let weights = inward::step(
        v,
        weights,
        inward::MARGIN * local_blur(instance, v, weights),
    );
    let normal = instance_normal(instance, triangle_normal(v));
    (along(normal, instance_error(instance, v, weights)), weights)
}

/// The bounds of all hits on triangles of the world, in lanes: (Σ |Nᵢ| Eᵢ) / |N| with the normal N in f64, since a sliver's
/// cross product cancels; 0 for a triangle without area. Weights of hits beside an edge are moved first.
#[inline(always)]
pub(crate) fn world_errors<L: Lanes>(triangles: &Triangles, hits: &mut Hits) {
    let mut at = 0;
    while at < hits.prim.len() {
        let mut v = [[[0.0; MOST_LANES]; 3]; 3];
        let rest = hits.prim.len() - at;
        let lanes = if rest < L::N { rest } else { L::N };
        let mut found = 0;
        for lane in 0..lanes {
            let (prim, instance) = (hits.prim[at + lane], hits.instance[at + lane]);
            // A miss is tagged, too.
            if prim & Spheres::TAG != 0 || instance != Hits::WORLD {
                continue;
            }
            found |= 1 << lane;
            let place = triangles.place[prim as usize] as usize;
            let block = &triangles.blocks[place / BLOCK];
            for (to, from) in v.iter_mut().zip(&block.v) {
                for axis in 0..3 {
                    to[axis][lane] = from[axis][place % BLOCK];
                }
            }
        }
        if found != 0 {
            let mut bounds = world_error::<L>(&v, [load(&hits.u, at), load(&hits.v, at)]);
            let beside = L::bits(bounds.beside) & found;
            if beside != 0 {
                let mut margin = [0.0; MOST_LANES];
                bounds.margin.store(&mut margin);
                for lane in 0..lanes {
                    if beside >> lane & 1 == 1 {
                        let mut corners = [[0.0; 3]; 3];
                        for (corner, from) in corners.iter_mut().zip(&v) {
                            *corner = [from[0][lane], from[1][lane], from[2][lane]];
                        }
                        let weights = [hits.u[at + lane], hits.v[at + lane]];
                        [hits.u[at + lane], hits.v[at + lane]] =
                            inward::step(corners, weights, margin[lane]);
                    }
                }
                bounds = world_error::<L>(&v, [load(&hits.u, at), load(&hits.v, at)]);
            }
            let mut err = [0.0; MOST_LANES];
            bounds.err.store(&mut err);
            for lane in 0..lanes {
                if found >> lane & 1 == 1 {
                    hits.err[at + lane] = err[lane];
                }
            }
        }
        at += L::N;
    }
}

/// A coordinate of a vertex relative to the first.
#[inline(always)]
fn edge<L: Lanes>(v: &[[[f32; MOST_LANES]; 3]; 3], vertex: usize, axis: usize) -> L::Wide {
    L::load(&v[vertex][axis]).widen() - L::load(&v[0][axis]).widen()
}

/// What is known of hits on triangles of the world.
struct Bounds<L: Lanes> {
    err: L,
    /// How far inside its triangle each should be.
    margin: L,
    /// Which may be nearer to an edge: none that is so is missing.
    beside: L::Mask,
}

#[inline(always)]
fn world_error<L: Lanes>(v: &[[[f32; MOST_LANES]; 3]; 3], [b1, b2]: [L; 2]) -> Bounds<L> {
    let b0 = L::splat(1.0) - b1 - b2;
    let (ax, ay, az) = (edge::<L>(v, 1, 0), edge::<L>(v, 1, 1), edge::<L>(v, 1, 2));
    let (bx, by, bz) = (edge::<L>(v, 2, 0), edge::<L>(v, 2, 1), edge::<L>(v, 2, 2));
    let normal = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
    let one = L::Wide::splat(1.0);
    let mut sum = L::Wide::splat(0.0);
    let mut square = sum;
    let mut blur = L::splat(0.0);
    // Lengths of the edges by the sum of their components, which is no less.
    let mut edges = [blur; 3];
    for axis in 0..3 {
        let [p, q, r] = [
            L::load(&v[0][axis]),
            L::load(&v[1][axis]),
            L::load(&v[2][axis]),
        ];
        let terms = (b0 * p).abs() + (b1 * q).abs() + (b2 * r).abs();
        let error = L::splat(gamma(7)) * terms;
        sum = sum + normal[axis].copysign(one) * error.widen();
        square = square + normal[axis] * normal[axis];
        blur = blur + error;
        edges[0] = edges[0] + (r - q).abs();
        edges[1] = edges[1] + (p - r).abs();
        edges[2] = edges[2] + (q - p).abs();
    }
    let length = square.sqrt().positive_or(L::Wide::splat(f64::INFINITY));
    let margin = L::splat(inward::MARGIN) * blur;
    let longest = edges[0].max(edges[1]).max(edges[2]);
    let least = b0.min(b1).min(b2) * L::narrow(length);
    Bounds {
        err: L::narrow(sum / length) * L::splat(1.0 + f32::EPSILON),
        margin,
        beside: least.lt(margin * longest),
    }
}

/// Σ |nᵢ| Eᵢ.
#[inline(always)]
fn along(normal: [f32; 3], error: [f32; 3]) -> f32 {
    normal[0].abs() * error[0] + normal[1].abs() * error[1] + normal[2].abs() * error[2]
}

/// By component, for p = b0 v0 + b1 v1 + b2 v2 in f32: γ₇ (|b0 v0| + |b1 v1| + |b2 v2|), as in pbrt (Pharr, Jakob and
/// Humphreys, *Physically Based Rendering*, 4th ed., §6.8.5).
#[inline(always)]
fn triangle_error(v: [[f32; 3]; 3], b1: f32, b2: f32) -> [f32; 3] {
    let b0 = 1.0 - b1 - b2;
    let mut error = [0.0; 3];
    for axis in 0..3 {
        let sum = (b0 * v[0][axis]).abs() + (b1 * v[1][axis]).abs() + (b2 * v[2][axis]).abs();
        error[axis] = gamma(7) * sum;
    }
    error
}

/// By component in world space, for a point of an instance: |M| times the local bound; going to world,
/// γ₃ (|M| |p| + |m|) (entries and result are rounded); and, since the next ray comes back to the local space before it is
/// tested, |M| γ₆ (|W| |p'| + |w|) with W = M⁻¹ (four roundings of the product, one of its entries, one of slack). The
/// same terms as in NVIDIA's OptiX toolkit, *SelfIntersectionAvoidance*.
#[inline(always)]
fn instance_error(instance: &Instance, v: [[f32; 3]; 3], [b1, b2]: [f32; 2]) -> [f32; 3] {
    let local = triangle_point(v, b1, b2);
    let inside = local_error(instance, v, [b1, b2]);
    let mut error = [0.0; 3];
    for axis in 0..3 {
        let m = instance.to_world[axis];
        error[axis] = gamma(3) * magnitude(m, local)
            + m[0].abs() * inside[0]
            + m[1].abs() * inside[1]
            + m[2].abs() * inside[2];
    }
    error
}

/// The part of that bound that arises in the local space.
#[inline(always)]
fn local_error(instance: &Instance, v: [[f32; 3]; 3], [b1, b2]: [f32; 2]) -> [f32; 3] {
    let world = instance_point(instance, triangle_point(v, b1, b2));
    let mut inside = triangle_error(v, b1, b2);
    for axis in 0..3 {
        inside[axis] += gamma(6) * magnitude(instance.to_local[axis], world);
    }
    inside
}

/// The sum over the components of how far, in the local space, a position and the start of the next ray may be from where
/// the weights say: what arises there, and γ₇ (|M| |p| + |m|), γ₃ for the position and the rest for that start.
#[inline(always)]
fn local_blur(instance: &Instance, v: [[f32; 3]; 3], weights: [f32; 2]) -> f32 {
    let local = triangle_point(v, weights[0], weights[1]);
    let inside = local_error(instance, v, weights);
    // Not by `array::map`, which is not inlined.
    let mut world = [0.0; 3];
    for axis in 0..3 {
        world[axis] = gamma(7) * magnitude(instance.to_world[axis], local);
    }
    let mut blur = 0.0;
    for axis in 0..3 {
        let w = &instance.to_local[axis];
        blur +=
            inside[axis] + w[0].abs() * world[0] + w[1].abs() * world[1] + w[2].abs() * world[2];
    }
    blur
}

/// |row| · (|p|, 1).
#[inline(always)]
fn magnitude(row: [f32; 4], p: [f32; 3]) -> f32 {
    (row[0] * p[0]).abs() + (row[1] * p[1]).abs() + (row[2] * p[2]).abs() + row[3].abs()
}
