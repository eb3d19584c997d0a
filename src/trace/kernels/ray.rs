//! Rays, ready to be tested: everything that costs once per ray.

use super::batch::MOST_LANES;
use crate::flat::BLOCK;
use crate::math::lanes::Lanes;

/// Factors of 1 / d, for near planes and far ones, that widen a slab interval by four units in the last place at each end.
///
/// A plane's parameter is `fl(fl(plane − o) · fl(fl(1 / d) · factor))`: four roundings, (1 + ε)⁴ with ε = 2⁻²⁴, so at
/// most two units of 2⁻²³ away from the exact one; a computed t takes the third, and the fourth is slack (Ize, *Robust BVH
/// Ray Traversal*, 2013, widens the far end alone by two; both ends are needed for a hit's t to lie inside the interval).
pub(crate) const WIDENED: [f32; 2] = [1.0 - 4.0 * f32::EPSILON, 1.0 + 4.0 * f32::EPSILON];

/// One of the six planes of a node's boxes, by where its eight lanes begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Plane {
    MinX = 0,
    MinY = BLOCK as u8,
    MinZ = 2 * BLOCK as u8,
    MaxX = 3 * BLOCK as u8,
    MaxY = 4 * BLOCK as u8,
    MaxZ = 5 * BLOCK as u8,
}

/// One plane of `L::N` boxes from lane `at` on.
#[inline(always)]
fn plane<L: Lanes>(planes: &[[f32; BLOCK]; 6], plane: Plane, at: usize) -> L {
    L::load(&planes.as_flattened()[plane as usize + at..])
}

impl Plane {
    /// Its row.
    #[inline(always)]
    pub(crate) fn row(self) -> usize {
        self as usize / BLOCK
    }
}

/// The planes that a ray meets first and those that it meets last, by axis.
#[derive(Clone, Copy)]
pub(crate) struct Planes {
    pub(crate) near: [Plane; 3],
    pub(crate) far: [Plane; 3],
}

/// By the direction's sign bits.
const PLANES: [Planes; 8] = planes();

const fn planes() -> [Planes; 8] {
    use Plane::{MaxX, MaxY, MaxZ, MinX, MinY, MinZ};
    let (min, max) = ([MinX, MinY, MinZ], [MaxX, MaxY, MaxZ]);
    let mut all = [Planes {
        near: min,
        far: max,
    }; 8];
    let mut signs = 0;
    while signs < 8 {
        let mut axis = 0;
        while axis < 3 {
            if signs >> axis & 1 == 1 {
                all[signs].near[axis] = max[axis];
                all[signs].far[axis] = min[axis];
            }
            axis += 1;
        }
        signs += 1;
    }
    all
}

/// An axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Axis {
    X,
    Y,
    Z,
}

/// kx, ky, kz of the watertight test by kz, the axis of the largest component.
const AXES: [[Axis; 3]; 3] = [
    [Axis::Y, Axis::Z, Axis::X],
    [Axis::Z, Axis::X, Axis::Y],
    [Axis::X, Axis::Y, Axis::Z],
];

/// What costs once per ray, for as many rays as there are lanes.
#[derive(Clone, Copy)]
pub(super) struct Setup<L> {
    /// 1 / d for near planes and for far ones.
    pub(super) inv: [[L; 3]; 2],
    /// −d[kx] / d[kz], −d[ky] / d[kz], 1 / d[kz].
    pub(super) shear: [L; 3],
    /// 0, 1 or 2: the axis of the largest component.
    pub(super) kz: L,
}

impl<L: Lanes> Setup<L> {
    #[inline(always)]
    pub(super) fn new(dir: [L; 3]) -> Setup<L> {
        Setup::widened(dir, WIDENED)
    }

