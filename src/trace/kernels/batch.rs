//! The kernels over a whole batch: rays in lanes against the spheres outside the tree, then through the tree. Everything
//! here is inlined into an entry of `super::entries`.

use super::bound;
use super::entries::Walks;
use super::group;
use super::instances::{self, LocalTrees, NoInstances};
use super::sphere::WideRay;
use super::walk::{Best, Sink, Tree};
use crate::flat::{BLOCK, FlatScene, Spheres};
use crate::math::lanes::{Lanes, WideLanes};
use crate::trace::{Hits, Rays};

/// The widest lanes of all.
pub(super) const MOST_LANES: usize = 16;

/// Room for what walks keep, from batch to batch.
#[derive(Default)]
pub(super) struct Scratch {
    groups: group::Scratch,
    local: instances::Scratch,
}

/// The elements from `at` on; zeros beyond the end, with which no ray hits anything.
#[inline(always)]
pub(super) fn load<L: Lanes>(from: &[f32], at: usize) -> L {
    if at + L::N <= from.len() {
        return L::load(&from[at..]);
    }
    let mut padded = [0.0; MOST_LANES];
    for (to, from) in padded.iter_mut().zip(&from[at..]) {
        *to = *from;
    }
    L::load(&padded)
}

/// Overwrites the elements from `at` on, as far as there are any.
#[inline(always)]
fn store<L: Lanes>(lanes: L, to: &mut [f32], at: usize) {
    if at + L::N <= to.len() {
        return lanes.store(&mut to[at..]);
    }
    let mut padded = [0.0; MOST_LANES];
    lanes.store(&mut padded);
    for (to, from) in to[at..].iter_mut().zip(&padded) {
        *to = *from;
    }
}

#[inline(always)]
pub(super) fn load3<L: Lanes>(from: &[Vec<f32>; 3], at: usize) -> [L; 3] {
    [load(&from[0], at), load(&from[1], at), load(&from[2], at)]
}

/// Sphere `lane` of a block in all lanes.
macro_rules! sphere_in_lanes {
    ($block:ident, $lane:ident, $lanes:ident) => {
        (
            [
                $lanes::Wide::splat($block.center[0][$lane]),
                $lanes::Wide::splat($block.center[1][$lane]),
                $lanes::Wide::splat($block.center[2][$lane]),
            ],
            $lanes::Wide::splat($block.radius[$lane]),
        )
    };
}

/// Every looped sphere against `L::N` rays at a time. On entry `hits.t` are limits: hits below count.
#[inline(always)]
pub(super) fn looped_closest<L: Lanes>(spheres: &Spheres, rays: &Rays, hits: &mut Hits) {
    let zero = L::splat(0.0);
    let mut at = 0;
    while at < rays.len() {
        let [origin, dir]: [[L; 3]; 2] = [load3(&rays.origin, at), load3(&rays.dir, at)];
        let ray = WideRay::new(origin, dir);
        let mut best: L = load(&hits.t, at);
        // Ids travel as bits: they are selected and stored, never computed with.
        let mut prim = L::splat(f32::from_bits(Hits::NONE));
        for block in &spheres.looped {
            for lane in 0..BLOCK {
                let id = block.prim[lane];
                if id == u32::MAX {
                    break;
                }
                let (center, radius) = sphere_in_lanes!(block, lane, L);
                if let Some(t) = ray.root::<L>(center, radius) {
                    let closer = zero.lt(t) & t.lt(best);
                    best = L::select(closer, t, best);
                    let id = L::splat(f32::from_bits(Spheres::TAG | id));
                    prim = L::select(closer, id, prim);
                }
            }
        }
        store(best, &mut hits.t, at);
        let err = looped_errors(spheres, [origin, dir], best, prim, &mut hits.prim[at..]);
        store(err, &mut hits.err, at);
        at += L::N;
    }
}

/// Writes the ids down and gathers their spheres for the error bounds.
#[inline(always)]
fn looped_errors<L: Lanes>(
    spheres: &Spheres,
    [origin, dir]: [[L; 3]; 2],
    t: L,
    prim: L,
    out: &mut [u32],
) -> L {
    let mut ids = [0.0; MOST_LANES];
    prim.store(&mut ids);
    let mut index = [0; MOST_LANES];
    for (lane, id) in ids.iter().map(|id| id.to_bits()).enumerate().take(L::N) {
        if let Some(out) = out.get_mut(lane) {
            *out = id;
        }
        // What hit nothing is given any sphere's: nobody asks for its error.
        index[lane] = if id == Hits::NONE {
            0
        } else {
            id & !Spheres::TAG
        };
    }
    let [x, y, z, radius] = L::rows(&spheres.placed, &index);
    let center = [L::narrow(x), L::narrow(y), L::narrow(z)];
    bound::sphere_error([origin, dir], t, center, L::narrow(radius))
}

