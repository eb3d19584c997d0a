//! Lights without extent: closed forms, and the reference.

use crate::luxel_side::{Stage, options, trace};
use crate::objs;
use crate::reference::Estimator;
use crate::stats::assert_agree;
use luxel::trace::TraceOptions;
use std::f64::consts::PI;

/// Roundings of f32 between a light and a pixel.
const ROUNDING: f64 = 1e-5;

/// What a spot of albedo 1/2 in the plane y = 0 around the origin shows of a light. It is off the square's diagonal, beside
/// which hits step aside.
fn receiver(name: &str, light: &str, more: &str) -> Stage {
    Stage::new(name)
        .file("square.obj", &objs::square(0.0, 1.0))
        .scene(&format!(
            r#"camera: (at: (-0.4, 0.3, 0.1), look_at: (0, 0, 0), vfov_deg: 1e-7), render: (size: (2, 2), filter: Box),
            materials: {{"half": Diffuse(color: Linear(0.5, 0.5, 0.5))}},
            entities: [(shape: Mesh("square.obj"), normals: Flat, material: "half",
                transform: (translate: (0.003, 0, 0), rotate: Euler(-90, 0, 0), scale: 0.01)), {light}, {more}]"#
        ))
}

/// Every sample is the irradiance times albedo over π.
fn assert_irradiance(name: &str, stage: &Stage, truth: [f64; 3]) {
    const SPP: u32 = 8;
    for mis in [true, false] {
        let sums = stage.sums(0, SPP, &TraceOptions { mis, ..options(1) });
        for sum in &sums.rgb {
            for c in 0..3 {
                let (found, truth) = (sum[c] / f64::from(SPP), truth[c] * 0.5 / PI);
                assert!(
                    (found - truth).abs() <= ROUNDING * truth,
                    "{name}, channel {c}: {found}, expected {truth}"
                );
            }
        }
    }
}

#[test]
fn a_point_lights_by_the_square_of_its_distance() {
    for (k, [x, y, z]) in [
        [0.0, 1.0, 0.0],
        [0.3, 2.0, -1.1],
        [-40.0, 7.0, 3.0],
        [0.02, 0.05, 0.01],
    ]
    .into_iter()
    .enumerate()
    {
        let light = format!(
            "(light: Point(intensity: (1, 2, 3)), transform: (translate: ({x}, {y}, {z})))"
        );
        let d2: f64 = x * x + y * y + z * z;
        let e = y / d2.sqrt() / d2;
        let stage = receiver(&format!("point_{k}"), &light, "");
        assert_irradiance(&format!("point {k}"), &stage, [e, 2.0 * e, 3.0 * e]);
    }
}

/// The axis of a spot at the zenith is tilted until the receiver leaves its cone.
#[test]
fn a_spot_falls_off_between_its_angles() {
    let (inner, outer) = (20.0f64, 35.0f64);
    let cos = |deg: f64| deg.to_radians().cos();
    for tilt in [0.0, 12.0, 19.9, 24.0, 30.0, 34.5, 36.0, 120.0] {
        let light = format!(
            "(light: Spot(intensity: (4, 4, 4), inner_deg: {inner}, outer_deg: {outer}),
                transform: (translate: (0, 2, 0), rotate: Euler({}, 0, 0)))",
            tilt - 90.0
        );
        let t = ((cos(tilt) - cos(outer)) / (cos(inner) - cos(outer))).clamp(0.0, 1.0);
        let stage = receiver(&format!("spot_{tilt}"), &light, "");
        assert_irradiance(&format!("spot at {tilt}°"), &stage, [t * t; 3]);
    }
}

const SUN: &str = "(light: Sun(irradiance: (2, 3, 4)), transform: (rotate: Euler(-50, 0, 0)))";

#[test]
fn a_sun_lights_by_the_cosine() {
    let cos = 50f64.to_radians().sin();
    assert_irradiance(
        "sun",
        &receiver("sun", SUN, ""),
        [2.0 * cos, 3.0 * cos, 4.0 * cos],
    );
}

/// From outside any wall: a room of wall spheres is dark, and so is one inside a shell.
#[test]
fn walls_shut_a_sun_out() {
    let wall = "(shape: Sphere(radius: 990), transform: (translate: (0, 1000, 0)))";
    assert_irradiance("walled sun", &receiver("walled_sun", SUN, wall), [0.0; 3]);
    let shell = "(shape: Sphere(radius: 3, inverted: true))";
    assert_irradiance(
        "shelled sun",
        &receiver("shelled_sun", SUN, shell),
        [0.0; 3],
    );
    // A wall below the floor is not in the way.
    let cos = 50f64.to_radians().sin();
    let ground = "(shape: Sphere(radius: 990), transform: (translate: (0, -991, 0)))";
    let truth = [2.0 * cos, 3.0 * cos, 4.0 * cos];
    assert_irradiance(
        "grounded sun",
        &receiver("grounded_sun", SUN, ground),
        truth,
    );
}

