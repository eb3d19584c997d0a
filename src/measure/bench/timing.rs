//! Taking turns: how the arms are timed.

use super::answers::{Answers, Chunk};
use super::clock;
use super::contender::Contender;
use std::time::{Duration, Instant};

/// Passes over the rays at least: with fewer a minimum says little.
const FEWEST: u32 = 3;

/// Passes at most: more change no digit that is printed.
const MOST: u32 = 50;

/// A contender with the chunks that it traces.
pub(super) type Turn<'a> = (Contender<'a>, Vec<&'a Chunk>);

/// What tracing a ray set took.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timing {
    /// The sum over the chunks of each one's shortest time.
    pub(super) seconds: f64,
    pub(super) passes: u32,
}

/// Times contenders on their chunks, in turns, at least [`FEWEST`] times and then until the deadline.
///
/// A turn is a whole ray set, so that nothing of a chunk is left in the near caches when it comes again.
pub(super) fn in_turns(turns: &[Turn], deadline: Instant) -> Vec<Timing> {
    let mut best: Vec<Vec<Duration>> = turns
        .iter()
        .map(|(_, chunks)| vec![Duration::MAX; chunks.len()])
        .collect();
    let mut answers = Answers::default();
    let mut passes = 0;
    while passes < FEWEST || (passes < MOST && Instant::now() < deadline) {
        for ((contender, chunks), best) in turns.iter().zip(&mut best) {
            for (chunk, best) in chunks.iter().zip(best) {
                let start = clock::now();
                chunk.trace(contender, &mut answers);
                *best = (*best).min(clock::now().saturating_sub(start));
            }
        }
        passes += 1;
    }
    let timing = |best: &Vec<Duration>| Timing {
        seconds: best.iter().sum::<Duration>().as_secs_f64(),
        passes,
    };
    best.iter().map(timing).collect()
}
