//! What a render cost, as a line for people and as JSON for scripts.

use super::patience::megabytes;
use super::progress::words;
use crate::film::Film;
use crate::render::{NonFinite, Stats};
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

impl Account<'_> {
    /// One line: `room.png · 512×512 · 64 spp · 3.1 s · 12.3 Mrays/s · extract 100 µs, flatten 2 ms, tree 8 ms · 12 MB`,
    /// the last being what the files and the buffers take.
    pub(crate) fn line(&self) -> String {
        let stages = &self.stats.stages;
        format!(
            "{} · {}×{} · {} spp · {} · {:.1} Mrays/s · extract {}, flatten {}, tree {} · {}",
            self.output,
            self.film.width(),
            self.film.height(),
            self.stats.spp,
            words(stages.trace),
            self.stats.mrays_per_second(),
            words(stages.extract),
            words(stages.flatten),
            words(stages.bvh),
            megabytes(self.files + self.stats.bytes as u64),
        )
    }

    /// How many samples were not finite, and which; `None` if all were.
    pub(crate) fn lost(&self) -> Option<String> {
        lost(self.film.total_non_finite(), self.non_finite)
    }

    /// The same and more, times in seconds.
    pub(crate) fn json(&self) -> String {
        let stats = &self.stats;
        let stages = &stats.stages;
        let value = json!({
            "output": self.output,
            "size": [self.film.width(), self.film.height()],
            "spp": stats.spp,
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
            "rays": { "closest": stats.closest_rays, "occlusion": stats.occlusion_rays },
            "mrays_per_second": stats.mrays_per_second(),
            "bytes": { "files": self.files, "buffers": stats.bytes },
            "seconds": {
                "load": self.load.as_secs_f64(),
                "extract": stages.extract.as_secs_f64(),
                "flatten": stages.flatten.as_secs_f64(),
                "bvh": stages.bvh.as_secs_f64(),
                "trace": stages.trace.as_secs_f64(),
                "write": self.write.as_secs_f64(),
            },
        });
        format!("{value:#}\n")
    }
}
