//! What error bars are made of: how much neighbouring blocks of a pixel's samples differ.
//!
//! Samples of one pixel are not independent: any 2ᵏ of them that are aligned are spread evenly, and any 2ᵏ⁺¹ more evenly
//! still. So their scatter says too much of the error of their mean. But the half-difference of two aligned blocks of 2ᵏ
//! has the variance V(2ᵏ) − V(2ᵏ⁺¹), where V(n) is the variance of a mean of n samples: by how much a doubling helps. These
//! squared half-differences, by level k, are what is kept here, of the running sums of a tile and between its samples, so
//! that tracing knows nothing of it. [`super::Film::error`] makes the error of them.
//!
//! Deliberately absent: what single samples do, which would cost time for each of them.

/// From here on, blocks are looked at when so many samples are complete; below, at powers of two.
const STRIDE: u32 = 8;

/// Levels that are kept: those of the longest blocks that are complete. The error is that of the next level, so that
/// shorter blocks say little of it.
const LEVELS: u32 = 5;

/// Squared half-differences of neighbouring blocks, of each pixel of a tile.
#[derive(Clone, Debug, Default)]
pub struct Blocks {
    levels: Vec<Level>,
}

/// Blocks of 2ᵏ samples. Both arrays are empty where the level is not kept.
#[derive(Clone, Debug, Default)]
struct Level {
    /// Running sums where the last odd number of such blocks was complete.
    middle: Vec<[f32; 3]>,
    /// Sum over pairs of such blocks of the squared half-difference of their means.
    squares: Vec<[f32; 3]>,
    pairs: u32,
}

impl Blocks {
    /// The number of samples at which [`Blocks::take`] must be called next, after `done`.
    #[must_use]
    pub fn next(done: u32) -> u32 {
        match done {
            0..STRIDE => (done + 1).next_power_of_two(),
            _ => (done / STRIDE + 1).saturating_mul(STRIDE),
        }
    }

    /// Takes the running sums of a tile's pixels, of their first `samples` samples. To be called at every number of samples
    /// that [`Blocks::next`] gives, and at no other.
    pub fn take(&mut self, samples: u32, sums: &[[f64; 3]]) {
        let lowest = samples.ilog2().saturating_sub(LEVELS);
        if self.levels.len() <= samples.ilog2() as usize {
            self.levels
                .resize_with(samples.ilog2() as usize + 1, Level::default);
            for level in &mut self.levels[..lowest as usize] {
                *level = Level::default();
            }
        }
        let reached = samples.trailing_zeros();
        for k in lowest..reached {
            let length = 1 << k;
            // The sums half-way, if anyone looked.
            if Blocks::next(samples - length - 1) == samples - length {
                self.compare(k as usize, samples - 2 * length, sums);
            }
        }
        if reached >= lowest {
            let middle = &mut self.levels[reached as usize].middle;
            middle.clear();
            middle.extend(sums.iter().map(|sum| sum.map(|s| s as f32)));
        }
    }

    /// Pairs of blocks of 2ᵏ samples that were compared when so many samples are complete, if the level is kept.
    #[must_use]
    pub fn pairs(samples: u32, k: u32) -> u32 {
        match 1 << k {
            length if length < STRIDE => (samples >= 2 * length).into(),
            length => samples / (2 * length),
        }
    }

    /// Compares the last two blocks of level k, the first of which began after `start` samples.
    fn compare(&mut self, k: usize, start: u32, sums: &[[f64; 3]]) {
        let mut level = std::mem::take(&mut self.levels[k]);
        level.pairs += 1;
        level.squares.resize(sums.len(), [0.0; 3]);
        let before = match start {
            0 => None,
            _ => Some(&self.levels[start.trailing_zeros() as usize].middle),
        };
        let scale = 0.5 / (1u64 << k) as f32;
        for (i, sum) in sums.iter().enumerate() {
            for c in 0..3 {
                let first = before.map_or(0.0, |b| b[i][c]);
                let middle = level.middle[i][c];
                let half = ((middle - first) - (sum[c] as f32 - middle)) * scale;
                level.squares[i][c] += half * half;
            }
        }
        self.levels[k] = level;
    }

    /// For each level k, the mean over its pairs of blocks of 2ᵏ samples of the squared half-difference of their means, of
    /// each pixel and channel; empty where the level was not kept or no pair is complete.
    #[must_use]
    pub fn means(self) -> Vec<Vec<[f32; 3]>> {
        let mean = |mut level: Level| {
            let pairs = level.pairs as f32;
            for square in &mut level.squares {
                *square = square.map(|s| s / pairs);
            }
            level.squares
        };
        self.levels.into_iter().map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a pixel, with fractions that f32 holds.
    fn sample(s: u32) -> f64 {
        f64::from(s.wrapping_mul(0x9e37_79b9) >> 20) / 64.0
    }

    fn of(samples: u32) -> (Blocks, Vec<f64>) {
        let values: Vec<f64> = (0..samples).map(sample).collect();
        let mut blocks = Blocks::default();
        let mut done = 0;
        while Blocks::next(done) <= samples {
            done = Blocks::next(done);
            let sum: f64 = values[..done as usize].iter().sum();
            blocks.take(done, &[[sum; 3], [0.0; 3]]);
        }
        (blocks, values)
    }

    #[test]
    fn neighbouring_blocks_are_compared() {
        for samples in [2, 4, 8, 16, 48, 64, 200] {
            let (blocks, values) = of(samples);
            let means = blocks.means();
            let lowest = samples.ilog2().saturating_sub(LEVELS);
            for k in lowest..samples.ilog2() {
                let length = 1usize << k;
                let mean = |block: &[f64]| block.iter().sum::<f64>() / length as f64;
                let pairs = Blocks::pairs(samples, k) as usize;
                let squares = values.chunks_exact(2 * length).take(pairs).map(|pair| {
                    let half = (mean(&pair[..length]) - mean(&pair[length..])) / 2.0;
                    half * half
                });
                let expected = squares.sum::<f64>() / pairs as f64;
                let [found, dark] = means[k as usize][..] else {
                    panic!("two pixels at {samples} samples, level {k}");
                };
                assert!(pairs > 0 && (f64::from(found[0]) / expected - 1.0).abs() < 1e-4);
                assert_eq!(dark, [0.0; 3]);
            }
        }
    }

    #[test]
    fn only_the_last_levels_are_kept() {
        let (blocks, _) = of(1024);
        let kept: Vec<bool> = blocks
            .means()
            .iter()
            .map(|level| !level.is_empty())
            .collect();
        let expected: Vec<bool> = (0..=10).map(|k| (5..10).contains(&k)).collect();
        assert_eq!(kept, expected);
    }
}
