//! Tracing: loops over SoA ray batches and path state. Takes a [`crate::flat::FlatScene`] and a lent slice, gives
//! radiance samples. Infallible.
//!
//! Deliberately absent: hecs, files, images, rayon, recursion, allocation per ray, locks.

pub mod isa;
pub mod options;
pub mod rays;
pub mod tile;

pub use isa::Isa;
pub use options::{Fresnel, Sampler, TraceOptions};
pub use rays::{Hits, Rays};
pub use tile::{Rect, TileSums};

use crate::flat::FlatScene;
use std::ops::Range;

/// Adds the samples `samples` of every pixel of `rect` to `sums` (made here if empty).
///
/// Sample s of a pixel is a pure function of (scene, frame, pixel, s, seed).
pub fn trace_tile(
    _scene: &FlatScene,
    _options: &TraceOptions,
    _rect: Rect,
    _samples: Range<u32>,
    _sums: &mut TileSums,
) {
}
