//! How many samples a wanted error takes: told by a pilot, a rendering of the same frame from another seed.
//!
//! A render that stops when its own samples look good stops too early where a rare bright one has not come yet, and is too
//! dark on average. The pilot's samples are not in the image, which knows nothing of its own when their number is set: it is
//! a mean of n samples as any other. And n depends on scene, frame and seed alone.

use super::passes::{Deadline, Passes};
use super::{Canvas, Control, Settings};
use crate::film::Blocks;
use crate::trace::TraceOptions;

/// Samples of the shortest pilot.
const SHORTEST: u32 = 32;

/// The pilot has at least this part of the samples that it asks for: a rate of convergence can be trusted for so many
/// doublings, no more.
const PART: u32 = 8;

/// And at least this part of what it asks for in any cell.
const PART_OF_LONGEST: u32 = 64;

/// Fewest samples of an image for which the error is asked: fewer say nothing about it.
const FEWEST: u32 = 4;

/// Fewest samples of a cell: a block, of which something can be told.
const LEAST: u32 = Blocks::LENGTH;

/// Share of the time that the pilot may take.
const TIME: f64 = 0.125;

/// What the pilot found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Samples per pixel that reach the error, on average, or the most there may be.
    pub spp: u32,
    /// Samples per pixel of the pilot.
    pub pilot: u32,
}

impl Verdict {
    /// Samples per pixel of the pilot that may say so many, and so many for some part of the image.
    #[must_use]
    pub fn pilot_for(spp: u32, longest: u32) -> u32 {
        let least = spp.div_ceil(PART).max(longest.div_ceil(PART_OF_LONGEST));
        least.div_ceil(SHORTEST).max(1).next_power_of_two() * SHORTEST
    }
}

/// The pilot's own numbers: another seed, and nothing beside the radiance.
pub(super) fn options(options: &TraceOptions) -> TraceOptions {
    TraceOptions {
        // The bits of "pilot": no one counts seeds up to there.
        seed: options.seed ^ 0x7069_6c6f_7400_0000,
        features: false,
        ids: false,
        ..*options
    }
}

/// How many samples, at most `most`, give a relative error of `wanted`: of every pixel, or of each cell of the canvas as far as
/// they differ. `trace` completes the passes that it is given and
/// says how many samples there are.
pub(super) fn ask(
    (wanted, adaptive): (f64, bool),
    most: u32,
    size: (u32, u32),
    canvas: &Canvas,
    control: &Control,
    deadline: Option<Deadline>,
    trace: impl Fn(&Canvas, Passes) -> u32,
) -> (Verdict, Vec<u32>) {
    let pixels = u64::from(size.0) * u64::from(size.1);
    let deadline = deadline.map(|deadline| deadline.part(TIME));
    let mut pilot = 0;
    loop {
        let goal = (2 * pilot).max(SHORTEST);
        control.expect(pixels * u64::from(goal + most.min(goal.saturating_mul(PART))));
        let complete = trace(canvas, Passes::new(pilot, goal, deadline));
        let film = canvas.film();
        let (spp, goals) = match adaptive {
            true => {
                let goals = film.allot(wanted, Settings::CELL, LEAST, most);
                goals.map_or((most, Vec::new()), |goals| (canvas.mean(&goals), goals))
            }
            false => {
                let bar = film.error();
                let spp = bar.map_or(most, |bar| bar.samples_for(wanted, FEWEST, most));
                (spp, Vec::new())
            }
        };
        let verdict = Verdict {
            spp,
            pilot: complete,
        };
        let longest = goals.iter().copied().max().unwrap_or(0);
        // Cut off by the time, or by Ctrl-C; or long enough.
        if complete < goal || goal >= Verdict::pilot_for(spp, longest) {
            return (verdict, goals);
        }
        pilot = goal;
    }
}
