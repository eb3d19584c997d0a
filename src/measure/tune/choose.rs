//! The choice: a function of what was measured, and of nothing else.
//!
//! The squared error of a setting with n samples is its squared bias, that of its size, and its variance: between measured
//! numbers of samples the variance is a power of n, and beyond them it goes on as between the last two.

use super::{Goal, Level, Quality, Report, Shrunk};
use crate::math::{ln, pow};
use crate::scene::RenderDesc;

/// Settings that take up to this many times as long as the fastest are as good: the one with fewer turned dials is
/// chosen. Times repeat to within that.
const AS_GOOD: f64 = 1.08;

/// The power of n that variance falls with beyond what was measured: low-discrepancy points gain more than the 1 of
/// random ones where light is smooth, but not on for ever.
const SLOPES: [f64; 2] = [0.9, 1.25];

/// A setting for a quality.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// What for.
    pub quality: Quality,
    /// Index of its row.
    pub row: usize,
    /// Width and height.
    pub size: (u32, u32),
    /// Samples per pixel.
    pub spp: u32,
    /// Relative RMSE that it will have.
    pub error: f64,
    /// The part of it that is bias, as measured.
    pub bias: f64,
    /// CPU seconds of build and tracing that it will take.
    pub seconds: f64,
}

/// A pick, with what it is judged by.
struct Candidate {
    pick: Pick,
    /// How many dials that bias are turned, size included; and dials in all.
    turned: (usize, usize),
}

/// The setting that reaches the goal in the least time; `None` if none does.
#[must_use]
pub fn choose(report: &Report, goal: Goal) -> Option<Pick> {
    let all = candidates(report, goal, 0..report.rows.len());
    let seconds = all.iter().map(|c| c.pick.seconds);
    let limit = AS_GOOD * seconds.fold(f64::INFINITY, f64::min);
    let good = all.iter().filter(|c| c.pick.seconds <= limit);
    let simplest = good.min_by(|a, b| {
        let turned = a.turned.cmp(&b.turned);
        turned.then(a.pick.seconds.total_cmp(&b.pick.seconds))
    });
    simplest.map(|c| c.pick)
}

/// What one setting takes for the goal at the full size.
#[must_use]
pub(super) fn pick_of(report: &Report, row: usize, goal: Goal) -> Option<Pick> {
    let mut all = candidates(report, goal, row..row + 1);
    all.retain(|c| c.pick.size == report.full);
    all.pop().map(|c| c.pick)
}

fn candidates(report: &Report, goal: Goal, rows: std::ops::Range<usize>) -> Vec<Candidate> {
    let sizes = || std::iter::once(None).chain(report.shrunk.iter().map(Some));
    rows.flat_map(|row| sizes().filter_map(move |size| candidate(report, row, size, goal)))
        .collect()
}

fn candidate(
    report: &Report,
    index: usize,
    shrunk: Option<&Shrunk>,
    goal: Goal,
) -> Option<Candidate> {
    let row = &report.rows[index];
    let of_size = shrunk.map_or(0.0, |s| s.bias_squared.upper().max(0.0));
    let most = row.most_bias_squared() + of_size;
    let squared = goal.error * goal.error;
    let share = goal.quality.bias_share();
    // Where all of the error is bias no number of samples would do.
    if most > share * share * squared || most >= squared {
        return None;
    }
    let scale = report.scale()[0] * shrunk.map_or(1.0, |s| s.variance);
    let spp = samples_for(&row.levels, (squared - most) / scale)?;
    let size = shrunk.map_or(report.full, |s| s.size);
    let bias = row.known_bias_squared() + shrunk.map_or(0.0, |s| s.bias_squared.value.max(0.0));
    let variance = scale * variance(&row.levels, f64::from(spp));
    Some(Candidate {
        pick: Pick {
            quality: goal.quality,
            row: index,
            size,
            spp,
            error: (bias + variance).sqrt(),
            bias: bias.sqrt(),
            seconds: report.seconds(row, spp, shrunk),
        },
        turned: (
            row.biases + usize::from(shrunk.is_some()),
            row.turned + usize::from(shrunk.is_some()),
        ),
    })
}

/// The fewest samples whose variance is at most so much.
fn samples_for(levels: &[Level], most: f64) -> Option<u32> {
    let enough = |n: u32| variance(levels, f64::from(n)) <= most;
    let (mut low, mut high) = (0, RenderDesc::MAX_SPP);
    if !enough(high) {
        return None;
    }
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        match enough(middle) {
            true => high = middle,
            false => low = middle,
        }
    }
    Some(high)
}

/// Relative variance with n samples, of small pictures.
fn variance(levels: &[Level], n: f64) -> f64 {
    let at = |l: &Level| (f64::from(l.spp), l.differences.variance.value);
    let slope = |a: &Level, b: &Level| {
        let ((n, v), (m, w)) = (at(a), at(b));
        match v > 0.0 && w > 0.0 {
            true => ln(v / w) / ln(m / n),
            false => 1.0,
        }
    };
    let Some(last) = levels.last() else {
        return f64::INFINITY;
    };
    let next = levels.iter().position(|l| f64::from(l.spp) >= n);
    let (from, slope) = match (next, levels) {
        (Some(0), _) => (&levels[0], 1.0),
        (Some(k), _) => (&levels[k - 1], slope(&levels[k - 1], &levels[k])),
        (None, [.., before, _]) => (last, slope(before, last).clamp(SLOPES[0], SLOPES[1])),
        (None, _) => (last, 1.0),
    };
    let (m, v) = at(from);
    v * pow(n / m, -slope)
}

#[cfg(test)]
mod tests;
