//! The product's own kernels as an arm.

use super::Arm;
use crate::flat::FlatScene;
use crate::trace::{self, Hits, Isa, Rays};
use std::sync::Arc;

/// What `luxel render` runs; unlike the others it also bounds the error of every hit, as a renderer needs.
pub struct Luxel(pub Arc<FlatScene>);

impl Arm for Luxel {
    fn closest_hit(&self, isa: Isa, rays: &Rays, hits: &mut Hits) {
        trace::closest_hit(&self.0, isa, rays, hits);
    }

    fn occluded(&self, isa: Isa, rays: &Rays, out: &mut Vec<bool>) {
        trace::occluded(&self.0, isa, rays, out);
    }

    fn bytes(&self) -> usize {
        let world = &self.0.world;
        size_of_val(&*world.bvh.nodes)
            + size_of_val(&*world.triangles.blocks)
            + size_of_val(&*self.0.spheres.blocks)
    }
}
