//! The leaf test of spheres in any layout: the product's, but for where they come from.

use super::{Best, Child, Primitives, first};
use crate::flat::{BLOCK, Spheres};
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::WalkRay;
use crate::trace::kernels::sphere::WideRay;

/// Spheres in some layout; beyond the last slot they hold anything.
pub(in super::super) trait Balls {
    /// The lanes that spheres are tested in, on a machine of lanes `L`.
    type Tested<L: Lanes>: Lanes;
    /// A plane of the boxes of the spheres from `slot` on: minima of x, y, z, then maxima.
    fn plane<L: Lanes>(&self, slot: usize, plane: usize) -> L;
    /// A coordinate of the centres.
    fn center<L: Lanes>(&self, slot: usize, axis: usize) -> L::Wide;
    /// The radii.
    fn radius<L: Lanes>(&self, slot: usize) -> L::Wide;
    /// Sphere index; `u32::MAX` in unused slots.
    fn prim(&self, slot: usize) -> u32;
    /// Bytes of all of them.
    fn bytes(&self) -> usize;
}

/// Spheres in some layout, as leaves.
pub(in super::super) struct Round<B>(pub(in super::super) B);

impl<B: Balls> Primitives for Round<B> {
    type Tested<L: Lanes> = B::Tested<L>;

    #[inline(always)]
    fn test<L: Lanes>(
        &self,
        leaf: Child,
        ray: &WalkRay<B::Tested<L>>,
        any: bool,
        best: &mut Best,
    ) -> bool {
        let wide = WideRay::splat::<B::Tested<L>>(ray.origin_dir);
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
    let own = ray.between(planes(from, slot, ray.near), planes(from, slot, ray.far));
    // Nothing at infinity is ever met.
    let met = own.meets(L::splat(Lanes::min(limit, f32::MAX)));
    if L::bits(met) == 0 {
        return 0;
    }
    let center = [
        from.center::<L>(slot, 0),
        from.center::<L>(slot, 1),
        from.center::<L>(slot, 2),
    ];
    let Some(root) = wide.root::<L>(center, from.radius::<L>(slot)) else {
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
fn planes<L: Lanes, B: Balls>(from: &B, slot: usize, of: [usize; 3]) -> [L; 3] {
    [
        from.plane(slot, of[0]),
        from.plane(slot, of[1]),
        from.plane(slot, of[2]),
    ]
}
