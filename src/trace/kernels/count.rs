//! What a walk visits, counted: one ray after the other, nearest child first, by the product's own tests. Packets share
//! their nodes and streams wait for them, so that rays of a batch visit no more than this.
//!
//! For those who measure; apart from the kernels, which do not count.

use super::instances::{self, NoInstances};
use super::ray::WalkRay;
use super::walk::{Best, Tree, boxes, leaf};
use super::{entries, reset};
use crate::flat::bvh::{WIDTH, kind};
use crate::flat::{BLOCK, Child, FlatScene};
use crate::trace::{Hits, Isa, Rays};

/// What rays visited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Rays.
    pub rays: u64,
    /// Inner nodes whose children's boxes were tested, those of instances' trees among them.
    pub nodes: u64,
    /// Triangles and spheres of leaves that were tested.
    pub primitives: u64,
    /// Instances whose boxes were tested.
    pub instances: u64,
}

/// [`super::closest_hit`], counted; of hits, t, the primitive and its instance are as there.
#[must_use]
pub fn count_closest(scene: &FlatScene, rays: &Rays, hits: &mut Hits) -> Visits {
    reset(hits, rays);
    if !scene.spheres.looped.is_empty() {
        entries::looped_closest(Isa::SCALAR, &scene.spheres, rays, hits);
    }
    let mut walk = Walk::new(scene);
    for i in 0..rays.len() {
        let mut best = Best::below(hits.t[i]);
        best.prim = hits.prim[i];
        walk.ray::<false>(rays, i, &mut best);
        hits.t[i] = best.t;
        hits.prim[i] = best.prim;
        hits.instance[i] = best.instance;
    }
    walk.visits
}

/// [`super::occluded`], counted.
#[must_use]
pub fn count_occluded(scene: &FlatScene, rays: &Rays, out: &mut Vec<bool>) -> Visits {
    out.clear();
    out.resize(rays.len(), false);
    if !scene.spheres.looped.is_empty() {
        entries::looped_occluded(Isa::SCALAR, &scene.spheres, rays, out);
    }
    let mut walk = Walk::new(scene);
    for (i, blocked) in out.iter_mut().enumerate() {
        let limit = if *blocked { 0.0 } else { rays.t_max[i] };
        *blocked |= walk.ray::<true>(rays, i, &mut Best::below(limit));
    }
    walk.visits
}

/// A walk and what it has visited so far.
struct Walk<'a> {
    scene: &'a FlatScene,
    visits: Visits,
}

impl<'a> Walk<'a> {
    fn new(scene: &'a FlatScene) -> Walk<'a> {
        Walk {
            scene,
            visits: Visits::default(),
        }
    }

    /// One ray from the root of the world. Rays that want nothing visit nothing.
    fn ray<const ANY: bool>(&mut self, rays: &Rays, i: usize, best: &mut Best) -> bool {
        self.visits.rays += 1;
        let of = |array: &[Vec<f32>; 3]| [array[0][i], array[1][i], array[2][i]];
        let ray = WalkRay::<f32>::new(of(&rays.origin), of(&rays.dir));
        let scene = self.scene;
        let tree = Tree::world(scene);
        match ray {
            Some(ray) if best.t > 0.0 && !scene.world.bvh.bounds.is_empty() => {
                self.tree::<ANY>(&tree, &ray, best)
            }
            _ => false,
        }
    }

    /// As [`super::walk::walk`].
    fn tree<const ANY: bool>(&mut self, tree: &Tree, ray: &WalkRay<f32>, best: &mut Best) -> bool {
        if tree.bvh.root.kind() == kind::INNER && tree.bvh.nodes.is_empty() {
            return false;
        }
        let mut waiting = vec![(tree.bvh.root, 0.0)];
        while let Some((child, near)) = waiting.pop() {
            if near > best.cull() {
                continue;
            }
            match child.kind() {
                kind::INNER => {
                    self.visits.nodes += 1;
                    let node = &tree.bvh.nodes[child.index()];
                    let mut entries = [0.0; WIDTH];
                    let met = boxes(node, ray, best.cull(), &mut entries);
                    let first = waiting.len();
                    let met = (0..WIDTH).filter(|slot| met >> slot & 1 == 1);
                    waiting.extend(met.map(|slot| (Child(node.child[slot]), entries[slot])));
                    waiting[first..].sort_by(|a, b| b.1.total_cmp(&a.1));
                }
                kind::INSTANCES => {
                    if self.instances::<ANY>(tree, child, ray, best) && ANY {
                        return true;
                    }
                }
                _ => {
                    self.visits.primitives += primitives(tree, child);
                    let none = &mut NoInstances;
                    let found = leaf::<f32, _, true, true, ANY>(tree, child, ray, none, best);
                    if found && ANY {
                        return true;
                    }
                }
            }
        }
        false
    }

    /// A leaf of instances, each with its own tree.
    fn instances<const ANY: bool>(
        &mut self,
        tree: &Tree,
        child: Child,
        ray: &WalkRay<f32>,
        best: &mut Best,
    ) -> bool {
        let run = child.index()..child.index() + child.run_len();
        for &index in &tree.bvh.instance_order[run] {
            self.visits.instances += 1;
            let instance = &self.scene.instances[index as usize];
            let Some((local, floor)) = instances::enter(instance, ray, best.cull()) else {
                continue;
            };
            let own = instances::tree(self.scene, index, floor);
            if self.tree::<ANY>(&own, &local, best) && ANY {
                return true;
            }
        }
        false
    }
}

/// Primitives of a leaf of blocks.
fn primitives(tree: &Tree, child: Child) -> u64 {
    let run = child.index()..child.index() + child.run_len();
    let used = |prims: &[u32; BLOCK]| prims.iter().filter(|&&prim| prim != u32::MAX).count() as u64;
    match child.kind() {
        kind::TRIANGLES => tree.triangles[run]
            .iter()
            .map(|block| used(&block.prim))
            .sum(),
        _ => tree.spheres[run]
            .iter()
            .map(|block| used(&block.prim))
            .sum(),
    }
}
