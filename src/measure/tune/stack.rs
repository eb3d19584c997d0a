//! Pictures of one setting with many seeds, and how they differ from those of a reference: bias and variance apart.
//!
//! With x of K seeds and r of R, per pixel and channel, `(x̄ − r̄)² − s²(x)/K − s²(r)/R` is the squared bias without the
//! noise of either: its expectation is exact, however short the reference, and so it may come out below 0. Pixels have
//! random numbers of their own, so that intervals come from the spread of the pixels. The mean brightness is compared
//! over seeds by Welch's interval.

/// A number and half of its 95 % interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// From it to either end of the interval.
    pub half_width: f64,
}

impl Estimate {
    /// The upper end.
    #[must_use]
    pub fn upper(&self) -> f64 {
        self.value + self.half_width
    }

    /// Whether the interval lies above or below 0.
    #[must_use]
    pub fn differs_from_zero(&self) -> bool {
        self.value.abs() > self.half_width
    }
}

/// How pictures differ from a reference. Squares are relative to the mean square of the reference, the brightness to
/// its mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Differences {
    /// Squared bias, mean over pixels and channels.
    pub bias_squared: Estimate,
    /// Variance of one picture.
    pub variance: Estimate,
    /// Both together: the squared error of one picture.
    pub squared: Estimate,
    /// Mean brightness over the reference's, less 1.
    pub brightness: Estimate,
}

/// Means and squared deviations over seeds.
#[derive(Clone, Debug, Default)]
pub(super) struct Stack {
    mean: Vec<[f64; 3]>,
    scatter: Vec<[f64; 3]>,
    brightness: Vec<f64>,
}

impl Stack {
    /// Adds the picture of one more seed (Welford's recurrence).
    pub(super) fn add(&mut self, pixels: impl ExactSizeIterator<Item = [f64; 3]>) {
        let count = pixels.len();
        self.mean.resize(count, [0.0; 3]);
        self.scatter.resize(count, [0.0; 3]);
        let n = (self.brightness.len() + 1) as f64;
        let mut total = 0.0;
        for ((mean, scatter), x) in self.mean.iter_mut().zip(&mut self.scatter).zip(pixels) {
            for c in 0..3 {
                let off = x[c] - mean[c];
                mean[c] += off / n;
                scatter[c] += off * (x[c] - mean[c]);
                total += x[c];
            }
        }
        self.brightness.push(total / (3 * count) as f64);
    }

    /// How many.
    pub(super) fn seeds(&self) -> usize {
        self.brightness.len()
    }

    /// Variance of a pixel's channel from seed to seed.
    fn variance(&self, pixel: usize, c: usize) -> f64 {
        self.scatter[pixel][c] / (self.seeds() as f64 - 1.0)
    }

    /// Mean square of what is converged to.
    pub(super) fn power(&self) -> f64 {
        let seeds = self.seeds() as f64;
        let of = |i: usize| {
            let c = |c: usize| square(self.mean[i][c]) - self.variance(i, c) / seeds;
            c(0) + c(1) + c(2)
        };
        (0..self.mean.len()).map(of).sum::<f64>() / (3 * self.mean.len()) as f64
    }

    /// How this differs from `reference`, of the same size. Both have two seeds at least.
    pub(super) fn against(&self, reference: &Stack) -> Differences {
        let [k, r] = [self.seeds() as f64, reference.seeds() as f64];
        let power = reference.power();
        let mut sums = [Sum::default(), Sum::default(), Sum::default()];
        for i in 0..self.mean.len() {
            let mut pixel = [0.0; 2];
            for c in 0..3 {
                let variance = self.variance(i, c);
                let off = square(self.mean[i][c] - reference.mean[i][c]);
                pixel[0] += (off - variance / k - reference.variance(i, c) / r) / 3.0;
                pixel[1] += variance / 3.0;
            }
            let [bias, variance] = pixel;
            for (sum, x) in sums.iter_mut().zip([bias, variance, bias + variance]) {
                sum.add(x / power);
            }
        }
        let [bias_squared, variance, squared] = sums.map(|sum| sum.mean());
        Differences {
            bias_squared,
            variance,
            squared,
            brightness: welch(&self.brightness, &reference.brightness),
        }
    }

    /// Squared bias of a setting whose differences from an unbiased one, seed by seed, these are: what both have in
    /// common cancels.
    pub(super) fn squared_mean(&self, power: f64) -> Estimate {
        let k = self.seeds() as f64;
        let mut sum = Sum::default();
        for i in 0..self.mean.len() {
            let c = |c: usize| square(self.mean[i][c]) - self.variance(i, c) / k;
            sum.add((c(0) + c(1) + c(2)) / (3.0 * power));
        }
        sum.mean()
    }
}

/// A mean over pixels.
#[derive(Default)]
struct Sum {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Sum {
    fn add(&mut self, x: f64) {
        self.count += 1.0;
        self.sum += x;
        self.squares += x * x;
    }

    fn mean(&self) -> Estimate {
        /// Two-sided 95 % quantile of the normal distribution.
        const NORMAL_95: f64 = 1.959_963_984_540_054;
        let value = self.sum / self.count;
        let variance = (self.squares / self.count - value * value).max(0.0) / (self.count - 1.0);
        Estimate {
            value,
            half_width: NORMAL_95 * variance.sqrt(),
        }
    }
}

/// Mean of x over that of r, less 1, with Welch's interval: spreads and counts may differ.
fn welch(x: &[f64], r: &[f64]) -> Estimate {
    let [(mean_x, of_x), (mean_r, of_r)] = [x, r].map(mean_and_variance);
    let variance = of_x + of_r;
    let share = |v: f64, n: usize| square(v) / (n as f64 - 1.0);
    let freedom = square(variance) / (share(of_x, x.len()) + share(of_r, r.len()));
    let half = match variance > 0.0 {
        true => student_95(freedom) * variance.sqrt(),
        false => 0.0,
    };
    Estimate {
        value: mean_x / mean_r - 1.0,
        half_width: half / mean_r,
    }
}

/// The mean, and the variance of the mean.
fn mean_and_variance(x: &[f64]) -> (f64, f64) {
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n;
    let scatter: f64 = x.iter().map(|x| square(x - mean)).sum();
    (mean, scatter / (n * (n - 1.0)))
}

/// Two-sided 95 % quantile of Student's distribution, of the next lower freedom in the table.
fn student_95(freedom: f64) -> f64 {
    const TABLE: [(f64, f64); 12] = [
        (120.0, 1.980),
        (60.0, 2.000),
        (30.0, 2.042),
        (20.0, 2.086),
        (15.0, 2.131),
        (10.0, 2.228),
        (8.0, 2.306),
        (6.0, 2.447),
        (5.0, 2.571),
        (4.0, 2.776),
        (3.0, 3.182),
        (2.0, 4.303),
    ];
    let row = TABLE.iter().find(|(from, _)| freedom >= *from);
    row.map_or(12.706, |(_, quantile)| *quantile)
}

fn square(x: f64) -> f64 {
    x * x
}

#[cfg(test)]
mod tests;