#[test]
fn rays_by_chance_find_no_point() {
    let stage = receiver(
        "chance",
        "(light: Point(intensity: (1, 2, 3)), transform: (translate: (0, 1, 0)))",
        "",
    );
    let dark = TraceOptions {
        nee: false,
        ..options(4)
    };
    assert!(
        stage
            .sums(0, 64, &dark)
            .rgb
            .iter()
            .flatten()
            .all(|&c| c == 0.0)
    );
}

/// Twice the size needs four times the intensity; a sun needs nothing.
#[test]
fn powers_of_two_scale_lights_to_the_bit() {
    let picture = |k: i32| {
        let s = 2f64.powi(k);
        let stage = Stage::new("punctual_size")
            .file("square.obj", &objs::square(0.0, 1.0))
            .scene(&format!(
                r#"camera: (at: (0, {}, {}), look_at: (0, 0, 0), vfov_deg: 50), render: (size: (16, 16)),
                entities: [(shape: Mesh("square.obj"), normals: Flat, transform: (rotate: Euler(-90, 0, 0), scale: {s})),
                    (shape: Sphere(radius: {}), transform: (translate: (0, {}, 0))), {SUN},
                    (shape: Sphere(radius: {}), transform: (translate: ({s}, {s}, 0)), emissive: (radiance: (2, 2, 2))),
                    (light: Point(intensity: ({i}, {i}, {i})), transform: (translate: ({}, {s}, 0))),
                    (light: Spot(intensity: ({i}, {i}, {i}), inner_deg: 10, outer_deg: 40),
                        transform: (translate: (0, {s}, {s}), rotate: Euler(-45, 0, 0)))]"#,
                1.5 * s, 2.0 * s, 0.25 * s, 0.25 * s, 0.25 * s, -0.5 * s, i = s * s
            ));
        let options = options(3);
        trace(&stage.flat(0, &options), 8, &options).rgb
    };
    let truth = picture(0);
    assert!(truth.iter().filter(|rgb| rgb[0] > 0.0).count() > 100);
    for k in [-12, 9] {
        assert!(picture(k) == truth, "2^{k}");
    }
}

/// All three, carried and turned, under a dim sky.
#[test]
fn lights_agree_with_the_reference() {
    let stage = Stage::new("punctual_room")
        .file("square.obj", &objs::square(0.0, 1.0))
        .scene(
            r#"camera: (at: (0, 2.2, 3.4), look_at: (0, 0.5, 0), vfov_deg: 40), render: (size: (16, 16), filter: Box),
            materials: {"floor": Diffuse(color: Linear(0.6, 0.5, 0.4)), "coat": Plastic(color: Linear(0.7, 0.3, 0.3))},
            background: Linear(0.1, 0.1, 0.1),
            entities: [(shape: Mesh("square.obj"), normals: Flat, material: "floor", transform: (rotate: Euler(-90, 0, 0), scale: 4)),
                (shape: Sphere(radius: 0.6), transform: (translate: (-0.7, 0.6, 0)), material: "coat"),
                (shape: Sphere(radius: 0.5), transform: (translate: (0.7, 0.5, 0.2)), material: "floor"),
                (light: Sun(irradiance: (0.7, 0.6, 0.5)), transform: (rotate: Euler(-60, 30, 0))),
                (name: "hub", transform: (translate: (0, 1.6, 0), scale: (2, 1, 1)), spin: (axis: (0, 1, 0), deg_per_s: 120)),
                (parent: "hub", light: Point(intensity: (1, 2, 1)), transform: (translate: (0.6, 0, 0))),
                (parent: "hub", light: Spot(intensity: (6, 5, 4), inner_deg: 12, outer_deg: 30),
                    transform: (translate: (-0.5, 0.3, 0), rotate: Euler(-60, 20, 0)))],
            animation: (fps: 24, frames: 0..48)"#,
        );
    let found = stage.luxel(17, 3072, &options(3));
    let estimator = Estimator {
        max_bounces: 3,
        lamps: false,
    };
    let truth = stage.reference(17, 240, estimator);
    assert_agree("lights", &found, &truth, 0.005);
}
