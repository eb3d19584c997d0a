//! The sky as an image of all directions, and the table by which light sampling chooses one.
//!
//! Directions have Y up. In the image's own frame u = 1/2 − atan2(x, z) / 2π and v = 1 − θ / π with θ the angle from +Y,
//! from the left and from the bottom: the image's middle is towards +Z and its left half towards +X, so that a viewer under
//! the sky sees it unmirrored. (Textures on spheres have the same middle and are unmirrored from outside.)
//!
//! Sampling chooses a row by the running sums of all rows, in it a column by those of its columns, and in this texel a
//! direction uniformly by solid angle: the density over solid angle is the texel's probability by its solid angle. The
//! probability is the difference of the rounded sums, not what they were rounded from, so that both are the same.

use super::FilterMode;
use std::sync::Arc;

/// Radiance from infinitely far by direction.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Linear R, G, B, row by row from the top; length `width * height`.
    pub texels: Arc<[[f32; 3]]>,
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Between texels. Columns go on around; beyond the first and the last row, these repeat.
    pub filter: FilterMode,
    /// Multiplies every texel.
    pub strength: f32,
    /// Cosine and sine of the angle by which the image is turned about +Y, counter-clockwise seen from above.
    pub turn: [f64; 2],
    /// Where to look for light.
    pub table: Arc<EnvironmentTable>,
}

/// Probabilities of texels, in proportion to their mean filtered radiance (the mean of R, G, B) times solid angle.
#[derive(Clone, Debug, Default)]
pub struct EnvironmentTable {
    /// Running sums over the rows from 0 to 1; length `height + 1`. All 0 where the image is black.
    pub rows: Vec<f32>,
    /// Running sums over the columns of every row from 0 to 1, row by row; length `height * (width + 1)`. All 0 where a row
    /// is black.
    pub columns: Vec<f32>,
    /// 1 − cos θ of the rows' borders, from 0 to 2; length `height + 1`.
    pub heights: Vec<f64>,
    /// Mean radiance integrated over all directions, at strength 1.
    pub total: f64,
}
