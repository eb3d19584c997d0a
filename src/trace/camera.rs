//! Generate: camera rays of a wave.

use super::chunk::{Chunk, WIDEST};
use super::sampler::{Pair, sample_pairs};
use super::vector::{V3, concentric_disk, sin_cos_turns};
use super::{Sampler, cut, wave::Wave};
use crate::flat::{Camera, PixelFilter};
use crate::math::lanes::BitLanes;
use crate::math::{Vec3, ln};

/// Starts a path for the sample in every slot.
#[inline(always)]
pub(super) fn generate<L: BitLanes>(wave: &mut Wave, camera: &Camera, sampler: Sampler) {
    let Wave { paths, slots, .. } = wave;
    let n = paths.key.len();
    paths.start(n);
    for first in (0..n).step_by(L::N) {
        let chunk = Chunk::range::<L>(first, n);
        let (key, sample) = (
            chunk.words::<L>(&paths.key),
            chunk.words::<L>(&paths.sample),
        );
        let u = sample_pairs::<L>(sampler, key, sample, Pair::Pixel);
        let [dx, dy] = filter_offset(camera.filter, u);
        let x = chunk.lanes::<L>(&slots.center[0]) + dx;
        let y = chunk.lanes::<L>(&slots.center[1]) + dy;
        let through = through(camera, x, y);
        let origin = V3::splat(camera.origin);
        if !cut::LENS || camera.aperture_radius == 0.0 {
            chunk.put_vector(origin, &mut paths.rays.origin);
            chunk.put_vector(through.unit(), &mut paths.rays.dir);
            continue;
        }
        let [lx, ly] = concentric_disk(sample_pairs::<L>(sampler, key, sample, Pair::Lens));
        let (right, down) = (V3::splat(camera.right), V3::splat(camera.down));
        let shift = (right * lx - down * ly) * L::splat(camera.aperture_radius);
        let dir = through - shift / L::splat(camera.focus_distance);
        chunk.put_vector(origin + shift, &mut paths.rays.origin);
        chunk.put_vector(dir.unit(), &mut paths.rays.dir);
    }
}

/// Direction through image point (x, y) in pixels, of length 1 along the view axis.
#[inline(always)]
fn through<L: BitLanes>(camera: &Camera, x: L, y: L) -> V3<L> {
    let pixel = L::splat(camera.pixel);
    let right = (x - L::splat(0.5 * camera.width as f32)) * pixel;
    let down = (y - L::splat(0.5 * camera.height as f32)) * pixel;
    V3::splat(camera.forward) + V3::splat(camera.right) * right + V3::splat(camera.down) * down
}

/// Unit direction through image point (x, y) in pixels from the middle of the lens.
pub(super) fn image_direction(camera: &Camera, x: f32, y: f32) -> Vec3 {
    Vec3::from(through(camera, x, y).unit())
}

/// Offset from the pixel's centre, in pixels, with the density of the filter.
///
/// The Gaussian cut off at R = 3σ: its radius by inversion, r = σ √(−2 ln(1 − u (1 − e^(−9/2)))) (Box and Muller 1958,
/// truncated).
#[inline(always)]
fn filter_offset<L: BitLanes>(filter: PixelFilter, u: [L; 2]) -> [L; 2] {
    match filter {
        PixelFilter::Box => [u[0] - L::splat(0.5), u[1] - L::splat(0.5)],
        PixelFilter::Gaussian(radius) => {
            let mut numbers = [0.0; WIDEST];
            u[0].store(&mut numbers);
            for u in &mut numbers[..L::N] {
                *u = gaussian_radius(radius, *u);
            }
            let r = L::load(&numbers);
            let (sin, cos) = sin_cos_turns(u[1]);
            [r * cos, r * sin]
        }
    }
}

#[inline(always)]
fn gaussian_radius(radius: f32, u: f32) -> f32 {
    /// 1 − e^(−9/2).
    const INSIDE: f64 = 0.988_891_003_461_757_7;
    (f64::from(radius) / 3.0 * (-2.0 * ln(1.0 - f64::from(u) * INSIDE)).sqrt()) as f32
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
