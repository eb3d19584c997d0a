//! The traversal kernels: batches of rays in, closest hits or occlusion out.
//!
//! Every rule of what a hit is stands here, and none depends on the tree, the instruction set or the order of anything:
//! - A candidate's t is clamped into the widened slab interval of its primitive's own box, then compared by
//!   (t, instance, primitive). Boxes of nodes contain those of their primitives exactly and the slab test is monotone, so that
//!   no ancestor culls a hit (`ray`, `triangle`, `walk`).
//! - Looped spheres are tested before the tree, without a box; which spheres they are is part of the scene.
//! - An instance is entered by rays that meet its own box; its hits are not nearer than that box.
//! - Rays with anything not finite, without direction, or without a positive `t_max` hit nothing. Triangles with two equal
//!   corners or anything not finite are never hit. Those whose corners lie in a line are by rays that come so near that
//!   only rounding tells: else meshes that are closed by such would have cracks.
//!
//! A batch goes through the tree in up to three ways, which `group` chooses: rays that go one way from one place as packets,
//! eight rays against one box or primitive (`packet`); the others each by itself, one ray against eight boxes or primitives
//! (`walk`), or, where the tree outgrows the caches, that way but many at a time (`stream`). All of them run the same tests.
//!
//! Generic over lanes and over what the tree holds, chosen once per batch; see `entries` for what runs where.
#![allow(
    clippy::needless_range_loop,
    reason = "axes are numbers here: several arrays are indexed by one"
)]

mod batch;
pub(crate) mod bound;
mod count;
mod entries;
mod group;
mod instances;
mod inward;
mod packet;
mod prepared;
pub(crate) mod ray;
pub(crate) mod sphere;
mod stack;
mod stream;
pub(crate) mod triangle;
mod walk;

pub use count::{Visits, count_closest, count_occluded};
pub use triangle::t_error_bound;

use super::{Hits, Isa, Rays};
use crate::flat::FlatScene;

/// The closest hit of each ray with 0 < t ≤ `t_max`, ties by (instance, primitive); `hits` are resized.
pub fn closest_hit(scene: &FlatScene, isa: Isa, rays: &Rays, hits: &mut Hits) {
    reset(hits, rays);
    if !scene.spheres.looped.is_empty() {
        entries::looped_closest(isa, &scene.spheres, rays, hits);
    }
    if !scene.world.bvh.bounds.is_empty() {
        entries::tree_closest(isa, scene, rays, hits);
    }
    for (i, &prim) in hits.prim.iter().enumerate() {
        if prim == Hits::NONE {
            hits.t[i] = f32::INFINITY;
            hits.err[i] = 0.0;
        }
    }
}

/// Whether each ray hits anything with 0 < t < `t_max`: exactly `closest_hit(...).t < t_max`. `out` is resized.
pub fn occluded(scene: &FlatScene, isa: Isa, rays: &Rays, out: &mut Vec<bool>) {
    out.clear();
    out.resize(rays.len(), false);
    if !scene.spheres.looped.is_empty() {
        entries::looped_occluded(isa, &scene.spheres, rays, out);
    }
    if !scene.world.bvh.bounds.is_empty() {
        entries::tree_occluded(isa, scene, rays, out);
    }
}

/// Misses, with the lowest t that does not count in place of t.
fn reset(hits: &mut Hits, rays: &Rays) {
    let n = rays.len();
    hits.t.clear();
    hits.t.extend(rays.t_max.iter().map(|&t| {
        if t > 0.0 {
            t.min(f32::MAX).next_up()
        } else {
            0.0
        }
    }));
    for (array, value) in [
        (&mut hits.prim, Hits::NONE),
        (&mut hits.instance, Hits::WORLD),
    ] {
        array.clear();
        array.resize(n, value);
    }
    for array in [&mut hits.u, &mut hits.v, &mut hits.err] {
        array.clear();
        array.resize(n, 0.0);
    }
}