    /// With other factors in place of [`WIDENED`].
    #[inline(always)]
    fn widened(dir: [L; 3], [nearer, farther]: [f32; 2]) -> Setup<L> {
        let one = L::splat(1.0);
        let inv = [one / dir[0], one / dir[1], one / dir[2]];
        let [nearer, farther] = [L::splat(nearer), L::splat(farther)];
        let [x, y, z] = [dir[0].abs(), dir[1].abs(), dir[2].abs()];
        let y_first = x.lt(y);
        let z_first = x.max(y).lt(z);
        let largest = [y_first, z_first];
        let dz = choose(largest, dir[0], dir[1], dir[2]);
        Setup {
            inv: [
                [inv[0] * nearer, inv[1] * nearer, inv[2] * nearer],
                [inv[0] * farther, inv[1] * farther, inv[2] * farther],
            ],
            shear: [
                -choose(largest, dir[1], dir[2], dir[0]) / dz,
                -choose(largest, dir[2], dir[0], dir[1]) / dz,
                one / dz,
            ],
            kz: choose(largest, L::splat(0.0), L::splat(1.0), L::splat(2.0)),
        }
    }

    /// Which rays can hit: all is finite, and the direction is not zero.
    #[inline(always)]
    pub(super) fn sound(origin: [L; 3], dir: [L; 3]) -> u32 {
        let zero = L::splat(0.0);
        let somewhere = zero.lt(dir[0].abs()) | zero.lt(dir[1].abs()) | zero.lt(dir[2].abs());
        L::bits(finite(origin) & finite(dir) & somewhere)
    }
}

/// Kinds of directions that [`cells`] tells apart.
pub(super) const CELLS: usize = 32;

/// The octant and the kz of directions, a number below [`CELLS`].
#[inline(always)]
pub(super) fn cells<L: Lanes>(dir: [L; 3]) -> L {
    let zero = L::splat(0.0);
    let [x, y, z] = [dir[0].abs(), dir[1].abs(), dir[2].abs()];
    let largest = [x.lt(y), x.max(y).lt(z)];
    let mut cell = choose(largest, zero, L::splat(8.0), L::splat(16.0));
    for axis in 0..3 {
        cell = cell + L::select(dir[axis].lt(zero), L::splat((1 << axis) as f32), zero);
    }
    cell
}

/// The value of the axis that is the largest: y before x, z before both.
#[inline(always)]
fn choose<L: Lanes>([y, z]: [L::Mask; 2], of_x: L, of_y: L, of_z: L) -> L {
    L::select(z, of_z, L::select(y, of_y, of_x))
}

#[inline(always)]
fn finite<L: Lanes>(v: [L; 3]) -> L::Mask {
    let most = L::splat(f32::MAX);
    v[0].abs().le(most) & v[1].abs().le(most) & v[2].abs().le(most)
}

/// Rays in lanes, with what the slab and the triangle test want once: one ray in all lanes, against as many boxes or
/// primitives, or a packet, rays with one octant and one kz, against one box or primitive.
#[derive(Clone, Copy)]
pub(crate) struct WalkRay<L> {
    /// Origin, one axis after the other.
    pub(crate) origin: [L; 3],
    /// Direction as given.
    pub(crate) dir: [L; 3],
    /// 1 / d for near planes and for far ones.
    pub(super) inv: [[L; 3]; 2],
    /// −d[kx] / d[kz], −d[ky] / d[kz], 1 / d[kz].
    pub(crate) shear: [L; 3],
    pub(crate) planes: Planes,
    /// kx, ky, kz of the watertight test.
    pub(crate) axes: [Axis; 3],
}

/// Where a ray is inside a box, widened; empty if `near <= far` does not hold.
#[derive(Clone, Copy)]
pub(crate) struct Interval<L> {
    pub(crate) near: L,
    pub(crate) far: L,
}

impl<L: Lanes> WalkRay<L> {
    /// Nothing for a ray that cannot hit: something is not finite, or the direction is zero.
    #[inline(always)]
    pub(crate) fn new(origin: [f32; 3], dir: [f32; 3]) -> Option<WalkRay<L>> {
        WalkRay::widened(origin, dir, WIDENED)
    }

