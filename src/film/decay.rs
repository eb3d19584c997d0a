//! How the variance of a pixel's mean falls with its samples, from what doublings were seen to bring.

/// By what a doubling's gain falls from one doubling to the next: ½ where samples are as good as independent, as after a
/// bounce; 2^(−3/2) at the edge of a shadow or of a shape (Mitchell 1996, "Consequences of stratified sampling in graphics").
/// Smooth pixels fall faster and are soon of no weight in the sum.
const RATES: [f64; 2] = [0.5, std::f64::consts::SQRT_2 / 4.0];

/// Levels that a fit sees, the last ones: what earlier ones have more of has settled since.
const SEEN: usize = 5;

/// Weight of a level against the next one's: what long blocks bring tells what longer ones will. At 0.9, edges were thought to
/// fall by as little as their first samples: 86 of 100 renders of `tests/trade hundred` were as wrong as asked, 97 are now.
const FADING: f64 = 0.7;

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
    /// What the last level has of each rate.
    parts: [f64; 2],
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
            parts: [scatter / 2.0, 0.0],
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
        let parts = RATES.into_iter().zip(self.parts);
        parts
            .map(|(rate, part)| part * crate::math::pow(rate, steps) / divisor(rate))
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

/// Least squares of relative deviations with parts that are not negative.
fn fit(levels: &[(u32, f64)]) -> Option<[f64; 2]> {
    let seen = &levels[levels.len().saturating_sub(SEEN)..];
    let &(last, newest) = seen.last()?;
    // Rows of the system: both rates' values and the gain, all divided by the gain.
    let rows: Vec<[f64; 3]> = seen
        .iter()
        .filter(|(_, gain)| *gain > 0.0)
        .map(|&(k, gain)| {
            let back = f64::from(last - k);
            let trust = crate::math::pow(FADING, back);
            let [a, b] = RATES.map(|rate| crate::math::pow(rate, -back) / gain);
            [a * trust, b * trust, trust]
        })
        .collect();
    let dot = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
    let (aa, ab, bb) = (dot(0, 0), dot(0, 1), dot(1, 1));
    let (ay, by) = (dot(0, 2), dot(1, 2));
    if rows.is_empty() || seen.len() == 1 {
        return Some([newest, 0.0]);
    }
    let determinant = aa * bb - ab * ab;
    let both = [
        (ay * bb - by * ab) / determinant,
        (by * aa - ay * ab) / determinant,
    ];
    if rows.len() > 1 && determinant > 0.0 && both.iter().all(|part| *part >= 0.0) {
        return Some(both);
    }
    // One of them alone: what is left of the sum of squares is less by ay²/aa or by²/bb.
    match ay * ay * bb >= by * by * aa {
        true => Some([ay / aa, 0.0]),
        false => Some([0.0, by / bb]),
    }
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

    /// A mixture of both rates is found again, and its sums have a closed form at powers of two.
    #[test]
    fn what_is_of_the_model_is_found() {
        let power = |rate: f64, k: u32| crate::math::pow(rate, f64::from(k));
        let gain = |k: u32| 0.7 * power(RATES[0], k) + 0.2 * power(RATES[1], k);
        let decay = Decay::of((2..6).map(|k| (k, gain(k))).collect()).expect("levels");
        for m in [0, 3, 6, 11] {
            let expected: f64 = (m..200).map(gain).sum();
            let variance = decay.variance(1 << m);
            assert!((variance / expected - 1.0).abs() < 1e-9, "{m}: {variance}");
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

    #[test]
    fn steeper_and_flatter_falls_than_the_models_keep_its_ends() {
        let of = |rate: f64| {
            let levels = (0..5).map(|k| (k, crate::math::pow(rate, f64::from(k))));
            Decay::of(levels.collect()).expect("levels").parts
        };
        assert_eq!(of(0.1)[0], 0.0);
        assert_eq!(of(0.7)[1], 0.0);
        assert!(Decay::of(Vec::new()).is_none());
        let nothing = Decay::of(vec![(0, 0.0), (1, 0.0)]).expect("levels");
        assert_eq!(nothing.variance(4), 0.0);
    }
}
