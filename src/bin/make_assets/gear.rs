//! Spur gears of one module, which mesh with each other: pitch radius = teeth / 2, so that axes stand (a + b) / 2 apart.
//!
//! Straight flanks, as on a rack; where they meet, real gears roll on involutes. Deliberately absent: everything inside but
//! the bore.

use luxel::math::sin_cos_deg;
use std::f64::consts::PI;
use std::fmt::Write;

/// Of every gear, along z, half of it to either side.
const THICKNESS: f64 = 2.0;
/// Radius of the hole in the middle.
const BORE: f64 = 2.0;
/// By how much teeth rise above the pitch circle, and reach below it.
const ADDENDUM: f64 = 1.0;
const DEDENDUM: f64 = 1.2;
/// Tangent of the pressure angle, 20 degrees.
const FLANK: f64 = 0.363_970_234;
/// What is missing of half a tooth at the pitch circle, so that two gears never touch.
const PLAY: f64 = 0.04;

/// Of all gears.
pub(crate) const GEAR_MTL: &str = "# Brass, if painted.\nnewmtl brass\nKd 0.62 0.46 0.20\n";

/// A gear as OBJ text: axis along z, a tooth's middle on +x.
pub(crate) fn gear(teeth: u32) -> String {
    let mut text = format!(
        "# A gear of {teeth} teeth for luxel, written by make_assets: axis along z, pitch radius {}.\n\
         mtllib gear.mtl\no gear_{teeth}\nusemtl brass\n",
        f64::from(teeth) / 2.0
    );
    let outline = outline(teeth);
    let n = outline.len();
    let bore = outline.iter().map(|&(_, deg)| (BORE, deg));
    let rings: Vec<(f64, f64)> = outline.iter().copied().chain(bore).collect();
    for z in [THICKNESS / 2.0, -THICKNESS / 2.0] {
        for &(radius, deg) in &rings {
            let (sin, cos) = sin_cos_deg(deg);
            // Writing into a String cannot fail, here and below.
            let _ = writeln!(text, "v {:.5} {:.5} {z}", radius * cos, radius * sin);
        }
    }
    // Front outline, front bore, back outline, back bore: each n vertices, from 1.
    let at = |ring: usize, i: usize| ring * n + i % n + 1;
    for i in 0..n {
        for [a, b] in [[0, 1], [1, 3], [3, 2], [2, 0]] {
            let _ = writeln!(
                text,
                "f {} {} {} {}",
                at(a, i),
                at(a, i + 1),
                at(b, i + 1),
                at(b, i)
            );
        }
    }
    text
}

/// Radius and angle in degrees of the corners of every tooth, counter-clockwise.
fn outline(teeth: u32) -> Vec<(f64, f64)> {
    let pitch = f64::from(teeth) / 2.0;
    let (root, tip) = (pitch - DEDENDUM, pitch + ADDENDUM);
    let half = PI / 4.0 - PLAY;
    let angle = |width: f64, radius: f64| (width / radius).to_degrees();
    let foot = angle(half + FLANK * DEDENDUM, root);
    let top = angle(half - FLANK * ADDENDUM, tip);
    let tooth = |k: u32| {
        let middle = 360.0 * f64::from(k) / f64::from(teeth);
        [
            (root, middle - foot),
            (tip, middle - top),
            (tip, middle + top),
            (root, middle + foot),
        ]
    };
    (0..teeth).flat_map(tooth).collect()
}
