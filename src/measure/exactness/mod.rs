//! What exactness costs: every choice of the product that is there for its answers, timed and judged beside the cheap one
//! that is usual.
//!
//! # Method
//!
//! **One thing at a time.** Of two traversals all but the rule in question is the same source: nodes, leaves, walk, rays
//! ([`crate::measure::arms::twins`]). What is no traversal is a loop over an array.
//!
//! **Times** are CPU times of one thread, as in [`super::bench`]: the work is cut into pieces that both sides do in turns, and
//! the shortest time of each piece counts.
//!
//! **Errors** are answers that an oracle calls wrong, on inputs that are hard on purpose: what a choice gets wrong at all is
//! the question, not how often a picture meets it. Each row names its inputs and its oracle in [`Row::counted`].
//!
//! Deliberately absent: errors of a whole image. See the dials of `luxel render` for those.

mod local;
mod report;
mod traversal;

pub use report::{csv, table};

use super::bench::clock;
use std::time::{Duration, Instant};

/// A choice and its cheap twin.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What is chosen: `triangle test`.
    pub choice: &'static str,
    /// What the product does.
    pub exact: &'static str,
    /// What is usual.
    pub cheap: &'static str,
    /// Of what the time is: `ray`.
    pub unit: &'static str,
    /// Nanoseconds, exact and cheap.
    pub ns: [f64; 2],
    /// Wrong answers among a million, exact and cheap.
    pub wrong: [f64; 2],
    /// Answers that were judged of each.
    pub judged: usize,
    /// What counts as wrong, on which inputs.
    pub counted: &'static str,
}

/// Measures all choices: so many rays or other inputs, in about so much time. `watch` hears of every choice beforehand.
pub fn run(count: usize, time: Duration, mut watch: impl FnMut(&'static str)) -> Vec<Row> {
    type Measure = fn(usize, Instant) -> Row;
    let choices: [(&str, Measure); 6] = [
        ("triangle test", traversal::triangles),
        ("box test", traversal::boxes),
        ("sphere roots", traversal::spheres),
        ("leaving a surface", local::offset),
        ("Fresnel reflectance", local::fresnel),
        ("sum of samples", local::film),
    ];
    let deadline = Instant::now() + time;
    let mut left = choices.len() as u32;
    let measure = |(name, measure): (&'static str, Measure)| {
        watch(name);
        let now = Instant::now();
        let until = now + deadline.saturating_duration_since(now) / left;
        left -= 1;
        measure(count.max(1), until)
    };
    choices.map(measure).to_vec()
}

/// Rays, hits or samples of a piece of work.
const PIECE: usize = 4096;

/// Passes over all pieces at least.
const FEWEST: u32 = 3;

/// Passes at most.
const MOST: u32 = 50;

/// Nanoseconds that both sides take for all pieces together, each piece's shortest of several passes. `work` is told a side
/// and a piece.
fn in_turns(pieces: usize, until: Instant, mut work: impl FnMut(usize, usize)) -> [f64; 2] {
    let mut best = [vec![Duration::MAX; pieces], vec![Duration::MAX; pieces]];
    let mut passes = 0;
    while passes < FEWEST || (passes < MOST && Instant::now() < until) {
        for (side, best) in best.iter_mut().enumerate() {
            for (piece, best) in best.iter_mut().enumerate() {
                let start = clock::now();
                work(side, piece);
                *best = (*best).min(clock::now().saturating_sub(start));
            }
        }
        passes += 1;
    }
    best.map(|pieces| pieces.iter().sum::<Duration>().as_secs_f64() * 1e9)
}

/// So many of so many, per million.
fn per_million(wrong: usize, judged: usize) -> f64 {
    wrong as f64 * 1e6 / judged.max(1) as f64
}
