//! Where samples go: how many each cell of an image gets so that a wanted error takes the fewest.
//!
//! Twice the samples of a cell cost as many as it has and take away what the film's decay says of its variance. The fewest
//! samples for a variance in all are those where the next doubling of every cell would bring as little for a sample as that of
//! any other (Everett 1963, "Generalized Lagrange multiplier method"): a price, which is sought. Numbers are powers of two,
//! of which Sobol points are evenest.
//!
//! Variances of cells are noisy, and cells that look better than they are would be given too little, always: the price is
//! judged by the pixels that had no part in the choice, every other one.

use super::Film;
use super::decay::Decay;

/// Share of a cell's variance that is that of the cells around it, which may have met what it has not yet.
const AROUND: f64 = 0.125;

/// Share of the mean variance that every cell has at least, for the same reason.
const EVERYWHERE: f64 = 1.0 / 256.0;

/// Halvings of the interval of prices.
const STEPS: u32 = 40;

/// A cell's variance, at the samples that the film has, by both halves of its pixels.
type Halves = [f64; 2];

struct Cells {
    variances: Vec<Halves>,
    /// Pixels of each.
    sizes: Vec<f64>,
    /// What the mean variance of all pixels may be.
    allowed: f64,
    least: u32,
    most: u32,
}

impl Film {
    /// Samples for each cell of `side` × `side` pixels, row by row, with which the relative error is `wanted`: powers of two,
    /// but for `least` and `most`, between which they lie. `None` where the film's own error is not known.
    #[must_use]
    pub fn allot(&self, wanted: f64, side: u32, least: u32, most: u32) -> Option<Vec<u32>> {
        let bar = self.error()?;
        let (variances, decay) = self.pixel_variances()?;
        let (variances, sizes) = self.halves(&variances, side as usize);
        let cells = Cells {
            variances,
            sizes,
            allowed: wanted * wanted * bar.mean_square(),
            least: least.min(most),
            most,
        };
        Some(cells.allot(&decay, self.samples()))
    }

    /// Variances of cells, with what their neighbours add, and numbers of pixels.
    fn halves(&self, variances: &[f64], side: usize) -> (Vec<Halves>, Vec<f64>) {
        let (width, height) = (self.width() as usize, self.height() as usize);
        let (columns, rows) = (width.div_ceil(side), height.div_ceil(side));
        let (mut sums, mut counts) = (
            vec![[0.0; 2]; columns * rows],
            vec![[0.0; 2]; columns * rows],
        );
        for (i, variance) in variances.iter().enumerate() {
            let (x, y) = (i % width, i / width);
            let cell = y / side * columns + x / side;
            sums[cell][(x + y) % 2] += variance;
            counts[cell][(x + y) % 2] += 1.0;
        }
        let sizes = counts.iter().map(|[a, b]| a + b).collect();
        let own: Vec<Halves> = sums
            .iter()
            .zip(&counts)
            .map(|(sum, count)| {
                // A cell of one pixel has one half only.
                let whole = (sum[0] + sum[1]) / (count[0] + count[1]);
                [0, 1].map(|half| match count[half] > 0.0 {
                    true => sum[half] / count[half],
                    false => whole,
                })
            })
            .collect();
        let floor = own.iter().flatten().sum::<f64>() / (2.0 * own.len() as f64) * EVERYWHERE;
        let smooth = |cell: usize| {
            let (x, y) = (cell % columns, cell / columns);
            let (mut around, mut count) = ([0.0; 2], 0.0);
            for row in y.saturating_sub(1)..=(y + 1).min(rows - 1) {
                for column in x.saturating_sub(1)..=(x + 1).min(columns - 1) {
                    let other = own[row * columns + column];
                    around = [around[0] + other[0], around[1] + other[1]];
                    count += 1.0;
                }
            }
            [0, 1].map(|half| {
                let mixed = (1.0 - AROUND) * own[cell][half] + AROUND * around[half] / count;
                mixed.max(floor)
            })
        };
        ((0..own.len()).map(smooth).collect(), sizes)
    }
}

