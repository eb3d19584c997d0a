//! Triangles as structs, in nine arrays, in lane blocks.

use super::triangles::Vertices;
use super::{first_lane, used};
use crate::flat::{BLOCK, FlatScene, TriangleBlock};
use crate::math::lanes::Lanes;
use std::sync::Arc;

/// A triangle as most programs have it.
#[derive(Clone, Copy)]
pub(in super::super) struct Triangle {
    v: [[f32; 3]; 3],
    prim: u32,
}

/// The scene's triangles in leaf order.
fn in_leaf_order(scene: &FlatScene) -> impl Iterator<Item = Triangle> {
    let blocks = &scene.world.triangles.blocks;
    used(blocks.iter().map(|block| block.prim)).map(|(block, lane)| Triangle {
        v: blocks[block].v.map(|vertex| vertex.map(|axis| axis[lane])),
        prim: blocks[block].prim[lane],
    })
}

/// An array of structs, tested one at a time: bvh crates that store what they are given.
pub(in super::super) struct Structs(Vec<Triangle>);

impl Structs {
    pub(in super::super) fn new(scene: &FlatScene) -> Structs {
        Structs(in_leaf_order(scene).collect())
    }
}

impl Vertices for Structs {
    type Tested<L: Lanes> = f32;

    type Place<'a> = &'a Triangle;

    #[inline(always)]
    fn place<L: Lanes>(&self, slot: usize) -> &Triangle {
        &self.0[slot]
    }

    #[inline(always)]
    fn load<L: Lanes>(place: &Triangle, vertex: usize, axis: usize) -> L {
        L::splat(place.v[vertex][axis])
    }

    #[inline(always)]
    fn prim(&self, slot: usize) -> u32 {
        self.0[slot].prim
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// The same array, eight triangles gathered into lanes for every test: SIMD over structs that somebody else needs as they
/// are.
pub(in super::super) struct Gathered(Vec<Triangle>);

impl Gathered {
    /// Seven more, so that lanes may end beyond the last.
    pub(in super::super) fn new(scene: &FlatScene) -> Gathered {
        let nothing = Triangle {
            v: [[0.0; 3]; 3],
            prim: u32::MAX,
        };
        let padding = std::iter::repeat_n(nothing, BLOCK - 1);
        Gathered(in_leaf_order(scene).chain(padding).collect())
    }
}

impl Vertices for Gathered {
    type Tested<L: Lanes> = L;

    type Place<'a> = &'a [Triangle];

    #[inline(always)]
    fn place<L: Lanes>(&self, slot: usize) -> &[Triangle] {
        &self.0[slot..slot + L::N]
    }

    #[inline(always)]
    fn load<L: Lanes>(place: &[Triangle], vertex: usize, axis: usize) -> L {
        let mut lanes = [0.0; BLOCK];
        for (lane, triangle) in lanes.iter_mut().zip(place) {
            *lane = triangle.v[vertex][axis];
        }
        L::load(&lanes)
    }

    #[inline(always)]
    fn prim(&self, slot: usize) -> u32 {
        self.0[slot].prim
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// Nine arrays, one for each coordinate of each vertex, and one of indices: structure of arrays by the book. A leaf's lanes
/// come from nine places of memory, unaligned.
pub(in super::super) struct Arrays {
    /// `v[vertex][axis]`, with seven more elements, so that lanes may end beyond the last.
    v: [[Vec<f32>; 3]; 3],
    prim: Vec<u32>,
}

impl Arrays {
    pub(in super::super) fn new(scene: &FlatScene) -> Arrays {
        let padding = || std::iter::repeat_n(0.0, BLOCK - 1);
        let array = |vertex: usize, axis: usize| -> Vec<f32> {
            let all = in_leaf_order(scene).map(|t| t.v[vertex][axis]);
            all.chain(padding()).collect()
        };
        Arrays {
            v: [0, 1, 2].map(|vertex| [0, 1, 2].map(|axis| array(vertex, axis))),
            prim: in_leaf_order(scene).map(|t| t.prim).collect(),
        }
    }
}

impl Vertices for Arrays {
    type Tested<L: Lanes> = L;

    type Place<'a> = (&'a Arrays, usize);

    #[inline(always)]
    fn place<L: Lanes>(&self, slot: usize) -> (&Arrays, usize) {
        (self, slot)
    }

    #[inline(always)]
    fn load<L: Lanes>((arrays, slot): (&Arrays, usize), vertex: usize, axis: usize) -> L {
        L::load(&arrays.v[vertex][axis][slot..slot + L::N])
    }

    #[inline(always)]
    fn prim(&self, slot: usize) -> u32 {
        self.prim[slot]
    }

    fn bytes(&self) -> usize {
        let arrays = self.v.iter().flatten();
        arrays.map(|array| size_of_val(&**array)).sum::<usize>() + size_of_val(&*self.prim)
    }
}

/// The product's blocks: eight triangles together, coordinate by coordinate; a leaf is one run of memory. Also known as
/// array of structures of arrays; Embree's `Triangle4v` with four lanes.
pub(in super::super) struct Blocks(pub(in super::super) Arc<FlatScene>);

impl Blocks {
    #[inline(always)]
    fn block(&self, slot: usize) -> &TriangleBlock {
        &self.0.world.triangles.blocks[slot / BLOCK]
    }
}

impl Vertices for Blocks {
    type Tested<L: Lanes> = L;

    type Place<'a> = (&'a TriangleBlock, usize);

    #[inline(always)]
    fn place<L: Lanes>(&self, slot: usize) -> (&TriangleBlock, usize) {
        (self.block(slot), first_lane::<L>(slot))
    }

    #[inline(always)]
    fn load<L: Lanes>((block, lane): (&TriangleBlock, usize), vertex: usize, axis: usize) -> L {
        L::load(&block.v[vertex][axis][lane..])
    }

    #[inline(always)]
    fn prim(&self, slot: usize) -> u32 {
        self.block(slot).prim[slot % BLOCK]
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.0.world.triangles.blocks)
    }
}
