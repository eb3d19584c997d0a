//! Layouts of primitives in leaf order: a layout of triangles is a module here; those of spheres share one.
//!
//! A *slot* is a place of a primitive. Structs and arrays have one for each, without gaps; lane blocks pad every leaf to a
//! multiple of four or eight.

pub(super) mod sphere_layouts;
pub(super) mod spheres;
pub(super) mod triangle_layouts;
pub(super) mod triangles;

use super::nodes::Child;
use crate::flat::{BLOCK, FlatScene};
use crate::math::lanes::Lanes;
use crate::trace::Hits;
use crate::trace::kernels::ray::WalkRay;

/// The closest hit so far.
#[derive(Clone, Copy)]
pub(super) struct Best {
    pub(super) t: f32,
    pub(super) u: f32,
    pub(super) v: f32,
    pub(super) prim: u32,
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
        }
    }

    /// Takes the candidate if it comes first by (t, prim).
    #[inline(always)]
    pub(super) fn offer(&mut self, candidate: Best) {
        let tie = candidate.t == self.t && self.prim != Hits::NONE && candidate.prim < self.prim;
        if candidate.t < self.t || tie {
            *self = candidate;
        }
    }
}

/// Primitives in some layout.
pub(super) trait Primitives {
    /// The lanes that primitives are tested in, on a machine of lanes `L`.
    type Tested<L: Lanes>: Lanes;

    /// The slots of a leaf are a multiple of it.
    const UNIT: usize;

    /// Whether it is tested on one lane, too: see [`Layout::runs_on`](super::Layout::runs_on).
    const SCALAR: bool;

    /// Tests a leaf. Leaves the closest hit in `best`, or returns true at once at a hit below `best.t` if `any` will do.
    fn test<L: Lanes>(
        &self,
        leaf: Child,
        ray: &WalkRay<Self::Tested<L>>,
        any: bool,
        best: &mut Best,
    ) -> bool;

    /// Primitives of a leaf.
    fn count(&self, leaf: Child) -> u64;

    /// Bytes of all of them.
    fn bytes(&self) -> usize;
}

/// Names leaves by their slots.
pub(super) struct Slots {
    /// Slots before each block of the product, and all of them.
    before: Vec<u32>,
}

impl Slots {
    /// Of the scene's triangles, or spheres where there are none, padded to a multiple of `unit`. The product's leaves are
    /// runs of full blocks but for the last.
    pub(super) fn of(scene: &FlatScene, unit: usize) -> Slots {
        let triangles = &scene.world.triangles.blocks;
        match triangles.is_empty() {
            false => Slots::new(triangles.iter().map(|block| block.prim), unit),
            true => Slots::new(scene.spheres.blocks.iter().map(|block| block.prim), unit),
        }
    }

    /// The blocks' primitive indices, `u32::MAX` in unused lanes.
    fn new(blocks: impl Iterator<Item = [u32; BLOCK]>, unit: usize) -> Slots {
        let mut before = vec![0];
        let mut sum = 0;
        for prims in blocks {
            let used = prims.iter().filter(|&&prim| prim != u32::MAX).count();
            sum += used.next_multiple_of(unit) as u32;
            before.push(sum);
        }
        Slots { before }
    }

    /// A run of the product's blocks.
    pub(super) fn leaf(&self, block: u32, blocks: u32) -> Child {
        let [first, end] = [block, block + blocks].map(|b| self.before[b as usize]);
        Child {
            first,
            slots: end - first,
        }
    }
}

/// Places in the product's blocks that hold a primitive, in leaf order.
fn used(blocks: impl Iterator<Item = [u32; BLOCK]>) -> impl Iterator<Item = (usize, usize)> {
    blocks.enumerate().flat_map(|(block, prims)| {
        let lanes = (0..BLOCK).filter(move |&lane| prims[lane] != u32::MAX);
        lanes.map(move |lane| (block, lane))
    })
}

/// The lowest bits, one for each slot that is left.
#[inline(always)]
pub(super) fn first(slots: u32) -> u32 {
    match 1u32.checked_shl(slots) {
        Some(bit) => bit - 1,
        None => u32::MAX,
    }
}

/// The lane of a slot in its block, which for as many lanes as a block has is 0, as the compiler can see.
#[inline(always)]
pub(super) fn first_lane<L: Lanes>(slot: usize) -> usize {
    slot % BLOCK / L::N * L::N
}
