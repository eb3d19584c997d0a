//! Furnaces: next-event estimation and roulette off, so that a sample has no variance and one lost path shows.

use crate::luxel_side::{Stage, options};
use crate::objs;
use crate::stats::{Mean, assert_mean};
use luxel::trace::{Sampler, TileSums, TraceOptions};

const SPP: u32 = 64;

fn bare(max_bounces: u32, sampler: Sampler) -> TraceOptions {
    TraceOptions {
        nee: false,
        roulette: false,
        sampler,
        ..options(max_bounces)
    }
}

/// Every sample of every pixel has this very value: a sum and a sum of squares cannot both be right otherwise.
fn assert_every_sample(name: &str, sums: &TileSums, value: f32) {
    let n = f64::from(SPP);
    let v = f64::from(value);
    for (i, (sum, squares)) in sums.rgb.iter().zip(&sums.rgb_squared).enumerate() {
        assert_eq!(sums.count[i], SPP, "{name}: samples of pixel {i}");
        for c in 0..3 {
            assert!(
                sum[c] == n * v && squares[c] == n * (v * v),
                "{name}: pixel {i} has the mean {} for {v}",
                sum[c] / n
            );
        }
    }
}

/// What a path adds up, in f32 and in its order.
fn series(albedo: f32, n: u32) -> f32 {
    let (mut sum, mut throughput) = (0.0f32, 1.0f32);
    for _ in 0..=n {
        sum += throughput;
        throughput *= albedo;
    }
    sum
}

fn closed_room(name: &str, albedo: f32, shape: &str) -> Stage {
    Stage::new(name)
        .file("cube.obj", &objs::cube(true))
        .scene(&format!(
            r#"camera: (at: (0.1, 0.2, 0.3), look_at: (0.4, -1, 0.7), vfov_deg: 100), render: (size: (8, 8)),
                materials: {{"wall": Diffuse(color: Linear({albedo}, {albedo}, {albedo}))}},
                entities: [(shape: {shape}, material: "wall", emissive: (radiance: (1, 1, 1)))]"#
        ))
}

fn closed_rooms(kind: &str, shape: &str) {
    for albedo in [0.0, 0.25, 0.5, 0.7, 1.0] {
        let stage = closed_room(&format!("furnace_{kind}_{albedo}"), albedo, shape);
        for (n, sampler) in [
            (0, Sampler::Sobol),
            (1, Sampler::Independent),
            (7, Sampler::Sobol),
            (50, Sampler::Independent),
        ] {
            let sums = stage.sums(0, SPP, &bare(n, sampler));
            let name = format!("{kind}, albedo {albedo}, {n} bounces");
            assert_every_sample(&name, &sums, series(albedo, n));
        }
    }
}

#[test]
fn in_a_closed_sphere_every_sample_is_equal() {
    closed_rooms("sphere", "Sphere(radius: 3, inverted: true)");
}

#[test]
fn in_a_closed_box_every_sample_is_equal() {
    closed_rooms("box", r#"Mesh("cube.obj"), normals: Flat"#);
}

fn ball(name: &str, material: &str) -> Stage {
    Stage::new(name).scene(&format!(
        r#"camera: (at: (0, 1, 4), look_at: (0, 0, 0), vfov_deg: 35), render: (size: (16, 16)),
            background: Linear(1, 1, 1), materials: {{"white": {material}}},
            entities: [(shape: Sphere(radius: 1), material: "white")]"#
    ))
}

#[test]
fn white_things_vanish_in_a_white_sky() {
    for (name, material) in [
        ("white_diffuse", "Diffuse(color: Linear(1, 1, 1))"),
        ("white_mirror", "Mirror"),
        ("white_metal", "Metal(color: Linear(1, 1, 1))"),
    ] {
        let sums = ball(name, material).sums(0, SPP, &bare(7, Sampler::Sobol));
        assert_every_sample(name, &sums, 1.0);
    }
}

/// A path leaves glass as often as it enters it, so its factors 1/n² and n² cancel up to rounding; paths that are still
/// inside after 400 reflections are lost, fewer than one in 10⁴.
#[test]
fn clear_glass_vanishes_in_a_white_sky() {
    for ior in [1.5, 1.33, 0.75] {
        let stage = ball(&format!("white_glass_{ior}"), &format!("Glass(ior: {ior})"));
        let sums = stage.sums(0, SPP, &bare(400, Sampler::Independent));
        let n = f64::from(SPP);
        let mut lost = 0.0;
        for (sum, squares) in sums.rgb.iter().zip(&sums.rgb_squared) {
            // Samples of 0 and 1 alone have sums equal to their squares' sums.
            assert!(
                (sum[0] - squares[0]).abs() <= 4e-7 * n,
                "{sum:?} {squares:?}"
            );
            lost += n - sum[0].round();
        }
        let total = n * sums.rgb.len() as f64;
        println!("glass {ior}: {lost} of {total} paths ended inside");
        assert!(
            lost <= 1e-4 * total,
            "glass {ior}: {lost} of {total} paths lost"
        );
    }
}

#[test]
fn white_plastic_vanishes_on_average() {
    let stage = ball("white_plastic", "Plastic(color: Linear(1, 1, 1))");
    let picture = stage.luxel(0, 2048, &bare(50, Sampler::Sobol));
    assert_mean("white plastic", picture.whole(0), Mean::exact(1.0), 0.003);
}
