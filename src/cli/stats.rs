//! What a render cost, as a line for people and as JSON for scripts.

use super::patience::megabytes;
use super::progress::words;
use super::tracing;
use crate::film::{ErrorBar, Film};
use crate::render::{Ended, NonFinite, Stats};
use serde_json::json;
use std::time::Duration;

/// So many samples that are not finite are named for people; the JSON has more.
const TOLD: usize = 4;

/// Everything about a finished render.
pub(crate) struct Account<'a> {
    /// The image's name.
    pub(crate) output: String,
    /// The sums.
    pub(crate) film: &'a Film,
    /// How wrong the image is; `None` below two samples.
    pub(crate) error: Option<ErrorBar>,
    /// How wrong it was to be.
    pub(crate) goal: Option<f64>,
    /// The first of the samples that were not finite.
    pub(crate) non_finite: &'a [NonFinite],
    /// What rendering cost.
    pub(crate) stats: Stats,
    /// Reading the scene and its files.
    pub(crate) load: Duration,
    /// Bytes that the scene's files take in memory.
    pub(crate) files: u64,
    /// Encoding and writing the image.
    pub(crate) write: Duration,
    /// The kernels' instruction set.
    pub(crate) isa: String,
    /// How well the tree was built.
    pub(crate) tree: &'static str,
    /// The one change that would help most, if one would.
    pub(crate) advice: Option<String>,
}

/// Says how many samples were not finite, and which some of them are; `None` for none.
pub(crate) fn lost(count: u64, some: &[NonFinite]) -> Option<String> {
    let name = |n: &NonFinite| {
        let (x, y) = n.pixel;
        format!(
            "\n  frame {}, pixel ({x}, {y}), sample {}, bounce {}",
            n.frame, n.sample, n.bounce
        )
    };
    let named: String = some.iter().take(TOLD).map(name).collect();
    let rest = match count.saturating_sub(TOLD as u64) {
        0 => String::new(),
        rest => format!("\n  and {rest} more"),
    };
    (count > 0).then(|| {
        format!(
            "{count} samples were not finite and were left out of their pixels' means:{named}{rest}"
        )
    })
}

/// `relative RMSE 1.8 % ± 0.2`.
pub(crate) fn error_words(bar: Option<&ErrorBar>) -> String {
    match bar {
        None => "error unknown".to_owned(),
        Some(bar) => format!(
            "relative RMSE {} % ± {}",
            percent(bar.relative, bar.half_width),
            percent(bar.half_width, bar.half_width)
        ),
    }
}

/// `64 spp`, and what ended a render where that was not their number; `goal` is how wrong it was to be.
pub(crate) fn samples(stats: &Stats, goal: Option<f64>) -> String {
    let spp = match stats.cells {
        Some((least, most)) if least < most => {
            format!("{least} to {most} spp, {} on average", stats.spp)
        }
        _ => format!("{} spp", stats.spp),
    };
    match (stats.ended, goal) {
        (Ended::Time, _) => format!("{spp}, ended by --time"),
        (Ended::Noise, Some(goal)) => format!(
            "{spp}, ended by --noise {} % (pilot: {} spp)",
            percent(goal, goal),
            stats.pilot
        ),
        (_, Some(_)) => format!("{spp}, ended by --spp"),
        _ => spp,
    }
}

/// Samples per pixel of several frames: `64 spp`, or `24 to 190 spp, 77 on average`.
pub(crate) fn spp_of_all(frames: &[u32]) -> String {
    let least = frames.iter().min().copied().unwrap_or_default();
    let most = frames.iter().max().copied().unwrap_or_default();
    if least == most {
        return format!("{most} spp");
    }
    let sum: f64 = frames.iter().copied().map(f64::from).sum();
    let mean = sum / frames.len() as f64;
    format!("{least} to {most} spp, {mean:.0} on average")
}

