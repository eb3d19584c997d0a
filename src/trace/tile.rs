//! A tile: the rectangle that one worker traces, and the sums that it leaves.

use super::Tallies;

/// A rectangle of pixels; (0, 0) is the image's top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// A sample that was left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct LostSample {
    /// Index of the pixel in its tile.
    pub pixel: u32,
    /// Index of the sample in its pixel.
    pub sample: u32,
}

/// Sums over the samples of each pixel of a tile, row by row, f64, added in the order of the sample index.
/// Arrays that were not asked for are empty.
#[derive(Clone, Debug, Default)]
pub struct TileSums {
    /// Radiance.
    pub rgb: Vec<[f64; 3]>,
    /// Squares of radiance, for the standard error.
    pub rgb_squared: Vec<[f64; 3]>,
    /// Samples in the sums.
    pub count: Vec<u32>,
    /// Samples left out because their radiance was not finite.
    pub non_finite: Vec<u32>,
    /// The first of these samples, by pixel and then by index, as [`TileSums::MAX_LOST`] allows; not in this order.
    pub lost: Vec<LostSample>,
    /// Samples whose camera ray hit something: the count of the four below.
    pub hit_count: Vec<u32>,
    /// Albedo of the first hit; 1 for glass and mirror.
    pub albedo: Vec<[f64; 3]>,
    /// Shading normal of the first hit, authored axes.
    pub normal: Vec<[f64; 3]>,
    /// Geometric normal of the first hit.
    pub geonormal: Vec<[f64; 3]>,
    /// Depth of the first hit along the view axis, authored units.
    pub depth: Vec<f64>,
    /// Texture coordinates of the hit of the ray through the pixel's centre; 0 for a miss.
    pub uv: Vec<[f32; 2]>,
    /// Triangle index in file order of that hit (0 for a sphere); `u32::MAX` for a miss.
    pub prim: Vec<u32>,
    /// Index in the scene file's `entities` of that hit; `u32::MAX` for a miss.
    pub entity: Vec<u32>,
    /// What the last call of [`super::Tracer::trace_tile`] cost.
    pub cost: Tallies,
}

impl TileSums {
    /// So many lost samples are remembered. The first ones of an image are among the first ones of its tiles, so that the
    /// cut into tiles does not change what is listed.
    pub const MAX_LOST: usize = 32;

    /// Counts a sample as left out, and remembers which if it is one of the first.
    #[cold]
    pub(super) fn lose(&mut self, pixel: usize, sample: u32) {
        self.non_finite[pixel] += 1;
        let lost = LostSample {
            pixel: pixel as u32,
            sample,
        };
        if self.lost.len() < TileSums::MAX_LOST {
            self.lost.push(lost);
        } else if let Some(last) = self.lost.iter_mut().max()
            && lost < *last
        {
            *last = lost;
        }
    }
}
