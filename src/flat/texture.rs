//! Textures as the surface stage reads them.

use std::sync::Arc;

/// Outside [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrapMode {
    /// Tiles.
    Repeat,
    /// Tiles, every second one mirrored.
    Mirror,
    /// The border goes on.
    Clamp,
}

/// Between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilterMode {
    /// Weighted mean of the four nearest texels; their centres are at half-integers.
    Bilinear,
    /// Nearest texel.
    Nearest,
}

/// An image as materials read it: bound to a set of texture coordinates, with its wrap and filter modes.
#[derive(Clone, Debug)]
pub struct Texture {
    /// sRGB bytes R, G, B, row by row from the top; row 0 is v = 1. Length `3 * width * height`.
    pub texels: Arc<[u8]>,
    /// Linear alpha of each texel in the same order; `None` where all of it is 1.
    pub alpha: Option<Arc<[u8]>>,
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// 0: [`super::Shading::uvs`]; 1: [`super::Shading::uvs1`].
    pub uv_set: u8,
    /// Row-major 2 × 3 matrix from those coordinates to the ones that are looked up; `None` is the identity.
    pub transform: Option<[f32; 6]>,
    /// Outside [0, 1], along u and v.
    pub wrap: [WrapMode; 2],
    /// Between texels.
    pub filter: FilterMode,
}
