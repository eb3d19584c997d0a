//! The sky as an image: closed forms, furnaces, orientation, and the reference with every estimator.

use crate::luxel_side::{Stage, options, trace};
use crate::objs;
use crate::reference::Estimator;
use crate::stats::{Mean, assert_agree, assert_mean};
use luxel::trace::{Sampler, TraceOptions};
use std::f64::consts::PI;

/// Three ways to find the sky: next-event estimation with and without multiple importance sampling, and neither.
fn estimators(max_bounces: u32) -> [(&'static str, TraceOptions); 3] {
    let with = |nee, mis| TraceOptions {
        nee,
        mis,
        ..options(max_bounces)
    };
    [
        ("nee, mis", with(true, true)),
        ("nee alone", with(true, false)),
        ("neither", with(false, false)),
    ]
}

/// Fills the view with a level white plane, seen from above.
const PLANE: &str = r#"camera: (at: (0, 1, 0), look_at: (0, 0, 0), up: (0, 0, -1), vfov_deg: 20),
    render: (size: (8, 8), filter: Box),
    materials: {"white": Diffuse(color: Linear(1, 1, 1))},
    entities: [(shape: Mesh("square.obj"), normals: Flat, material: "white", transform: (rotate: Euler(-90, 0, 0)))],"#;

fn plane(name: &str, sky: &str) -> Stage {
    Stage::new(name)
        .file("square.obj", &objs::square(0.0, 1.0))
        .scene(&format!("{PLANE} background: {sky}"))
}

/// Every direction has one radiance, so that neither paths nor the table's density, which is the same everywhere, vary.
#[test]
fn under_a_sky_of_one_colour_a_plane_has_its_albedo() {
    for filter in ["Bilinear", "Nearest"] {
        let sky = format!(r#"Hdr(path: "white.hdr", rotate_deg: 25, filter: {filter})"#);
        let stage =
            plane(&format!("white_plane_{filter}"), &sky).hdr("white.hdr", &[[1.0; 3]; 18], 6);
        for (name, options) in estimators(1) {
            let picture = stage.luxel(0, 1024, &options);
            let name = format!("{filter}, {name}");
            assert_mean(&name, picture.whole(0), Mean::exact(1.0), 0.005);
        }
    }
}

/// What is white and closed is not to be told from what is behind it, in any sample.
#[test]
fn white_things_vanish_in_a_white_sky() {
    let bare = TraceOptions {
        nee: false,
        roulette: false,
        sampler: Sampler::Sobol,
        ..options(7)
    };
    for (name, material) in [
        ("diffuse", "Diffuse(color: Linear(1, 1, 1))"),
        ("mirror", "Mirror"),
    ] {
        for filter in ["Bilinear", "Nearest"] {
            let stage = Stage::new(&format!("white_{name}_{filter}"))
                .hdr("white.hdr", &[[1.0; 3]; 18], 6)
                .scene(&format!(
                    r#"camera: (at: (0, 1, 4), look_at: (0, 0, 0), vfov_deg: 35), render: (size: (16, 16)),
                    background: Hdr(path: "white.hdr", rotate_deg: 25, filter: {filter}),
                    materials: {{"white": {material}}}, entities: [(shape: Sphere(radius: 1), material: "white")]"#
                ));
            let sums = stage.sums(0, 16, &bare);
            for (sum, squares) in sums.rgb.iter().zip(&sums.rgb_squared) {
                assert_eq!((*sum, *squares), ([16.0; 3], [16.0; 3]), "{name}, {filter}");
            }
        }
    }
}

/// A texel from θ₁ to θ₂, Δφ wide, gives the level plane the irradiance L Δφ (sin² θ₂ − sin² θ₁) / 2. It fills the
/// thousandth part of the sky: paths alone find it with a noise that is no test.
#[test]
fn a_sun_of_one_texel_gives_its_irradiance() {
    const L: f32 = 131_072.0;
    let (width, height, row) = (64, 32, 7);
    let mut texels = vec![[0.0; 3]; width * height];
    texels[row * width + 11] = [L, L / 2.0, L / 4.0];
    let sin2 = |row: usize| (PI * row as f64 / height as f64).sin().powi(2);
    let step = 2.0 * PI / width as f64;
    let exact = f64::from(L) * step * (sin2(row + 1) - sin2(row)) / 2.0 / PI;
    let sky = r#"Hdr(path: "sun.hdr", rotate_deg: -70, strength: 0.5, filter: Nearest)"#;
    let stage = plane("sun_of_one_texel", sky).hdr("sun.hdr", &texels, width);
    for (name, options) in &estimators(1)[..2] {
        let picture = stage.luxel(0, 256, options);
        for (c, share) in [0.5, 0.25, 0.125].into_iter().enumerate() {
            let name = format!("sun, {name}, channel {c}");
            assert_mean(&name, picture.whole(c), Mean::exact(exact * share), 0.001);
        }
    }
}

/// The same sun in a grey sky, bilinear: no sample is far from the mean, whatever the paths find by themselves.
#[test]
fn a_bright_sun_makes_no_fireflies() {
    let mut texels = vec![[1.0; 3]; 64 * 32];
    texels[7 * 64 + 11] = [100_000.0; 3];
    for filter in ["Bilinear", "Nearest"] {
        let sky = format!(r#"Hdr(path: "sun.hdr", filter: {filter})"#);
        let stage = plane(&format!("fireflies_{filter}"), &sky).hdr("sun.hdr", &texels, 64);
        let options = options(1);
        let flat = stage.flat(0, &options);
        let (mut sum, mut largest) = (0.0, 0.0f64);
        let (pixels, spp) = (64.0, 256);
        for sample in 0..spp {
            let options = TraceOptions {
                seed: sample,
                ..options
            };
            for one in trace(&flat, 1, &options).rgb {
                sum += one[0];
                largest = largest.max(one[0]);
            }
        }
        let mean = sum / (pixels * spp as f64);
        println!("{filter}: mean {mean}, largest {largest}");
        // Between two texels a bilinear corner is 16 times the mean of what its texel has of the bright one.
        assert!(largest < 17.0 * mean, "{filter}: {largest} for {mean}");
    }
}

/// Four columns of three rows, told apart by their numbers.
fn marked() -> Vec<[f32; 3]> {
    let texel = |i: u8| [f32::from(1 + i), 0.5, 0.25];
    (0..12).map(texel).collect()
}

/// What a camera at the origin sees in its one pixel.
fn seen(name: &str, rotate_deg: f64, look_at: &str) -> f64 {
    let stage = Stage::new(name)
        .hdr("marked.hdr", &marked(), 4)
        .scene(&format!(
            r#"camera: (at: (0, 0, 0), look_at: {look_at}, up: (0.01, 0, 1), vfov_deg: 1), render: (size: (1, 1), filter: Box),
            background: Hdr(path: "marked.hdr", rotate_deg: {rotate_deg}, filter: Nearest)"#
        ));
    stage.sums(0, 1, &options(0)).rgb[0][0]
}

/// The middle is towards +Z, and who looks there has the image's right half to the right, towards −X.
#[test]
fn the_sky_is_upright_and_unmirrored() {
    for (look_at, number) in [
        // Just right and left of the middle, in the middle row.
        ("(-0.3, 0, 1)", 7.0),
        ("(0.3, 0, 1)", 6.0),
        // Right and left of what is behind.
        ("(0.3, 0, -1)", 5.0),
        ("(-0.3, 0, -1)", 8.0),
        // Top and bottom rows.
        ("(-0.1, 1, 0.2)", 3.0),
        ("(-0.1, -1, 0.2)", 11.0),
    ] {
        assert_eq!(seen("unmirrored", 0.0, look_at), number, "{look_at}");
    }
}

/// A quarter turn, counter-clockwise from above, takes what was towards +Z to +X.
#[test]
fn the_sky_turns_about_the_vertical() {
    for (deg, look_at) in [
        (0.0, "(-0.3, 0, 1)"),
        (90.0, "(1, 0, 0.3)"),
        (180.0, "(0.3, 0, -1)"),
        (-90.0, "(-1, 0, -0.3)"),
        (450.0, "(1, 0, 0.3)"),
    ] {
        assert_eq!(seen("turned", deg, look_at), 7.0, "{deg}");
    }
}

/// Colours all over, a few texels much brighter than the rest; the first row and column, and the last, take part.
fn colorful() -> Vec<[f32; 3]> {
    let number = |k: usize| (k * 89 % 97) as f32 / 97.0;
    let mut texels: Vec<[f32; 3]> = (0..72)
        .map(|i| [0, 1, 2].map(|c| 0.05 + number(3 * i + c)))
        .collect();
    texels[15] = [9.0, 8.0, 6.0];
    texels[24] = [6.0, 7.0, 8.0];
    texels[2] = [4.0, 5.0, 6.0];
    texels[40] = [0.0; 3];
    texels
}

const ENTITIES: &str = r#"(shape: Mesh("square.obj"), normals: Flat, material: "floor", transform: (rotate: Euler(-90, 0, 0), scale: 4)),
    (shape: Sphere(radius: 0.8), transform: (translate: (-0.7, 0.8, 0)), material: "coat"),
    (shape: Sphere(radius: 0.5), transform: (translate: (0.9, 0.5, 0.4)), material: "chrome"),"#;

fn agree(name: &str, filter: &str, more: &str, lamps: bool, max_bounces: u32) {
    let stage = Stage::new(name)
        .file("square.obj", &objs::square(0.0, 1.0))
        .hdr("sky.hdr", &colorful(), 12)
        .scene(&format!(
            r#"camera: (at: (0, 1.2, 4), look_at: (0, 0.6, 0), vfov_deg: 40), render: (size: (16, 16), filter: Box),
            background: Hdr(path: "sky.hdr", rotate_deg: 35, strength: 1.5, filter: {filter}),
            materials: {{"floor": Diffuse(color: Linear(0.6, 0.5, 0.4)), "coat": Plastic(color: Linear(0.7, 0.3, 0.2)), "chrome": Mirror}},
            entities: [{ENTITIES} {more}]"#
        ));
    let estimator = Estimator { max_bounces, lamps };
    let truth = stage.reference(0, 1600, estimator);
    for (kind, options) in estimators(max_bounces) {
        // Paths alone hardly find a small lamp.
        if lamps && !options.nee {
            continue;
        }
        let found = stage.luxel(0, 1024, &options);
        assert_agree(&format!("{name}, {kind}"), &found, &truth, 0.01);
    }
}

#[test]
fn the_reference_agrees_on_a_smooth_sky() {
    agree("smooth_sky", "Bilinear", "", false, 4);
}

#[test]
fn the_reference_agrees_on_a_sky_of_texels() {
    agree("sky_of_texels", "Nearest", "", false, 4);
}

#[test]
fn the_reference_agrees_on_a_sky_among_lamps() {
    let lamps = r#"(shape: Sphere(radius: 0.3), transform: (translate: (0.3, 2.2, 0.5)), emissive: (radiance: (20, 16, 12))),
        (light: Sun(irradiance: (1, 1.5, 2)), transform: (rotate: Euler(-50, 30, 0))),"#;
    agree("sky_among_lamps", "Bilinear", lamps, true, 2);
}