impl Account<'_> {
    /// One line: `room.png · 512×512 · 64 spp · 3.1 s · relative RMSE 1.8 % ± 0.2 · 12.3 Mrays/s · extract 100 µs, flatten
    /// 2 ms, tree 8 ms · 12 MB`, the last being what the files and the buffers take.
    pub(crate) fn line(&self) -> String {
        let stages = &self.stats.stages;
        format!(
            "{} · {}×{} · {} · {} · {} · {:.1} Mrays/s · extract {}, flatten {}, tree {} · {}",
            self.output,
            self.film.width(),
            self.film.height(),
            samples(&self.stats, self.goal),
            words(stages.pilot + stages.trace),
            error_words(self.error.as_ref()),
            self.stats.mrays_per_second(),
            words(stages.pose + stages.extract),
            words(stages.flatten),
            words(stages.bvh),
            megabytes(self.files + self.stats.bytes as u64),
        )
    }

    /// Why the error bar is not to be trusted, if so.
    pub(crate) fn doubt(&self) -> Option<String> {
        let bar = self.error.as_ref().filter(|bar| bar.is_fragile())?;
        Some(format!(
            "the error is not to be trusted: {:.0} % of it is in pixels where a few samples carry most of the light",
            100.0 * bar.fragile
        ))
    }

    /// How many samples were not finite, and which; `None` if all were.
    pub(crate) fn lost(&self) -> Option<String> {
        lost(self.film.total_non_finite(), self.non_finite)
    }

    /// Where the time went, as shares of all of it.
    fn shares(&self) -> serde_json::Value {
        let stages = &self.stats.stages;
        let all = (self.load + stages.total() + self.write).as_secs_f64();
        let share = |time: Duration| ratio(time.as_secs_f64(), all);
        json!({
            "load": share(self.load),
            "pose": share(stages.pose),
            "extract": share(stages.extract),
            "flatten": share(stages.flatten),
            "bvh": share(stages.bvh),
            "pilot": share(stages.pilot),
            "trace": share(stages.trace),
            "write": share(self.write),
        })
    }

    /// The same and more, times in seconds.
    pub(crate) fn json(&self) -> String {
        let stats = &self.stats;
        let stages = &stats.stages;
        let value = json!({
            "output": self.output,
            "size": [self.film.width(), self.film.height()],
            "spp": stats.spp,
            "ended_by": match stats.ended {
                Ended::Samples => "samples",
                Ended::Noise => "noise",
                Ended::Time => "time",
            },
            "pilot_spp": stats.pilot,
            "error": self.error.as_ref().map(|bar| json!({
                "relative_rmse": bar.relative,
                "half_width_95": bar.half_width,
                "wanted": self.goal,
                "share_of_few_samples": bar.fragile,
                "trusted": !bar.is_fragile(),
            })),
            "samples": self.film.total_samples(),
            "non_finite_samples": self.film.total_non_finite(),
            "non_finite": self.non_finite.iter().map(|n| json!({
                "frame": n.frame,
                "pixel": [n.pixel.0, n.pixel.1],
                "sample": n.sample,
                "bounce": n.bounce,
            })).collect::<Vec<_>>(),
            "stopped": stats.stopped,
            "threads": stats.threads,
            "isa": self.isa,
            "tree": self.tree,
            "rays": {
                "closest": stats.tracing.closest_rays(),
                "occlusion": stats.tracing.occlusion_rays(),
            },
            "mrays_per_second": stats.mrays_per_second(),
            "bytes": { "files": self.files, "buffers": stats.bytes },
            "seconds": {
                "load": self.load.as_secs_f64(),
                "pose": stages.pose.as_secs_f64(),
                "extract": stages.extract.as_secs_f64(),
                "flatten": stages.flatten.as_secs_f64(),
                "bvh": stages.bvh.as_secs_f64(),
                "pilot": stages.pilot.as_secs_f64(),
                "trace": stages.trace.as_secs_f64(),
                "write": self.write.as_secs_f64(),
            },
            "shares": self.shares(),
            "per_ray": {
                "nanoseconds_of_a_thread": ratio(
                    stages.trace.as_secs_f64() * 1e9 * stats.threads as f64,
                    stats.rays() as f64,
                ),
                "rays_per_sample": ratio(
                    stats.rays() as f64,
                    self.film.total_samples() as f64,
                ),
            },
            "tracing": tracing::json(&stats.tracing, self.film.total_samples()),
            "most_would_help": self.advice,
        });
        format!("{value:#}\n")
    }
}

fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// A share in percent, with the decimals that make two digits of `unit`.
fn percent(share: f64, unit: f64) -> String {
    let steps = std::iter::successors(Some(100.0 * unit), |step| Some(10.0 * step));
    let decimals = match unit > 0.0 {
        true => steps.take(6).take_while(|step| *step < 9.5).count(),
        false => 0,
    };
    format!("{:.decimals$}", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_have_the_digits_that_they_are_known_to() {
        assert_eq!(percent(0.018_34, 0.002_1), "1.83");
        assert_eq!(percent(0.002_1, 0.002_1), "0.21");
        assert_eq!(percent(0.4, 0.2), "40");
        assert_eq!(percent(0.000_183, 0.000_02), "0.0183");
        assert_eq!(percent(0.0, 0.0), "0");
    }
}
