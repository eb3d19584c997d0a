//! Random numbers and noise of the generators: equal seeds give equal bits on every machine.

use crate::math::DVec3;

/// SplitMix64 (Steele, Lea and Flood, *Fast splittable pseudorandom number generators*, 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A stream of its own for every seed.
    #[must_use]
    pub fn new(seed: u64) -> Random {
        Random(seed)
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.0)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        unit(self.bits())
    }

    /// Uniform in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform below `n`; the bias of the remainder is below n / 2⁶⁴.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// Uniform in the box from `low` to `high`.
    pub fn point(&mut self, low: DVec3, high: DVec3) -> DVec3 {
        let at = DVec3::new(self.unit(), self.unit(), self.unit());
        low + (high - low) * at
    }

    /// Uniform on the unit sphere, by rejection from the cube.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.point(DVec3::NEG_ONE, DVec3::ONE);
            let length = v.length();
            // A short vector would have few bits of direction.
            if length > 0.01 && length <= 1.0 {
                return v / length;
            }
        }
    }
}

/// The finalizer of SplitMix64: every bit of the result depends on every bit of `z`.
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The upper 53 bits as a number in [0, 1).
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// Octaves of value noise, each of twice the frequency and half the height of the one before. In [0, 1).
pub(super) fn fractal(p: DVec3, octaves: u32) -> f64 {
    let (mut sum, mut at, mut height) = (0.0, p, 0.5);
    for _ in 0..octaves {
        sum += height * value_noise(at);
        at *= 2.0;
        height *= 0.5;
    }
    sum
}

/// Random values at the points of the integer lattice, blended smoothly in between. In [0, 1).
fn value_noise(p: DVec3) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let smooth = f * f * (DVec3::splat(3.0) - 2.0 * f);
    let blend = |a: f64, b: f64, s: f64| a + (b - a) * s;
    let row = |y: i64, z: i64| blend(lattice(cell, 0, y, z), lattice(cell, 1, y, z), smooth.x);
    let plane = |z: i64| blend(row(0, z), row(1, z), smooth.y);
    blend(plane(0), plane(1), smooth.z)
}

/// The value at a corner of a cell.
fn lattice(cell: DVec3, x: i64, y: i64, z: i64) -> f64 {
    // Odd constants keep the axes apart; lattice coordinates are small.
    let key = (cell.x as i64 + x)
        .wrapping_mul(0x2545_f491_4f6c_dd1d)
        .wrapping_add((cell.y as i64 + y).wrapping_mul(0x5851_f42d_4c95_7f2d))
        .wrapping_add((cell.z as i64 + z).wrapping_mul(0x1405_7b7e_f767_814f));
    unit(mix(key as u64))
}
