//! Where samples go: how many each cell of an image gets so that a wanted error takes the fewest.
//!
//! Twice the samples of a cell cost as many as it has and take away what the film's decay says of its variance. The fewest
//! samples for a variance in all are those where the next doubling of every cell would bring as little for a sample as that of
//! any other (Everett 1963, "Generalized Lagrange multiplier method"): a price, which is sought. Numbers are powers of two,
//! of which Sobol points are evenest.
//!
//! What is bright falls otherwise than what is dark: along edges, samples that are spread evenly err by less and less. So
//! cells are sorted by their variance into some groups, each with a decay of its own.
//!
//! Variances of cells are noisy, and cells that look better than they are would be given too little, always: a cell's pixels
//! are halved like the fields of a chessboard, and what one half chooses, group and price, is judged by the other.

use super::decay::Decay;
use super::error::{Sums, decay_of, mean_of};
use super::pixels::Scale;
use super::{ErrorBar, Film};

/// Groups of cells.
const GROUPS: usize = 4;

/// Fewest pixels that tell how the variance of a group falls.
const FEWEST: f64 = 256.0;

/// Share of a cell's variance that is that of the cells around it, which may have met what it has not yet.
const AROUND: f64 = 0.125;

/// Share of the mean variance that every cell has at least, for the same reason.
const EVERYWHERE: f64 = 1.0 / 256.0;

/// Halvings of the interval of prices.
const STEPS: u32 = 40;

/// Something of a cell by both halves of its pixels.
type Halves<T> = [T; 2];

/// The cells of an image, row by row.
struct Grid {
    side: usize,
    width: usize,
    height: usize,
}

impl Grid {
    fn columns(&self) -> usize {
        self.width.div_ceil(self.side)
    }

    fn rows(&self) -> usize {
        self.height.div_ceil(self.side)
    }

    /// A pixel's cell, and its half.
    fn place(&self, pixel: usize) -> (usize, usize) {
        let (x, y) = (pixel % self.width, pixel / self.width);
        (y / self.side * self.columns() + x / self.side, (x + y) % 2)
    }

    /// Mean variances of cells, and their numbers of pixels.
    fn means(&self, variances: &[f64]) -> (Vec<Halves<f64>>, Vec<f64>) {
        let cells = self.columns() * self.rows();
        let (mut sums, mut counts) = (vec![[0.0; 2]; cells], vec![[0.0; 2]; cells]);
        for (pixel, variance) in variances.iter().enumerate() {
            let (cell, half) = self.place(pixel);
            sums[cell][half] += variance;
            counts[cell][half] += 1.0;
        }
        let mean = |(sum, count): (&Halves<f64>, &Halves<f64>)| {
            // A cell of one pixel has one half only.
            let whole = (sum[0] + sum[1]) / (count[0] + count[1]);
            [0, 1].map(|half| match count[half] > 0.0 {
                true => sum[half] / count[half],
                false => whole,
            })
        };
        let own: Vec<Halves<f64>> = sums.iter().zip(&counts).map(mean).collect();
        let sizes = counts.iter().map(|[a, b]| a + b).collect();
        (self.smooth(&own), sizes)
    }

    /// With what the cells around say, and all of them.
    fn smooth(&self, own: &[Halves<f64>]) -> Vec<Halves<f64>> {
        let floor = own.iter().flatten().sum::<f64>() / (2.0 * own.len() as f64) * EVERYWHERE;
        let of = |cell: usize| {
            let (x, y) = (cell % self.columns(), cell / self.columns());
            let (mut around, mut count) = ([0.0; 2], 0.0);
            for row in y.saturating_sub(1)..=(y + 1).min(self.rows() - 1) {
                for column in x.saturating_sub(1)..=(x + 1).min(self.columns() - 1) {
                    let other = own[row * self.columns() + column];
                    around = [around[0] + other[0], around[1] + other[1]];
                    count += 1.0;
                }
            }
            [0, 1].map(|half| {
                let mixed = (1.0 - AROUND) * own[cell][half] + AROUND * around[half] / count;
                mixed.max(floor)
            })
        };
        (0..own.len()).map(of).collect()
    }
}

/// Variances from which on a cell is in the second group, in the third …: all groups cost about the same.
fn thresholds(means: &[Halves<f64>]) -> Vec<f64> {
    let mut sorted: Vec<f64> = means.iter().map(|[a, b]| (a + b) / 2.0).collect();
    sorted.sort_by(f64::total_cmp);
    let whole: f64 = sorted.iter().map(|v| v.sqrt()).sum();
    let (mut sum, mut thresholds) = (0.0, Vec::new());
    for variance in sorted {
        let next = (thresholds.len() + 1) as f64 / GROUPS as f64;
        if thresholds.len() + 1 < GROUPS && sum >= next * whole {
            thresholds.push(variance);
        }
        sum += variance.sqrt();
    }
    thresholds
}

