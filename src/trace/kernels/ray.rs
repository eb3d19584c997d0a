//! One ray, ready to be tested against blocks: everything that costs once per ray.

use crate::flat::BLOCK;
use crate::math::lanes::Lanes;

/// Factors that widen a slab interval by three units in the last place at each end.
///
/// A plane's parameter is `fl(fl(plane − o) · fl(1 / d))`: three roundings, (1 + ε)³ with ε = 2⁻²⁴, so less than
/// two units of 2⁻²³ away from the exact one; a computed t and the rounding of the product here take the third
/// (Ize, *Robust BVH Ray Traversal*, 2013, widens the far end alone by two; both ends are needed for a hit's t to
/// lie inside the interval).
const NEAR: f32 = 1.0 - 3.0 * f32::EPSILON;
const FAR: f32 = 1.0 + 3.0 * f32::EPSILON;

/// A ray in lanes, with what the slab and the triangle test want once.
#[derive(Clone, Copy)]
pub(super) struct WalkRay<L> {
    /// Origin, one axis after the other.
    pub(super) origin: [L; 3],
    inv: [L; 3],
    /// Which of six planes is the near one, and which the far one, by axis.
    near: [usize; 3],
    far: [usize; 3],
    /// kx, ky, kz of the watertight test: kz is the axis of the largest component.
    pub(super) axes: [usize; 3],
    /// −d[kx] / d[kz], −d[ky] / d[kz], 1 / d[kz].
    pub(super) shear: [L; 3],
    /// Origin and direction as given.
    pub(super) origin_dir: [[f32; 3]; 2],
}

/// Where a ray is inside a box, widened; empty if `near <= far` does not hold.
#[derive(Clone, Copy)]
pub(super) struct Interval<L> {
    pub(super) near: L,
    pub(super) far: L,
}

impl<L: Lanes> WalkRay<L> {
    /// Nothing for a ray that cannot hit: something is not finite, or the direction is zero.
    #[inline(always)]
    pub(super) fn new(origin: [f32; 3], dir: [f32; 3]) -> Option<WalkRay<L>> {
        let [x, y, z] = [dir[0].abs(), dir[1].abs(), dir[2].abs()];
        let mut finite = true;
        for axis in 0..3 {
            finite &= origin[axis].is_finite() & dir[axis].is_finite();
        }
        if !finite || (x == 0.0 && y == 0.0 && z == 0.0) {
            return None;
        }
        let kz = if x >= y && x >= z {
            0
        } else {
            1 + usize::from(z > y)
        };
        let [kx, ky] = [[1, 2], [2, 0], [0, 1]][kz];
        let negative = [
            usize::from(dir[0].is_sign_negative()),
            usize::from(dir[1].is_sign_negative()),
            usize::from(dir[2].is_sign_negative()),
        ];
        let shear = [-dir[kx] / dir[kz], -dir[ky] / dir[kz], 1.0 / dir[kz]];
        Some(WalkRay {
            origin: splat(origin),
            inv: splat([1.0 / dir[0], 1.0 / dir[1], 1.0 / dir[2]]),
            near: [3 * negative[0], 1 + 3 * negative[1], 2 + 3 * negative[2]],
            far: [
                3 - 3 * negative[0],
                4 - 3 * negative[1],
                5 - 3 * negative[2],
            ],
            axes: [kx, ky, kz],
            shear: splat(shear),
            origin_dir: [origin, dir],
        })
    }

    /// Whether the direction's sign bit is set on the axis.
    #[inline(always)]
    fn negative(&self, axis: usize) -> bool {
        self.near[axis] > self.far[axis]
    }

    /// The slab test of `L::N` boxes from lane `at` on.
    #[inline(always)]
    pub(super) fn slabs(&self, planes: &[[f32; BLOCK]; 6], at: usize) -> Interval<L> {
        let near = [
            L::load(&planes[self.near[0]][at..]),
            L::load(&planes[self.near[1]][at..]),
            L::load(&planes[self.near[2]][at..]),
        ];
        let far = [
            L::load(&planes[self.far[0]][at..]),
            L::load(&planes[self.far[1]][at..]),
            L::load(&planes[self.far[2]][at..]),
        ];
        self.between(near, far)
    }

    /// The slab test of boxes given by their corners.
    #[inline(always)]
    pub(super) fn box_of(&self, min: [L; 3], max: [L; 3]) -> Interval<L> {
        let [mut near, mut far] = [min, max];
        for axis in 0..3 {
            if self.negative(axis) {
                near[axis] = max[axis];
                far[axis] = min[axis];
            }
        }
        self.between(near, far)
    }

    /// `(plane − o) · inv`, the largest of the near planes and 0, the smallest of the far planes.
    ///
    /// The new value is the first operand of each select, so that NaN, 0 · ∞ of a ray that lies in a slab's plane,
    /// is dropped: such a ray counts as inside. Every step is monotone in the planes, so that the interval of a box
    /// contains those of all boxes in it, to the bit.
    #[inline(always)]
    fn between(&self, near_planes: [L; 3], far_planes: [L; 3]) -> Interval<L> {
        let mut near = L::splat(0.0);
        let mut far = L::splat(f32::INFINITY);
        for axis in 0..3 {
            let n = (near_planes[axis] - self.origin[axis]) * self.inv[axis];
            let f = (far_planes[axis] - self.origin[axis]) * self.inv[axis];
            near = n.max(near);
            far = f.min(far);
        }
        Interval {
            near: near * L::splat(NEAR),
            far: far * L::splat(FAR),
        }
    }
}

impl<L: Lanes> Interval<L> {
    /// Whether the interval holds any t in [0, `limit`].
    #[inline(always)]
    pub(super) fn meets(&self, limit: L) -> L::Mask {
        self.near.le(self.far.min(limit))
    }
}

#[inline(always)]
pub(super) fn splat<L: Lanes>(x: [f32; 3]) -> [L; 3] {
    [L::splat(x[0]), L::splat(x[1]), L::splat(x[2])]
}
