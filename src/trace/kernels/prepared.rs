//! The setup of rays that are walked one by one, in lanes and ahead of them.

use super::ray::{Setup, WalkRay};
use crate::math::lanes::Lanes;
use crate::trace::Rays;

/// Rays whose setup is done at a time.
pub(super) const AHEAD: usize = 64;

/// The setup of rays of a batch, `[value][ray]`.
pub(super) struct Prepared {
    /// Origin, direction, near and far 1 / d, shear, kz.
    values: [[f32; AHEAD]; 16],
}

impl Default for Prepared {
    fn default() -> Prepared {
        Prepared {
            values: [[0.0; AHEAD]; 16],
        }
    }
}

impl Prepared {
    /// Sets up the first rays of `which`.
    #[inline(always)]
    pub(super) fn fill<L: Lanes>(&mut self, rays: &Rays, which: &[u32]) {
        for (k, &i) in which.iter().take(AHEAD).enumerate() {
            let i = i as usize;
            for axis in 0..3 {
                self.values[axis][k] = rays.origin[axis][i];
                self.values[3 + axis][k] = rays.dir[axis][i];
            }
        }
        let mut at = 0;
        while at < AHEAD && at < which.len() {
            let row = |row: usize| L::load(&self.values[row][at..]);
            let setup = Setup::new([row(3), row(4), row(5)]);
            let [near, far] = setup.inv;
            let values = [
                near[0],
                near[1],
                near[2],
                far[0],
                far[1],
                far[2],
                setup.shear[0],
                setup.shear[1],
                setup.shear[2],
                setup.kz,
            ];
            for (to, value) in self.values[6..].iter_mut().zip(values) {
                value.store(&mut to[at..]);
            }
            at += L::N;
        }
    }

    /// Ray `k` of those that were set up last, counted from any multiple of [`AHEAD`].
    #[inline(always)]
    pub(super) fn ray<L: Lanes>(&self, k: usize) -> WalkRay<L> {
        let k = k % AHEAD;
        let v = |row: usize| self.values[row][k];
        let setup = Setup {
            inv: [[v(6), v(7), v(8)], [v(9), v(10), v(11)]],
            shear: [v(12), v(13), v(14)],
            kz: v(15),
        };
        let (origin, dir) = ([v(0), v(1), v(2)], [v(3), v(4), v(5)]);
        WalkRay::prepared(origin, dir, &setup)
    }
}