impl Cells {
    fn allot(&self, decay: &Decay, taken: u32) -> Vec<u32> {
        // By the decay of all, a cell's variance is its own part of these.
        let now = decay.variance(taken).max(f64::MIN_POSITIVE);
        let ladder = self.ladder();
        let left: Vec<f64> = ladder.iter().map(|&n| decay.variance(n) / now).collect();
        // What a step brings for a sample, which never grows.
        let mut bargains: Vec<f64> = (1..ladder.len())
            .map(|i| (left[i - 1] - left[i]).max(0.0) / f64::from(ladder[i] - ladder[i - 1]))
            .collect();
        for i in 1..bargains.len() {
            bargains[i] = bargains[i].min(bargains[i - 1]);
        }
        let step = |variance: f64, price: f64| {
            bargains.partition_point(|bargain| variance * bargain > price)
        };
        let error = |price: f64| {
            let mut sum = 0.0;
            for (halves, size) in self.variances.iter().zip(&self.sizes) {
                let [a, b] = *halves;
                sum += size * (left[step(a, price)] * b + left[step(b, price)] * a) / 2.0;
            }
            sum / self.sizes.iter().sum::<f64>()
        };
        let dearest = self
            .variances
            .iter()
            .flatten()
            .fold(0.0, |most: f64, v| most.max(*v));
        let (mut low, mut high) = (dearest * 1e-30, dearest.max(f64::MIN_POSITIVE));
        for _ in 0..STEPS {
            let middle = (low * high).sqrt();
            match error(middle) <= self.allowed {
                true => low = middle,
                false => high = middle,
            }
        }
        let goal = |halves: &Halves| ladder[step((halves[0] + halves[1]) / 2.0, low)];
        self.variances.iter().map(goal).collect()
    }

    /// The numbers of samples that a cell may have, rising.
    fn ladder(&self) -> Vec<u32> {
        let mut ladder = vec![self.least];
        while let Some(&last) = ladder.last().filter(|last| **last < self.most) {
            let next = last.saturating_add(1).checked_next_power_of_two();
            ladder.push(next.map_or(self.most, |next| next.min(self.most)));
        }
        ladder
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(variances: &[f64], allowed: f64) -> Cells {
        Cells {
            variances: variances.iter().map(|v| [*v; 2]).collect(),
            sizes: vec![1.0; variances.len()],
            allowed,
            least: 4,
            most: 1 << 20,
        }
    }

    fn variance(cells: &Cells, decay: &Decay, taken: u32, goals: &[u32]) -> f64 {
        let now = decay.variance(taken);
        let each = cells.variances.iter().zip(goals);
        let sum: f64 = each.map(|([v, _], n)| v * decay.variance(*n) / now).sum();
        sum / goals.len() as f64
    }

    /// Of independent samples: n is proportional to the deviation (Neyman 1934), as far as powers of two go.
    #[test]
    fn samples_go_where_deviations_are() {
        let variances: Vec<f64> = (0..200).map(|i| 1.0 + f64::from(i * i)).collect();
        let decay = Decay::of_independent(1.0);
        let cells = cells(&variances, 10.0);
        let goals = cells.allot(&decay, 16);
        let found = variance(&cells, &decay, 16, &goals);
        assert!(found <= 10.0 && found > 9.0, "{found}");
        let mean = |of: &dyn Fn(f64) -> f64| {
            variances.iter().map(|v| of(*v)).sum::<f64>() / variances.len() as f64
        };
        // The least of Σ v · 16 / n for a mean of n.
        let optimum = 16.0 * mean(&f64::sqrt).powi(2) / found;
        let uniform = 16.0 * mean(&|v| v) / found;
        let spent = goals.iter().map(|n| f64::from(*n)).sum::<f64>() / goals.len() as f64;
        assert!(
            spent < 1.1 * optimum && spent < 0.85 * uniform,
            "{spent} {optimum} {uniform}"
        );
    }

    #[test]
    fn equal_cells_get_equal_numbers_within_a_doubling() {
        let cells = cells(&[3.0; 50], 1.0);
        let goals = cells.allot(&Decay::of_independent(1.0), 16);
        assert!(goals.iter().all(|n| *n == goals[0]), "{goals:?}");
        assert_eq!(goals[0], 64);
    }

    /// Where half of the pixels say nothing, the other half is judged by that nothing, and the reverse.
    #[test]
    fn numbers_stay_between_their_limits() {
        let decay = Decay::of_independent(1.0);
        let mut dark = cells(&[0.0; 9], 1.0);
        assert!(dark.allot(&decay, 16).iter().all(|n| *n == 4));
        dark.variances[4] = [1e9; 2];
        dark.most = 100;
        let goals = dark.allot(&decay, 16);
        assert_eq!((goals[4], goals[3]), (100, 4));
        dark.least = 500;
        dark.least = dark.least.min(dark.most);
        assert!(dark.allot(&decay, 16).iter().all(|n| *n == 100));
    }
}
