//! Random numbers: xoshiro256++ (Blackman and Vigna 2021), seeded by splitmix64.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

pub(crate) struct Random([u64; 4]);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        let mut state = seed;
        Random([0; 4].map(|_: u64| {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        }))
    }

    fn bits(&mut self) -> u64 {
        let s = &mut self.0;
        let out = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = s[3].rotate_left(45);
        out
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in the unit disk, by rejection.
    pub(crate) fn disk(&mut self) -> DVec2 {
        loop {
            let p = DVec2::new(2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            if p.length_squared() < 1.0 {
                return p;
            }
        }
    }

    /// Uniform on the unit sphere (Archimedes).
    pub(crate) fn sphere(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (sin, cos) = (TAU * self.unit()).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        DVec3::new(r * cos, r * sin, z)
    }

    /// Cosine-distributed about n: the direction of n plus a point of the unit sphere.
    pub(crate) fn cosine(&mut self, n: DVec3) -> DVec3 {
        loop {
            let d = n + self.sphere();
            if d.length_squared() > 1e-20 {
                return d.normalize();
            }
        }
    }
}
