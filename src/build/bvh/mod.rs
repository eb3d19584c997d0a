//! The builder of bounding volume hierarchies: boxes of primitives in, blocks in leaf order and a linear tree out.
//!
//! Two lives, two types: while it grows, the tree is made of `BuildNode`s over ranges of items; what rays
//! walk is [`LinearNode`](crate::flat::LinearNode)s. Deterministic, whatever the number of threads.
//!
//! Three steps: `item` makes a box and a name of every primitive (in the fast mode `morton` makes blocks of the
//! triangles first), `tree` partitions them top down, `linear` writes nodes and blocks down.
//!
//! Deliberately absent: refitting, any knowledge of rays, and spatial splits: those of Embree's builder took 3 to 8 times
//! the time on five meshes, a soup of thin triangles among them, and made rays 15 % slower to 8 % faster.

mod blocks;
mod item;
mod linear;
mod morton;
mod partition;
mod split;
mod standing;
mod tree;
pub mod validate;

use crate::flat::{BLOCK, Bvh, SphereBlock, Triangles};
use crate::math::{Aabb, Vec3};
use blocks::Ready;
pub use standing::Standing;
use std::ops::Range;

/// Lanes of a [`SphereBlock`].
const SPHERES: usize = BLOCK;

/// Items that one thread handles at a time where a range is shared by several: 512 KiB of them, which a second-level
/// cache holds.
const CHUNK: usize = 1 << 14;

/// Ranges of at least so many items are shared by threads.
const SHARED: usize = 2 * CHUNK;

/// Subtrees of at least so many items are grown by tasks of their own: some milliseconds of work.
const SUBTREE: usize = 8192;

/// How much of a tree is built. The picture is the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Accel {
    /// None: every ray tests every primitive.
    Brute,
    /// One box per group of triangles, with all its triangles.
    Box,
    /// The tree.
    #[default]
    Bvh,
}

/// How well a tree is built. The picture is the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Quality {
    /// By the surface area heuristic throughout.
    #[default]
    Good,
    /// Blocks of triangles along the Morton curve, and the heuristic above them: a third of the time, for which rays
    /// visit a fifth more nodes and blocks. For what is built anew for every frame, or seen by few rays.
    Fast,
}

/// A sphere for the tree or for the loop, scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereItem {
    /// Centre.
    pub center: [f64; 3],
    /// Radius.
    pub radius: f64,
    /// Index in authoring order.
    pub prim: u32,
}

impl SphereItem {
    /// Its row of [`crate::flat::Spheres::placed`].
    #[must_use]
    pub fn placed(&self) -> [f64; 4] {
        let [x, y, z] = self.center;
        [x, y, z, self.radius]
    }
}

/// What a tree is built over; all in one space.
#[derive(Clone, Copy, Debug, Default)]
pub struct Primitives<'a> {
    /// Vertices of each triangle, authoring order.
    pub triangles: &'a [[Vec3; 3]],
    /// The triangles of each mesh, for [`Accel::Box`]: disjoint, ascending, together all triangles. Empty means one
    /// group.
    pub groups: &'a [Range<u32>],
    /// Spheres of the tree.
    pub spheres: &'a [SphereItem],
    /// Boxes of the instances, in the scene's order.
    pub instances: &'a [Aabb],
}

/// What [`build`] gives.
#[derive(Clone, Debug)]
pub struct Built {
    /// The tree.
    pub bvh: Bvh,
    /// Triangles in leaf order.
    pub triangles: Triangles,
    /// Spheres in leaf order.
    pub sphere_blocks: Vec<SphereBlock>,
    /// Expected work of a ray that meets the root's box, in block tests (surface area heuristic): every inner node
    /// costs 0.4, every block 1, weighted by area.
    pub cost: f32,
}

/// Builds the tree over `p`, or less of it, as well as is worth it.
///
/// Any input is fine: none, one, a million equal ones. A primitive with a coordinate that is not finite gets an empty
/// box: it is stored, and never hit.
#[must_use]
pub fn build(p: &Primitives, accel: Accel) -> Built {
    build_with(p, accel, Quality::Good)
}

/// As [`build`], with a choice of how well.
#[must_use]
pub fn build_with(p: &Primitives, accel: Accel, quality: Quality) -> Built {
    let fast = (accel, quality) == (Accel::Bvh, Quality::Fast);
    let (ready, mut items) = if fast {
        morton::runs(p.triangles)
    } else {
        (Ready::new(p.triangles.len()), item::triangles(p))
    };
    items.extend(item::others(p));
    let root = match accel {
        Accel::Bvh => tree::grow(&mut items),
        Accel::Box if !p.groups.is_empty() => tree::over_kinds(&items, p.groups),
        Accel::Brute | Accel::Box => {
            let all = std::iter::once(0..p.triangles.len() as u32);
            tree::over_kinds(&items, &all.collect::<Vec<_>>())
        }
    };
    linear::linearize(p, &items, root, ready, None)
}

/// Spheres in the order given, eight to a block, the last one padded.
#[must_use]
pub fn sphere_blocks(spheres: &[SphereItem]) -> Vec<SphereBlock> {
    spheres.chunks(SPHERES).map(blocks::sphere_block).collect()
}

/// The f32 box of a sphere, rounded outward; empty if something is not finite.
#[must_use]
pub fn sphere_bounds(center: [f64; 3], radius: f64) -> Aabb {
    let lo = center.map(|c| round_down((c - radius).next_down()));
    let hi = center.map(|c| -round_down(-(c + radius).next_up()));
    finite_or_empty(Aabb {
        min: Vec3::from(lo),
        max: Vec3::from(hi),
    })
}

/// The largest f32 that is not above `x`.
fn round_down(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x {
        nearest.next_down()
    } else {
        nearest
    }
}

fn finite_or_empty(b: Aabb) -> Aabb {
    if b.min.is_finite() && b.max.is_finite() {
        b
    } else {
        Aabb::EMPTY
    }
}
