//! How the variance of a pixel's mean falls with its samples, from what doublings were seen to bring.

/// By what a doubling's gain falls from one doubling to the next: 2^(−1−1/D) where a jump cuts through the D dimensions that
/// points are spread evenly in together, since the variance of n of them is n^(−1−1/D) there (Mitchell 1996, "Consequences of
/// stratified sampling in graphics"; He and Wang 2015, SIAM J. Numer. Anal. 53(5)). D = 2 is the edge of a shape in a pixel,
/// D = 4 that of a shadow on a pixel and a light; after a bounce, there are so many that samples are as good as
/// independent.
const RATES: [f64; 3] = [0.5, 0.420_448_207_626_857_3, std::f64::consts::SQRT_2 / 4.0];

/// A fall that is faster than this is nearer to the ¼ of a jump that only cuts one dimension than to an edge's: pixels without
/// an edge have a rate of their own.
const SMOOTH: f64 = 0.3;

/// No fall is believed to be faster.
const FASTEST: f64 = 0.125;

/// Levels that a fit sees, the last ones: what earlier ones have more of has settled since.
const SEEN: usize = 5;

/// Weight of a level against the next one's: what long blocks bring tells what longer ones will.
const FADING: f64 = 0.7;

/// What falls by one rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Part {
    rate: f64,
    gain: f64,
}

/// The variance of a mean of n samples, which are the first n of a scrambled sequence.
///
/// Let d(k) be the mean squared half-difference of two neighbouring aligned blocks of 2ᵏ samples. Two samples have a
/// covariance that only depends on the smallest aligned block that holds both, so that d(k) for all k tells the variance of
/// the mean of any number of samples, not only of powers of two: it is the sum of (2 Q(k) − Q(k + 1)) / n² · d(k), where Q(k) is
/// the number of ordered pairs of samples in the same block of 2ᵏ.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Decay {
    /// (k, d(k)) for consecutive k; at least one.
    levels: Vec<(u32, f64)>,
    /// What the last level has of two rates.
    parts: [Part; 2],
}

impl Decay {
    /// From (k, d(k)) for consecutive k; `None` without any.
    pub(super) fn of(levels: Vec<(u32, f64)>) -> Option<Decay> {
        let parts = fit(&levels)?;
        Some(Decay { levels, parts })
    }

    /// That of independent samples of variance `scatter`.
    pub(super) fn of_independent(scatter: f64) -> Decay {
        Decay {
            levels: vec![(0, scatter / 2.0)],
            parts: [part(RATES[0], scatter / 2.0), Part::default()],
        }
    }

    /// Variance of a mean of n ≥ 1 samples.
    pub(super) fn variance(&self, n: u32) -> f64 {
        let whole = n.next_power_of_two().ilog2();
        let partial: f64 = (0..whole).map(|k| weight(n, k) * self.gain(k)).sum();
        partial + self.beyond(whole)
    }

    /// d(k): as seen, or by the fit.
    pub(super) fn gain(&self, k: u32) -> f64 {
        let seen = self.levels.iter().find(|(level, _)| *level == k);
        seen.map_or_else(|| self.sum(k, |_| 1.0), |&(_, gain)| gain)
    }

    /// Sum of d(k) for k from `first` on: what is left when blocks of that many are complete.
    fn beyond(&self, first: u32) -> f64 {
        let last = self.last();
        let seen: f64 = (first..=last).map(|k| self.gain(k)).sum();
        seen + self.sum(first.max(last + 1), |rate| 1.0 - rate)
    }

    fn sum(&self, k: u32, divisor: impl Fn(f64) -> f64) -> f64 {
        let steps = f64::from(k) - f64::from(self.last());
        let parts = self.parts.iter().filter(|part| part.gain > 0.0);
        parts
            .map(|part| part.gain * crate::math::pow(part.rate, steps) / divisor(part.rate))
            .sum()
    }

    fn last(&self) -> u32 {
        self.levels.last().map_or(0, |(k, _)| *k)
    }
}

