//! What a render cost.

use crate::trace::Tallies;
use std::time::Duration;

/// Wall-clock time of each stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stages {
    /// Placing what moves.
    pub pose: Duration,
    /// Reading the world.
    pub extract: Duration,
    /// World space to flat buffers.
    pub flatten: Duration,
    /// Bounding volume hierarchies.
    pub bvh: Duration,
    /// The pilot of [`super::Settings::noise`].
    pub pilot: Duration,
    /// Tracing.
    pub trace: Duration,
}

impl Stages {
    /// All of them together.
    #[must_use]
    pub fn total(&self) -> Duration {
        self.beside_tracing() + self.pilot + self.trace
    }

    /// What comes before the first ray.
    #[must_use]
    pub fn beside_tracing(&self) -> Duration {
        self.pose + self.extract + self.flatten + self.bvh
    }
}

/// What ends a render: the first that is reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ended {
    /// All samples that were asked for.
    #[default]
    Samples,
    /// As many as the wanted error takes.
    Noise,
    /// The time.
    Time,
}

/// What a render cost, and what it did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Where the time went.
    pub stages: Stages,
    /// What the stages of tracing cost; of the image alone, not of its pilot.
    pub tracing: Tallies,
    /// Bytes of all buffers that tracing read.
    pub bytes: usize,
    /// Threads.
    pub threads: usize,
    /// Samples that every pixel has; the mean, where not all have as many.
    pub spp: u32,
    /// The fewest and the most that parts of the image were given, where not all have as many.
    pub cells: Option<(u32, u32)>,
    /// Samples per pixel that were traced to find how many the wanted error takes, and that are not in the image.
    pub pilot: u32,
    /// What ended the render.
    pub ended: Ended,
    /// Whether it was stopped before all samples or the time were used up.
    pub stopped: bool,
}

impl Stats {
    /// Rays of both kinds.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.tracing.closest_rays() + self.tracing.occlusion_rays()
    }

    /// Rays of both kinds per second of tracing, in millions.
    #[must_use]
    pub fn mrays_per_second(&self) -> f64 {
        let seconds = self.stages.trace.as_secs_f64();
        let rays = self.rays() as f64;
        if seconds > 0.0 {
            rays / seconds / 1e6
        } else {
            0.0
        }
    }
}
