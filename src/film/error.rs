//! Error bars: how far a film's radiance is from what infinitely many samples would give, told from its samples alone.
//!
//! The pixels' variances come from [`super::Blocks`], each pixel's own; how they go on falling beyond the longest blocks
//! ([`super::decay`]) cannot be told from one pixel and is fitted to all together.
//!
//! Deliberately absent: errors that no sample shows: light that was never found, and that bounces end.

use super::decay::Decay;
use super::{Blocks, Film};

/// Groups of pixels for the jackknife.
const GROUPS: usize = 20;

/// 97.5 % quantile of the normal distribution.
const TWO_SIDED_95: f64 = 1.96;

/// Standard deviation of the predicted error over the true one where noise of the prediction plays no part: scenes fall
/// as they like, not as the model of [`super::decay`] does. Found on the scenes of this repository, held by
/// `tests/trade`.
const MODEL: f64 = 0.03;

/// A pixel stands on few samples if (Σx)² / Σx² is below this: then one of them carries more than half of it.
const FEW: f64 = 2.0;

/// Samples from which on that means something.
const ENOUGH: u32 = 16;

/// A standard error that is itself an estimate from d squares is widened by 1 + STUDENT / d, as much as the 95 % interval of
/// Student's t is wider than the normal one: (z² + 1) / 4 with z = 1.96.
const STUDENT: f64 = 1.21;

/// Of a pixel and its eight neighbours, so many tell about it.
const ALIKE: f64 = 3.0;

/// Numbers of samples are sought in steps of 2⁻¹⁰ of them.
const FINEST: u32 = 10;

/// Share of the error in such pixels from which on it is not to be trusted: a few more such samples, and it would be
/// another.
const FRAGILE: f64 = 0.25;

/// How wrong an image is, and how well that is known.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorBar {
    /// sqrt(mean variance of the pixels / mean of their squared radiance).
    pub relative: f64,
    /// Half the width of the 95 % interval of that.
    pub half_width: f64,
    /// Share of the mean variance in pixels where few samples carry most of the light.
    pub fragile: f64,
    decay: Decay,
    mean_square: f64,
}

impl ErrorBar {
    /// Whether single samples are too much of it for it to be trusted.
    #[must_use]
    pub fn is_fragile(&self) -> bool {
        self.fragile > FRAGILE
    }

    /// What `relative` would be with n ≥ 1 samples in every pixel.
    #[must_use]
    pub fn at(&self, n: u32) -> f64 {
        ratio(self.decay.variance(n), self.mean_square)
    }

    /// The fewest samples per pixel, from `least` to `most`, with which the relative error is at most `wanted`; `most` if there
    /// are none.
    #[must_use]
    pub fn samples_for(&self, wanted: f64, least: u32, most: u32) -> u32 {
        let mut enough = least.min(most);
        while enough < most && self.at(enough) > wanted {
            enough = (enough + 1).next_power_of_two().min(most);
        }
        // Just above a power of two, more samples may be worse: a scan, not a bisection.
        let from = (enough / 2).max(least).min(enough);
        let step = (enough >> FINEST).max(1);
        let mut between = (from..enough).step_by(step as usize);
        between.find(|&n| self.at(n) <= wanted).unwrap_or(enough)
    }
}

fn ratio(variance: f64, mean_square: f64) -> f64 {
    match variance > 0.0 {
        true => (variance / mean_square).sqrt(),
        false => 0.0,
    }
}

/// Sums over some pixels.
#[derive(Clone, Debug)]
struct Sums {
    pixels: f64,
    /// Of squared means.
    square: f64,
    /// Of each level's squared half-differences; of independent samples, their variance alone.
    levels: Vec<f64>,
}

impl Sums {
    fn zero(levels: usize) -> Sums {
        Sums {
            pixels: 0.0,
            square: 0.0,
            levels: vec![0.0; levels],
        }
    }

    fn add(&mut self, other: &Sums, sign: f64) {
        self.pixels += sign * other.pixels;
        self.square += sign * other.square;
        for (level, other) in self.levels.iter_mut().zip(&other.levels) {
            *level += sign * other;
        }
    }
}

