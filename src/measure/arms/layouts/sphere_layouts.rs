//! Spheres as structs, in ten arrays, in lane blocks.

use super::spheres::Balls;
use super::{first_lane, used};
use crate::flat::{BLOCK, FlatScene, SphereBlock};
use crate::math::lanes::{Lanes, WideLanes};
use std::sync::Arc;

/// A sphere with its box.
#[derive(Clone, Copy)]
pub(in super::super) struct Sphere {
    bounds: [f32; 6],
    center: [f64; 3],
    radius: f64,
    prim: u32,
}

/// The spheres of the scene's tree in leaf order.
fn in_leaf_order(scene: &FlatScene) -> impl Iterator<Item = Sphere> {
    let blocks = &scene.spheres.blocks;
    used(blocks.iter().map(|block| block.prim)).map(|(at, lane)| {
        let block = &blocks[at];
        Sphere {
            bounds: block.bounds.map(|plane| plane[lane]),
            center: block.center.map(|axis| axis[lane]),
            radius: block.radius[lane],
            prim: block.prim[lane],
        }
    })
}

/// An array of structs, tested one at a time.
pub(in super::super) struct Structs(Vec<Sphere>);

impl Structs {
    pub(in super::super) fn new(scene: &FlatScene) -> Structs {
        Structs(in_leaf_order(scene).collect())
    }
}

impl Balls for Structs {
    type Tested<L: Lanes> = f32;

    type Place<'a> = &'a Sphere;

    #[inline(always)]
    fn place<L: Lanes>(&self, slot: usize) -> &Sphere {
        &self.0[slot]
    }

    #[inline(always)]
    fn plane<L: Lanes>(place: &Sphere, plane: usize) -> L {
        L::splat(place.bounds[plane])
    }

    #[inline(always)]
    fn center<L: Lanes>(place: &Sphere, axis: usize) -> L::Wide {
        L::Wide::splat(place.center[axis])
    }

    #[inline(always)]
    fn radius<L: Lanes>(place: &Sphere) -> L::Wide {
        L::Wide::splat(place.radius)
    }

    #[inline(always)]
    fn prim(&self, slot: usize) -> u32 {
        self.0[slot].prim
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// An array for every number, with seven more elements, so that lanes may end beyond the last.
pub(in super::super) struct Arrays {
    bounds: [Vec<f32>; 6],
    center: [Vec<f64>; 3],
    radius: Vec<f64>,
    prim: Vec<u32>,
}

impl Arrays {
    pub(in super::super) fn new(scene: &FlatScene) -> Arrays {
        let all = || in_leaf_order(scene);
        let narrow = |of: &dyn Fn(&Sphere) -> f32| -> Vec<f32> {
            let padding = std::iter::repeat_n(0.0, BLOCK - 1);
            all().map(|s| of(&s)).chain(padding).collect()
        };
        let wide = |of: &dyn Fn(&Sphere) -> f64| -> Vec<f64> {
            let padding = std::iter::repeat_n(0.0, BLOCK - 1);
            all().map(|s| of(&s)).chain(padding).collect()
        };
        Arrays {
            bounds: [0, 1, 2, 3, 4, 5].map(|plane| narrow(&|s| s.bounds[plane])),
            center: [0, 1, 2].map(|axis| wide(&|s| s.center[axis])),
            radius: wide(&|s| s.radius),
            prim: all().map(|s| s.prim).collect(),
        }
    }
}

impl Balls for Arrays {
    type Tested<L: Lanes> = L;

    type Place<'a> = (&'a Arrays, usize);

    #[inline(always)]
    fn place<L: Lanes>(&self, slot: usize) -> (&Arrays, usize) {
        (self, slot)
    }

    #[inline(always)]
    fn plane<L: Lanes>((arrays, slot): (&Arrays, usize), plane: usize) -> L {
        L::load(&arrays.bounds[plane][slot..slot + L::N])
    }

    #[inline(always)]
    fn center<L: Lanes>((arrays, slot): (&Arrays, usize), axis: usize) -> L::Wide {
        L::Wide::load(&arrays.center[axis][slot..slot + L::N])
    }

    #[inline(always)]
    fn radius<L: Lanes>((arrays, slot): (&Arrays, usize)) -> L::Wide {
        L::Wide::load(&arrays.radius[slot..slot + L::N])
    }

    #[inline(always)]
    fn prim(&self, slot: usize) -> u32 {
        self.prim[slot]
    }

    fn bytes(&self) -> usize {
        let bounds: usize = self.bounds.iter().map(|plane| size_of_val(&**plane)).sum();
        let center: usize = self.center.iter().map(|axis| size_of_val(&**axis)).sum();
        bounds + center + size_of_val(&*self.radius) + size_of_val(&*self.prim)
    }
}

/// The product's blocks of eight spheres.
pub(in super::super) struct Blocks(pub(in super::super) Arc<FlatScene>);

impl Blocks {
    #[inline(always)]
    fn block(&self, slot: usize) -> &SphereBlock {
        &self.0.spheres.blocks[slot / BLOCK]
    }
}

impl Balls for Blocks {
    type Tested<L: Lanes> = L;

    const UNIT: usize = BLOCK;

    type Place<'a> = (&'a SphereBlock, usize);

    #[inline(always)]
    fn place<L: Lanes>(&self, slot: usize) -> (&SphereBlock, usize) {
        (self.block(slot), first_lane::<L>(slot))
    }

    #[inline(always)]
    fn plane<L: Lanes>((block, lane): (&SphereBlock, usize), plane: usize) -> L {
        L::load(&block.bounds[plane][lane..])
    }

    #[inline(always)]
    fn center<L: Lanes>((block, lane): (&SphereBlock, usize), axis: usize) -> L::Wide {
        L::Wide::load(&block.center[axis][lane..])
    }

    #[inline(always)]
    fn radius<L: Lanes>((block, lane): (&SphereBlock, usize)) -> L::Wide {
        L::Wide::load(&block.radius[lane..])
    }

    #[inline(always)]
    fn prim(&self, slot: usize) -> u32 {
        self.block(slot).prim[slot % BLOCK]
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.0.spheres.blocks)
    }
}
