//! Errors of single pixels: from what the blocks of a pixel's samples differ by, with its neighbours' help.
//!
//! A pixel has few blocks, and its shorter ones say little of its mean: by how much pixels fall from there differs. So long
//! runs count most, and what the eight pixels around say is averaged in.
//!
//! How far below the differences of runs the error of the whole is, pixels must say together; but a smooth one falls
//! faster than one that an edge crosses, and the few with the largest errors would say it for all. So pixels are sorted into
//! groups by the variance of those around them, and each group has a decay of its own. By their own they must not be
//! sorted: one whose long runs agree by accident would meet others of that kind, and all be thought to fall fast.

use super::decay::Decay;
use super::error::{Classes, Sums, decay_of, mean_of};
use super::{Blocks, Film};

/// Groups of pixels that fall alike.
const GROUPS: usize = 12;

/// Fewest pixels that tell how the variance of a group falls.
const FEWEST: f64 = 64.0;

/// Weight of a pixel against one of its neighbours.
const OWN: f64 = 4.0;

/// As many equal pixels, all of one weight, know as much as a pixel and its eight neighbours: (Σ w)² / Σ w².
const ALIKE: f64 = (OWN + 8.0) * (OWN + 8.0) / (OWN * OWN + 8.0);

/// Relative deviation among pixels of what one doubling takes away.
const DRIFT: f64 = 0.6;

/// A standard error that is itself an estimate from d squares is widened by 1 + STUDENT / d, as much as the 95 % interval of
/// Student's t is wider than the normal one: (z² + 1) / 4 with z = 1.96.
const STUDENT: f64 = 1.21;

/// From the differences of a pixel's blocks to the variance of its mean.
pub(super) struct Scale {
    /// (level, by what its mean squared half-difference is multiplied); none if samples are independent.
    factors: Vec<(u32, f64)>,
    /// Samples.
    n: u32,
    /// Degrees of freedom: so many squared differences of equal weight would tell as much of one pixel.
    squares: f64,
}

impl Scale {
    /// Every level by itself, times its ratio in all pixels that `decay` is of, estimates the variance. Its weight is the
    /// inverse of its own: few pairs, and many doublings from its runs to the whole, make it large.
    pub(super) fn new(decay: &Decay, levels: &[u32], n: u32) -> Scale {
        let variance = decay.variance(n);
        let pairs = |k: u32| f64::from(Blocks::pairs(n, k).max(1));
        let weight = |&k: &u32| {
            let doublings = DRIFT * f64::from(n.max(1).ilog2().saturating_sub(k).max(1));
            1.0 / (2.0 / (ALIKE * pairs(k)) + doublings * doublings)
        };
        let weights: Vec<f64> = levels.iter().map(weight).collect();
        let all: f64 = weights.iter().sum();
        let each = || levels.iter().zip(&weights);
        let factor = |(&k, weight): (&u32, &f64)| match decay.gain(k) {
            gain if gain > 0.0 => (k, weight / all * variance / gain),
            _ => (k, 0.0),
        };
        let spread: f64 = each().map(|(&k, w)| w * w / pairs(k)).sum();
        Scale {
            factors: each().map(factor).collect(),
            n,
            squares: match levels.is_empty() {
                true => f64::from(n.max(2) - 1),
                false => all * all / spread,
            },
        }
    }

    pub(super) fn variance(&self, film: &Film, i: usize) -> [f64; 3] {
        if self.factors.is_empty() {
            return film.scatter(i).map(|scatter| scatter / f64::from(self.n));
        }
        let mut variance = [0.0; 3];
        for &(k, factor) in &self.factors {
            let gain = film.planes().gains[k as usize][i];
            for c in 0..3 {
                variance[c] += factor * f64::from(gain[c]);
            }
        }
        variance
    }

