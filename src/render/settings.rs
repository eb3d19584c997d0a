//! What a frame is rendered with.

use crate::build::{Accel, Quality};
use crate::scene::SceneDesc;
use crate::trace::TraceOptions;
use std::time::Duration;

/// Settings of a render. Threads, tile, accel, quality and the instruction set change no bit of the image.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Width and height in pixels, each at least 1.
    pub size: (u32, u32),
    /// Samples per pixel, at least 1; at most so many, where `noise` or `time` ends the render.
    pub spp: u32,
    /// Stop where the relative error (see [`crate::film::ErrorBar`]) is this, if that comes first. A pilot from another seed
    /// says how many samples that takes.
    pub noise: Option<f64>,
    /// Where `noise` ends the render: give the parts of the image as many samples as each of them needs, not all the same.
    pub adaptive: bool,
    /// Stop when this is over, if that comes first; at least one sample per pixel is traced.
    pub time: Option<Duration>,
    /// Worker threads; as many as the thread that starts the renderer has in its pool, if not said.
    pub threads: Option<usize>,
    /// Side of a tile in pixels, at least 1.
    pub tile: u32,
    /// How much of a tree is built.
    pub accel: Accel,
    /// How well trees are built.
    pub quality: Quality,
    /// Every frame has the noise of frame 0, for pictures that are compared; else frames share no random number.
    pub fixed_noise: bool,
    /// Dials of tracing.
    pub trace: TraceOptions,
}

impl Settings {
    /// Side of a tile: small enough that the last tiles leave no thread idle for long, large enough for a batch.
    pub const DEFAULT_TILE: u32 = 32;

    /// Side of what has one number of samples, where that number is not the same everywhere: small enough to follow edges, and
    /// enough pixels to tell its error.
    pub const CELL: u32 = 8;

    /// Whether parts of the image may have different numbers of samples.
    #[must_use]
    pub fn is_adaptive(&self) -> bool {
        self.adaptive && self.noise.is_some()
    }

    /// Side of what is traced at once.
    pub(super) fn side(&self) -> u32 {
        match self.is_adaptive() {
            true => Settings::CELL,
            false => self.tile,
        }
    }

    /// What a scene file asks for, exactly and on all threads.
    #[must_use]
    pub fn of_scene(desc: &SceneDesc) -> Settings {
        Settings {
            size: desc.render.size,
            spp: desc.render.spp,
            noise: None,
            adaptive: true,
            time: None,
            threads: None,
            tile: Settings::DEFAULT_TILE,
            accel: Accel::default(),
            quality: Quality::default(),
            fixed_noise: false,
            trace: TraceOptions {
                max_bounces: desc.render.max_bounces,
                ..TraceOptions::default()
            },
        }
    }
}