    /// With other factors in place of [`WIDENED`], to measure what those cost.
    #[inline(always)]
    pub(crate) fn widened(origin: [f32; 3], dir: [f32; 3], by: [f32; 2]) -> Option<WalkRay<L>> {
        let sound = Setup::<f32>::sound(origin, dir) != 0;
        sound.then(|| WalkRay::prepared(origin, dir, &Setup::<f32>::widened(dir, by)))
    }

    /// A ray whose setup is done, in all lanes.
    #[inline(always)]
    pub(super) fn prepared(origin: [f32; 3], dir: [f32; 3], setup: &Setup<f32>) -> WalkRay<L> {
        let lanes = Setup {
            inv: [splat(setup.inv[0]), splat(setup.inv[1])],
            shear: splat(setup.shear),
            kz: L::splat(setup.kz),
        };
        WalkRay::packet(splat(origin), splat(dir), &lanes)
    }

    /// Rays with the octant and the kz of the first, whose setup is done.
    #[inline(always)]
    pub(super) fn packet(origin: [L; 3], dir: [L; 3], setup: &Setup<L>) -> WalkRay<L> {
        let first = lane_of(dir, 0);
        let [kz, ..] = lane_of([setup.kz; 3], 0);
        let sign = |axis: usize| (first[axis].to_bits() >> 31) as usize;
        WalkRay {
            origin,
            dir,
            inv: setup.inv,
            shear: setup.shear,
            planes: PLANES[sign(0) | sign(1) << 1 | sign(2) << 2],
            axes: AXES[if kz > 1.5 { 2 } else { usize::from(kz > 0.5) }],
        }
    }

    /// The ray of a lane in all lanes.
    #[inline(always)]
    pub(super) fn alone(&self, lane: usize) -> WalkRay<L> {
        let of = |x: [L; 3]| splat(lane_of(x, lane));
        WalkRay {
            origin: of(self.origin),
            dir: of(self.dir),
            inv: [of(self.inv[0]), of(self.inv[1])],
            shear: of(self.shear),
            ..*self
        }
    }

    /// Origin and direction of the ray in a lane.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> [[f32; 3]; 2] {
        [lane_of(self.origin, lane), lane_of(self.dir, lane)]
    }

    /// Whether the direction's sign bit is set on the axis.
    #[inline(always)]
    pub(super) fn negative(&self, axis: usize) -> bool {
        self.planes.near[axis] as u8 > self.planes.far[axis] as u8
    }

    /// The slab test of `L::N` boxes from lane `at` on.
    #[inline(always)]
    pub(crate) fn slabs(&self, planes: &[[f32; BLOCK]; 6], at: usize) -> Interval<L> {
        let near = [
            plane(planes, self.planes.near[0], at),
            plane(planes, self.planes.near[1], at),
            plane(planes, self.planes.near[2], at),
        ];
        let far = [
            plane(planes, self.planes.far[0], at),
            plane(planes, self.planes.far[1], at),
            plane(planes, self.planes.far[2], at),
        ];
        self.between(near, far)
    }

    /// The slab test of boxes given by their corners.
    #[inline(always)]
    pub(crate) fn box_of(&self, min: [L; 3], max: [L; 3]) -> Interval<L> {
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
    pub(crate) fn between(&self, near_planes: [L; 3], far_planes: [L; 3]) -> Interval<L> {
        let mut near = L::splat(0.0);
        let mut far = L::splat(f32::INFINITY);
        for axis in 0..3 {
            let n = (near_planes[axis] - self.origin[axis]) * self.inv[0][axis];
            let f = (far_planes[axis] - self.origin[axis]) * self.inv[1][axis];
            near = n.max(near);
            far = f.min(far);
        }
        Interval { near, far }
    }
}

impl<L: Lanes> Interval<L> {
    /// Whether the interval holds any t in [0, `limit`].
    #[inline(always)]
    pub(crate) fn meets(&self, limit: L) -> L::Mask {
        self.near.le(self.far.min(limit))
    }
}