fn group(thresholds: &[f64], variance: f64) -> usize {
    thresholds.partition_point(|threshold| *threshold <= variance)
}

/// What decides about samples.
struct Cells {
    /// Variances at the samples that the film has.
    variances: Vec<Halves<f64>>,
    /// Pixels of each.
    sizes: Vec<f64>,
    thresholds: Vec<f64>,
    /// What is left of a variance in each group at each step of the ladder, as a share.
    left: Vec<Vec<f64>>,
    /// The numbers of samples that a cell may have, rising.
    ladder: Vec<u32>,
    /// What the mean variance of all pixels may be.
    allowed: f64,
}

impl Film {
    /// Samples for each cell of `side` × `side` pixels, row by row, with which the relative error is `wanted`: powers of two,
    /// but for `least` and `most`, between which they lie. `None` where the film's own error is not known, or not all pixels
    /// have as many samples.
    #[must_use]
    pub fn allot(&self, wanted: f64, side: u32, least: u32, most: u32) -> Option<Vec<u32>> {
        let bar = self.error()?;
        let [(_, decay)] = bar.decays() else {
            return None;
        };
        let grid = Grid {
            side: side as usize,
            width: self.width() as usize,
            height: self.height() as usize,
        };
        let (levels, taken) = (self.seen_levels(), self.samples());
        let scale = Scale::new(decay, &levels, taken);
        let pixels = 0..self.pixels();
        let first: Vec<f64> = pixels
            .clone()
            .map(|i| mean_of(scale.variance(self, i)))
            .collect();
        let (means, _) = grid.means(&first);
        let thresholds = thresholds(&means);
        // By the other half of its cell.
        let group_of = |pixel: usize| {
            let (cell, half) = grid.place(pixel);
            group(&thresholds, means[cell][1 - half])
        };
        let decays = self.decays(&levels, decay, thresholds.len() + 1, group_of);
        let of = |decay: &Decay| Scale::new(decay, &levels, taken);
        let scales: Vec<Scale> = decays.iter().map(of).collect();
        let variance = |i: usize| mean_of(scales[group_of(i)].variance(self, i));
        let second: Vec<f64> = pixels.map(variance).collect();
        let (variances, sizes) = grid.means(&second);
        let ladder = ladder(least.min(most), most);
        let share = |decay: &Decay| {
            let now = decay.variance(taken).max(f64::MIN_POSITIVE);
            ladder.iter().map(|&n| decay.variance(n) / now).collect()
        };
        let cells = Cells {
            variances,
            sizes,
            left: decays.iter().map(share).collect(),
            thresholds,
            ladder,
            allowed: allowed(&bar, wanted),
        };
        Some(cells.allot())
    }

    /// How the variance falls in each group of pixels; as in all of them where they are few.
    fn decays(
        &self,
        levels: &[u32],
        all: &Decay,
        groups: usize,
        group_of: impl Fn(usize) -> usize,
    ) -> Vec<Decay> {
        let mut sums = vec![Sums::zero(levels.len().max(1)); groups];
        for i in 0..self.pixels() {
            self.add_levels(&mut sums[group_of(i)], levels, i);
        }
        let own = |sums: &Sums| match sums.pixels >= FEWEST {
            true => decay_of(levels, sums).unwrap_or_else(|| all.clone()),
            false => all.clone(),
        };
        sums.iter().map(own).collect()
    }
}

/// The mean variance with which an image is as wrong as wanted.
fn allowed(bar: &ErrorBar, wanted: f64) -> f64 {
    wanted * wanted * bar.mean_square()
}

/// From `least` to `most` by powers of two.
fn ladder(least: u32, most: u32) -> Vec<u32> {
    let mut ladder = vec![least];
    while let Some(&last) = ladder.last().filter(|last| **last < most) {
        let next = last.saturating_add(1).checked_next_power_of_two();
        ladder.push(next.map_or(most, |next| next.min(most)));
    }
    ladder
}

impl Cells {
    fn allot(&self) -> Vec<u32> {
        let bargains: Vec<Vec<f64>> = self.left.iter().map(|left| self.bargains(left)).collect();
        // A cell's group and step, as a variance would have them.
        let step = |variance: f64, price: f64| {
            let group = group(&self.thresholds, variance);
            let worth = |bargain: &f64| variance * bargain > price;
            (group, bargains[group].partition_point(worth))
        };
        let error = |price: f64| {
            let left = |chooser: f64| {
                let (group, step) = step(chooser, price);
                self.left[group][step]
            };
            let (mut crossed, mut own) = (0.0, 0.0);
            for (&[a, b], size) in self.variances.iter().zip(&self.sizes) {
                let both = (a + b) / 2.0;
                crossed += size * (left(a) * b + left(b) * a) / 2.0;
                own += size * left(both) * both;
            }
            // Both halves choose together, which errs by half as much as one: by their own judgement too little, by the
            // other's, which is of a half's choice, twice too much.
            (own + 2.0 * crossed) / 3.0 / self.sizes.iter().sum::<f64>()
        };
        let variances = self.variances.iter().flatten();
        let dearest = variances.fold(
            f64::MIN_POSITIVE,
            |most, v| if *v > most { *v } else { most },
        );
        let (mut low, mut high) = (dearest * 1e-30, dearest);
        for _ in 0..STEPS {
            let middle = (low * high).sqrt();
            match error(middle) <= self.allowed {
                true => low = middle,
                false => high = middle,
            }
        }
        let goal = |[a, b]: &Halves<f64>| self.ladder[step((a + b) / 2.0, low).1];
        self.variances.iter().map(goal).collect()
    }

