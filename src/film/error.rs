//! Error bars: how far a film's radiance is from what infinitely many samples would give, told from its samples alone.
//!
//! The pixels' variances come from [`super::Blocks`], each pixel's own ([`super::pixels`]); how they go on falling beyond the
//! longest blocks ([`super::decay`]) cannot be told from one pixel and is fitted to all together.
//!
//! Deliberately absent: errors that no sample shows: light that was never found, and that bounces end.

use super::decay::Decay;
use super::pixels::Scale;
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
    /// Share of the pixels that have equally many samples, and how their variance falls.
    decays: Vec<(f64, Decay)>,
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
        let parts = self.decays.iter();
        let variance = parts.map(|(share, decay)| share * decay.variance(n)).sum();
        ratio(variance, self.mean_square)
    }

    /// Shares of the pixels that have equally many samples, with how their variances fall.
    pub(super) fn decays(&self) -> &[(f64, Decay)] {
        &self.decays
    }

    /// What `relative` is relative to, squared: the mean over pixels of their squared radiance.
    pub(super) fn mean_square(&self) -> f64 {
        self.mean_square
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
pub(super) struct Sums {
    pub(super) pixels: f64,
    /// Of squared means.
    square: f64,
    /// Of each level's squared half-differences; of independent samples, their variance alone.
    levels: Vec<f64>,
}

impl Sums {
    pub(super) fn zero(levels: usize) -> Sums {
        Sums {
            pixels: 0.0,
            square: 0.0,
            levels: vec![0.0; levels],
        }
    }

    pub(super) fn add(&mut self, other: &Sums, sign: f64) {
        self.pixels += sign * other.pixels;
        self.square += sign * other.square;
        for (level, other) in self.levels.iter_mut().zip(&other.levels) {
            *level += sign * other;
        }
    }
}

/// Pixels with equally many samples.
pub(super) struct Class {
    /// Samples of each.
    pub(super) n: u32,
    /// Levels of [`Blocks`] that tell their error; none if samples are independent.
    pub(super) levels: Vec<u32>,
    /// Their sums, group by group.
    groups: Vec<Sums>,
}

impl Class {
    fn all(&self) -> Sums {
        let mut all = Sums::zero(self.levels.len().max(1));
        self.groups.iter().for_each(|group| all.add(group, 1.0));
        all
    }
}

/// The classes of a film, by rising samples, and that of every pixel.
pub(super) struct Classes {
    pub(super) classes: Vec<Class>,
    pub(super) of_pixel: Vec<u8>,
}

impl Film {
    /// The error of the radiance, if every pixel has at least two samples.
    #[must_use]
    pub fn error(&self) -> Option<ErrorBar> {
        let Classes {
            mut classes,
            of_pixel,
        } = self.classes()?;
        for i in 0..self.pixels() {
            let class = &mut classes[usize::from(of_pixel[i])];
            let group = &mut class.groups[group_of(i)];
            let mean = self.mean(i);
            group.square += mean_of(mean.map(|m| m * m));
            self.add_levels(group, &class.levels, i);
        }
        let pixels = self.pixels() as f64;
        let (mut square, mut variance) = (0.0, 0.0);
        let (mut decays, mut scales) = (Vec::new(), Vec::new());
        for class in &classes {
            let all = class.all();
            let decay = decay_of(&class.levels, &all)?;
            square += all.square;
            variance += all.pixels / pixels * decay.variance(class.n);
            scales.push(Scale::new(&decay, &class.levels, class.n));
            decays.push((all.pixels / pixels, decay));
        }
        // The mean of a pixel is off by its error, whose square is in the mean of its squares.
        let mean_square = (square / pixels - variance).max(f64::MIN_POSITIVE);
        let relative = ratio(variance, mean_square);
        let (fragile, concentration) = self.shares(&scales, &of_pixel);
        let spread = jackknife(&classes, &decays, variance) + concentration;
        // A root has half the relative deviation.
        let deviation = (spread / 4.0 + MODEL * MODEL).sqrt();
        Some(ErrorBar {
            relative,
            half_width: TWO_SIDED_95 * deviation * relative,
            fragile,
            decays,
            mean_square,
        })
    }

    /// Adds what a pixel says of the levels, or of independent samples.
    pub(super) fn add_levels(&self, sums: &mut Sums, levels: &[u32], i: usize) {
        sums.pixels += 1.0;
        if levels.is_empty() {
            sums.levels[0] += mean_of(self.scatter(i));
        }
        for (sum, &k) in sums.levels.iter_mut().zip(levels) {
            let gain = self.planes().gains[k as usize][i];
            *sum += mean_of(gain.map(f64::from));
        }
    }

    /// Sorts pixels by their samples, those that were left out included; `None` if one has fewer than two.
    pub(super) fn classes(&self) -> Option<Classes> {
        let planes = self.planes();
        if planes.rgb_squared.is_empty() {
            return None;
        }
        let samples = |i: usize| planes.count[i] + planes.non_finite.get(i).copied().unwrap_or(0);
        let mut numbers: Vec<u32> = Vec::new();
        for i in 0..self.pixels() {
            // Neighbours are alike.
            if (i == 0 || samples(i) != samples(i - 1))
                && let Err(at) = numbers.binary_search(&samples(i))
            {
                numbers.insert(at, samples(i));
            }
        }
        if *numbers.first()? < 2 || numbers.len() > usize::from(u8::MAX) {
            return None;
        }
        let place = |i: usize| numbers.partition_point(|n| *n < samples(i)) as u8;
        let of_pixel = (0..self.pixels()).map(place).collect();
        let seen = self.seen_levels();
        let class = |&n: &u32| {
            let own = Blocks::levels(n);
            let levels: Vec<u32> = seen.iter().copied().filter(|k| own.contains(k)).collect();
            Class {
                n,
                groups: vec![Sums::zero(levels.len().max(1)); GROUPS],
                levels,
            }
        };
        Some(Classes {
            classes: numbers.iter().map(class).collect(),
            of_pixel,
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
    pub(super) fn samples(&self) -> u32 {
        let pixels = self.pixels().max(1) as u64;
        ((self.total_samples() + pixels / 2) / pixels) as u32
    }

    fn mean(&self, i: usize) -> [f64; 3] {
        let n = f64::from(self.planes().count[i].max(1));
        self.planes().rgb[i].map(|sum| sum / n)
    }

    /// Variance of a sample, by the samples of a pixel; 0 below two.
    pub(super) fn scatter(&self, i: usize) -> [f64; 3] {
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
    fn shares(&self, scales: &[Scale], of_pixel: &[u8]) -> (f64, f64) {
        let (mut sum, mut square, mut fragile) = (0.0, 0.0, 0.0);
        for i in 0..self.pixels() {
            let scale = &scales[usize::from(of_pixel[i])];
            let variance = mean_of(scale.variance(self, i));
            sum += variance;
            square += scale.squared(variance);
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
}

/// Pixels that are near each other are in different groups.
fn group_of(pixel: usize) -> usize {
    // Knuth's multiplicative hash.
    ((pixel as u32).wrapping_mul(2_654_435_761) >> 16) as usize % GROUPS
}

pub(super) fn decay_of(levels: &[u32], sums: &Sums) -> Option<Decay> {
    let means = sums.levels.iter().map(|sum| sum / sums.pixels);
    match levels.is_empty() {
        true => Some(Decay::of_independent(means.sum())),
        false => Decay::of(levels.iter().copied().zip(means).collect()),
    }
}

/// Squared relative deviation of the variance, by leaving out one group of pixels after the other.
fn jackknife(classes: &[Class], decays: &[(f64, Decay)], variance: f64) -> f64 {
    if variance <= 0.0 {
        return 0.0;
    }
    let all: Vec<Sums> = classes.iter().map(Class::all).collect();
    let without = |group: usize| -> f64 {
        let of = |((class, all), (share, decay)): ((&Class, &Sums), &(f64, Decay))| {
            let mut rest = all.clone();
            rest.add(&class.groups[group], -1.0);
            let decay = match rest.pixels > 0.0 {
                true => decay_of(&class.levels, &rest),
                false => Some(decay.clone()),
            };
            share * decay.map_or(0.0, |decay| decay.variance(class.n))
        };
        classes.iter().zip(&all).zip(decays).map(of).sum()
    };
    let values: Vec<f64> = (0..GROUPS).map(without).collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (count - 1.0) / count * squares / (variance * variance)
}

pub(super) fn mean_of(rgb: [f64; 3]) -> f64 {
    (rgb[0] + rgb[1] + rgb[2]) / 3.0
}
