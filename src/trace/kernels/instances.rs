//! Leaves of instances: rays go on in a mesh's own space.

use super::entries::Walks;
use super::packet::{self, Bests, Packet};
use super::ray::{Setup, WalkRay, cells, splat};
use super::stack::Stack;
use super::walk::{Best, Tree};
use crate::flat::{BLOCK, FlatScene, Instance};
use crate::math::lanes::Lanes;

/// What instance leaves do: walk on, or not exist.
pub(super) trait InstanceLeaves<L: Lanes> {
    /// Tests a run of instances; true ends the walk.
    fn test<const ANY: bool>(&mut self, run: &[u32], ray: &WalkRay<L>, best: &mut Best) -> bool;
    /// The same for a packet.
    fn test_packet<const ANY: bool>(
        &mut self,
        run: &[u32],
        packet: &Packet<L>,
        best: &mut Bests<L>,
    );
}

/// A tree without instances.
pub(super) struct NoInstances;

impl<L: Lanes> InstanceLeaves<L> for NoInstances {
    #[inline(always)]
    fn test<const ANY: bool>(&mut self, _: &[u32], _: &WalkRay<L>, _: &mut Best) -> bool {
        false
    }

    #[inline(always)]
    fn test_packet<const ANY: bool>(&mut self, _: &[u32], _: &Packet<L>, _: &mut Bests<L>) {}
}

/// Stacks for local trees.
#[derive(Default)]
pub(super) struct Scratch {
    stack: Box<Stack>,
    packets: packet::Scratch,
}

/// The scene's instances with stacks for their trees.
pub(super) struct LocalTrees<'a> {
    pub(super) scene: &'a FlatScene,
    pub(super) scratch: &'a mut Scratch,
}

/// The tree of an instance, with no hit nearer than `floor`.
#[inline(always)]
pub(super) fn tree<'a>(scene: &'a FlatScene, index: u32, floor: f32) -> Tree<'a> {
    let instance = &scene.instances[index as usize];
    let geometry = &scene.local[instance.geometry as usize];
    Tree {
        bvh: &geometry.bvh,
        triangles: &geometry.triangles.blocks,
        spheres: &[],
        instance: index,
        floor,
    }
}

/// A ray in the space of an instance, and where it enters the instance's box; nothing if it does not before `cull`.
#[inline(always)]
pub(super) fn enter<L: Lanes>(
    instance: &Instance,
    ray: &WalkRay<L>,
    cull: f32,
) -> Option<(WalkRay<L>, f32)> {
    let [min, max] = instance.bounds;
    let own = ray.box_of(splat(min), splat(max));
    if L::bits(own.meets(L::splat(cull))) & 1 == 0 {
        return None;
    }
    let [origin, dir] = local(instance, ray.lane(0));
    let local = WalkRay::new(origin, dir)?;
    let mut near = [0.0; BLOCK];
    own.near.store(&mut near);
    Some((local, near[0]))
}

impl<L: Walks> InstanceLeaves<L> for LocalTrees<'_> {
    #[inline(always)]
    fn test<const ANY: bool>(&mut self, run: &[u32], ray: &WalkRay<L>, best: &mut Best) -> bool {
        for &index in run {
            let instance = &self.scene.instances[index as usize];
            let Some((local, floor)) = enter(instance, ray, best.cull()) else {
                continue;
            };
            let tree = tree(self.scene, index, floor);
            let (stack, root) = (&mut self.scratch.stack, tree.bvh.root);
            let found =
                L::walk::<_, true, false, ANY>(&tree, root, &local, &mut NoInstances, stack, best);
            if ANY && found {
                return true;
            }
        }
        false
    }

    /// Rays that are no packet in an instance's space are tested one by one.
    #[inline(always)]
    fn test_packet<const ANY: bool>(
        &mut self,
        run: &[u32],
        packet: &Packet<L>,
        best: &mut Bests<L>,
    ) {
        for at in 0..run.len() {
            let index = run[at];
            let instance = &self.scene.instances[index as usize];
            let [min, max] = instance.bounds;
            let own = packet.ray.box_of(splat(min), splat(max));
            let met = own.meets(best.cull());
            if L::bits(met) == 0 {
                continue;
            }
            let [origin, dir] = local(instance, [packet.ray.origin, packet.ray.dir]);
            let cell = cells(dir);
            let mut lanes = [0.0; BLOCK];
            cell.store(&mut lanes);
            let like = L::splat(lanes[0]);
            let alike = L::bits(cell.le(like) & like.le(cell)) & Setup::sound(origin, dir);
            let local = if alike == (1 << L::N) - 1 {
                Packet::new(origin, dir, f32::INFINITY)
            } else {
                None
            };
            if let Some(local) = local {
                let tree = tree(self.scene, index, 0.0);
                let mut inside = best.only(met);
                L::walk_packet::<_, true, false, ANY>(
                    &tree,
                    &local,
                    &mut NoInstances,
                    &mut self.scratch.packets,
                    &own.near,
                    &mut inside,
                );
                best.update(met, &inside);
                continue;
            }
            let mut bests = best.scatter();
            for (lane, best) in bests.iter_mut().enumerate() {
                let ray = packet.ray.alone(lane);
                if best.t > 0.0 && self.test::<ANY>(&run[at..=at], &ray, best) {
                    best.t = packet::NOTHING;
                }
            }
            *best = Bests::of(&bests);
        }
    }
}

/// Rays in the instance's space; their directions keep their length, so that t is shared.
#[inline(always)]
fn local<L: Lanes>(instance: &Instance, [o, d]: [[L; 3]; 2]) -> [[L; 3]; 2] {
    let zero = L::splat(0.0);
    let [mut origin, mut dir] = [[zero; 3]; 2];
    for row in 0..3 {
        let [x, y, z, w] = instance.to_local[row];
        let [x, y, z, w] = [L::splat(x), L::splat(y), L::splat(z), L::splat(w)];
        origin[row] = x * o[0] + y * o[1] + z * o[2] + w;
        dir[row] = x * d[0] + y * d[1] + z * d[2];
    }
    [origin, dir]
}