    /// What each step brings for a sample, as a share of the variance; it never grows.
    fn bargains(&self, left: &[f64]) -> Vec<f64> {
        let (mut bargains, mut last) = (Vec::new(), f64::INFINITY);
        for (left, samples) in left.windows(2).zip(self.ladder.windows(2)) {
            let bargain = (left[0] - left[1]).max(0.0) / f64::from(samples[1] - samples[0]);
            last = if bargain < last { bargain } else { last };
            bargains.push(last);
        }
        bargains
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of independent samples, at 16 of them.
    fn cells(variances: &[f64], allowed: f64, most: u32) -> Cells {
        let ladder = ladder(4.min(most), most);
        Cells {
            variances: variances.iter().map(|v| [*v; 2]).collect(),
            sizes: vec![1.0; variances.len()],
            thresholds: Vec::new(),
            left: vec![ladder.iter().map(|n| 16.0 / f64::from(*n)).collect()],
            ladder,
            allowed,
        }
    }

    fn variance(variances: &[f64], goals: &[u32]) -> f64 {
        let each = variances.iter().zip(goals);
        let sum: f64 = each.map(|(v, n)| v * 16.0 / f64::from(*n)).sum();
        sum / goals.len() as f64
    }

    /// Where the error is 1 / n, n is proportional to the deviation (Neyman 1934), as far as powers of two go.
    #[test]
    fn samples_go_where_deviations_are() {
        let variances: Vec<f64> = (0..200).map(|i| 1.0 + f64::from(i * i)).collect();
        let goals = cells(&variances, 10.0, 1 << 20).allot();
        let found = variance(&variances, &goals);
        assert!(found <= 10.0 && found > 9.0, "{found}");
        let mean = |of: &dyn Fn(f64) -> f64| {
            variances.iter().map(|v| of(*v)).sum::<f64>() / variances.len() as f64
        };
        // The least mean of n for a mean of v · 16 / n.
        let optimum = 16.0 * mean(&f64::sqrt).powi(2) / found;
        let uniform = 16.0 * mean(&|v| v) / found;
        let spent = goals.iter().map(|n| f64::from(*n)).sum::<f64>() / goals.len() as f64;
        assert!(
            spent < 1.1 * optimum && spent < 0.85 * uniform,
            "{spent} {optimum} {uniform}"
        );
    }

    #[test]
    fn equal_cells_get_equal_numbers() {
        let goals = cells(&[3.0; 50], 1.0, 1 << 20).allot();
        assert!(goals.iter().all(|n| *n == 64), "{goals:?}");
    }

    #[test]
    fn numbers_stay_between_their_limits() {
        let mut variances = [0.0; 9];
        assert!(cells(&variances, 1.0, 100).allot().iter().all(|n| *n == 4));
        variances[4] = 1e9;
        let goals = cells(&variances, 1.0, 100).allot();
        assert_eq!((goals[4], goals[3]), (100, 4));
        assert_eq!(cells(&variances, 1.0, 3).allot()[4], 3);
    }

    /// Two halves that say different things are each other's judges: what one alone would take for enough is not.
    #[test]
    fn a_cell_that_looks_good_by_accident_is_not_believed() {
        let mut doubtful = cells(&[1.0; 64], 0.25, 1 << 20);
        let sure = doubtful.allot();
        for halves in &mut doubtful.variances {
            *halves = [0.1, 1.9];
        }
        let sum = |goals: &[u32]| goals.iter().sum::<u32>();
        assert!(sum(&doubtful.allot()) > sum(&sure));
    }

    #[test]
    fn groups_cost_the_same() {
        let means: Vec<Halves<f64>> = (1..=100).map(|i| [f64::from(i * i); 2]).collect();
        let cuts = thresholds(&means);
        // Σ i up to 50 is a quarter of that up to 100.
        assert_eq!(cuts.len(), 3);
        assert!((f64::sqrt(cuts[0]) - 50.0).abs() < 2.0, "{cuts:?}");
        assert_eq!(group(&cuts, 0.0), 0);
        assert_eq!(group(&cuts, 1e9), 3);
    }
}
