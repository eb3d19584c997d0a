//! G, and B2: furnaces, in which no path may be lost, and identities of depth. Closed forms and estimators against each other
//! are in `tests/light`.

use crate::book::{Outcome, items};
use crate::luxel_side::{Stage, options};
use crate::objs;
use luxel::flat::FlatScene;
use luxel::trace::fresnel::dielectric;
use luxel::trace::{Fresnel, Rect, Sampler, TileSums, TraceOptions, Tracer};

items! {
    b2_corner(2e5, 1e8): "B2", "bounces inside six spheres of R = 1e5 with balls: paths that escape";
    g1_furnace(1e5, 1e8): "G1", "samples of closed rooms that shine everywhere: a sphere, a box, a mesh of 1280 triangles: not equal to the bit; six spheres of R = 1e6: escaped";
    g4_thousand_bounces(1e3, 1e5): "G4", "samples of a white room after a thousand bounces, roulette on: not 1001 exactly";
    g5_depth(2e4, 2e6): "G5", "pixels of a room of every material, one bounce more: darker";
}

/// Pixels of a furnace's picture, which say nothing but more samples.
const SIDE: u32 = 8;

pub(crate) fn bare(max_bounces: u32) -> TraceOptions {
    TraceOptions {
        nee: false,
        roulette: false,
        ..options(max_bounces)
    }
}

/// Samples of each of the pixels, in parts so small that sums of equal squares of f32 are exact in f64: 48 bits and five.
fn samples(scene: &FlatScene, options: &TraceOptions, spp: u64, mut each: impl FnMut(&TileSums)) {
    const PART: u64 = 32;
    let rect = Rect {
        x: 0,
        y: 0,
        width: scene.camera.width,
        height: scene.camera.height,
    };
    let mut tracer = Tracer::new(scene, options);
    for start in (0..spp).step_by(PART as usize) {
        let mut sums = TileSums::default();
        let range = start as u32..(start + PART).min(spp) as u32;
        tracer.trace_tile(rect, range, &mut sums);
        each(&sums);
    }
}

/// How many samples there were, and by how much some were not `value`: of a pixel's part whose sum or sum of squares is not
/// that of equal samples, one, since they are so rare. NaN for one that is not finite.
fn deviations(scene: &FlatScene, options: &TraceOptions, spp: u64, value: f32) -> (u64, Vec<f64>) {
    let (mut trials, mut off) = (0, Vec::new());
    let v = f64::from(value);
    samples(scene, options, spp, |sums| {
        for (i, (sum, squares)) in sums.rgb.iter().zip(&sums.rgb_squared).enumerate() {
            let n = f64::from(sums.count[i]);
            if !(0..3).all(|c| sum[c] == n * v && squares[c] == n * (v * v)) {
                off.push(sum[0] - n * v);
            }
            off.extend((0..sums.non_finite[i]).map(|_| f64::NAN));
            trials += u64::from(sums.count[i] + sums.non_finite[i]);
        }
    });
    (trials, off)
}

/// A furnace in which every sample must be `value`.
pub(crate) fn deviating(
    scene: &FlatScene,
    options: &TraceOptions,
    spp: u64,
    value: f32,
) -> Outcome {
    let (trials, off) = deviations(scene, options, spp, value);
    Outcome::new(trials as usize, off.len())
}

/// What a path adds up, in f32 and in its order.
pub(crate) fn series(albedo: f32, n: u32) -> f32 {
    let (mut sum, mut throughput) = (0.0f32, 1.0f32);
    for _ in 0..=n {
        sum += throughput;
        throughput *= albedo;
    }
    sum
}

/// Six spheres of that radius around a room of side 10, and what else is in it; all of albedo `a`, shining with 1. What
/// escapes sees another background.
fn six_spheres(name: &str, radius: f64, albedo: f32, more: &str) -> Stage {
    let mut entities = String::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut c = [0.0; 3];
            c[axis] = side * (radius + 5.0);
            let [x, y, z] = c;
            entities += &entity(
                &format!("Sphere(radius: {radius})"),
                &format!("({x}, {y}, {z})"),
            );
        }
    }
    Stage::new(name).scene(&format!(
        r#"{} background: Linear(1000, 1000, 1000),
        materials: {{"wall": Diffuse(color: Linear({albedo}, {albedo}, {albedo}))}}, entities: [{entities} {more}]"#,
        camera(),
    ))
}