    /// What the square of an estimate says of the square of a variance: without its own noise, which adds 2 / d of it.
    pub(super) fn squared(&self, variance: f64) -> f64 {
        variance * variance * self.squares / (self.squares + 2.0)
    }

    /// By what a standard error is widened that is a mean over a pixel and its neighbours.
    fn widening(&self) -> f64 {
        1.0 + STUDENT / (ALIKE * self.squares)
    }
}

impl Film {
    /// Standard errors of the pixels' means from what blocks of samples differ by; `None` if samples are independent.
    pub(super) fn block_errors(&self) -> Option<Vec<[f32; 3]>> {
        let Classes { classes, of_pixel } = self.classes()?;
        if classes.iter().any(|class| class.levels.is_empty()) {
            return None;
        }
        let class = |i: usize| usize::from(of_pixel[i]);
        let own = |i: usize| {
            let step = |&k: &u32| {
                mean_of(self.planes().gains[k as usize][i].map(f64::from)) * f64::from(2u32 << k)
            };
            classes[class(i)].levels.iter().map(step).sum()
        };
        let own: Vec<f64> = (0..self.pixels()).map(own).collect();
        let around = |i: usize| {
            let (sum, count) = self
                .neighbours(i)
                .fold((0.0, 0.0), |(sum, count), j| (sum + own[j], count + 1.0));
            sum / f64::max(count, 1.0)
        };
        let around: Vec<f64> = (0..self.pixels()).map(around).collect();
        let thresholds = thresholds(&around);
        let group = |i: usize| thresholds.partition_point(|threshold| *threshold < around[i]);

        let none = |levels: &[u32]| vec![Sums::zero(levels.len()); GROUPS];
        let mut sums: Vec<Vec<Sums>> = classes.iter().map(|class| none(&class.levels)).collect();
        for i in 0..self.pixels() {
            self.add_levels(&mut sums[class(i)][group(i)], &classes[class(i)].levels, i);
        }
        let mut scales = Vec::new();
        for (class, groups) in classes.iter().zip(&sums) {
            let mut all = Sums::zero(class.levels.len());
            groups.iter().for_each(|group| all.add(group, 1.0));
            let of = |group: &Sums| {
                let enough = if group.pixels >= FEWEST { group } else { &all };
                let decay = decay_of(&class.levels, enough)?;
                Some(Scale::new(&decay, &class.levels, class.n))
            };
            scales.push(groups.iter().map(of).collect::<Option<Vec<Scale>>>()?);
        }

        let scale = |i: usize| &scales[class(i)][group(i)];
        let variances: Vec<[f64; 3]> = (0..self.pixels())
            .map(|i| scale(i).variance(self, i))
            .collect();
        let error = |i: usize| {
            let (mut sum, mut weights) = (variances[i].map(|v| OWN * v), OWN);
            for j in self.neighbours(i) {
                weights += 1.0;
                sum = std::array::from_fn(|c| sum[c] + variances[j][c]);
            }
            sum.map(|s| (scale(i).widening() * (s / weights).sqrt()) as f32)
        };
        Some((0..self.pixels()).map(error).collect())
    }

    /// The pixels around one, eight or at the border fewer.
    fn neighbours(&self, i: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.width() as usize, self.height() as usize);
        let (x, y) = (i % width, i / width);
        let rows = y.saturating_sub(1)..=(y + 1).min(height - 1);
        let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
            .filter(move |j| *j != i)
    }
}

