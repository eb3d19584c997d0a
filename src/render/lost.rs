//! Samples that are not finite, by name.
//!
//! The rule: such a sample is counted and left out, of the sums and of the count that they are divided by, so that a pixel
//! is the mean of its finite samples. A pixel without any is black.

use super::Canvas;
use crate::flat::FlatScene;
use crate::trace::{TileSums, TraceOptions, replay};

/// A sample whose radiance is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NonFinite {
    /// Frame.
    pub frame: u32,
    /// Column and row of the pixel, from the top left.
    pub pixel: (u32, u32),
    /// Index in the pixel.
    pub sample: u32,
    /// Bounce at which the radiance ceased to be finite; 0 is the first hit.
    pub bounce: u32,
}

/// The first [`TileSums::MAX_LOST`] of an image, by row, column and index. Tracing keeps no record of bounces: these few are
/// traced once more to find theirs.
pub(super) fn find(
    canvas: &Canvas,
    scene: &FlatScene,
    frame: u32,
    options: &TraceOptions,
) -> Vec<NonFinite> {
    let mut all: Vec<(u32, u32, u32)> = Vec::new();
    for patch in canvas.patches() {
        let w = patch.window;
        all.extend(patch.lost.iter().map(|[pixel, sample]| {
            let [x, y] = [pixel % w.width, pixel / w.width];
            (w.y + y, w.x + x, *sample)
        }));
    }
    all.sort_unstable();
    all.truncate(TileSums::MAX_LOST);
    all.into_iter()
        .map(|(y, x, sample)| NonFinite {
            frame,
            pixel: (x, y),
            sample,
            // Replayed to the bit, so that there is such a bounce.
            bounce: replay(scene, options, (x, y), sample)
                .lost_at()
                .unwrap_or(0),
        })
        .collect()
}
