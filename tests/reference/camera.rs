//! A thin lens with a uniform disk, and pixel filters by rejection.

use super::Random;
use super::shape::Ray;
use glam::{DVec2, DVec3};

#[derive(Clone, Copy)]
pub(crate) enum Filter {
    Box,
    /// Radially symmetric, cut off at the radius, σ = radius / 3.
    Gaussian(f64),
}

pub(crate) struct Camera {
    pub(crate) eye: DVec3,
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    pub(crate) forward: DVec3,
    /// tan(vfov / 2).
    pub(crate) slope: f64,
    pub(crate) aperture: f64,
    pub(crate) focus: f64,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) filter: Filter,
}

impl Camera {
    /// A ray of the pixel in column x, row y from the top.
    pub(crate) fn ray(&self, x: u32, y: u32, random: &mut Random) -> Ray {
        let offset = match self.filter {
            Filter::Box => DVec2::new(random.unit() - 0.5, random.unit() - 0.5),
            Filter::Gaussian(radius) => gaussian(radius, random),
        };
        let sharp = self.through(f64::from(x) + 0.5 + offset.x, f64::from(y) + 0.5 + offset.y);
        if self.aperture == 0.0 {
            return sharp;
        }
        let focus = self.eye + sharp.dir * (self.focus / sharp.dir.dot(self.forward));
        let lens = random.disk() * self.aperture;
        let origin = self.eye + self.right * lens.x + self.up * lens.y;
        Ray {
            origin,
            dir: (focus - origin).normalize(),
            from: None,
        }
    }

    /// The ray from the eye through an image point in pixels.
    pub(crate) fn through(&self, px: f64, py: f64) -> Ray {
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        let right = (2.0 * px - w) / h * self.slope;
        let up = (h - 2.0 * py) / h * self.slope;
        Ray {
            origin: self.eye,
            dir: (self.forward + self.right * right + self.up * up).normalize(),
            from: None,
        }
    }
}

fn gaussian(radius: f64, random: &mut Random) -> DVec2 {
    let sigma = radius / 3.0;
    loop {
        let p = random.disk() * radius;
        if random.unit() < (-p.length_squared() / (2.0 * sigma * sigma)).exp() {
            return p;
        }
    }
}
