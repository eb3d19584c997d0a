//! The walk of one ray through a tree, eight children at a time, nearest first.

use super::instances::InstanceLeaves;
use super::ray::WalkRay;
use super::sphere::WideRay;
use super::stack::{DONE, Stack};
use super::triangle::{self, Candidates, FromLane};
use crate::flat::bvh::{WIDTH, kind};
use crate::flat::{BLOCK, Bvh, Child, FlatScene, LinearNode, SphereBlock, Spheres, TriangleBlock};
use crate::math::lanes::{Lanes, WideLanes};
use crate::trace::Hits;

/// The closest hit so far.
#[derive(Clone, Copy)]
pub(super) struct Best {
    pub(super) t: f32,
    pub(super) u: f32,
    pub(super) v: f32,
    pub(super) prim: u32,
    pub(super) instance: u32,
}

impl Best {
    /// No hit; hits below `limit` count.
    #[inline(always)]
    pub(super) fn below(limit: f32) -> Best {
        Best {
            t: limit,
            u: 0.0,
            v: 0.0,
            prim: Hits::NONE,
            instance: Hits::WORLD,
        }
    }

    /// Whether the candidate comes first by (t, instance, prim).
    #[inline(always)]
    pub(super) fn yields_to(&self, candidate: &Best) -> bool {
        let tie = candidate.t == self.t
            && self.prim != Hits::NONE
            && (candidate.instance, candidate.prim) < (self.instance, self.prim);
        candidate.t < self.t || tie
    }

    /// What boxes are culled by: nothing at infinity is ever entered.
    #[inline(always)]
    pub(super) fn cull(&self) -> f32 {
        Lanes::min(self.t, f32::MAX)
    }
}

/// Where rays come from and go to.
pub(super) trait Sink {
    /// What is known of a ray before the walk: its limit, or the closest hit that it has already. Nothing for a ray that
    /// is not to be walked.
    fn best(&self, index: usize) -> Option<Best>;
    /// What became of a ray.
    fn done(&mut self, index: usize, best: &Best);
}

/// A tree with the blocks that its leaves name.
#[derive(Clone, Copy)]
pub(super) struct Tree<'a> {
    pub(super) bvh: &'a Bvh,
    pub(super) triangles: &'a [TriangleBlock],
    pub(super) spheres: &'a [SphereBlock],
    /// Instance that the tree belongs to.
    pub(super) instance: u32,
    /// Where the ray enters that instance's box: no hit in it is nearer.
    pub(super) floor: f32,
}

impl Tree<'_> {
    /// The world's.
    #[inline(always)]
    pub(super) fn world(scene: &FlatScene) -> Tree<'_> {
        Tree {
            bvh: &scene.world.bvh,
            triangles: &scene.world.triangles.blocks,
            spheres: &scene.spheres.blocks,
            instance: Hits::WORLD,
            floor: 0.0,
        }
    }

    /// Where a child is, to be asked for; anywhere for instances and for what is not there.
    #[inline(always)]
    pub(super) fn address(&self, child: Child) -> *const u8 {
        match child.kind() {
            kind::INNER => self.bvh.nodes.as_ptr().wrapping_add(child.index()).cast(),
            kind::TRIANGLES => self.triangles.as_ptr().wrapping_add(child.index()).cast(),
            _ => self.spheres.as_ptr().wrapping_add(child.index()).cast(),
        }
    }
}

/// Walks the tree from a child on: leaves the closest hit in `best`, or with `ANY` returns true at the first hit below
/// `best.t`.
///
/// `T`, `S`: the tree has triangles, spheres. A node is culled when the ray enters it strictly beyond the best hit, so that
/// ties survive to be decided by id; and no hit lies outside its ancestors' intervals. Hence the result does not depend on
/// the tree.
#[inline(always)]
pub(super) fn walk<
    L: Lanes,
    I: InstanceLeaves<L>,
    const T: bool,
    const S: bool,
    const ANY: bool,
>(
    tree: &Tree,
    start: Child,
    ray: &WalkRay<L>,
    instances: &mut I,
    stack: &mut Stack,
    best: &mut Best,
) -> bool {
    let bvh = tree.bvh;
    let mut child = start;
    if child.kind() == kind::INNER && bvh.nodes.is_empty() {
        return false;
    }
    let mut top = 1;
    loop {
        if child.kind() == kind::INNER {
            let node = &bvh.nodes[child.index()];
            if let Some(nearest) = enter(node, ray, best.cull(), stack, &mut top) {
                child = nearest;
                continue;
            }
        } else if leaf::<L, I, T, S, ANY>(tree, child, ray, instances, best) && ANY {
            return true;
        }
        child = stack.pop(&mut top, best.cull());
        if child == DONE {
            return false;
        }
    }
}

/// Tests what a leaf holds; true ends the walk.
#[inline(always)]
pub(super) fn leaf<
    L: Lanes,
    I: InstanceLeaves<L>,
    const T: bool,
    const S: bool,
    const ANY: bool,
