//! Where waves are taken from a picture.

use crate::flat::Camera;
use crate::trace::Rect;

/// Pixels of a wave: those that a tile's wave holds with [`super::SAMPLES`] samples each.
const SIZE: (u32, u32) = (32, 4);

/// Golden section, by which steps fall evenly into what is left.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// All of a picture, each once, so that the first ones are spread evenly over it.
pub(super) fn spread(camera: &Camera) -> impl Iterator<Item = Rect> {
    let (width, height) = (camera.width, camera.height);
    let columns = u64::from(width.div_ceil(SIZE.0));
    let count = columns * u64::from(height.div_ceil(SIZE.1));
    let step = coprime(count);
    (0..count).map(move |k| {
        let cell = k * step % count;
        let (x, y) = (
            (cell % columns) as u32 * SIZE.0,
            (cell / columns) as u32 * SIZE.1,
        );
        Rect {
            x,
            y,
            width: SIZE.0.min(width - x),
            height: SIZE.1.min(height - y),
        }
    })
}

/// A step about the golden section of `count` that meets all before it meets one again.
fn coprime(count: u64) -> u64 {
    let divisor = |mut a: u64, mut b: u64| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let from = (count as f64 * GOLDEN).round().max(1.0) as u64;
    (from..)
        .find(|&step| divisor(count, step) == 1)
        .unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flat::PixelFilter;

    #[test]
    fn every_pixel_is_in_one_wave() {
        for (width, height) in [(1, 1), (32, 4), (33, 5), (100, 60), (360, 240)] {
            let camera = Camera {
                origin: [0.0; 3],
                right: [1.0, 0.0, 0.0],
                down: [0.0, -1.0, 0.0],
                forward: [0.0, 0.0, -1.0],
                pixel: 0.01,
                aperture_radius: 0.0,
                focus_distance: 1.0,
                width,
                height,
                filter: PixelFilter::Box,
            };
            let mut seen = vec![0; (width * height) as usize];
            for rect in spread(&camera) {
                for y in rect.y..rect.y + rect.height {
                    for x in rect.x..rect.x + rect.width {
                        seen[(y * width + x) as usize] += 1;
                    }
                }
            }
            assert!(seen.iter().all(|&times| times == 1), "{width}×{height}");
        }
    }
}
