//! Cheap twins of the product's tests: what is common, faster and wrong now and then. Benchmarks of what exactness costs walk
//! them, nothing else does.

use super::Arm;
use super::layouts::sphere_layouts as balls;
use super::layouts::spheres::Round;
use super::layouts::triangle_layouts as triangles;
use super::layouts::triangles::{Triangles, Vertices};
use super::layouts::{Best, Primitives, first, first_lane};
use super::nodes::{Child, Wide};
use super::rival::Rival;
use crate::flat::{BLOCK, FlatScene, Spheres};
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::WalkRay;
use std::sync::Arc;

/// A rule of what a hit is that has a cheap twin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// The watertight test of triangles; Möller's and Trumbore's.
    Triangle,
    /// Boxes widened by four units in the last place; as they are.
    Slab,
    /// Roots of spheres in f64; in f32.
    Sphere,
}

/// Two arms that differ in a rule alone: as the product has it, and cheap.
#[must_use]
pub fn twins(rule: Rule, scene: &Arc<FlatScene>) -> [Box<dyn Arm>; 2] {
    let watertight = || Triangles(triangles::Blocks(Arc::clone(scene)));
    let exact: Box<dyn Arm> = match rule {
        Rule::Triangle | Rule::Slab => Rival::<Wide, _>::new(scene, watertight()),
        Rule::Sphere => Rival::<Wide, _>::new(scene, Round(balls::Blocks(Arc::clone(scene)))),
    };
    let cheap: Box<dyn Arm> = match rule {
        Rule::Triangle => {
            Rival::<Wide, _>::new(scene, MollerTrumbore(triangles::Blocks(Arc::clone(scene))))
        }
        Rule::Slab => {
            let mut rival = Rival::<Wide, _>::new(scene, watertight());
            rival.tree.slabs = [1.0; 2];
            rival
        }
        Rule::Sphere => Rival::<Wide, _>::new(scene, Single::new(scene)),
    };
    [exact, cheap]
}

/// Triangles tested as by Möller and Trumbore, *Fast, Minimum Storage Ray/Triangle Intersection*, 1997: neighbours compute
/// their common edge from different numbers.
struct MollerTrumbore<V>(V);

impl<V: Vertices> Primitives for MollerTrumbore<V> {
    type Tested<L: Lanes> = V::Tested<L>;
    const UNIT: usize = V::UNIT;
    const SCALAR: bool = false;

    #[inline(always)]
    fn test<L: Lanes>(
        &self,
        leaf: Child,
        ray: &WalkRay<V::Tested<L>>,
        any: bool,
        best: &mut Best,
    ) -> bool {
        let [mut t, mut u, mut v] = [[0.0; BLOCK]; 3];
        let mut at = 0;
        while at < leaf.slots {
            let slot = (leaf.first + at) as usize;
            let place = self.0.place::<V::Tested<L>>(slot);
            let corners = [
                corner::<V, V::Tested<L>>(place, 0),
                corner::<V, V::Tested<L>>(place, 1),
                corner::<V, V::Tested<L>>(place, 2),
            ];
            let mut hit = moller_trumbore(ray, corners, best.t, [&mut t, &mut u, &mut v]);
            hit &= first(leaf.slots - at);
            while hit != 0 {
                let lane = hit.trailing_zeros() as usize & (BLOCK - 1);
                hit &= hit - 1;
                if any && t[lane] < best.t {
                    return true;
                }
                best.offer(Best {
                    t: t[lane],
                    u: u[lane],
                    v: v[lane],
                    prim: self.0.prim(slot + lane),
                });
            }
            at += <V::Tested<L> as Lanes>::N as u32;
        }
        false
    }

