//! Random numbers: xoshiro256++ (Blackman and Vigna 2021), seeded by splitmix64; and Latin hypercubes of them.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// This many numbers of each sample are those of a Latin hypercube: place in the pixel, a light, a direction, a light.
const COLUMNS: usize = 10;

pub(crate) struct Random {
    state: [u64; 4],
    /// Which stratum every sample of a batch takes, column by column.
    strata: [Vec<u32>; COLUMNS],
    /// Of the batch, and how many of its numbers were drawn.
    sample: usize,
    drawn: usize,
}

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        let mut state = seed;
        let state = [0; 4].map(|_: u64| {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        });
        Random {
            state,
            strata: Default::default(),
            sample: 0,
            drawn: COLUMNS,
        }
    }

    /// Begins a batch of n samples: the k-th numbers of all of them fall into n equal intervals, one into each, in an
    /// order of its own for every k (McKay, Beckman and Conover 1979). One sample's numbers stay independent.
    pub(crate) fn batch(&mut self, n: usize) {
        self.drawn = COLUMNS;
        for k in 0..COLUMNS {
            let mut order: Vec<u32> = (0..n as u32).collect();
            for i in (1..n).rev() {
                let j = (self.unit() * (i + 1) as f64) as usize;
                order.swap(i, j.min(i));
            }
            self.strata[k] = order;
        }
    }

    /// Begins a sample of the batch.
    pub(crate) fn sample(&mut self, i: usize) {
        (self.sample, self.drawn) = (i, 0);
    }

    fn bits(&mut self) -> u64 {
        let s = &mut self.state;
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
        let u = (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
        let Some(column) = self.strata.get(self.drawn) else {
            return u;
        };
        self.drawn += 1;
        let n = column.len() as f64;
        ((f64::from(column[self.sample]) + u) / n).min(1.0f64.next_down())
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

    /// Uniform on the part of the unit sphere where the cosine to the unit vector `axis` is at least `low`.
    pub(crate) fn cap(&mut self, axis: DVec3, low: f64) -> DVec3 {
        let (s, t) = axis.any_orthonormal_pair();
        let cos = 1.0 - self.unit() * (1.0 - low);
        let (y, x) = (TAU * self.unit()).sin_cos();
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        s * (sin * x) + t * (sin * y) + axis * cos
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