/// Whether any looped sphere is hit below `t_max`.
#[inline(always)]
pub(super) fn looped_occluded<L: Lanes>(spheres: &Spheres, rays: &Rays, out: &mut [bool]) {
    let zero = L::splat(0.0);
    let all = u32::MAX >> (u32::BITS - L::N as u32);
    let mut at = 0;
    while at < rays.len() {
        let ray = WideRay::new::<L>(load3(&rays.origin, at), load3(&rays.dir, at));
        let limit: L = load(&rays.t_max, at);
        let mut blocked = 0;
        'spheres: for block in &spheres.looped {
            for lane in 0..BLOCK {
                if block.prim[lane] == u32::MAX {
                    break;
                }
                let (center, radius) = sphere_in_lanes!(block, lane, L);
                if let Some(t) = ray.root::<L>(center, radius) {
                    blocked |= L::bits(zero.lt(t) & t.lt(limit));
                    if blocked == all {
                        break 'spheres;
                    }
                }
            }
        }
        for (lane, out) in out[at..].iter_mut().take(L::N).enumerate() {
            *out = blocked >> lane & 1 == 1;
        }
        at += L::N;
    }
}

/// Every ray through the world's tree. `hits` hold what the looped spheres left.
#[inline(always)]
pub(super) fn tree_closest<L: Walks, const T: bool, const S: bool, const I: bool>(
    scene: &FlatScene,
    rays: &Rays,
    hits: &mut Hits,
    scratch: &mut Scratch,
) {
    let mut sink = Closest { scene, rays, hits };
    walk_world::<L, _, T, S, I, false>(scene, rays, &mut sink, scratch);
    if T {
        bound::world_errors::<L>(&scene.world.triangles, hits);
    }
}

/// Whether anything in the world's tree is hit below `t_max`; rays that are blocked already stay so.
#[inline(always)]
pub(super) fn tree_occluded<L: Walks, const T: bool, const S: bool, const I: bool>(
    scene: &FlatScene,
    rays: &Rays,
    out: &mut [bool],
    scratch: &mut Scratch,
) {
    let mut sink = Occluded { rays, out };
    walk_world::<L, _, T, S, I, true>(scene, rays, &mut sink, scratch);
}

#[inline(always)]
fn walk_world<L: Walks, R: Sink, const T: bool, const S: bool, const I: bool, const ANY: bool>(
    scene: &FlatScene,
    rays: &Rays,
    sink: &mut R,
    scratch: &mut Scratch,
) {
    let tree = Tree::world(scene);
    if I {
        let mut instances = LocalTrees {
            scene,
            scratch: &mut scratch.local,
        };
        let scratch = &mut scratch.groups;
        group::walk_batch::<L, _, R, T, S, ANY>(&tree, rays, sink, &mut instances, scratch);
    } else {
        let scratch = &mut scratch.groups;
        group::walk_batch::<L, _, R, T, S, ANY>(&tree, rays, sink, &mut NoInstances, scratch);
    }
}

/// Rays that want their closest hit.
struct Closest<'a> {
    scene: &'a FlatScene,
    rays: &'a Rays,
    hits: &'a mut Hits,
}

impl Sink for Closest<'_> {
    #[inline(always)]
    fn best(&self, i: usize) -> Option<Best> {
        let mut best = Best::below(self.hits.t[i]);
        best.prim = self.hits.prim[i];
        Some(best)
    }

    #[inline(always)]
    fn done(&mut self, i: usize, best: &Best) {
        let hits = &mut *self.hits;
        if best.prim != hits.prim[i] {
            hits.t[i] = best.t;
            hits.u[i] = best.u;
            hits.v[i] = best.v;
            hits.prim[i] = best.prim;
            hits.instance[i] = best.instance;
            // Those of triangles of the world are bounded together, afterwards.
            if best.prim & Spheres::TAG != 0 || best.instance != Hits::WORLD {
                let [o, d] = [&self.rays.origin, &self.rays.dir];
                let ray = [[o[0][i], o[1][i], o[2][i]], [d[0][i], d[1][i], d[2][i]]];
                let (err, [u, v]) = bound::hit_error(self.scene, ray, best);
                [hits.err[i], hits.u[i], hits.v[i]] = [err, u, v];
            }
        }
    }
}

/// Rays that want to know whether they are blocked.
struct Occluded<'a> {
    rays: &'a Rays,
    out: &'a mut [bool],
}

impl Sink for Occluded<'_> {
    #[inline(always)]
    fn best(&self, i: usize) -> Option<Best> {
        // A limit of NaN is one below which nothing lies.
        let limit = self.rays.t_max[i];
        (limit > 0.0 && !self.out[i]).then(|| Best::below(limit))
    }

    #[inline(always)]
    fn done(&mut self, i: usize, best: &Best) {
        self.out[i] = best.prim != Hits::NONE;
    }
}
