//! B7, F and J5: light where shapes touch, where it is tiny or huge or shut out closely, and scenes that are turned.

use crate::closed;
use crate::luxel_side::{Stage, options};
use crate::objs;
use crate::stats::{Mean, assert_agree, assert_mean};
use luxel::trace::TraceOptions;

/// 8 × 8 pixels that see a spot of a thousandth around the target.
fn spot(eye: [f64; 3], target: [f64; 3], vfov: f64) -> String {
    let triple = |[x, y, z]: [f64; 3]| format!("({x:?}, {y:?}, {z:?})");
    format!(
        "camera: (at: {}, look_at: {}, up: (0.1, 1, 0.3), vfov_deg: {vfov:?}), render: (size: (8, 8), filter: Box),",
        triple(eye),
        triple(target)
    )
}

const MATERIALS: &str = r#"materials: {"half": Diffuse(color: Linear(0.5, 0.5, 0.5)), "black": Diffuse(color: Linear(0, 0, 0))},"#;

/// A receiver of side 0.02 around the origin, facing up, albedo 0.5.
const RECEIVER: &str = r#"(shape: Mesh("square.obj"), normals: Flat, material: "half",
    transform: (rotate: Euler(-90, 0, 0), scale: 0.01)),"#;

/// F1: from a lamp that fills half the sky to one of 3e-16 sr, all as bright on the ground.
#[test]
fn lamps_of_any_angle_light_alike() {
    for (k, (theta, s)) in [
        (0.0f64, 0.9999),
        (0.7, 0.5),
        (0.7, 1e-2),
        (1.2, 1e-4),
        (0.3, 1e-6),
        (0.7, 1e-8),
    ]
    .into_iter()
    .enumerate()
    {
        let radiance = 1.0 / (s * s);
        let stage = Stage::new(&format!("catalogue_f1_{k}"))
            .file("square.obj", &objs::square(0.0, 1.0))
            .scene(&format!(
                r#"{} {MATERIALS} entities: [{RECEIVER} (shape: Sphere(radius: {:?}),
                    transform: (translate: ({:?}, {:?}, 0)), emissive: (radiance: ({radiance:?}, {radiance:?}, {radiance:?})))]"#,
                spot([-0.01, 2e-4, 0.002], [0.0; 3], 1e-3),
                4.0 * s,
                4.0 * theta.sin(),
                4.0 * theta.cos(),
            ));
        let picture = stage.luxel(0, 256, &options(1));
        let truth = 0.5 * radiance * closed::sphere_light(theta, s);
        assert_mean(
            &format!("r / d = {s}"),
            picture.whole(0),
            Mean::exact(truth),
            0.02,
        );
    }
}

/// F4: as close to the lamp or to the receiver as 1e-5 of the way. Not one sample may see the lamp.
#[test]
fn close_blockers_leave_nothing() {
    for near in [1e-3, 1e-4, 1e-5] {
        // Close to the lamp, a square that covers it; the camera sees the receiver from aside.
        let lamp = r#"(shape: Mesh("square.obj"), normals: Flat, emissive: (radiance: (1000, 1000, 1000)),
            transform: (translate: (0, 1, 0), rotate: Euler(90, 0, 0), scale: 0.1)),"#;
        let blocker = |y: f64, scale: f64| {
            format!(
                r#"(shape: Mesh("blocker.obj"), normals: Flat, material: "black",
                transform: (translate: (0, {y:?}, 0), rotate: Euler(90, 0, 0), scale: {scale:?})),"#
            )
        };
        let eye = |h: f64| [-10.0 * h, 0.8 * h, 0.0];
        for (name, camera, blocker, dark) in [
            (
                "none",
                spot(eye(1e-2), [0.0; 3], 1e-3),
                String::new(),
                false,
            ),
            (
                "lamp",
                spot(eye(1e-2), [0.0; 3], 1e-3),
                blocker(1.0 - near, 0.2),
                true,
            ),
            (
                "receiver",
                spot(eye(near), [0.0; 3], 1e-3),
                blocker(near, 4.0 * near),
                true,
            ),
        ] {
            let stage = Stage::new(&format!("catalogue_f4_{name}_{near}"))
                .file("square.obj", &objs::square(0.0, 1.0))
                .file("blocker.obj", &objs::square(0.0, 1.0))
                .scene(&format!(
                    "{camera} {MATERIALS} entities: [{RECEIVER} {lamp} {blocker}]"
                ));
            for nee in [true, false] {
                let options = TraceOptions { nee, ..options(1) };
                let sums = stage.sums(0, 256, &options);
                let lit = sums.rgb.iter().filter(|rgb| rgb[0] > 0.0).count();
                assert!(
                    if dark { lit == 0 } else { lit > 0 || !nee },
                    "{name} {near}: {lit} pixels are lit"
                );
            }
        }
    }
}

