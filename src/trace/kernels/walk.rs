//! The walk of one ray through a tree, eight children at a time, nearest first.

use super::ray::{WalkRay, splat};
use super::sphere::WideRay;
use super::triangle::{self, Candidates, FromLane};
use crate::flat::bvh::{STACK, WIDTH, kind};
use crate::flat::{
    BLOCK, Bvh, Child, FlatScene, Instance, LinearNode, SphereBlock, Spheres, TriangleBlock,
};
use crate::math::lanes::{Lanes, WideLanes};
use crate::trace::Hits;

/// Children put off, and where the ray enters them. Its length is proven by the builder's cap on depth.
pub(super) type Stack = [(Child, f32); STACK];

/// A stack with nothing on it.
pub(super) const EMPTY_STACK: Stack = [(Child::inner(0), 0.0); STACK];

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
    fn yields_to(&self, candidate: &Best) -> bool {
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

/// What instance leaves do: walk on, or not exist.
pub(super) trait InstanceLeaves<L: Lanes> {
    /// Tests a run of instances; true ends the walk.
    fn test<const ANY: bool>(&mut self, run: &[u32], ray: &WalkRay<L>, best: &mut Best) -> bool;
}

/// A tree without instances.
pub(super) struct NoInstances;

impl<L: Lanes> InstanceLeaves<L> for NoInstances {
    #[inline(always)]
    fn test<const ANY: bool>(&mut self, _: &[u32], _: &WalkRay<L>, _: &mut Best) -> bool {
        false
    }
}

/// The scene's instances with a stack for their trees.
pub(super) struct LocalTrees<'a> {
    pub(super) scene: &'a FlatScene,
    pub(super) stack: &'a mut Stack,
}

impl<L: Lanes> InstanceLeaves<L> for LocalTrees<'_> {
    #[inline(always)]
    fn test<const ANY: bool>(&mut self, run: &[u32], ray: &WalkRay<L>, best: &mut Best) -> bool {
        for &index in run {
            let instance = &self.scene.instances[index as usize];
            let [min, max] = instance.bounds;
            let own = ray.box_of(splat(min), splat(max));
            if L::bits(own.meets(L::splat(best.cull()))) & 1 == 0 {
                continue;
            }
            let Some(local) = local_ray::<L>(instance, ray.origin_dir) else {
                continue;
            };
            let mut near = [0.0; BLOCK];
            own.near.store(&mut near);
            let geometry = &self.scene.local[instance.geometry as usize];
            let tree = Tree {
                bvh: &geometry.bvh,
                triangles: &geometry.triangles.blocks,
                spheres: &[],
                instance: index,
                floor: near[0],
            };
            let found =
                walk::<L, _, true, false, ANY>(&tree, &local, &mut NoInstances, self.stack, best);
            if ANY && found {
                return true;
            }
        }
        false
    }
}

/// The ray in the instance's space; its direction keeps its length, so that t is shared.
#[inline(always)]
fn local_ray<L: Lanes>(instance: &Instance, [o, d]: [[f32; 3]; 2]) -> Option<WalkRay<L>> {
    let m = &instance.to_local;
    let [mut origin, mut dir] = [[0.0; 3]; 2];
    for row in 0..3 {
        let [x, y, z, w] = m[row];
        origin[row] = x * o[0] + y * o[1] + z * o[2] + w;
        dir[row] = x * d[0] + y * d[1] + z * d[2];
    }
    WalkRay::new(origin, dir)
}

/// Walks the tree: leaves the closest hit in `best`, or with `ANY` returns true at the first hit below `best.t`.
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
    ray: &WalkRay<L>,
    instances: &mut I,
    stack: &mut Stack,
    best: &mut Best,
) -> bool {
    let bvh = tree.bvh;
    let mut child = bvh.root;
    if child.kind() == kind::INNER && bvh.nodes.is_empty() {
        return false;
    }
    let mut top = 0;
    loop {
        let found = if child.kind() == kind::INNER {
            let node = &bvh.nodes[child.index()];
            if let Some(nearest) = enter(node, ray, best.cull(), stack, &mut top) {
                child = nearest;
                continue;
            }
            false
        } else {
            leaf::<L, I, T, S, ANY>(tree, child, ray, instances, best)
        };
        if ANY && found {
            return true;
        }
        loop {
            if top == 0 {
                return false;
            }
            top -= 1;
            if stack[top].1 <= best.cull() {
                break;
            }
        }
        child = stack[top].0;
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
    let mut met = 0;
    let mut at = 0;
    while at < WIDTH {
        let interval = ray.slabs(&node.planes, at);
        interval.near.store(&mut near[at..]);
        met |= L::bits(interval.meets(L::splat(cull))) << at;
        at += L::N;
    }
    if met == 0 {
        return None;
    }
    let mut nearest = lowest(met);
    met &= met - 1;
    let first = *top;
    while met != 0 {
        let mut far = lowest(met);
        met &= met - 1;
        if near[far] < near[nearest] {
            (far, nearest) = (nearest, far);
        }
        let entry = (Child(node.child[far]), near[far]);
        let mut place = *top;
        while place > first && stack[place - 1].1 < entry.1 {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = entry;
        *top += 1;
    }
    Some(Child(node.child[nearest]))
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
        hit |= triangle::test(ray, &corners, at, [tree.floor, best.t], &mut c) << at;
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
                && let Some(root) = WideRay::splat::<L>(ray.origin_dir)
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
