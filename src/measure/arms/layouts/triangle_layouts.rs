//! Triangles as structs, in nine arrays, in blocks of four and of eight lanes.

use super::triangles::Vertices;
use super::{first_lane, used};
use crate::flat::{BLOCK, FlatScene, TriangleBlock};
use crate::math::lanes::{Lanes, baseline};
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

    /// One lane at a time is what [`Structs`] does.
    const SCALAR: bool = false;

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

/// Four triangles, coordinate by coordinate, on registers of four lanes: Embree's `Triangle4v`. Leaves are padded less than in
/// blocks of eight, and tested in up to twice as many steps.
pub(in super::super) struct Fours(Vec<Four>);

/// As [`TriangleBlock`].
#[repr(C, align(32))]
pub(in super::super) struct Four {
    v: [[[f32; FOUR]; 3]; 3],
    prim: [u32; FOUR],
}

/// Lanes of a [`Four`].
const FOUR: usize = 4;

impl Fours {
    pub(in super::super) fn new(scene: &FlatScene) -> Fours {
        let mut fours = Vec::new();
        for block in &scene.world.triangles.blocks {
            for at in (0..BLOCK).step_by(FOUR) {
                let four = |lanes: &[f32; BLOCK]| [0, 1, 2, 3].map(|lane| lanes[at + lane]);
                let prim = [0, 1, 2, 3].map(|lane| block.prim[at + lane]);
                if prim[0] != u32::MAX {
                    let v = block.v.each_ref().map(|axes| axes.each_ref().map(four));
                    fours.push(Four { v, prim });
                }
            }
        }
        Fours(fours)
    }
}

impl Vertices for Fours {
    type Tested<L: Lanes> = baseline::F32x4;

    const UNIT: usize = FOUR;

    /// One lane at a time is what [`Blocks`] does.
    const SCALAR: bool = false;

    type Place<'a> = (&'a Four, usize);

    #[inline(always)]
    fn place<L: Lanes>(&self, slot: usize) -> (&Four, usize) {
        (&self.0[slot / FOUR], slot % FOUR / L::N * L::N)
    }

    #[inline(always)]
    fn load<L: Lanes>((four, lane): (&Four, usize), vertex: usize, axis: usize) -> L {
        L::load(&four.v[vertex][axis][lane..])
    }

    #[inline(always)]
    fn prim(&self, slot: usize) -> u32 {
        self.0[slot / FOUR].prim[slot % FOUR]
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// The product's blocks: eight triangles together, coordinate by coordinate; a leaf is one run of memory. Also known as
/// array of structures of arrays.
pub(in super::super) struct Blocks(pub(in super::super) Arc<FlatScene>);

impl Blocks {
    #[inline(always)]
    fn block(&self, slot: usize) -> &TriangleBlock {
        &self.0.world.triangles.blocks[slot / BLOCK]
    }
}

impl Vertices for Blocks {
    type Tested<L: Lanes> = L;

    const UNIT: usize = BLOCK;

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
