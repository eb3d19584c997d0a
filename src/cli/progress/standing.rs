//! How things stand, and the lines that say so.

use super::{Finished, How, Work};
#[cfg(doc)]
use crate::render::Control;
use serde_json::{Value, json};
use std::time::Duration;

/// What is being done, and how much of it is over.
#[derive(Debug, PartialEq)]
pub(super) enum Standing {
    /// The scene is read, for so long.
    Reading(Duration),
    /// The first frame is built, since so long after the start.
    Building(Duration),
    Tracing(Tracing),
}

/// How much is traced.
#[derive(Debug, PartialEq)]
pub(super) struct Tracing {
    /// The frame at hand.
    pub(super) frame: u32,
    /// How many there are.
    pub(super) frames: usize,
    /// Its samples per pixel.
    spp: f64,
    /// How many there will be.
    of: f64,
    /// The share of everything, of samples or of time, that is done.
    pub(super) done: f64,
    /// The relative error of the frame, where it is known.
    rel_err: Option<f64>,
    /// Until everything is finished.
    pub(super) left: Option<Duration>,
}

impl Standing {
    /// So many samples of so many are traced, of the frame at hand as [`Control::place`] says, `spent` since the start, of
    /// which it took `tracing`.
    pub(super) fn of(
        work: &Work,
        (samples, total): (u64, u64),
        (at, traced, expected): (u32, u64, u64),
        (spent, tracing): (Duration, Duration),
        rel_err: Option<f64>,
    ) -> Standing {
        let by_samples = remaining(tracing, samples, total);
        let by_clock = work.limit.map(|limit| limit.saturating_sub(spent));
        let clock = work
            .limit
            .map_or(0.0, |limit| spent.as_secs_f64() / limit.as_secs_f64());
        let share = samples as f64 / total as f64;
        let per_pixel = |samples: u64| samples as f64 / work.pixels as f64;
        Standing::Tracing(Tracing {
            frame: work.frames.get(at as usize).copied().unwrap_or_default(),
            frames: work.frames.len(),
            spp: per_pixel(traced),
            of: per_pixel(expected),
            done: share.max(clock.min(1.0)),
            rel_err,
            left: by_samples.into_iter().chain(by_clock).min(),
        })
    }

    /// A line of a log.
    pub(super) fn line(&self, how: How) -> String {
        match how {
            How::Json => self.json().to_string(),
            How::Openjd => match self {
                Standing::Tracing(tracing) => format!(
                    "openjd_progress: {:.1}\nopenjd_status: {self}",
                    100.0 * tracing.done
                ),
                _ => format!("openjd_status: {self}"),
            },
            _ => self.to_string(),
        }
    }

    fn json(&self) -> Value {
        match self {
            Standing::Reading(time) => json!({"event": "read", "elapsed_s": tenths(*time)}),
            Standing::Building(time) => json!({"event": "build", "elapsed_s": tenths(*time)}),
            Standing::Tracing(tracing) => json!({
                "event": "progress",
                "frame": tracing.frame,
                "spp": tracing.spp as u64,
                "of": tracing.of.round() as u64,
                "done": (1e4 * tracing.done).floor() / 1e4,
                "rel_err": tracing.rel_err.map(short),
                "eta_s": tracing.left.map(tenths),
            }),
        }
    }
}

impl std::fmt::Display for Standing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let tracing = match self {
            Standing::Reading(time) => return write!(f, "reading, {} so far", words(*time)),
            Standing::Building(time) => return write!(f, "building, {} so far", words(*time)),
            Standing::Tracing(tracing) => tracing,
        };
        let Tracing { frame, spp, of, .. } = tracing;
        write!(f, "frame {frame}: {:.0} of {of:.0} spp", spp.floor())?;
        if let Some(error) = tracing.rel_err {
            write!(f, ", relative RMSE {:.2} %", 100.0 * error)?;
        }
        write!(f, ", {:.0} % of all", 100.0 * tracing.done)?;
        match tracing.left {
            Some(left) => write!(f, ", {} left", words(left)),
            None => Ok(()),
        }
    }
}

impl Tracing {
    /// How much of the frame is traced.
    pub(super) fn share(&self) -> f64 {
        self.spp / self.of
    }
}