/// Variances beyond which pixels are in the second group, in the third …: as many in each, but for those that have none.
fn thresholds(variances: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = variances.iter().copied().filter(|v| *v > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let at = |group: usize| sorted.get(group * sorted.len() / GROUPS).copied();
    (1..GROUPS).filter_map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Planes, Window};
    use super::*;

    const SIDE: u32 = 128;
    const SPP: u32 = 64;

    /// Mean of `count` squares of normal numbers, by a generator of its own.
    fn chi(state: &mut u64, count: u32) -> f64 {
        let mut uniform = || {
            *state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (*state >> 40) as f64 / (1u64 << 24) as f64
        };
        let squares = (0..count).map(|_| {
            let normal = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
            normal * normal
        });
        squares.sum::<f64>() / f64::from(count)
    }

    /// Left half and right: (d(0), by what it falls).
    fn film(halves: [(f64, f64); 2]) -> Film {
        let pixels = (SIDE * SIDE) as usize;
        let mut state = 7;
        let levels = Blocks::levels(SPP);
        let mut gains = vec![Vec::new(); levels.start as usize];
        for k in levels {
            let of = |i: usize| {
                let (first, rate) = halves[i % SIDE as usize / (SIDE as usize / 2)];
                let gain = first * crate::math::pow(rate, f64::from(k));
                [(gain * chi(&mut state, Blocks::pairs(SPP, k))) as f32; 3]
            };
            gains.push((0..pixels).map(of).collect());
        }
        let mut film = Film::new(SIDE, SIDE);
        let window = Window {
            x: 0,
            y: 0,
            width: SIDE,
            height: SIDE,
        };
        let planes = Planes {
            rgb: vec![[f64::from(SPP); 3]; pixels],
            rgb_squared: vec![[f64::from(SPP); 3]; pixels],
            count: vec![SPP; pixels],
            gains,
            ..Planes::default()
        };
        film.put(window, &planes);
        film
    }

    /// Dim pixels that fall as independent samples do beside bright smooth ones: most of each half, all but those that share a
    /// group with the other, have its own errors, widened by a few percent.
    #[test]
    fn pixels_fall_as_their_like() {
        let halves = [(1.0, 0.5), (1e4, 0.25)];
        let errors = film(halves).block_errors().expect("blocks");
        for (half, (first, rate)) in halves.into_iter().enumerate() {
            let of_half = |i: &usize| i % SIDE as usize / (SIDE as usize / 2) == half;
            let mut own: Vec<f64> = (0..errors.len())
                .filter(of_half)
                .map(|i| f64::from(errors[i][0]))
                .collect();
            own.sort_by(f64::total_cmp);
            let expected = (first * crate::math::pow(rate, 6.0) / (1.0 - rate)).sqrt();
            let ratio = own[own.len() / 2] / expected;
            assert!((0.9..1.15).contains(&ratio), "{rate}: {ratio}");
        }
    }

    /// Whatever its levels weigh, a pixel that falls as its group has the variance of its group.
    #[test]
    fn weights_of_levels_do_not_change_what_is_of_the_model() {
        let gains: Vec<(u32, f64)> = (1..6)
            .map(|k| (k, crate::math::pow(0.4, f64::from(k))))
            .collect();
        let decay = Decay::of(gains.clone()).expect("levels");
        let levels: Vec<u32> = (1..6).collect();
        for n in [48, 63, 64] {
            let scale = Scale::new(&decay, &levels, n);
            let variance: f64 = scale
                .factors
                .iter()
                .map(|&(k, factor)| factor * decay.gain(k))
                .sum();
            assert!(
                (variance / decay.variance(n) - 1.0).abs() < 1e-12,
                "{n}: {variance}"
            );
            assert!(
                scale.squares > 1.0 && scale.squares < 9.0,
                "{n}: {}",
                scale.squares
            );
        }
    }

    #[test]
    fn groups_have_as_many_pixels() {
        let variances: Vec<f64> = (0..1300)
            .map(|i| f64::from(i % 1000).max(299.0) - 299.0)
            .collect();
        let thresholds = thresholds(&variances);
        let group = |v: &f64| thresholds.partition_point(|threshold| threshold < v);
        for wanted in 1..GROUPS {
            let count = variances
                .iter()
                .filter(|v| **v > 0.0 && group(v) == wanted)
                .count();
            assert!((55..=61).contains(&count), "{wanted}: {count}");
        }
    }
}
