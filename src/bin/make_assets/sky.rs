//! A hazy afternoon: a gradient from the horizon up, the sun in a few texels with the glow about it, and ground.
//!
//! Written as Radiance HDR by an encoder of its own, so that no version of a library changes a byte.

use luxel::math::{DVec3, sin_cos};
use std::f64::consts::PI;

/// Texels of `sky.hdr`.
const SIZE: [usize; 2] = [128, 64];

/// Towards the sun, before it is made a unit vector.
const SUN: DVec3 = DVec3::new(-1.0, 0.85, 1.1);
/// 1 − cos of the angle at which the veiled sun ends, nine degrees: a sharper one would make the caustics of mirrors grainy.
const SUN_EDGE: f64 = 0.0123;
/// Irradiance of what faces the sun.
const SUN_IRRADIANCE: DVec3 = DVec3::new(2.6, 2.25, 1.75);
const ZENITH: DVec3 = DVec3::new(0.10, 0.22, 0.52);
const HORIZON: DVec3 = DVec3::new(0.62, 0.72, 0.84);
const GLOW: DVec3 = DVec3::new(1.0, 0.82, 0.56);
const GROUND: DVec3 = DVec3::new(0.20, 0.18, 0.15);

/// `sky.hdr`.
pub(crate) fn sky() -> Vec<u8> {
    let [width, height] = SIZE;
    let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
    let sun = SUN.normalize();
    let disc = disc(sun);
    let rows = (0..height).flat_map(|y| {
        let row: Vec<[u8; 4]> = (0..width)
            .map(|x| {
                let dir = direction(x, y);
                rgbe(clear(dir, sun) + SUN_IRRADIANCE * (within(dir, sun) / disc))
            })
            .collect();
        scanline(&row)
    });
    header.into_bytes().into_iter().chain(rows).collect()
}

/// The middle of a texel, with the image's middle towards +Z and its left half towards +X.
fn direction(x: usize, y: usize) -> DVec3 {
    let [width, height] = SIZE.map(|n| n as f64);
    let (sin_around, cos_around) = sin_cos(2.0 * PI * (x as f64 + 0.5) / width);
    let (sin, cos) = sin_cos(PI * (y as f64 + 0.5) / height);
    DVec3::new(sin * sin_around, cos, -sin * cos_around)
}

/// 1 in the middle of the sun's disc, falling to 0 at its edge.
fn within(dir: DVec3, sun: DVec3) -> f64 {
    (1.0 - (1.0 - dir.dot(sun)) / SUN_EDGE).max(0.0)
}

/// [`within`] integrated over all texels.
fn disc(sun: DVec3) -> f64 {
    let [width, height] = SIZE;
    let row = |y: usize| (0..width).map(move |x| within(direction(x, y), sun) * solid_angle(y));
    (0..height).flat_map(row).sum()
}

fn solid_angle(y: usize) -> f64 {
    let [width, height] = SIZE.map(|n| n as f64);
    let cos = |y: usize| sin_cos(PI * y as f64 / height).1;
    2.0 * PI / width * (cos(y) - cos(y + 1))
}

/// Radiance but for the sun's disc.
fn clear(dir: DVec3, sun: DVec3) -> DVec3 {
    // Powers by multiplication.
    let power = |x: f64, doublings: u32| (0..doublings).fold(x, |x, _| x * x);
    if dir.y < 0.0 {
        return GROUND.lerp(HORIZON, power((1.0 + 4.0 * dir.y).max(0.0), 1));
    }
    let near = dir.dot(sun).max(0.0);
    let glow = 0.35 * power(near, 3) + 1.5 * power(near, 7);
    ZENITH.lerp(HORIZON, power(1.0 - dir.y, 2)) + GLOW * glow
}

/// Three mantissas with the exponent of the largest.
fn rgbe(radiance: DVec3) -> [u8; 4] {
    let largest = radiance.max_element();
    let mut exponent = 0i32;
    let mut scale = 1.0;
    while largest * scale >= 1.0 {
        (exponent, scale) = (exponent + 1, 0.5 * scale);
    }
    while largest * scale < 0.5 {
        (exponent, scale) = (exponent - 1, 2.0 * scale);
    }
    let [r, g, b] = (radiance * (256.0 * scale)).to_array().map(|c| c as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// A row, component by component: runs of equal bytes, and what is between them.
fn scanline(row: &[[u8; 4]]) -> Vec<u8> {
    /// Shorter runs do not pay.
    const RUN: usize = 3;
    /// Most bytes of one packet.
    const MOST: usize = 127;
    let mut bytes = vec![2, 2, (row.len() >> 8) as u8, row.len() as u8];
    for component in 0..4 {
        let plane: Vec<u8> = row.iter().map(|texel| texel[component]).collect();
        let mut plain: Vec<u8> = Vec::new();
        let flush = |plain: &mut Vec<u8>, bytes: &mut Vec<u8>| {
            for packet in plain.chunks(MOST) {
                bytes.push(packet.len() as u8);
                bytes.extend(packet);
            }
            plain.clear();
        };
        for run in plane
            .chunk_by(|a, b| a == b)
            .flat_map(|run| run.chunks(MOST))
        {
            if run.len() < RUN {
                plain.extend(run);
                continue;
            }
            flush(&mut plain, &mut bytes);
            bytes.extend([128 + run.len() as u8, run[0]]);
        }
        flush(&mut plain, &mut bytes);
    }
    bytes
}