impl Finished<'_> {
    /// A line of a log.
    pub(super) fn json(&self) -> String {
        json!({
            "event": "frame",
            "frame": self.frame,
            "path": self.path,
            "rel_err": self.rel_err.map(short),
            "seconds": tenths(self.took),
        })
        .to_string()
    }
}

/// Seconds with one decimal.
fn tenths(time: Duration) -> f64 {
    (10.0 * time.as_secs_f64()).round() / 10.0
}

/// An error with as many digits as anybody reads.
fn short(error: f64) -> f64 {
    (1e5 * error).round() / 1e5
}

/// Samples cost the same on average from first to last, so the rest takes as long in proportion.
fn remaining(elapsed: Duration, samples: u64, total: u64) -> Option<Duration> {
    let rest = total.saturating_sub(samples) as f64;
    (samples > 0).then(|| elapsed.mul_f64(rest / samples as f64))
}

/// `3.1 s`, `2 min 05 s`, `1 h 10 min`.
pub(crate) fn words(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    if seconds < 0.001 {
        return format!("{:.0} µs", seconds * 1e6);
    }
    if seconds < 1.0 {
        return format!("{:.0} ms", seconds * 1e3);
    }
    if seconds < 59.95 {
        return format!("{seconds:.1} s");
    }
    let whole = (seconds + 0.5) as u64;
    if whole < 3600 {
        return format!("{} min {:02} s", whole / 60, whole % 60);
    }
    format!("{} h {:02} min", whole / 3600, whole % 3600 / 60)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Control;
    use std::sync::Arc;

    /// Of frames of ten pixels, after ten seconds of tracing in twelve.
    fn standing(frames: &[u32], counted: (u64, u64), limit: Option<u64>) -> Standing {
        let expected = counted.1 / frames.len() as u64;
        let at = (counted.0 / expected).min(frames.len() as u64 - 1);
        let place = (at as u32, counted.0 - at * expected, expected);
        let work = Work {
            control: Arc::new(Control::default()),
            limit: limit.map(Duration::from_secs),
            frames: frames.to_vec(),
            pixels: 10,
        };
        let times = (Duration::from_secs(12), Duration::from_secs(10));
        Standing::of(&work, counted, place, times, Some(0.021_001))
    }

    #[test]
    fn frames_are_told_by_their_number_and_samples_by_pixel() {
        for (counted, said) in [
            (
                (0, 400),
                "frame 3: 0 of 10 spp, relative RMSE 2.10 %, 0 % of all",
            ),
            (
                (150, 400),
                "frame 5: 5 of 10 spp, relative RMSE 2.10 %, 38 % of all, 16.7 s left",
            ),
            (
                (400, 400),
                "frame 9: 10 of 10 spp, relative RMSE 2.10 %, 100 % of all, 0 µs left",
            ),
        ] {
            assert_eq!(standing(&[3, 5, 7, 9], counted, None).to_string(), said);
        }
        assert_eq!(
            standing(&[7], (50, 100), Some(13)).to_string(),
            "frame 7: 5 of 10 spp, relative RMSE 2.10 %, 92 % of all, 1.0 s left",
            "the clock ends it first"
        );
    }

    #[test]
    fn scripts_read_the_same() {
        let standing = standing(&[3, 5], (50, 400), None);
        assert_eq!(
            standing.json(),
            json!({"event": "progress", "frame": 3, "spp": 5, "of": 20, "done": 0.125, "rel_err": 0.021, "eta_s": 70.0})
        );
        let said = standing.line(How::Openjd);
        assert!(
            said.starts_with("openjd_progress: 12.5\nopenjd_status: frame 3"),
            "{said}"
        );
    }

    #[test]
    fn the_rest_is_in_proportion() {
        let s = Duration::from_secs;
        assert_eq!(remaining(s(10), 25, 100), Some(s(30)));
        assert_eq!(remaining(s(10), 0, 100), None);
        assert_eq!(remaining(s(10), 100, 100), Some(s(0)));
    }

    #[test]
    fn times_read_well() {
        let of = |s: f64| words(Duration::from_secs_f64(s));
        assert_eq!(of(0.000_05), "50 µs");
        assert_eq!(of(0.25), "250 ms");
        assert_eq!(of(3.12), "3.1 s");
        assert_eq!(of(59.96), "1 min 00 s");
        assert_eq!(of(125.0), "2 min 05 s");
        assert_eq!(of(4200.0), "1 h 10 min");
    }
}
