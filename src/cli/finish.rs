//! What comes after tracing, told before it: `--time` is for both.

use super::output::{Encoding, Format, encode};
use crate::film::{Aov, Film, Metadata, Planes, Window};
use std::time::{Duration, Instant};

/// Side of the image that is tried, twice, pixels: some ten milliseconds each.
const SIDE: u32 = 192;

/// Images of fewer such squares end soon enough.
const FEW: f64 = 4.0;

/// Samples of its pixels.
const SPP: u32 = 8;

/// How long an image takes to be encoded and its error to be told, by a small one of noise. Further images in the file count
/// as often as the picture.
pub(crate) fn takes(size: (u32, u32), format: Format, aovs: &[Aov]) -> Duration {
    let squares = f64::from(size.0) * f64::from(size.1) / f64::from(SIDE * SIDE);
    if squares < FEW {
        return Duration::ZERO;
    }
    let film = noise();
    let encoding = Encoding::new(format, Metadata::default(), 0.0, &[]);
    let try_it = || {
        let start = Instant::now();
        let bytes = encode(format, &film, &encoding).map_or(0, |bytes| bytes.len());
        let picture = start.elapsed();
        std::hint::black_box((bytes, film.error()));
        start.elapsed() + picture.mul_f64(aovs.len() as f64)
    };
    // Memory is touched first by the first.
    try_it().min(try_it()).mul_f64(squares)
}

/// Grey that varies by a fifth from pixel to pixel.
fn noise() -> Film {
    let pixels = SIDE * SIDE;
    let value = |i: u32| {
        let bits = (i.wrapping_mul(0x9e37_79b9) ^ (i >> 7)).wrapping_mul(0x85eb_ca6b) >> 16;
        0.2 + 0.1 * f64::from(bits) / 65536.0
    };
    let sums = |of: &dyn Fn(f64) -> f64| {
        (0..pixels)
            .map(|i| [f64::from(SPP) * of(value(i)); 3])
            .collect()
    };
    let planes = Planes {
        rgb: sums(&|x| x),
        rgb_squared: sums(&|x| 1.1 * x * x),
        count: vec![SPP; pixels as usize],
        gains: (0..SPP.ilog2())
            .map(|_| vec![[0.01; 3]; pixels as usize])
            .collect(),
        ..Planes::default()
    };
    let mut film = Film::new(SIDE, SIDE);
    let all = Window {
        x: 0,
        y: 0,
        width: SIDE,
        height: SIDE,
    };
    film.put(all, &planes);
    film
}