pub(crate) fn camera() -> String {
    format!(
        "camera: (at: (0.1, 0.2, 0.3), look_at: (0.4, -1, 0.7), vfov_deg: 120), render: (size: ({SIDE}, {SIDE})),"
    )
}

fn entity(shape: &str, at: &str) -> String {
    let flat = if shape.starts_with("Mesh") {
        ", normals: Flat"
    } else {
        ""
    };
    format!(
        r#"(shape: {shape}, material: "wall"{flat}, emissive: (radiance: (1, 1, 1)), transform: (translate: {at})),"#
    )
}

fn b2_corner(trials: u64) -> Outcome {
    const BOUNCES: u32 = 100;
    let spp = trials / u64::from(BOUNCES) / u64::from(SIDE * SIDE);
    let bounces = |name: &str, balls: &[&str], spp: u64| {
        let balls = balls.iter().map(|at| entity("Sphere(radius: 1)", at));
        let scene = six_spheres(name, 1e5, 1.0, &balls.collect::<String>()).flat(0, &bare(BOUNCES));
        deviations(&scene, &bare(BOUNCES), spp.max(1), series(1.0, BOUNCES))
    };
    // Two unit balls in the open and one in a corner, 1.6e-4 from three walls.
    let balls = ["(2, 1, -2)", "(-2, -1, 1)", "(4, 4, 4)"];
    let (paths, off) = bounces("catalogue_b2", &balls, spp);
    // Outside it is brighter; who does not come back sees the walls' dark sides to the end.
    let escaped = off.iter().filter(|d| !(-20.0..=0.0).contains(*d)).count();
    let (few, touching) = bounces("catalogue_b2_touching", &["(0, -4, 0)"], spp / 4);
    Outcome::new((paths * u64::from(BOUNCES)) as usize, escaped).saying(format!(
        "{} paths came behind a wall where two meet within rounding, and back after {:.0} bounces at most; {} of {:.1e} behind a floor that a ball touches",
        off.len() - escaped,
        off.iter().fold(0.0, |m: f64, d| m.max(-d)),
        touching.len(),
        few as f64 * f64::from(BOUNCES)
    ))
}

