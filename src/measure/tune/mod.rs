//! Tuning: what the dials of a scene cost and err, and the settings that reach an error in the least time.
//!
//! A scene enters, a [`Report`] leaves. The protocol:
//!
//! - **Error** is relative: the root of the mean squared error over the mean square of the reference, over pixels and
//!   channels in linear light. The reference has the exact dials, the scene's own bounces and seeds of its own; its noise is
//!   subtracted, so that it need not be converged. Bias and variance come apart over the seeds of each setting, with
//!   intervals of 95 %. For dials that bias, pictures are also compared seed by seed with those of the unbiased
//!   setting that they were turned from: what both have in common cancels, and the narrower interval counts.
//! - **Time** is CPU time of all threads: of tracing, the least over seeds, and of the build. Settings take turns, seed by
//!   seed, so that what disturbs a while disturbs all of them. What others do on the machine hardly counts.
//! - **Pictures** are small, so that many fit into the budget. Ratios between dials carry over to the full size; absolute
//!   numbers are scaled by pictures of the full size and few samples, where the budget allows those.
//! - **Which settings**: first all choices of the dials that bias nothing race; a setting that takes twice the time for
//!   the same error, with few samples and with many, drops out after three seeds. Then the dials that bias or only take time
//!   are turned one by one on the winner, then together where each by itself was a gain. Last the best ones are measured
//!   with the samples that the final quality needs. Smaller pictures, enlarged bilinearly, are judged at full size.
//! - **The choice** is a function of the measurements ([`choose`]): the least time whose error, bias with the upper end of
//!   its interval, reaches the goal. Within 8 % the setting with fewer turned dials wins.
//!
//! Deliberately absent: words on a terminal, files, any dial that the renderer does not have, and dials of geometry, which
//! [`super::exactness`] measures.

mod choose;
mod dials;
mod lab;
mod race;
pub mod report;
mod run;
mod size;
mod stack;

pub use choose::{Pick, choose};
pub use dials::{Dials, accel_name, fresnel_name, sampler_name, tree_name};
pub use run::run;
pub use size::Shrunk;
pub use stack::{Differences, Estimate};

use std::time::Instant;

/// What pictures are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Is everything in its place?
    Draft,
    /// Is the light right?
    Preview,
    /// To show.
    Final,
}

impl Quality {
    /// From coarse to fine.
    pub const ALL: [Quality; 3] = [Quality::Draft, Quality::Preview, Quality::Final];

    /// As it is written.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Quality::Draft => "draft",
            Quality::Preview => "preview",
            Quality::Final => "final",
        }
    }

    /// The part of the error that may be bias, which the eye tells from noise: samples do not remove it.
    #[must_use]
    pub fn bias_share(self) -> f64 {
        match self {
            Quality::Draft => 1.0,
            Quality::Preview => 0.5,
            Quality::Final => 0.25,
        }
    }
}

/// An error to reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// What for.
    pub quality: Quality,
    /// Relative RMSE.
    pub error: f64,
}

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Frame that is rendered.
    pub frame: u32,
    /// When measuring ends.
    pub deadline: Instant,
    /// The errors to reach.
    pub goals: Vec<Goal>,
}

/// What goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Pictures of the full size, and smaller ones.
    Sizes,
    /// The reference.
    Reference,
    /// Settings that bias nothing.
    Race,
    /// Dials that bias or only take time.
    Turning,
    /// The best settings with all their samples.
    Confirming,
}

/// A setting with a number of samples, small pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Samples per pixel.
    pub spp: u32,
    /// Pictures, each of another seed.
    pub seeds: usize,
    /// CPU seconds of tracing a picture: the least, and the median.
    pub seconds: [f64; 2],
    /// From the reference.
    pub differences: Differences,
}

/// A setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Which.
    pub dials: Dials,
    /// How many of its dials change what pictures converge to.
    pub biases: usize,
    /// How many dials are turned.
    pub turned: usize,
    /// CPU seconds of a first build.
    pub build: f64,
    /// CPU seconds of tracing a sample of a pixel.
    pub per_sample: f64,
    /// Relative squared bias as best known.
    pub bias_squared: Estimate,
    /// By samples, ascending; two seeds at least each.
    pub levels: Vec<Level>,
    /// Whether it left the race: then its seeds are few.
    pub dropped: bool,
}

/// All that was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The exact dials first, then as they were tried.
    pub rows: Vec<Row>,
    /// Width and height of the pictures that are wanted.
    pub full: (u32, u32),
    /// Width and height of the pictures that were measured.
    pub size: (u32, u32),
    /// Variance and time a sample at the full size over those of small pictures; `None` where that took too long.
    pub scale: Option<[f64; 2]>,
    /// Smaller pictures.
    pub shrunk: Vec<Shrunk>,
    /// Seeds and samples of the reference.
    pub reference: (usize, u32),
    /// Threads that traced.
    pub threads: usize,
}

impl Report {
    /// The exact dials.
    #[must_use]
    pub fn exact(&self) -> &Row {
        &self.rows[0]
    }

    /// Variance and time a sample at the full size over those of small pictures, 1 if not known.
    #[must_use]
    pub fn scale(&self) -> [f64; 2] {
        self.scale.unwrap_or([1.0; 2])
    }

    /// Relative RMSE of a picture of the full size, or of a smaller one that is enlarged, with its interval.
    #[must_use]
    pub fn error(&self, row: &Row, level: &Level, shrunk: Option<&Shrunk>) -> Estimate {
        let of_size = shrunk.map_or(0.0, |s| s.bias_squared.value.max(0.0));
        let bias = row.known_bias_squared() + of_size;
        let scale = self.scale()[0] * shrunk.map_or(1.0, |s| s.variance);
        let Differences {
            variance, squared, ..
        } = level.differences;
        let value = (bias + variance.value * scale).sqrt();
        let relative = squared.half_width / squared.value.max(f64::MIN_POSITIVE);
        Estimate {
            value,
            half_width: 0.5 * relative * value,
        }
    }

    /// CPU seconds of build and tracing of a picture of the full size, or of a smaller one.
    #[must_use]
    pub fn seconds(&self, row: &Row, spp: u32, shrunk: Option<&Shrunk>) -> f64 {
        let (width, height) = shrunk.map_or(self.full, |s| s.size);
        let samples = f64::from(width) * f64::from(height) * f64::from(spp);
        let time = self.scale()[1] * shrunk.map_or(1.0, |s| s.time);
        row.build + samples * row.per_sample * time
    }
}

impl Row {
    /// Squared bias that counts: none for dials that have none by their nature.
    #[must_use]
    pub fn known_bias_squared(&self) -> f64 {
        match self.biases {
            0 => 0.0,
            _ => self.bias_squared.value.max(0.0),
        }
    }

    /// The most that it may be.
    #[must_use]
    pub fn most_bias_squared(&self) -> f64 {
        match self.biases {
            0 => 0.0,
            _ => self.bias_squared.upper().max(0.0),
        }
    }
}