    fn count(&self, leaf: Child) -> u64 {
        u64::from(leaf.slots)
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

#[inline(always)]
fn corner<V: Vertices, L: Lanes>(place: V::Place<'_>, vertex: usize) -> [L; 3] {
    [
        V::load(place, vertex, 0),
        V::load(place, vertex, 1),
        V::load(place, vertex, 2),
    ]
}

/// The lanes that are hit at 0 < t ≤ `limit`.
#[inline(always)]
fn moller_trumbore<L: Lanes>(
    ray: &WalkRay<L>,
    [a, b, c]: [[L; 3]; 3],
    limit: f32,
    out: [&mut [f32; BLOCK]; 3],
) -> u32 {
    let dir = ray.dir;
    let (ab, ac, from) = (minus(b, a), minus(c, a), minus(ray.origin, a));
    let (p, q) = (cross(dir, ac), cross(from, ab));
    let inv = L::splat(1.0) / dot(ab, p);
    let [t, u, v] = [dot(ac, q) * inv, dot(from, p) * inv, dot(dir, q) * inv];
    let [t_out, u_out, v_out] = out;
    t.store(t_out);
    u.store(u_out);
    v.store(v_out);
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let inside = zero.le(u) & zero.le(v) & (u + v).le(one);
    L::bits(inside & zero.lt(t) & t.le(L::splat(limit)))
}

/// Spheres in f32, whose roots are found in f32 by the form that cancels least (Haines, Günther and Akenine-Möller,
/// *Precision Improvements for Ray/Sphere Intersection*, Ray Tracing Gems, ch. 7): what the product does in f64.
struct Single(Vec<SingleBlock>);

/// As [`SphereBlock`](crate::flat::SphereBlock), without boxes: nothing is clamped.
struct SingleBlock {
    center: [[f32; BLOCK]; 3],
    radius: [f32; BLOCK],
    prim: [u32; BLOCK],
}

impl Single {
    fn new(scene: &FlatScene) -> Single {
        let blocks = scene.spheres.blocks.iter().map(|block| SingleBlock {
            center: block.center.map(|axis| axis.map(|x| x as f32)),
            radius: block.radius.map(|x| x as f32),
            prim: block.prim,
        });
        Single(blocks.collect())
    }
}

impl Primitives for Single {
    type Tested<L: Lanes> = L;
    const UNIT: usize = BLOCK;
    const SCALAR: bool = false;

    #[inline(always)]
    fn test<L: Lanes>(&self, leaf: Child, ray: &WalkRay<L>, any: bool, best: &mut Best) -> bool {
        let mut t = [0.0; BLOCK];
        let mut at = 0;
        while at < leaf.slots {
            let slot = (leaf.first + at) as usize;
            let (block, lane) = (&self.0[slot / BLOCK], first_lane::<L>(slot));
            let center = [
                L::load(&block.center[0][lane..]),
                L::load(&block.center[1][lane..]),
                L::load(&block.center[2][lane..]),
            ];
            let radius = L::load(&block.radius[lane..]);
            let mut hit = single(ray, center, radius, best.t, &mut t);
            while hit != 0 {
                let lane = hit.trailing_zeros() as usize & (BLOCK - 1);
                hit &= hit - 1;
                let prim = block.prim[(slot + lane) % BLOCK];
                if prim == u32::MAX {
                    continue;
                }
                if any && t[lane] < best.t {
                    return true;
                }
                best.offer(Best {
                    prim: Spheres::TAG | prim,
                    ..Best::below(t[lane])
                });
            }
            at += L::N as u32;
        }
        false
    }

    fn count(&self, leaf: Child) -> u64 {
        u64::from(leaf.slots)
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// The lanes that are hit at 0 < t ≤ `limit`.
#[inline(always)]
fn single<L: Lanes>(
    ray: &WalkRay<L>,
    center: [L; 3],
    radius: L,
    limit: f32,
    out: &mut [f32; BLOCK],
) -> u32 {
    let zero = L::splat(0.0);
    let dir = ray.dir;
    let oc = minus(ray.origin, center);
    let (a, b) = (dot(dir, dir), dot(oc, dir));
    let s = b / a;
    let beside = minus(oc, [s * dir[0], s * dir[1], s * dir[2]]);
    let r2 = radius * radius;
    let quarter = r2 - dot(beside, beside);
    let real = zero.le(quarter);
    if L::bits(real) == 0 {
        return 0;
    }
    let root = (a * quarter).sqrt();
    let q = -(b + L::select(b.lt(zero), -root, root));
    let [t0, t1] = [(dot(oc, oc) - r2) / q, q / a];
    let [nearer, farther] = [t0.min(t1), t0.max(t1)];
    let t = L::select(zero.lt(nearer), nearer, farther);
    t.store(out);
    L::bits(real & zero.lt(t) & t.le(L::splat(limit)))
}

#[inline(always)]
fn minus<L: Lanes>(a: [L; 3], b: [L; 3]) -> [L; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot<L: Lanes>(a: [L; 3], b: [L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<L: Lanes>(a: [L; 3], b: [L; 3]) -> [L; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
