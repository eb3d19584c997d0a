//! Rigid motions: a closed room turned any way loses no light. Next-event estimation and roulette are off, so that every
//! sample must be equal to the bit; one path lost in a crack shows.

use crate::stage::{Stage, cube, obj, picture, turned};
use crate::support::Rng;
use luxel::trace::{Sampler, TileSums, TraceOptions};

const BOUNCES: u32 = 12;
const ALBEDO: f32 = 0.5;

fn options(seed: u64) -> TraceOptions {
    TraceOptions {
        max_bounces: BOUNCES,
        seed,
        sampler: Sampler::Independent,
        nee: false,
        roulette: false,
        ..TraceOptions::default()
    }
}

/// What a path adds up, in f32 and in its order.
fn series() -> f64 {
    let (mut sum, mut throughput) = (0.0f32, 1.0f32);
    for _ in 0..=BOUNCES {
        sum += throughput;
        throughput *= ALBEDO;
    }
    f64::from(sum)
}

fn deviating(sums: &TileSums, spp: u32) -> usize {
    let (n, value) = (f64::from(spp), series());
    let pairs = sums.rgb.iter().zip(&sums.rgb_squared);
    pairs
        .filter(|(sum, squares)| sum[0] != n * value || squares[0] != n * value * value)
        .count()
}

/// Pixels in which a sample deviates, in rooms with random rotations; every second one is an instance.
fn lost(name: &str, rotations: usize, spp: u32) -> usize {
    let (vertices, faces) = cube();
    let stage = Stage::new(name).file("room.obj", &obj(&vertices, &turned(&faces)));
    let mut rng = Rng(11);
    let mut lost = 0;
    for k in 0..rotations {
        let [x, y, z, w] = [(); 4].map(|()| rng.range(-1.0, 1.0));
        let spin = match k % 2 {
            0 => "",
            _ => "spin: (axis: (0, 1, 0), deg_per_s: 90),",
        };
        let flat = stage.flat(&format!(
            r#"camera: (at: (0.1, 0.2, 0.3), look_at: (0.4, -1, 0.7), vfov_deg: 100),
            materials: {{"wall": Diffuse(color: Linear({ALBEDO}, {ALBEDO}, {ALBEDO}))}},
            entities: [(shape: Mesh("room.obj"), material: "wall", emissive: (radiance: (1, 1, 1)), normals: Flat,
                {spin} transform: (rotate: Quat({x}, {y}, {z}, {w}), scale: 1.7))]"#
        ));
        assert_eq!(
            flat.instances.len(),
            k % 2,
            "every second room is an instance"
        );
        lost += deviating(&picture(&flat, spp, &options(k as u64)), spp);
    }
    lost
}

#[test]
fn a_closed_room_keeps_its_light_in_any_rotation() {
    assert_eq!(lost("rigid", 200, 4), 0);
}

#[test]
#[ignore = "a few minutes"]
fn a_closed_room_keeps_its_light_in_any_rotation_for_long() {
    let (rotations, spp) = (200, 1024);
    let lost = lost("rigid_long", rotations, spp);
    let paths = rotations * 24 * 16 * spp as usize;
    println!("{paths} paths of {BOUNCES} bounces: {lost} pixels with a lost path");
    assert_eq!(lost, 0);
}
