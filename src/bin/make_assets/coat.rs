//! The coat: sRGB-encoded colour of a point of the cat's surface.
//!
//! Enters: a point of the surface. Leaves: a colour. A ginger tabby, asymmetric on purpose, since a symmetric cat
//! would hide a texture that is in the wrong place: a dark patch over the left eye and ear only, a dark stocking on
//! the right fore leg, white socks on the others. Deliberately absent: light and shade.

use crate::shape::{Cat, Part, along_tail, ear_cavity, to_head};
use luxel::math::{DVec2, DVec3};

type Colour = DVec3;

const GINGER: Colour = DVec3::new(0.87, 0.58, 0.30);
const CREAM: Colour = DVec3::new(0.95, 0.76, 0.52);
const STRIPE: Colour = DVec3::new(0.64, 0.33, 0.12);
const WHITE: Colour = DVec3::new(0.96, 0.94, 0.90);
const DARK: Colour = DVec3::new(0.21, 0.17, 0.16);
const PINK: Colour = DVec3::new(0.90, 0.63, 0.60);
const NOSE: Colour = DVec3::new(0.80, 0.44, 0.43);
const IRIS: Colour = DVec3::new(0.52, 0.68, 0.26);
const IRIS_RIM: Colour = DVec3::new(0.80, 0.74, 0.30);
const BLACK: Colour = DVec3::new(0.06, 0.05, 0.05);

/// Colour of a point of the surface, in [0, 1].
pub(crate) fn colour(cat: &Cat, p: DVec3) -> [f64; 3] {
    let c = match cat.part(p) {
        Part::Head => head(to_head(p)),
        Part::EarLeft => ear(to_head(p), DARK),
        Part::EarRight => ear(to_head(p), GINGER),
        Part::Body => body(p),
        Part::Tail => tail(p),
        Part::ForeLeft => leg(p, 0.10, WHITE),
        Part::ForeRight => leg(p, 0.26, DARK),
        Part::HindLeft | Part::HindRight => hind(p),
    };
    (c * (1.0 + 0.05 * noise(p * 60.0)))
        .clamp(DVec3::ZERO, DVec3::ONE)
        .to_array()
}

/// Ground colour with stripes: `s` runs across the stripes, one stripe per unit; `strength` in [0, 1].
fn tabby(p: DVec3, s: f64, strength: f64) -> Colour {
    let ground = GINGER.lerp(CREAM, 0.25 + 0.25 * noise(p * 9.0));
    let s = s + 0.28 * noise(p * 11.0);
    let wave = 1.0 - 4.0 * (s - s.floor() - 0.5).abs();
    ground.lerp(STRIPE, strength * step(-0.1, 0.45, wave))
}

/// Stripes across the spine that fade towards the belly, a dark line along it; a white bib down the chest.
fn body(p: DVec3) -> Colour {
    let along = p.y * 0.86 + p.z * 0.51;
    let back = 1.0 - step(-0.02, 0.12, p.z - 0.12 * (p.y - 0.4));
    let line = step(0.032, 0.014, p.x.abs() + 0.01 * noise(p * 17.0))
        * step(0.02, -0.06, p.z - 0.5 * (p.y - 0.5));
    let coat = tabby(p, along * 12.0, 0.35 + 0.65 * back).lerp(STRIPE, line);
    let wobble = 0.025 * noise(p * 14.0);
    let width = 0.05 + 0.08 * step(0.66, 0.42, p.y);
    let bib = step(width + 0.02, width - 0.02, p.x.abs() + wobble) * step(0.02, 0.06, p.z + wobble);
    coat.lerp(WHITE, bib)
}

fn tail(p: DVec3) -> Colour {
    let s = along_tail(p);
    tabby(p, s * 9.0, 0.9).lerp(WHITE, step(0.86, 0.9, s + 0.04 * noise(p * 20.0)))
}

/// Rings down to a sock that reaches up to `sock`.
fn leg(p: DVec3, sock: f64, sock_colour: Colour) -> Colour {
    let rings = tabby(p, p.y * 15.0, 0.75 * step(0.04, 0.0, p.z - 0.2));
    let inner = step(0.075, 0.045, p.x.abs()) * step(0.2, 0.3, p.y);
    let edge = p.y + 0.025 * noise(p * 22.0);
    rings
        .lerp(WHITE, inner)
        .lerp(sock_colour, step(sock + 0.012, sock - 0.012, edge))
}

/// Arcs around the haunch, and a white paw.
fn hind(p: DVec3) -> Colour {
    let arc = DVec2::new(p.z - 0.07, p.y - 0.02).length();
    let coat = tabby(p, arc * 14.0, 0.8);
    coat.lerp(
        WHITE,
        step(0.025, 0.055, p.z + 0.02 * noise(p * 25.0)) * step(0.14, 0.1, p.y),
    )
}