fn g1_furnace(trials: u64) -> Outcome {
    let room = |name: &str, albedo: f32, shape: &str| {
        Stage::new(name)
            .file("cube.obj", &objs::cube(true))
            .file("ball.obj", &inward_ball())
            .scene(&format!(
                r#"{} background: Linear(1000, 1000, 1000),
                materials: {{"wall": Diffuse(color: Linear({albedo}, {albedo}, {albedo}))}}, entities: [{}]"#,
                camera(),
                entity(shape, "(0, 0, 0)")
            ))
    };
    let cases = [(0.1f32, 3), (0.5, 7), (0.9, 20), (0.99, 7), (1.0, 7)];
    let mut outcome = Outcome::default();
    let (mut paths, mut astray) = (0, 0);
    let spp = (trials / (4 * cases.len() as u64 * u64::from(SIDE * SIDE))).max(1);
    for (k, (albedo, bounces)) in cases.into_iter().enumerate() {
        let name = |kind: &str| format!("catalogue_g1_{kind}_{k}");
        let options = bare(bounces);
        let value = series(albedo, bounces);
        for stage in [
            room(&name("sphere"), albedo, "Sphere(radius: 3, inverted: true)"),
            room(&name("box"), albedo, r#"Mesh("cube.obj")"#),
            room(&name("mesh"), albedo, r#"Mesh("ball.obj")"#),
        ] {
            outcome.add(deviating(&stage.flat(0, &options), &options, spp, value));
        }
        // See B2 for what happens in its corners.
        let six = six_spheres(&name("six"), 1e6, albedo, "");
        let (n, off) = deviations(&six.flat(0, &options), &options, spp, value);
        paths += n;
        astray += off.len();
        let escaped = off.iter().filter(|d| !(-20.0..=0.0).contains(*d)).count();
        outcome.add(Outcome::new(n as usize, escaped));
    }
    outcome.saying(format!(
        "of {:.1e} in the six spheres {astray} came behind a wall",
        paths as f64
    ))
}

/// A ball of 1280 triangles that shines inward, flat.
fn inward_ball() -> String {
    use std::fmt::Write;
    let ball = crate::support::Solid::icosphere(3);
    let mut text = String::new();
    for v in &ball.vertices {
        writeln!(text, "v {} {} {}", v.x * 3.0, v.y * 3.0, v.z * 3.0).expect("a string");
    }
    for f in &ball.faces {
        let [a, b, c] = f.map(|i| ball.vertices[i]);
        let outward = (b - a).cross(c - a).dot(a) > 0.0;
        let [i, j, k] = f.map(|i| i + 1);
        let [j, k] = if outward { [k, j] } else { [j, k] };
        writeln!(text, "f {i} {j} {k}").expect("a string");
    }
    text
}

fn g4_thousand_bounces(trials: u64) -> Outcome {
    const BOUNCES: u32 = 1000;
    let options = TraceOptions {
        roulette: true,
        ..bare(BOUNCES)
    };
    let stage = Stage::new("catalogue_g4").scene(&format!(
        r#"{} materials: {{"wall": Diffuse(color: Linear(1, 1, 1))}}, entities: [{}]"#,
        camera(),
        entity("Sphere(radius: 3, inverted: true)", "(0, 0, 0)")
    ));
    let spp = (trials / u64::from(SIDE * SIDE)).max(1);
    deviating(
        &stage.flat(0, &options),
        &options,
        spp,
        series(1.0, BOUNCES),
    )
}

/// A room with a lamp and every material.
fn g5_depth(trials: u64) -> Outcome {
    let stage = Stage::new("catalogue_g5").file("cube.obj", &objs::cube(true)).scene(&format!(
        r#"{} background: Linear(0, 0, 0), materials: {{"wall": Diffuse(color: Linear(0.7, 0.6, 0.5)),
            "glass": Glass(ior: 1.5), "coat": Plastic(color: Linear(0.2, 0.5, 0.8)),
            "chrome": Mirror(color: Linear(0.9, 0.9, 0.9)), "gold": Metal(color: Linear(0.9, 0.6, 0.2))}},
            entities: [(shape: Mesh("cube.obj"), normals: Flat, material: "wall", transform: (scale: 4)),
                (shape: Sphere(radius: 1), material: "glass", transform: (translate: (0.5, -2, 1.5))),
                (shape: Sphere(radius: 1), material: "coat", transform: (translate: (2, -3, 0))),
                (shape: Sphere(radius: 1), material: "chrome", transform: (translate: (-2, -3, 1))),
                (shape: Sphere(radius: 1), material: "gold", transform: (translate: (0, -3, 3))),
                (shape: Sphere(radius: 0.5), emissive: (radiance: (6, 5, 4)), transform: (translate: (1, 3, 1)))]"#,
        camera()
    ));
    let mut outcome = Outcome::default();
    let cases = [(false, Sampler::Independent), (true, Sampler::Sobol)];
    let spp = (trials / 16 / u64::from(SIDE * SIDE)).max(1);
    for (nee, sampler) in cases {
        let mut last: Vec<[f64; 3]> = Vec::new();
        for depth in 0..8 {
            let options = TraceOptions {
                nee,
                caustics: nee,
                sampler,
                ..bare(depth)
            };
            let mut all: Vec<[f64; 3]> = Vec::new();
            samples(&stage.flat(0, &options), &options, spp, |sums| {
                all.extend(&sums.rgb)
            });
            let darker = last
                .iter()
                .zip(&all)
                .filter(|(a, b)| (0..3).any(|c| b[c] < a[c]));
            outcome.add(Outcome::new(
                (spp * u64::from(SIDE * SIDE)) as usize,
                darker.count(),
            ));
            last = all;
        }
        let lit = last.iter().filter(|rgb| rgb[0] > 0.0).count();
        assert!(lit * 2 > last.len(), "{lit} lit pixels");
    }
    outcome
}

/// G7. The rainbow: light that is reflected once inside a ball of n = 4/3 turns by 137.9703° at least.
#[test]
fn the_rainbow_stands_at_its_angle() {
    let n = 4.0f64 / 3.0;
    let cos_i = ((n * n - 1.0) / 3.0).sqrt();
    let (_, cos_r) = dielectric(Fresnel::Exact, cos_i as f32, n as f32);
    let turn = std::f64::consts::PI + 2.0 * cos_i.acos() - 4.0 * f64::from(cos_r).acos();
    assert!(
        (turn.to_degrees() - 137.9703).abs() < 1e-4,
        "{}",
        turn.to_degrees()
    );
    // The least: to either side it is more.
    for aside in [-0.02, 0.02] {
        let i = cos_i.acos() + aside;
        let (_, cos_r) = dielectric(Fresnel::Exact, i.cos() as f32, n as f32);
        let other = std::f64::consts::PI + 2.0 * i - 4.0 * f64::from(cos_r).acos();
        assert!(other > turn);
    }
}