impl Film {
    /// The error of the radiance, if every pixel has at least two samples.
    #[must_use]
    pub fn error(&self) -> Option<ErrorBar> {
        let n = self.samples();
        if n < 2 || self.planes().rgb_squared.is_empty() {
            return None;
        }
        let levels = self.seen_levels();
        let mut groups = vec![Sums::zero(levels.len().max(1)); GROUPS];
        for i in 0..self.pixels() {
            let group = &mut groups[group_of(i)];
            group.pixels += 1.0;
            let mean = self.mean(i);
            group.square += mean_of(mean.map(|m| m * m));
            match levels.is_empty() {
                true => group.levels[0] += mean_of(self.scatter(i)),
                false => {
                    for (sum, &k) in group.levels.iter_mut().zip(&levels) {
                        let gain = self.planes().gains[k as usize][i];
                        *sum += mean_of(gain.map(f64::from));
                    }
                }
            }
        }
        let mut all = Sums::zero(levels.len().max(1));
        for group in &groups {
            all.add(group, 1.0);
        }
        let decay = decay_of(&levels, &all)?;
        let variance = decay.variance(n);
        // The mean of a pixel is off by its error, whose square is in the mean of its squares.
        let mean_square = (all.square / all.pixels - variance).max(f64::MIN_POSITIVE);
        let relative = ratio(variance, mean_square);
        let (fragile, concentration) = self.shares(&decay, &levels, n);
        let spread = jackknife(&levels, &groups, &all, n, variance) + concentration;
        // A root has half the relative deviation.
        let deviation = (spread / 4.0 + MODEL * MODEL).sqrt();
        Some(ErrorBar {
            relative,
            half_width: TWO_SIDED_95 * deviation * relative,
            fragile,
            decay,
            mean_square,
        })
    }

    /// The levels of [`super::Blocks`] that are kept and have a pair, without gaps; none if samples are independent.
    pub(super) fn seen_levels(&self) -> Vec<u32> {
        let kept = |k: &u32| !self.planes().gains[*k as usize].is_empty();
        let top = self.planes().gains.len() as u32;
        let mut levels: Vec<u32> = (0..top)
            .rev()
            .skip_while(|k| !kept(k))
            .take_while(kept)
            .collect();
        levels.reverse();
        levels
    }

    /// Samples of a pixel: as good as all have as many.
    fn samples(&self) -> u32 {
        let pixels = self.pixels().max(1) as u64;
        ((self.total_samples() + pixels / 2) / pixels) as u32
    }

    fn mean(&self, i: usize) -> [f64; 3] {
        let n = f64::from(self.planes().count[i].max(1));
        self.planes().rgb[i].map(|sum| sum / n)
    }

    /// Variance of a sample, by the samples of a pixel; 0 below two.
    fn scatter(&self, i: usize) -> [f64; 3] {
        let n = f64::from(self.planes().count[i]);
        std::array::from_fn(|c| {
            let sum = self.planes().rgb[i][c];
            let scatter = self.planes().rgb_squared[i][c] - sum * sum / n;
            if n < 2.0 {
                0.0
            } else {
                scatter.max(0.0) / (n - 1.0)
            }
        })
    }

    /// The share of the variance in fragile pixels; and the squared relative deviation of the squared error that this one
    /// image has from its mean, if pixels' errors are normal: small where the error is spread over many pixels.
    fn shares(&self, decay: &Decay, levels: &[u32], n: u32) -> (f64, f64) {
        let scale = Scale::new(decay, levels, n);
        let (mut sum, mut square, mut fragile) = (0.0, 0.0, 0.0);
        for i in 0..self.pixels() {
            let variance = match levels.is_empty() {
                true => mean_of(self.scatter(i)),
                false => mean_of(scale.variance(self, i)),
            };
            sum += variance;
            square += variance * variance;
            if self.count_of(i) >= ENOUGH && self.stands_on_few(i) {
                fragile += variance;
            }
        }
        if sum <= 0.0 {
            return (0.0, 0.0);
        }
        (fragile / sum, 2.0 * square / (sum * sum))
    }

    fn count_of(&self, i: usize) -> u32 {
        self.planes().count[i]
    }

    fn stands_on_few(&self, i: usize) -> bool {
        let (sum, square) = (self.planes().rgb[i], self.planes().rgb_squared[i]);
        let (sum, square) = (mean_of(sum), mean_of(square));
        sum * sum < FEW * square
    }

