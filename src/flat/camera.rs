//! The camera of a frame, in scene units.

/// The pixel filter, importance-sampled: a pixel needs no neighbour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PixelFilter {
    /// One pixel wide.
    Box,
    /// Radially symmetric, cut off at the radius in pixels, σ = radius / 3.
    Gaussian(f32),
}

/// A thin lens at `origin`. The ray of image point (px, py) in pixels, lens point (lx, ly) on the unit disk:
/// `d = forward + right · (px − w/2) · pixel + down · (py − h/2) · pixel` through the pinhole, and with a lens the
/// origin moves by `aperture_radius · (lx · right − ly · down)` while `origin + focus_distance · d` stays.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// The eye.
    pub origin: [f32; 3],
    /// Unit; to the right in the image.
    pub right: [f32; 3],
    /// Unit; down in the image.
    pub down: [f32; 3],
    /// Unit view axis.
    pub forward: [f32; 3],
    /// Side of a pixel on the plane at distance 1: `2 tan(vfov / 2) / height`.
    pub pixel: f32,
    /// Scene units; 0 is a pinhole.
    pub aperture_radius: f32,
    /// Distance of the focal plane along `forward`, scene units.
    pub focus_distance: f32,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Pixel filter.
    pub filter: PixelFilter,
}