/// The weight of d(k) in the variance of a mean of n samples.
fn weight(n: u32, k: u32) -> f64 {
    let pairs = |k: u32| {
        let length = 1u64 << k;
        let (blocks, rest) = (u64::from(n) / length, u64::from(n) % length);
        blocks as f64 * (length * length) as f64 + (rest * rest) as f64
    };
    (2.0 * pairs(k) - pairs(k + 1)) / (f64::from(n) * f64::from(n))
}

/// Parts that are not negative, one or two, with the least squares of relative deviations; or one that is [`SMOOTH`].
fn fit(levels: &[(u32, f64)]) -> Option<[Part; 2]> {
    let seen = &levels[levels.len().saturating_sub(SEEN)..];
    let &(last, newest) = seen.last()?;
    let seen: Vec<Seen> = seen
        .iter()
        .filter(|(_, gain)| *gain > 0.0)
        .map(|&(k, gain)| Seen {
            back: f64::from(last - k),
            gain,
            trust: crate::math::pow(FADING, f64::from(last - k)),
        })
        .collect();
    if seen.len() < 2 {
        return Some([part(RATES[0], newest), Part::default()]);
    }
    if let Some(fast) = smooth(&seen) {
        return Some([fast, Part::default()]);
    }
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];
    let fits = pairs
        .into_iter()
        .filter_map(|(i, j)| mixture(&seen, [RATES[i], RATES[j]]));
    let best = fits.min_by(|(_, a), (_, b)| a.total_cmp(b));
    best.map(|(parts, _)| parts)
}

/// A level that a fit sees.
struct Seen {
    /// Doublings from it to the last one.
    back: f64,
    gain: f64,
    trust: f64,
}

fn part(rate: f64, gain: f64) -> Part {
    Part { rate, gain }
}

/// The one rate of gains that fall as those of smooth pixels: on average, by a line through their logarithms, and at the last.
fn smooth(seen: &[Seen]) -> Option<Part> {
    let [.., before, last] = seen else {
        return None;
    };
    let mean = |of: &dyn Fn(&Seen) -> f64| {
        let weights: f64 = seen.iter().map(|level| level.trust * level.trust).sum();
        let sum: f64 = seen
            .iter()
            .map(|level| level.trust * level.trust * of(level))
            .sum();
        sum / weights
    };
    let log = |level: &Seen| crate::math::ln(level.gain);
    let (x, y) = (mean(&|level| -level.back), mean(&log));
    let slope = mean(&|level| (-level.back - x) * (log(level) - y))
        / mean(&|level| (-level.back - x) * (-level.back - x));
    let rate = crate::math::exp(slope)
        .max(last.gain / before.gain)
        .max(FASTEST);
    let gain = crate::math::exp(y - crate::math::ln(rate) * x);
    (rate < SMOOTH).then_some(part(rate, gain))
}

