//! A rival: a tree in some format over primitives in some layout.

use super::layouts::sphere_layouts as balls;
use super::layouts::spheres::Round;
use super::layouts::triangle_layouts as triangles;
use super::layouts::triangles::Triangles;
use super::layouts::{Gapless, Primitives, padded};
use super::nodes::{Node, Tree};
use super::walk::Answers;
use super::work::Work;
use super::{Arm, Layout, entries};
use crate::flat::FlatScene;
use crate::trace::{Hits, Isa, Rays};
use std::sync::Arc;

/// A rival.
struct Rival<N, P> {
    tree: Tree<N>,
    primitives: P,
}

impl<N: Node, P: Primitives> Rival<N, P> {
    fn gapless(scene: &FlatScene, primitives: P) -> Box<dyn Arm>
    where
        Self: 'static,
    {
        let names = Gapless::of(scene);
        let tree = N::tree(&scene.world.bvh, |block, blocks| names.leaf(block, blocks));
        Box::new(Rival { tree, primitives })
    }

    fn padded(scene: &FlatScene, primitives: P) -> Rival<N, P> {
        let tree = N::tree(&scene.world.bvh, padded);
        Rival { tree, primitives }
    }
}

/// The rival with this format of nodes; none where it would be the same as another.
pub(super) fn make<N: Node + 'static>(
    layout: Layout,
    scene: &Arc<FlatScene>,
) -> Option<Box<dyn Arm>> {
    let spheres = scene.world.triangles.blocks.is_empty();
    let own = || Arc::clone(scene);
    Some(match (layout, spheres) {
        (Layout::Structs, false) => {
            Rival::<N, _>::gapless(scene, Triangles(triangles::Structs::new(scene)))
        }
        (Layout::Gathered, false) => {
            Rival::<N, _>::gapless(scene, Triangles(triangles::Gathered::new(scene)))
        }
        (Layout::Arrays, false) => {
            Rival::<N, _>::gapless(scene, Triangles(triangles::Arrays::new(scene)))
        }
        (Layout::Blocks, false) => Box::new(Rival::<N, _>::padded(
            scene,
            Triangles(triangles::Blocks(own())),
        )),
        (Layout::Structs, true) => Rival::<N, _>::gapless(scene, Round(balls::Structs::new(scene))),
        (Layout::Arrays, true) => Rival::<N, _>::gapless(scene, Round(balls::Arrays::new(scene))),
        (Layout::Blocks, true) => {
            Box::new(Rival::<N, _>::padded(scene, Round(balls::Blocks(own()))))
        }
        (Layout::Gathered, true) | (Layout::Luxel, _) => return None,
    })
}

impl<N: Node, P: Primitives> Arm for Rival<N, P> {
    fn closest_hit(&self, isa: Isa, rays: &Rays, hits: &mut Hits) {
        resize(hits, rays.len());
        entries::batch(
            isa,
            &self.tree,
            &self.primitives,
            rays,
            Answers::Closest(hits),
        );
    }

    fn occluded(&self, isa: Isa, rays: &Rays, out: &mut Vec<bool>) {
        out.resize(rays.len(), false);
        entries::batch(
            isa,
            &self.tree,
            &self.primitives,
            rays,
            Answers::Occluded(out),
        );
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.tree.nodes) + self.primitives.bytes()
    }
}

/// The fields that rivals write.
fn resize(hits: &mut Hits, rays: usize) {
    for array in [&mut hits.t, &mut hits.u, &mut hits.v] {
        array.resize(rays, 0.0);
    }
    hits.prim.resize(rays, Hits::NONE);
}

/// Counts what walking a tree takes: of all layouts, since a layout changes nothing of it.
pub(super) trait Count {
    /// Of these rays.
    fn count(&self, rays: &Rays, occlusion: bool) -> Work;
}

/// The counting walk of this format of nodes.
pub(super) fn counter<N: Node + 'static>(scene: &Arc<FlatScene>) -> Box<dyn Count> {
    let own = || Arc::clone(scene);
    match scene.world.triangles.blocks.is_empty() {
        false => Box::new(Rival::<N, _>::padded(
            scene,
            Triangles(triangles::Blocks(own())),
        )),
        true => Box::new(Rival::<N, _>::padded(scene, Round(balls::Blocks(own())))),
    }
}

impl<N: Node, P: Primitives> Count for Rival<N, P> {
    fn count(&self, rays: &Rays, occlusion: bool) -> Work {
        let mut hits = Hits::default();
        let mut occluded = Vec::new();
        let answers = if occlusion {
            occluded.resize(rays.len(), false);
            Answers::Occluded(&mut occluded)
        } else {
            resize(&mut hits, rays.len());
            Answers::Closest(&mut hits)
        };
        entries::counted(&self.tree, &self.primitives, rays, answers)
    }
}
