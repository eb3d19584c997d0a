//! The leaf test of triangles in any layout: the product's watertight test, told where the vertices come from.

use super::{Best, Child, Primitives, first};
use crate::flat::BLOCK;
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::WalkRay;
use crate::trace::kernels::triangle::{self, Candidates, Corners};

/// Vertices in some layout.
pub(in super::super) trait Vertices {
    /// The lanes that triangles are tested in, on a machine of lanes `L`.
    type Tested<L: Lanes>: Lanes;
    /// As [`Primitives::UNIT`].
    const UNIT: usize = 1;
    /// As [`Primitives::SCALAR`].
    const SCALAR: bool = true;
    /// Where some triangles are: found once, so that what is checked is checked once, too.
    type Place<'a>: Copy
    where
        Self: 'a;
    /// The `L::N` triangles from `slot` on.
    fn place<L: Lanes>(&self, slot: usize) -> Self::Place<'_>;
    /// A coordinate of one of their vertices; beyond the last slot, anything.
    fn load<L: Lanes>(place: Self::Place<'_>, vertex: usize, axis: usize) -> L;
    /// Primitive index; `u32::MAX` in unused slots.
    fn prim(&self, slot: usize) -> u32;
    /// Bytes of all of them.
    fn bytes(&self) -> usize;
}

/// Triangles with their vertices in some layout.
pub(in super::super) struct Triangles<V>(pub(in super::super) V);

/// Some triangles of a layout, for the product's test.
struct Placed<'a, V: Vertices> {
    from: &'a V,
    slot: usize,
    place: V::Place<'a>,
}

impl<L: Lanes, V: Vertices> Corners<L> for Placed<'_, V> {
    #[inline(always)]
    fn load(&self, vertex: usize, axis: usize) -> L {
        V::load(self.place, vertex, axis)
    }

    #[inline(always)]
    fn vertices(&self, lane: usize) -> [[f32; 3]; 3] {
        let place = self.from.place::<f32>(self.slot + lane);
        let vertex = |k: usize| {
            [
                V::load::<f32>(place, k, 0),
                V::load::<f32>(place, k, 1),
                V::load::<f32>(place, k, 2),
            ]
        };
        [vertex(0), vertex(1), vertex(2)]
    }
}

impl<V: Vertices> Primitives for Triangles<V> {
    type Tested<L: Lanes> = V::Tested<L>;
    const UNIT: usize = V::UNIT;
    const SCALAR: bool = V::SCALAR;

    #[inline(always)]
    fn test<L: Lanes>(
        &self,
        leaf: Child,
        ray: &WalkRay<V::Tested<L>>,
        any: bool,
        best: &mut Best,
    ) -> bool {
        let lanes = <V::Tested<L> as Lanes>::N;
        let mut found = Candidates::NONE;
        let mut at = 0;
        while at < leaf.slots {
            let slot = (leaf.first + at) as usize;
            let corners = Placed {
                from: &self.0,
                slot,
                place: self.0.place::<V::Tested<L>>(slot),
            };
            let range = [Lanes::splat(0.0), Lanes::splat(best.t)];
            let mut hit =
                triangle::test(ray, &corners, 0, range, &mut found) & first(leaf.slots - at);
            while hit != 0 {
                let lane = hit.trailing_zeros() as usize & (BLOCK - 1);
                hit &= hit - 1;
                if any && found.t[lane] < best.t {
                    return true;
                }
                let [u, v] = found.weights(lane);
                best.offer(Best {
                    t: found.t[lane],
                    u,
                    v,
                    prim: self.0.prim(slot + lane),
                });
            }
            at += lanes as u32;
        }
        false
    }

    fn count(&self, leaf: Child) -> u64 {
        let used = |slot: &u32| self.0.prim(*slot as usize) != u32::MAX;
        (leaf.first..leaf.first + leaf.slots).filter(used).count() as u64
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}