/// Least squares with both rates, which may be the same one, and the sum that is left; `None` if a part is negative.
fn mixture(seen: &[Seen], rates: [f64; 2]) -> Option<([Part; 2], f64)> {
    // Rows of the system: both rates' values, divided by the gain, which should add up to 1.
    let row = |level: &Seen| {
        rates.map(|rate| crate::math::pow(rate, -level.back) * level.trust / level.gain)
    };
    let rows: Vec<([f64; 2], f64)> = seen.iter().map(|level| (row(level), level.trust)).collect();
    let dot = |i: usize, j: usize| rows.iter().map(|(row, _)| row[i] * row[j]).sum::<f64>();
    let with = |i: usize| rows.iter().map(|(row, one)| row[i] * one).sum::<f64>();
    let (aa, ab, bb) = (dot(0, 0), dot(0, 1), dot(1, 1));
    let gains = if rates[0] == rates[1] {
        [with(0) / aa, 0.0]
    } else {
        let determinant = aa * bb - ab * ab;
        [
            (with(0) * bb - with(1) * ab) / determinant,
            (with(1) * aa - with(0) * ab) / determinant,
        ]
    };
    let deviation = |(row, one): &([f64; 2], f64)| gains[0] * row[0] + gains[1] * row[1] - one;
    let left: f64 = rows.iter().map(|row| deviation(row) * deviation(row)).sum();
    let parts = [part(rates[0], gains[0]), part(rates[1], gains[1])];
    gains
        .iter()
        .all(|gain| *gain >= 0.0)
        .then_some((parts, left))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn independent_samples_have_the_textbooks_variance() {
        let decay = Decay::of_independent(3.0);
        for n in [1, 2, 3, 7, 48, 100, 1000, 65_537] {
            let variance = decay.variance(n);
            let expected = 3.0 / f64::from(n);
            assert!((variance / expected - 1.0).abs() < 1e-12, "{n}: {variance}");
        }
    }

    /// A mixture of two rates is found again, and its sums have a closed form at powers of two; so is the one rate of smooth
    /// pixels.
    #[test]
    fn what_is_of_the_model_is_found() {
        let power = |rate: f64, k: u32| crate::math::pow(rate, f64::from(k));
        for [a, b] in [
            [RATES[0], RATES[1]],
            [RATES[1], RATES[2]],
            [RATES[0], RATES[2]],
            [0.25, 0.25],
        ] {
            let gain = |k: u32| 0.7 * power(a, k) + 0.2 * power(b, k);
            let decay = Decay::of((2..6).map(|k| (k, gain(k))).collect()).expect("levels");
            for m in [0, 3, 6, 11] {
                let expected: f64 = (m..200).map(gain).sum();
                let variance = decay.variance(1 << m);
                assert!(
                    (variance / expected - 1.0).abs() < 1e-9,
                    "{a} {b} {m}: {variance}"
                );
            }
        }
    }

    /// For covariances by the smallest common block, added up pair by pair.
    #[test]
    fn any_number_of_samples_is_the_sum_over_all_pairs() {
        let gains = [0.9, 0.3, 0.21, 0.05, 0.03];
        let decay = Decay::of((0..5).zip(gains).collect()).expect("levels");
        let beyond = |k: u32| decay.variance(1 << k);
        let covariance = |i: u32, j: u32| match i ^ j {
            0 => beyond(0),
            // V(2^(l+1)) is the mean of V(2^l) and the covariance.
            apart => 2.0 * beyond(apart.ilog2() + 1) - beyond(apart.ilog2()),
        };
        for n in 1..=32 {
            let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let sum: f64 = pairs.map(|(i, j)| covariance(i, j)).sum();
            let expected = sum / f64::from(n * n);
            let found = decay.variance(n);
            assert!(
                (found / expected - 1.0).abs() < 1e-9,
                "{n}: {found} {expected}"
            );
        }
    }

    /// Flatter than independent samples, or steeper than any smooth pixel, is accident.
    #[test]
    fn steeper_and_flatter_falls_than_the_models_keep_its_ends() {
        let of = |rate: f64| {
            let levels = (0..5).map(|k| (k, crate::math::pow(rate, f64::from(k))));
            Decay::of(levels.collect()).expect("levels").parts
        };
        assert_eq!(of(0.05)[0].rate, FASTEST);
        assert_eq!(of(0.32)[0].rate, RATES[2]);
        let flat = of(0.7).map(|part| part.rate);
        assert_eq!(flat, [RATES[0]; 2]);
        assert!(Decay::of(Vec::new()).is_none());
        let nothing = Decay::of(vec![(0, 0.0), (1, 0.0)]).expect("levels");
        assert_eq!(nothing.variance(4), 0.0);
    }

    /// Where the last doubling was like that at an edge, the earlier ones were those of something that has settled.
    #[test]
    fn a_steep_beginning_is_not_taken_for_the_end() {
        let decay = Decay::of(vec![(1, 1.0), (2, 0.1), (3, 0.01), (4, 0.005)]).expect("levels");
        assert!(
            decay.parts.iter().all(|part| part.rate >= RATES[2]),
            "{decay:?}"
        );
    }
}
