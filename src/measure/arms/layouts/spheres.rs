//! The leaf test of spheres in any layout: the product's, but for where they come from.

use super::{Best, Child, Primitives, first};
use crate::flat::{BLOCK, Spheres};
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::{Plane, WalkRay};
use crate::trace::kernels::sphere::WideRay;

/// Spheres in some layout; beyond the last slot they hold anything.
pub(in super::super) trait Balls {
    /// The lanes that spheres are tested in, on a machine of lanes `L`.
    type Tested<L: Lanes>: Lanes;
    /// As [`Primitives::UNIT`].
    const UNIT: usize = 1;
    /// Where some spheres are: found once, so that what is checked is checked once, too.
    type Place<'a>: Copy
    where
        Self: 'a;
    /// The `L::N` spheres from `slot` on.
    fn place<L: Lanes>(&self, slot: usize) -> Self::Place<'_>;
    /// A plane of their boxes: minima of x, y, z, then maxima.
    fn plane<L: Lanes>(place: Self::Place<'_>, plane: usize) -> L;
    /// A coordinate of their centres.
    fn center<L: Lanes>(place: Self::Place<'_>, axis: usize) -> L::Wide;
    /// Their radii.
    fn radius<L: Lanes>(place: Self::Place<'_>) -> L::Wide;
    /// Sphere index; `u32::MAX` in unused slots.
    fn prim(&self, slot: usize) -> u32;
    /// Bytes of all of them.
    fn bytes(&self) -> usize;
}

/// Spheres in some layout, as leaves.
pub(in super::super) struct Round<B>(pub(in super::super) B);

impl<B: Balls> Primitives for Round<B> {
    type Tested<L: Lanes> = B::Tested<L>;
    const UNIT: usize = B::UNIT;
    const SCALAR: bool = true;

    #[inline(always)]
    fn test<L: Lanes>(
        &self,
        leaf: Child,
        ray: &WalkRay<B::Tested<L>>,
        any: bool,
        best: &mut Best,
    ) -> bool {
        let wide = WideRay::new(ray.origin, ray.dir);
        let mut t = [0.0; BLOCK];
        let mut at = 0;
        while at < leaf.slots {
            let slot = (leaf.first + at) as usize;
            let mut hit = hits(ray, &wide, &self.0, slot, best.t, &mut t);
            hit &= first(leaf.slots - at);
            while hit != 0 {
                let lane = hit.trailing_zeros() as usize & (BLOCK - 1);
                hit &= hit - 1;
                if any && t[lane] < best.t {
                    return true;
                }
                best.offer(Best {
                    prim: Spheres::TAG | self.0.prim(slot + lane),
                    ..Best::below(t[lane])
                });
            }
            at += <B::Tested<L> as Lanes>::N as u32;
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

/// Tests the `L::N` spheres from `slot` on; returns the lanes that hit.
#[inline(always)]
fn hits<L: Lanes, B: Balls>(
    ray: &WalkRay<L>,
    wide: &WideRay<L::Wide>,
    from: &B,
    slot: usize,
    limit: f32,
    t: &mut [f32; BLOCK],
) -> u32 {
    let place = from.place::<L>(slot);
    let near = planes::<L, B>(place, ray.planes.near);
    let own = ray.between(near, planes::<L, B>(place, ray.planes.far));
    // Nothing at infinity is ever met.
    let met = own.meets(L::splat(Lanes::min(limit, f32::MAX)));
    if L::bits(met) == 0 {
        return 0;
    }
    let center = [
        B::center::<L>(place, 0),
        B::center::<L>(place, 1),
        B::center::<L>(place, 2),
    ];
    let Some(root) = wide.root::<L>(center, B::radius::<L>(place)) else {
        return 0;
    };
    let zero = L::splat(0.0);
    let clamped = root.min(own.far).max(own.near);
    clamped.store(t);
    let counts = zero.lt(root) & root.lt(L::splat(f32::INFINITY)) & zero.lt(clamped);
    L::bits(met & counts & clamped.le(L::splat(limit)))
}

/// A plane for each axis.
#[inline(always)]
fn planes<L: Lanes, B: Balls>(place: B::Place<'_>, of: [Plane; 3]) -> [L; 3] {
    [
        B::plane(place, of[0].row()),
        B::plane(place, of[1].row()),
        B::plane(place, of[2].row()),
    ]
}
