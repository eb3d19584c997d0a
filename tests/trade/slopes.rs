//! How errors fall with samples: Owen-scrambled Sobol points against independent ones.

use crate::stage::{Ask, Stage};
use crate::truth::Truth;
use luxel::trace::Sampler;

/// Slope of log RMSE over log samples, by least squares.
fn slope(stage: &Stage, spps: &[u32], seeds: u64) -> f64 {
    let points: Vec<(f64, f64)> = spps
        .iter()
        .map(|&spp| {
            let error = Truth::of(stage, Ask::new(spp, 0), seeds).relative;
            (f64::from(spp).ln(), error.ln())
        })
        .collect();
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (mx, my) = (mean(|p| p.0), mean(|p| p.1));
    let xy: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    let xx: f64 = points.iter().map(|p| (p.0 - mx).powi(2)).sum();
    println!("{}: slope {:.3}", stage.name, xy / xx);
    xy / xx
}

/// A floor seen from above, a lamp out of sight, and what stands between them; pixels are squares, as small as those of a
/// picture of 512 rows.
fn floor(name: &str, between: &str) -> Stage {
    let body = format!(
        "camera: (at: (0, 4, 0.01), look_at: (0, 0, 0), vfov_deg: 2), render: (size: (16, 16), spp: 4, max_bounces: 1, filter: Box),
        materials: {{\"white\": Diffuse(color: Linear(0.5, 0.5, 0.5))}},
        entities: [
            (name: \"floor\", shape: Sphere(radius: 1000), transform: (translate: (0, -1000, 0)), material: \"white\"),
            (name: \"lamp\", shape: Sphere(radius: 2), transform: (translate: (6, 8, 0)), emissive: (radiance: (9, 9, 9))),
            {between}
        ]"
    );
    Stage::of(name, &body, (16, 16))
}

/// Twice as fast as independent samples: place in the pixel and place on the lamp are spread evenly together.
#[test]
fn on_a_lit_plane_the_error_falls_as_the_samples_grow() {
    let slope = slope(&floor("lit plane", ""), &[4, 16, 64, 256], 8);
    assert!(slope <= -1.0, "{slope}");
}

/// The ball is out of sight, its penumbra fills the frame.
#[test]
fn in_a_soft_shadow_it_falls_as_the_power_of_three_quarters() {
    let ball = "(name: \"ball\", shape: Sphere(radius: 1), transform: (translate: (3.74, 3.32, 0)), material: \"white\"),";
    let slope = slope(&floor("soft shadow", ball), &[4, 16, 64, 256], 8);
    assert!(slope <= -0.70, "{slope}");
}

/// The first of the rooms that other renderers drew: spheres for walls, a lamp, a ball.
fn room(ball: &str) -> Stage {
    let wall = |name: &str, at: &str, radius: u32, color: &str| {
        format!(
            "(name: \"{name}\", shape: Sphere(radius: {radius}), transform: (translate: {at}), material: \"{color}\"),"
        )
    };
    let walls = [
        wall("left", "(-1000, 0, 0)", 940, "red"),
        wall("right", "(1000, 0, 0)", 940, "blue"),
        wall("floor", "(0, -1000, 0)", 940, "white"),
        wall("ceiling", "(0, 1000, 0)", 940, "white"),
        wall("back", "(0, 0, -1000)", 940, "white"),
        wall("front", "(0, 0, 1000)", 900, "white"),
    ];
    let body = format!(
        "camera: (at: (0, 0, 95), look_at: (0, 0, 0), vfov_deg: 70), render: (size: (32, 32), spp: 4, max_bounces: 7),
        materials: {{
            \"red\": Diffuse(color: Linear(0.75, 0.25, 0.25)), \"blue\": Diffuse(color: Linear(0.25, 0.25, 0.75)),
            \"white\": Diffuse(color: Linear(0.75, 0.75, 0.75)), \"ball\": Diffuse(color: Linear(0.8, 0.8, 0.8)),
        }},
        entities: [
            {}
            (name: \"lamp\", shape: Sphere(radius: 8), transform: (translate: (0, 40, 0)), emissive: (radiance: (30, 30, 30))),
            {ball}
        ]",
        walls.concat()
    );
    Stage::of("room", &body, (32, 32))
}

const BALL: &str = "(name: \"ball\", shape: Sphere(radius: 25), transform: (translate: (0, -35, 0)), material: \"ball\"),";

#[test]
fn light_from_many_bounces_falls_as_the_root_and_below_independent_samples() {
    let stage = room(BALL);
    let slope = slope(&stage, &[4, 16, 64], 6);
    assert!(slope <= -0.48, "{slope}");
    better_than_independent(&stage, 1.2);
}

/// The third of them, with a mesh in the place of the ball.
#[test]
#[ignore = "long: half a minute; needs LUXEL_DATA; cargo test --release --test trade rooms -- --ignored --nocapture"]
fn both_rooms_of_the_peers_are_below_independent_samples() {
    better_than_independent(&room(BALL), 1.2);
    let Some(inputs) = std::env::var_os("LUXEL_DATA") else {
        println!("skipped: LUXEL_DATA is not set");
        return;
    };
    let mesh = std::path::Path::new(&inputs).join("../peers/meshes/s3_bunny.obj");
    let bunny = format!(
        "(name: \"bunny\", shape: Mesh({:?}), material: \"ball\"),",
        mesh.display().to_string()
    );
    let stage = room(&bunny);
    assert!(slope(&stage, &[16, 64, 256], 6) <= -0.48);
    better_than_independent(&stage, 1.2);
}

fn better_than_independent(stage: &Stage, factor: f64) {
    let error = |sampler| {
        let ask = Ask {
            sampler,
            ..Ask::new(64, 0)
        };
        Truth::of(stage, ask, 6).relative
    };
    let gain = error(Sampler::Independent) / error(Sampler::Sobol);
    println!("{}: {gain:.2} times below independent samples", stage.name);
    assert!(gain >= factor, "{gain}");
}