    /// Standard errors of the pixels' means from what blocks of samples differ by; `None` if samples are independent.
    ///
    /// A pixel has few blocks: its neighbours' help, with a quarter of its own weight each. And how much a level tells of
    /// the whole, pixels say together, each with the same weight, or the few with the largest errors would say it for all.
    pub(super) fn block_errors(&self) -> Option<Vec<[f32; 3]>> {
        let levels = self.seen_levels();
        let n = self.samples();
        let mut sums = Sums::zero(levels.len());
        for i in 0..self.pixels() {
            let gains: Vec<f64> = levels
                .iter()
                .map(|&k| mean_of(self.planes().gains[k as usize][i].map(f64::from)))
                .collect();
            let steps = gains
                .iter()
                .zip(0..)
                .map(|(gain, k)| gain * f64::from(1u32 << k));
            let whole: f64 = steps.sum();
            if whole > 0.0 {
                sums.pixels += 1.0;
                for (sum, gain) in sums.levels.iter_mut().zip(gains) {
                    *sum += gain / whole;
                }
            }
        }
        sums.pixels = sums.pixels.max(1.0);
        let decay = match levels.is_empty() {
            true => return None,
            false => decay_of(&levels, &sums)?,
        };
        let scale = Scale::new(&decay, &levels, n);
        let variances: Vec<[f64; 3]> = (0..self.pixels())
            .map(|i| scale.variance(self, i))
            .collect();
        let (width, height) = (self.width() as usize, self.height() as usize);
        let student = 1.0 + STUDENT / (ALIKE * scale.pairs);
        let widening = student * student;
        let smooth = |i: usize| {
            let (x, y) = (i % width, i / width);
            let (mut sum, mut weights) = ([0.0; 3], 0.0);
            for row in y.saturating_sub(1)..=(y + 1).min(height - 1) {
                for column in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                    let weight = if (column, row) == (x, y) { 4.0 } else { 1.0 };
                    weights += weight;
                    for c in 0..3 {
                        sum[c] += weight * variances[row * width + column][c];
                    }
                }
            }
            sum.map(|s| (widening * s / weights).sqrt() as f32)
        };
        Some((0..self.pixels()).map(smooth).collect())
    }
}

/// From the differences of a pixel's blocks to the variance of its mean.
struct Scale {
    /// (level, by what its mean squared half-difference is multiplied).
    factors: Vec<(u32, f64)>,
    /// Pairs of blocks of one pixel, of all levels.
    pairs: f64,
}

impl Scale {
    /// Every level by itself, times its ratio in the whole image, estimates the variance; their pairs are their weights.
    fn new(decay: &Decay, levels: &[u32], n: u32) -> Scale {
        let variance = decay.variance(n);
        let pairs = |k: u32| f64::from(Blocks::pairs(n, k).max(1));
        let all: f64 = levels.iter().map(|&k| pairs(k)).sum();
        let factor = |&k: &u32| match decay.gain(k) {
            gain if gain > 0.0 => (k, pairs(k) / all * variance / gain),
            _ => (k, 0.0),
        };
        Scale {
            factors: levels.iter().map(factor).collect(),
            pairs: all,
        }
    }

    fn variance(&self, film: &Film, i: usize) -> [f64; 3] {
        let mut variance = [0.0; 3];
        for &(k, factor) in &self.factors {
            let gain = film.planes().gains[k as usize][i];
            for c in 0..3 {
                variance[c] += factor * f64::from(gain[c]);
            }
        }
        variance
    }
}

/// Pixels that are near each other are in different groups.
fn group_of(pixel: usize) -> usize {
    // Knuth's multiplicative hash.
    ((pixel as u32).wrapping_mul(2_654_435_761) >> 16) as usize % GROUPS
}

fn decay_of(levels: &[u32], sums: &Sums) -> Option<Decay> {
    let means = sums.levels.iter().map(|sum| sum / sums.pixels);
    match levels.is_empty() {
        true => Some(Decay::of_independent(means.sum())),
        false => Decay::of(levels.iter().copied().zip(means).collect()),
    }
}

/// Squared relative deviation of the variance, by leaving out one group of pixels after the other.
fn jackknife(levels: &[u32], groups: &[Sums], all: &Sums, n: u32, variance: f64) -> f64 {
    if variance <= 0.0 {
        return 0.0;
    }
    let without = |group: &Sums| {
        let mut rest = all.clone();
        rest.add(group, -1.0);
        rest.pixels = rest.pixels.max(1.0);
        decay_of(levels, &rest).map_or(0.0, |decay| decay.variance(n))
    };
    let values: Vec<f64> = groups.iter().map(without).collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (count - 1.0) / count * squares / (variance * variance)
}

fn mean_of(rgb: [f64; 3]) -> f64 {
    (rgb[0] + rgb[1] + rgb[2]) / 3.0
}