/// In the head's frame: stripes, patch, muzzle, ears, then eyes, nose and mouth over them.
fn head(q: DVec3) -> Colour {
    let side = q.x.abs();
    let brow = step(0.815, 0.84, q.y) * step(-0.06, 0.05, q.z) * step(0.1, 0.07, side);
    let crown = tabby(q, q.x * 26.0 + 0.5, brow);
    let cheek = step(0.10, 0.125, side) * step(0.80, 0.775, q.y);
    let nape = step(0.06, -0.02, q.z);
    let banded = tabby(q, (q.y - 0.35 * side) * 22.0, 0.8 * cheek.max(nape));
    let mut c = crown.lerp(banded, cheek.max(nape));

    let patch =
        DVec2::new((q.x - 0.082) / 0.078, (q.y - 0.81) / 0.088).length() + 0.22 * noise(q * 18.0);
    c = c.lerp(DARK, step(1.06, 0.94, patch) * step(0.085, 0.115, q.z));
    let front = step(0.1, 0.15, q.z);
    let muzzle = DVec2::new(q.x / 0.094, (q.y - 0.695) / 0.058).length() + 0.1 * noise(q * 20.0);
    let blaze = (side + 0.006 * noise(q * 30.0)) / (0.012 + 0.02 * step(0.83, 0.74, q.y));
    c = c.lerp(
        WHITE,
        front * step(1.06, 0.94, muzzle).max(step(1.15, 0.85, blaze) * step(0.87, 0.84, q.y)),
    );
    if q.z > 0.12 { mouth(eye(c, q), q) } else { c }
}

/// The colour of the ear's back, growing out of the head's, and pink skin in the cavity.
fn ear(q: DVec3, back: Colour) -> Colour {
    let grown = step(0.87, 0.9, q.y + 0.012 * noise(q * 25.0));
    let skin = step(0.011, 0.003, ear_cavity(q));
    head(q).lerp(back, grown).lerp(PINK, skin)
}

/// An almond with a dark lid, an iris, an upright pupil and a highlight (on the same side in both eyes).
fn eye(coat: Colour, q: DVec3) -> Colour {
    let side = if q.x > 0.0 { 1.0 } else { -1.0 };
    let e = DVec2::new(q.x * side - 0.068, q.y - 0.782);
    let e = DVec2::new(e.x, e.y - 0.25 * e.x);
    let almond = (e / DVec2::new(0.036, 0.03)).length();
    let lid = coat
        .lerp(WHITE, 0.7 * step(1.75, 1.35, almond))
        .lerp(BLACK, step(1.22, 1.12, almond));
    let iris = IRIS.lerp(IRIS_RIM, step(0.35, 0.95, almond));
    let pupil = (e / DVec2::new(0.0125, 0.026)).length();
    let c = lid
        .lerp(iris, step(1.04, 0.96, almond))
        .lerp(BLACK, step(1.08, 0.92, pupil));
    let glint = (DVec2::new(q.x - side * 0.068, q.y - 0.782) - DVec2::new(-0.009, 0.012)).length();
    c.lerp(DVec3::ONE, step(0.0085, 0.0065, glint))
}

/// Nose, the line below it, the two arcs of the mouth, and dots on the whisker pads.
fn mouth(coat: Colour, q: DVec3) -> Colour {
    let side = q.x.abs();
    let nose = side - 0.026 * ((q.y - 0.722) / 0.03).clamp(-1.0, 1.0);
    let mut c = coat.lerp(NOSE, step(0.002, -0.002, nose) * step(0.758, 0.754, q.y));
    let philtrum = step(0.0042, 0.0022, side) * step(0.727, 0.724, q.y) * step(0.696, 0.699, q.y);
    let arc = ((DVec2::new(side - 0.03, q.y - 0.712)).length() - 0.032).abs();
    let arc = step(0.0042, 0.0022, arc) * step(0.705, 0.702, q.y) * step(0.062, 0.056, side);
    c = c.lerp(DARK, 0.85 * philtrum.max(arc));
    let grid = DVec2::new(side - 0.034, q.y - 0.72) / 0.013;
    let dot = (grid - grid.round()).length();
    let pad = grid.round().length() < 1.5 && grid.x > -0.5;
    if pad {
        c.lerp(DARK, 0.6 * step(0.2, 0.12, dot))
    } else {
        c
    }
}

/// 0 before `from`, 1 after `to`, smooth between; falls if `from` > `to`.
fn step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Value noise in [−1, 1], one cell per unit.
fn noise(p: DVec3) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let w = f * f * (DVec3::splat(3.0) - 2.0 * f);
    let at = |dx: f64, dy: f64, dz: f64| lattice(cell + DVec3::new(dx, dy, dz));
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let row = |y: f64, z: f64| mix(at(0.0, y, z), at(1.0, y, z), w.x);
    mix(
        mix(row(0.0, 0.0), row(1.0, 0.0), w.y),
        mix(row(0.0, 1.0), row(1.0, 1.0), w.y),
        w.z,
    )
}

/// A value in [−1, 1] of a lattice point, by integer hashing.
fn lattice(cell: DVec3) -> f64 {
    let [x, y, z] = cell.to_array().map(|c| c as i64 as u64);
    let mut h = x.wrapping_mul(0x9E37_79B9_7F4A_7C15)
        ^ y.wrapping_mul(0xC2B2_AE3D_27D4_EB4F)
        ^ z.wrapping_mul(0x1656_67B1_9E37_79F9);
    h = (h ^ (h >> 32)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    h ^= h >> 32;
    (h & 0xFFFF) as f64 / 32767.5 - 1.0
}
