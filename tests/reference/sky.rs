//! The background by direction.

use super::Image;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::PI;

pub(crate) enum Sky {
    Flat(DVec3),
    /// All directions: the top row is the zenith, and who looks along +Z of the sky's own frame sees the middle of the image
    /// before him, what is right of it to his right.
    Image {
        image: Image,
        /// From the sky's own frame to the scene.
        turned: DMat3,
    },
}

impl Sky {
    pub(crate) fn at(&self, dir: DVec3) -> DVec3 {
        let (image, turned) = match self {
            Sky::Flat(radiance) => return *radiance,
            Sky::Image { image, turned } => (image, turned),
        };
        let d = turned.transpose() * dir;
        // Who looks along +Z with +Y up has −X to the right.
        let right = (-d.x).atan2(d.z);
        let uv = DVec2::new(0.5 + right / (2.0 * PI), 1.0 - d.y.acos() / PI);
        image.factor * image.look_up(uv)
    }
}