>(
    tree: &Tree,
    child: Child,
    ray: &WalkRay<L>,
    instances: &mut I,
    best: &mut Best,
) -> bool {
    let run = child.index()..child.index() + child.run_len();
    match child.kind() {
        kind::TRIANGLES if T => triangle_leaf::<L, ANY>(tree, &tree.triangles[run], ray, best),
        kind::SPHERES if S => sphere_leaf::<L, ANY>(&tree.spheres[run], ray, best),
        kind::INSTANCES => instances.test::<ANY>(&tree.bvh.instance_order[run], ray, best),
        _ => false,
    }
}

/// Tests the eight boxes; puts off those that the ray enters, farthest first, and returns the nearest.
#[inline(always)]
fn enter<L: Lanes>(
    node: &LinearNode,
    ray: &WalkRay<L>,
    cull: f32,
    stack: &mut Stack,
    top: &mut usize,
) -> Option<Child> {
    let mut near = [0.0; WIDTH];
    let met = boxes(node, ray, cull, &mut near);
    if met & met.wrapping_sub(1) == 0 {
        return (met != 0).then_some(Child(node.child[lowest(met)]));
    }
    let children = stack.children[*top..].first_chunk_mut()?;
    let entries = stack.entries[*top..].first_chunk_mut()?;
    let len = L::sort_falling(&near, met, &node.child, children, entries);
    *top += len - 1;
    Some(Child(children[(len - 1) % WIDTH]))
}

/// Tests the eight boxes of a node: writes where the ray enters them, negative where it does not, and returns the bits of
/// those that it enters.
#[inline(always)]
pub(super) fn boxes<L: Lanes>(
    node: &LinearNode,
    ray: &WalkRay<L>,
    cull: f32,
    near: &mut [f32; WIDTH],
) -> u32 {
    let mut met = 0;
    let mut at = 0;
    while at < WIDTH {
        let interval = ray.slabs(&node.planes, at);
        let meets = interval.meets(L::splat(cull));
        L::select(meets, interval.near, L::splat(-1.0)).store(&mut near[at..]);
        met |= L::bits(meets) << at;
        at += L::N;
    }
    met
}

/// Index of the lowest set bit of eight.
#[inline(always)]
pub(super) fn lowest(bits: u32) -> usize {
    bits.trailing_zeros() as usize & (WIDTH - 1)
}

#[inline(always)]
fn triangle_leaf<L: Lanes, const ANY: bool>(
    tree: &Tree,
    blocks: &[TriangleBlock],
    ray: &WalkRay<L>,
    best: &mut Best,
) -> bool {
    for block in blocks {
        if triangle_block::<L, ANY>(tree, block, ray, best) {
            return true;
        }
    }
    false
}

/// Tests a block of triangles; with `ANY`, true ends the walk.
#[inline(always)]
pub(super) fn triangle_block<L: Lanes, const ANY: bool>(
    tree: &Tree,
    block: &TriangleBlock,
    ray: &WalkRay<L>,
    best: &mut Best,
) -> bool {
    let mut c = Candidates::NONE;
    let mut hit = 0;
    let mut at = 0;
    while at < BLOCK {
        let corners = FromLane(block, at);
        let range = [L::splat(tree.floor), L::splat(best.t)];
        hit |= triangle::test(ray, &corners, at, range, &mut c) << at;
        at += L::N;
    }
    while hit != 0 {
        let lane = lowest(hit);
        hit &= hit - 1;
        if ANY && c.t[lane] < best.t {
            best.prim = block.prim[lane];
            return true;
        }
        let mut candidate = Best::below(c.t[lane]);
        candidate.prim = block.prim[lane];
        candidate.instance = tree.instance;
        if best.yields_to(&candidate) {
            [candidate.u, candidate.v] = c.weights(lane);
            *best = candidate;
        }
    }
    false
}

#[inline(always)]
fn sphere_leaf<L: Lanes, const ANY: bool>(
    blocks: &[SphereBlock],
    ray: &WalkRay<L>,
    best: &mut Best,
) -> bool {
    let zero = L::splat(0.0);
    let mut t = [0.0; BLOCK];
    for block in blocks {
        let mut hit = 0;
        let mut at = 0;
        while at < BLOCK {
            let own = ray.slabs(&block.bounds, at);
            let met = own.meets(L::splat(best.cull()));
            let center = [
                L::Wide::load(&block.center[0][at..]),
                L::Wide::load(&block.center[1][at..]),
                L::Wide::load(&block.center[2][at..]),
            ];
            if L::bits(met) != 0
                && let Some(root) = WideRay::new(ray.origin, ray.dir)
                    .root::<L>(center, L::Wide::load(&block.radius[at..]))
            {
                let clamped = root.min(own.far).max(own.near);
                clamped.store(&mut t[at..]);
                let counts = zero.lt(root) & root.lt(L::splat(f32::INFINITY)) & zero.lt(clamped);
                hit |= L::bits(met & counts & clamped.le(L::splat(best.t))) << at;
            }
            at += L::N;
        }
        while hit != 0 {
            let lane = lowest(hit);
            hit &= hit - 1;
            if ANY && t[lane] < best.t {
                best.prim = Spheres::TAG | block.prim[lane];
                return true;
            }
            let mut candidate = Best::below(t[lane]);
            candidate.prim = Spheres::TAG | block.prim[lane];
            if best.yields_to(&candidate) {
                *best = candidate;
            }
        }
    }
    false
}
