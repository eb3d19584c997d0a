//! Generate: camera rays of a wave.

use super::sampler::{Pair, sample_pair};
use super::vector::{concentric_disk, unit};
use super::{Sampler, wave::Wave};
use crate::flat::{Camera, PixelFilter};
use crate::math::{Vec3, ln, sin_cos_turns};

/// A sample of the image: pixel, sample index and the key of the pixel's random numbers.
#[derive(Clone, Copy)]
pub(super) struct ImageSample {
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) sample: u32,
    pub(super) key: u32,
}

/// Starts a path for the sample in the next slot.
pub(super) fn generate(wave: &mut Wave, camera: &Camera, sampler: Sampler, s: ImageSample) {
    let slot = wave.slots.key.len() as u32;
    wave.slots.key.push(s.key);
    wave.slots.sample.push(s.sample);
    let [dx, dy] = filter_offset(
        camera.filter,
        sample_pair(sampler, s.key, s.sample, Pair::Pixel),
    );
    let through = image_direction(camera, s.x as f32 + 0.5 + dx, s.y as f32 + 0.5 + dy);
    let origin = Vec3::from(camera.origin);
    if camera.aperture_radius == 0.0 {
        wave.paths.push(origin, unit(through), slot);
    } else {
        let [lx, ly] = concentric_disk::<f32>(sample_pair(sampler, s.key, s.sample, Pair::Lens));
        let shift =
            (Vec3::from(camera.right) * lx - Vec3::from(camera.down) * ly) * camera.aperture_radius;
        wave.paths.push(
            origin + shift,
            unit(through - shift / camera.focus_distance),
            slot,
        );
    }
}

/// Direction through image point (x, y) in pixels, of length 1 along the view axis.
pub(super) fn image_direction(camera: &Camera, x: f32, y: f32) -> Vec3 {
    let right = (x - 0.5 * camera.width as f32) * camera.pixel;
    let down = (y - 0.5 * camera.height as f32) * camera.pixel;
    Vec3::from(camera.forward) + Vec3::from(camera.right) * right + Vec3::from(camera.down) * down
}

/// Offset from the pixel's centre, in pixels, with the density of the filter.
///
/// The Gaussian cut off at R = 3σ: its radius by inversion, r = σ √(−2 ln(1 − u (1 − e^(−9/2)))) (Box and Muller 1958,
/// truncated).
fn filter_offset(filter: PixelFilter, u: [f32; 2]) -> [f32; 2] {
    match filter {
        PixelFilter::Box => [u[0] - 0.5, u[1] - 0.5],
        PixelFilter::Gaussian(radius) => {
            /// 1 − e^(−9/2).
            const INSIDE: f64 = 0.988_891_003_461_757_7;
            let r = f64::from(radius) / 3.0 * (-2.0 * ln(1.0 - f64::from(u[0]) * INSIDE)).sqrt();
            let (sin, cos) = sin_cos_turns(u[1]);
            [r as f32 * cos, r as f32 * sin]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The filter's second moment against its closed form: E[r²] = 2σ² (1 − (9/2) e^(−9/2) / (1 − e^(−9/2))).
    #[test]
    fn gaussian_has_its_variance_and_cut_off() {
        let (n, radius) = (500, 1.5f32);
        let (mut sum, mut largest) = (0.0, 0f64);
        for i in 0..n * n {
            let u = [
                ((i % n) as f32 + 0.5) / n as f32,
                ((i / n) as f32 + 0.5) / n as f32,
            ];
            let [x, y] = filter_offset(PixelFilter::Gaussian(radius), u);
            let r2 = f64::from(x).powi(2) + f64::from(y).powi(2);
            largest = largest.max(r2.sqrt());
            sum += r2;
        }
        let e = (-4.5f64).exp();
        let want = 2.0 * 0.25 * (1.0 - 4.5 * e / (1.0 - e));
        assert!(
            (sum / f64::from(n * n) - want).abs() < 2e-3 * want,
            "{} {want}",
            sum / f64::from(n * n)
        );
        assert!(largest <= 1.5 + 1e-6 && largest > 1.4);
    }
}
