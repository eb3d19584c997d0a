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

/// An image with its wrap and filter modes.
#[derive(Clone, Debug)]
pub struct Texture {
    /// sRGB bytes R, G, B, row by row from the top; row 0 is v = 1. Length `3 * width * height`.
    pub texels: Arc<[u8]>,
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Outside [0, 1].
    pub wrap: WrapMode,
    /// Between texels.
    pub filter: FilterMode,
}
