//! A rival: a tree in some format over primitives in some layout.

use super::layouts::sphere_layouts as balls;
use super::layouts::spheres::Round;
use super::layouts::triangle_layouts as triangles;
use super::layouts::triangles::Triangles;
use super::layouts::{Primitives, Slots};
use super::nodes::{Node, Quantised, Tree, Wide};
use super::walk::Answers;
use super::work::Work;
use super::{Arm, Layout, entries};
use crate::flat::FlatScene;
use crate::trace::{Hits, Isa, Rays};
use std::sync::Arc;

/// A rival.
pub(super) struct Rival<N, P> {
    pub(super) tree: Tree<N>,
    primitives: P,
}

impl<N: Node, P: Primitives> Rival<N, P> {
    pub(super) fn new(scene: &FlatScene, primitives: P) -> Box<Rival<N, P>> {
        let slots = Slots::of(scene, P::UNIT);
        let tree = N::tree(&scene.world.bvh, |block, blocks| slots.leaf(block, blocks));
        Box::new(Rival { tree, primitives })
    }
}

/// The layouts that every tree has.
pub(super) fn make<N: Node + 'static>(
    layout: Layout,
    scene: &Arc<FlatScene>,
) -> Option<Box<dyn Arm>> {
    let own = || Arc::clone(scene);
    Some(match (layout, spheres(scene)) {
        (Layout::Structs, false) => {
            Rival::<N, _>::new(scene, Triangles(triangles::Structs::new(scene)))
        }
        (Layout::Arrays, false) => {
            Rival::<N, _>::new(scene, Triangles(triangles::Arrays::new(scene)))
        }
        (Layout::Blocks, false) => Rival::<N, _>::new(scene, Triangles(triangles::Blocks(own()))),
        (Layout::Structs, true) => Rival::<N, _>::new(scene, Round(balls::Structs::new(scene))),
        (Layout::Arrays, true) => Rival::<N, _>::new(scene, Round(balls::Arrays::new(scene))),
        (Layout::Blocks, true) => Rival::<N, _>::new(scene, Round(balls::Blocks(own()))),
        _ => return None,
    })
}

/// The layouts of triangles that only wide nodes have: each takes seconds to compile, and says nothing new on others.
pub(super) fn make_wide(layout: Layout, scene: &FlatScene) -> Option<Box<dyn Arm>> {
    Some(match (layout, spheres(scene)) {
        (Layout::Gathered, false) => {
            Rival::<Wide, _>::new(scene, Triangles(triangles::Gathered::new(scene)))
        }
        (Layout::Fours, false) => {
            Rival::<Wide, _>::new(scene, Triangles(triangles::Fours::new(scene)))
        }
        _ => return None,
    })
}

/// Quantised nodes, which only the product's layout has, likewise.
pub(super) fn make_quantised(layout: Layout, scene: &Arc<FlatScene>) -> Option<Box<dyn Arm>> {
    let blocks = || Triangles(triangles::Blocks(Arc::clone(scene)));
    let there = layout == Layout::Blocks && !spheres(scene);
    there.then(|| Rival::<Quantised, _>::new(scene, blocks()) as Box<dyn Arm>)
}

/// Whether a scene has spheres in place of triangles.
fn spheres(scene: &FlatScene) -> bool {
    scene.world.triangles.blocks.is_empty()
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
    match spheres(scene) {
        false => Rival::<N, _>::new(scene, Triangles(triangles::Blocks(own()))),
        true => Rival::<N, _>::new(scene, Round(balls::Blocks(own()))),
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