/// F6: a lamp of R = 1e6 around everything is its radiance, from inside and from outside.
#[test]
fn a_huge_lamp_is_as_bright_as_it_is() {
    for (name, eye, inverted) in [
        ("inside", "(0, 0, 3)", true),
        ("outside", "(0, 0, 2e6)", false),
    ] {
        let stage = Stage::new(&format!("catalogue_f6_{name}")).scene(&format!(
            r#"camera: (at: {eye}, look_at: (0, 0, 0), vfov_deg: 20), render: (size: (8, 8)),
            materials: {{"white": Diffuse(color: Linear(1, 1, 1))}},
            entities: [(shape: Sphere(radius: 1e6, inverted: {inverted}), emissive: (radiance: (0.7, 0.7, 0.7))),
                (shape: Sphere(radius: 0.5), material: "white")]"#
        ));
        let bare = TraceOptions {
            nee: false,
            roulette: false,
            ..options(3)
        };
        let sums = stage.sums(0, 64, &bare);
        let expected = f64::from(0.7f32) * 64.0;
        assert!(sums.rgb.iter().all(|rgb| rgb[0] == expected), "{name}");
    }
}

/// B7: a black ball on a ground that is a sphere of R = 1e6, under a white sky.
#[test]
fn a_ball_shades_a_ground_of_any_radius() {
    for (k, (x, spp)) in [(1.0, 1024), (0.3, 4096), (0.1, 16_384), (0.03, 65_536)]
        .into_iter()
        .enumerate()
    {
        let stage = Stage::new(&format!("catalogue_b7_{k}")).scene(&format!(
            r#"{} {MATERIALS} background: Linear(1, 1, 1), entities: [
                (shape: Sphere(radius: 1e6), material: "half", transform: (translate: (0, -1e6, 0))),
                (shape: Sphere(radius: 1), material: "black", transform: (translate: ({:?}, 1, 0)))]"#,
            spot([0.04, 2e-4, 0.0], [0.0; 3], 1e-3),
            -x
        ));
        let picture = stage.luxel(0, spp, &options(1));
        // The ground bends by x² / 2R = 5e-7 x at most.
        let truth = Mean::exact(0.5 * closed::contact(x, 1.0));
        assert_mean(&format!("x = {x}"), picture.whole(0), truth, 0.05);
    }
}

/// J5: turned by any rotation about any point, a scene looks the same, up to noise.
#[test]
fn turned_scenes_look_the_same() {
    let stage = |k: usize, hub: &str| {
        Stage::new(&format!("catalogue_j5_{k}"))
            .file("cube.obj", &objs::cube(true))
            .file("ball.obj", &objs::smooth_ball())
            .scene(&format!(
                r#"render: (size: (16, 16)), materials: {{"wall": Diffuse(color: Linear(0.7, 0.6, 0.5)), "glass": Glass,
                    "coat": Plastic(color: Linear(0.2, 0.5, 0.8))}},
                entities: [(name: "hub", transform: {hub}),
                    (name: "eye", parent: "hub", camera: (vfov_deg: 60), transform: (translate: (0.1, 0.2, 0.9))),
                    (parent: "hub", shape: Mesh("cube.obj"), normals: Flat, material: "wall"),
                    (parent: "hub", shape: Mesh("ball.obj"), material: "coat", transform: (translate: (0.4, -0.6, -0.2), scale: 0.4)),
                    (parent: "hub", shape: Sphere(radius: 0.3), material: "glass", transform: (translate: (-0.4, -0.6, -0.1))),
                    (parent: "hub", shape: Sphere(radius: 0.2), transform: (translate: (0.3, 0.6, -0.4)), emissive: (radiance: (9, 8, 7)))]"#
            ))
    };
    let picture = |stage: Stage| stage.luxel(0, 1024, &options(5));
    let truth = picture(stage(0, "()"));
    for (k, hub) in [
        "(rotate: Euler(31, 47, 73), translate: (1.1, -2.3, 0.7))",
        "(rotate: AxisAngle(axis: (1, 2, -3), deg: 200), translate: (1234.5, 1e5, -777.7), scale: 0.37)",
    ]
    .into_iter()
    .enumerate()
    {
        assert_agree(&format!("turned {k}"), &picture(stage(k + 1, hub)), &truth, 0.02);
    }
}
