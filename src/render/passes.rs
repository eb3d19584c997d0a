//! How the samples of a frame are cut into passes over the whole image.
//!
//! The first pass is one sample, so that a stopped render is a whole picture early; passes then double. The cut changes
//! no bit, only when a picture exists.

use std::ops::Range;
use std::time::{Duration, Instant};

/// Samples of the longest pass: then waiting for the slowest tile at its end costs little, and a stop or a deadline is
/// met soon.
const LONGEST: u32 = 16;

/// The deadline of a render, and how exactly it is met.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deadline {
    at: Instant,
    slack: Duration,
}

impl Deadline {
    /// `time` from now, met within 1.5 % or a tenth of a second.
    pub(super) fn after(time: Duration) -> Deadline {
        Deadline {
            at: Instant::now() + time,
            slack: time.mul_f64(0.015).max(Duration::from_millis(100)),
        }
    }

    /// After `share` of the time to go.
    pub(super) fn part(self, share: f64) -> Deadline {
        let now = Instant::now();
        let left = self.at.saturating_duration_since(now);
        Deadline {
            at: now + left.mul_f64(share),
            ..self
        }
    }
}

/// Samples to trace in every pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Pass {
    pub(super) samples: Range<u32>,
    /// When to leave it unfinished.
    pub(super) until: Option<Instant>,
}

/// Gives out passes until the samples or the time are used up.
pub(super) struct Passes {
    done: u32,
    /// Samples that were done before.
    from: u32,
    spp: u32,
    deadline: Option<Deadline>,
    start: Instant,
}

impl Passes {
    /// Passes over the samples from `done` to `spp`; of those that would not end by the deadline none is begun, but for the
    /// first.
    pub(super) fn new(done: u32, spp: u32, deadline: Option<Deadline>) -> Passes {
        Passes {
            done,
            from: done,
            spp: spp.max(done),
            deadline,
            start: Instant::now(),
        }
    }

    /// Samples of the passes given out so far, and of those before.
    pub(super) fn done(&self) -> u32 {
        self.done
    }

    /// The next pass. All passes before it must be complete.
    pub(super) fn next_pass(&mut self) -> Option<Pass> {
        let wanted = self.done.clamp(1, LONGEST).min(self.spp - self.done);
        let (length, until) = match self.deadline {
            Some(deadline) if self.done > self.from => {
                let now = Instant::now();
                let sample = (now - self.start).div_f64(f64::from(self.done - self.from));
                let left = deadline.at.saturating_duration_since(now);
                let (length, cut) = affordable(sample, left, deadline.slack);
                (wanted.min(length), cut.then_some(deadline.at))
            }
            _ => (wanted, None),
        };
        let first = self.done;
        self.done += length;
        (length > 0).then_some(Pass {
            samples: first..self.done,
            until,
        })
    }
}

/// How many samples that take `sample` each fit into `left`, and whether the last one has to be left unfinished. What misses
/// the end by less than `slack` fits.
fn affordable(sample: Duration, left: Duration, slack: Duration) -> (u32, bool) {
    // A float to integer cast saturates, and 0/0 gives 0.
    match (left.as_secs_f64() / sample.as_secs_f64()) as u32 {
        0 if sample <= left + slack.min(left) => (1, false),
        0 if left > slack => (1, true),
        whole => (whole, false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(mut passes: Passes) -> Vec<Range<u32>> {
        std::iter::from_fn(|| passes.next_pass())
            .map(|pass| pass.samples)
            .collect()
    }

    #[test]
    fn passes_cover_every_sample_once_in_order() {
        for (done, spp) in [
            (0, 1),
            (0, 2),
            (0, 3),
            (0, 7),
            (0, 16),
            (0, 100),
            (16, 32),
            (32, 64),
        ] {
            let passes = all(Passes::new(done, spp, None));
            assert_eq!(passes[0].start, done);
            assert!(done > 0 || passes[0] == (0..1));
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
        let passes = all(Passes::new(0, 64, Some(Deadline::after(Duration::ZERO))));
        assert_eq!((passes.len(), passes[0].end), (1, 1));
    }

    #[test]
    fn the_time_is_met_within_the_slack() {
        let s = Duration::from_secs_f64;
        let slack = s(0.1);
        assert_eq!(affordable(s(0.5), s(3.2), slack), (6, false));
        // Too short by less than the slack, and nearer to the end than none.
        assert_eq!(affordable(s(0.5), s(0.45), slack), (1, false));
        assert_eq!(affordable(s(0.11), s(0.04), slack), (0, false));
        // Neither one more nor none would do.
        assert_eq!(affordable(s(2.0), s(1.5), slack), (1, true));
    }
}
