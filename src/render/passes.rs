//! How the samples of a frame are cut into passes over the whole image.
//!
//! The first pass is one sample, so that a stopped render is a whole picture early; passes then double. The cut changes
//! no bit, only when a picture exists.

use std::ops::Range;
use std::time::{Duration, Instant};

/// Samples of the longest pass: then waiting for the slowest tile at its end costs little, and a stop or a deadline is
/// met soon.
const LONGEST: u32 = 16;

/// Gives out passes until the samples or the time are used up.
pub(super) struct Passes {
    done: u32,
    spp: u32,
    deadline: Option<Instant>,
    start: Instant,
}

impl Passes {
    /// Passes over `spp` samples; those that would not end by `deadline` are left out, but for the first.
    pub(super) fn new(spp: u32, deadline: Option<Instant>) -> Passes {
        Passes {
            done: 0,
            spp,
            deadline,
            start: Instant::now(),
        }
    }

    /// The sample indices of the next pass. All passes before it must be complete.
    pub(super) fn next_pass(&mut self) -> Option<Range<u32>> {
        let wanted = self.done.clamp(1, LONGEST).min(self.spp - self.done);
        let length = match self.deadline {
            Some(deadline) if self.done > 0 => {
                let now = Instant::now();
                wanted.min(affordable(
                    now - self.start,
                    self.done,
                    deadline.saturating_duration_since(now),
                ))
            }
            _ => wanted,
        };
        let first = self.done;
        self.done += length;
        (length > 0).then_some(first..self.done)
    }
}

/// Samples that fit into `left` when `done` of them took `spent`.
fn affordable(spent: Duration, done: u32, left: Duration) -> u32 {
    let per_sample = spent.as_secs_f64() / f64::from(done);
    // A float to integer cast saturates, and 0/0 gives 0.
    (left.as_secs_f64() / per_sample) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(mut passes: Passes) -> Vec<Range<u32>> {
        std::iter::from_fn(|| passes.next_pass()).collect()
    }

    #[test]
    fn passes_cover_every_sample_once_in_order() {
        for spp in [1, 2, 3, 7, 16, 64, 100] {
            let passes = all(Passes::new(spp, None));
            assert_eq!(passes[0], 0..1);
            assert_eq!(passes.last().map(|p| p.end), Some(spp));
            assert!(passes.windows(2).all(|w| w[0].end == w[1].start));
            assert!(
                passes
                    .iter()
                    .all(|p| !p.is_empty() && p.len() <= LONGEST as usize)
            );
        }
    }

    #[test]
    fn a_deadline_in_the_past_leaves_the_first_pass() {
        let passes = all(Passes::new(64, Some(Instant::now())));
        assert_eq!((passes.len(), passes[0].end), (1, 1));
    }

    #[test]
    fn no_more_is_begun_than_fits() {
        let s = Duration::from_secs_f64;
        assert_eq!(affordable(s(2.0), 4, s(3.2)), 6);
        assert_eq!(affordable(s(2.0), 1, s(1.9)), 0);
    }
}