/// A lane of three.
#[inline(always)]
fn lane_of<L: Lanes>(x: [L; 3], lane: usize) -> [f32; 3] {
    let mut lanes = [[0.0; MOST_LANES]; 3];
    for axis in 0..3 {
        x[axis].store(&mut lanes[axis]);
    }
    let lane = lane % MOST_LANES;
    [lanes[0][lane], lanes[1][lane], lanes[2][lane]]
}

#[inline(always)]
pub(super) fn dot<L: Lanes>(a: [L; 3], b: [L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn splat<L: Lanes>(x: [f32; 3]) -> [L; 3] {
    [L::splat(x[0]), L::splat(x[1]), L::splat(x[2])]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole numbers that differ from run to run of a generator (Marsaglia 2003, xorshift).
    struct Numbers(u64);

    impl Numbers {
        fn below(&mut self, n: u64) -> u64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            self.0 % n
        }

        fn range(&mut self, low: f32, high: f32) -> f32 {
            low + (high - low) * self.below(1 << 24) as f32 / (1 << 24) as f32
        }
    }

    /// Rays that start in a corner, an edge or a face of a box, or are aimed at one by steps that are exact: all meet the
    /// box, and the point is in the interval.
    #[test]
    fn boxes_are_met_at_their_corners() {
        let mut numbers = Numbers(0x2545_f491_4f6c_dd1d);
        let mut flat = 0;
        for case in 0..1_000_000u32 {
            let scale = 2f32.powi(numbers.below(41) as i32 - 20);
            let away = [0.0, 1e3, 1e5, 1e6, 1e7][case as usize % 5] * scale;
            let [mut min, mut max, mut point] = [[0.0f32; 3]; 3];
            for axis in 0..3 {
                let a = away + numbers.range(-1.0, 1.0) * scale;
                let b = away + numbers.range(-1.0, 1.0) * scale;
                [min[axis], max[axis]] = [a.min(b), a.max(b)];
                if numbers.below(8) == 0 {
                    max[axis] = min[axis];
                    flat += 1;
                }
                point[axis] = match numbers.below(3) {
                    0 => min[axis],
                    1 => max[axis],
                    _ => (0.5 * min[axis] + 0.5 * max[axis]).clamp(min[axis], max[axis]),
                };
            }
            // Origins from which a step of a whole number of directions leads to the point to the bit, where f32 holds them.
            let steps = [0.0, 1.0, 3.0, 1024.0][numbers.below(4) as usize];
            let small = [-3.0f32, -1.0, -0.0, 0.0, 1.0, 2.0, 7.0, 1e-20];
            let dir = [(); 3].map(|()| small[numbers.below(8) as usize] * scale);
            let mut origin = [0.0; 3];
            for axis in 0..3 {
                origin[axis] = point[axis] - steps * dir[axis];
            }
            let exact = (0..3).all(|axis| {
                let [o, step] = [origin[axis], steps * dir[axis]].map(f64::from);
                let there = o + step;
                let rounded = there - o != step || there - step != o;
                !rounded && there >= f64::from(min[axis]) && there <= f64::from(max[axis])
            });
            let Some(ray) = WalkRay::<f32>::new(origin, dir).filter(|_| exact) else {
                continue;
            };
            let met = ray.box_of(min, max);
            assert!(
                met.near <= steps && steps <= met.far,
                "case {case}: {origin:?} {dir:?} {min:?} {max:?}"
            );
            let planes: [[f32; BLOCK]; 6] =
                [min[0], min[1], min[2], max[0], max[1], max[2]].map(|x| [x; BLOCK]);
            let same = ray.slabs(&planes, 0);
            assert!(
                same.near.to_bits() == met.near.to_bits()
                    && same.far.to_bits() == met.far.to_bits()
            );
        }
        assert!(flat > 100_000);
    }
}
