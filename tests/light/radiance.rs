//! Closed-form radiance: luxel against formulas, by every estimator that it has.

use crate::closed;
use crate::luxel_side::{Stage, options};
use crate::objs;
use crate::stats::{Mean, Picture, assert_mean};
use luxel::trace::TraceOptions;

/// Most that a bias may be and stay unseen.
const DETECTABLE: f64 = 0.01;

/// The estimators: by chance alone, by light samples alone, and both weighed.
const ESTIMATORS: [(&str, bool, bool); 3] = [
    ("bsdf", false, false),
    ("nee", true, false),
    ("mis", true, true),
];

/// Renders by each estimator and compares the mean with `truth`. `spp` is by chance and with light samples.
fn by_all_estimators(name: &str, stage: &Stage, max_bounces: u32, spp: [u32; 2], truth: f64) {
    for (kind, nee, mis) in ESTIMATORS {
        let options = TraceOptions {
            nee,
            mis,
            ..options(max_bounces)
        };
        let picture = stage.luxel(0, spp[usize::from(nee)], &options);
        for channel in 0..3 {
            let name = format!("{name}, {kind}, channel {channel}");
            assert_mean(
                &name,
                picture.whole(channel),
                Mean::exact(truth),
                DETECTABLE,
            );
        }
    }
}

/// 8 × 8 pixels that see almost nothing but `target`.
fn spot(eye: [f64; 3], target: [f64; 3]) -> String {
    format!(
        "camera: (at: {}, look_at: {}, up: (0.1, 1, 0.3), vfov_deg: 0.01), render: (size: (8, 8), filter: Box),",
        triple(eye),
        triple(target)
    )
}

fn triple([x, y, z]: [f64; 3]) -> String {
    format!("({x}, {y}, {z})")
}

/// A receiver of side 0.02 around the origin, facing up, albedo 0.5.
const RECEIVER: &str = r#"(shape: Mesh("square.obj"), normals: Flat, material: "half",
    transform: (rotate: Euler(-90, 0, 0), scale: 0.01)),"#;

const HALF: &str = r#"materials: {"half": Diffuse(color: Linear(0.5, 0.5, 0.5)),
    "black": Diffuse(color: Linear(0, 0, 0)), "wall": Diffuse(color: Linear(0.7, 0.7, 0.7)),
    "inner": Diffuse(color: Linear(0.3, 0.3, 0.3)), "outer": Diffuse(color: Linear(0.8, 0.8, 0.8)),
    "glass": Glass(ior: 1.5)},"#;

#[test]
fn a_sphere_lights_a_plane() {
    for (k, (theta, s)) in [(0.7f64, 0.5), (1.2, 0.9), (1.7, 0.5)]
        .into_iter()
        .enumerate()
    {
        let lamp = [4.0 * theta.sin(), 4.0 * theta.cos(), 0.0];
        let stage = Stage::new(&format!("sphere_light_{k}"))
            .file("square.obj", &objs::square(0.0, 1.0))
            .scene(&format!(
                r#"{} {HALF} entities: [{RECEIVER} (shape: Sphere(radius: {}),
                    transform: (translate: {}), emissive: (radiance: (2, 2, 2)))]"#,
                spot([-0.4, 0.3, 0.1], [0.0; 3]),
                4.0 * s,
                triple(lamp)
            ));
        let truth = 2.0 * 0.5 * closed::sphere_light(theta, s);
        let spp = [[2048, 512], [2048, 1024], [32_768, 4096]][k];
        by_all_estimators(&format!("sphere light {k}"), &stage, 1, spp, truth);
    }
}

#[test]
fn a_disc_of_triangles_lights_a_plane() {
    // With equal areas the polygon's error falls with the fourth power of its sides.
    const SIDES: u32 = 64;
    let (x, h, r) = (0.8, 1.3, 0.6);
    let stage = Stage::new("disc_light")
        .file("square.obj", &objs::square(0.0, 1.0))
        .file("disc.obj", &objs::fan(SIDES, objs::equal_area(SIDES, r)))
        .scene(&format!(
            r#"{} {HALF} entities: [{RECEIVER} (shape: Mesh("disc.obj"), normals: Flat,
                transform: (translate: ({x}, {h}, 0), rotate: Euler(180, 0, 0)), emissive: (radiance: (3, 3, 3)))]"#,
            spot([-0.4, 0.3, 0.1], [0.0; 3]),
        ));
    let truth = 3.0 * 0.5 * closed::disc_light(x, h, r);
    by_all_estimators("disc light", &stage, 1, [8192, 1024], truth);
}

#[test]
fn a_ball_shades_the_plane_it_rests_on() {
    let x = 0.3;
    let stage = Stage::new("contact")
        .file("square.obj", &objs::square(0.0, 1.0))
        .scene(&format!(
            r#"{} {HALF} background: Linear(1, 1, 1), entities: [{RECEIVER} (shape: Sphere(radius: 1),
                transform: (translate: ({}, 1, 0)), material: "black")]"#,
            spot([3.0, 0.9, 0.0], [0.0; 3]),
            -x
        ));
    let picture = stage.luxel(0, 8192, &options(1));
    let truth = 0.5 * closed::contact(x, 1.0);
    assert_mean("contact", picture.whole(0), Mean::exact(truth), DETECTABLE);
}

#[test]
fn an_emitting_room_multiplies_its_light() {
    let stage = Stage::new("emitting_room").scene(&format!(
        r#"{} {HALF} entities: [(shape: Sphere(radius: 2, inverted: true), material: "half",
            emissive: (radiance: (1, 1, 1)))]"#,
        spot([0.3, 0.2, 0.1], [1.0, 0.7, 0.2])
    ));
    let truth = closed::furnace(0.5, 7);
    by_all_estimators("emitting room", &stage, 7, [2048, 2048], truth);
}

/// The series with roulette on: a third of the light comes after it has begun.
#[test]
fn roulette_keeps_what_it_ends() {
    let stage = Stage::new("roulette").scene(&format!(
        r#"{} {HALF} entities: [(shape: Sphere(radius: 2, inverted: true), material: "outer",
            emissive: (radiance: (1, 1, 1)))]"#,
        spot([0.3, 0.2, 0.1], [1.0, 0.7, 0.2])
    ));
    let options = TraceOptions {
        nee: false,
        ..options(60)
    };
    let picture = stage.luxel(0, 8192, &options);
    let truth = Mean::exact(closed::furnace(0.8, 60));
    assert_mean("roulette", picture.whole(0), truth, DETECTABLE / 2.0);
}

#[test]
fn an_integrating_sphere_is_lit_evenly() {
    // The disc on the rim of the cap covers what the cap would. Its inscribed polygon is 2π²/3n² too small.
    const SIDES: u32 = 256;
    let (share, emission, albedo) = (0.1, 5.0, 0.7);
    let height = 2.0 * share;
    let rim = (1.0 - (1.0f64 - height).powi(2)).sqrt();
    let stage = Stage::new("integrating_sphere")
        .file("disc.obj", &objs::fan(SIDES, rim))
        .scene(&format!(
            r#"{} {HALF} entities: [(shape: Sphere(radius: 1, inverted: true), material: "wall"),
                (shape: Mesh("disc.obj"), normals: Flat, transform: (translate: (0, {}, 0)),
                 emissive: (radiance: ({emission}, {emission}, {emission})))]"#,
            spot([0.2, 0.1, 0.0], [-0.9, 0.2, 0.3]),
            height - 1.0
        ));
    let truth = closed::integrating_sphere(share, emission, albedo);
    by_all_estimators("integrating sphere", &stage, 60, [8192, 3072], truth);
}

#[test]
fn concentric_spheres_exchange_light() {
    let stage = |name: &str, target: [f64; 3]| {
        Stage::new(name).scene(&format!(
            r#"{} {HALF} entities: [(shape: Sphere(radius: 2, inverted: true), material: "outer"),
                (shape: Sphere(radius: 1), material: "inner", emissive: (radiance: (1, 1, 1)))]"#,
            spot([0.0, 0.0, 1.5], target)
        ))
    };
    let (inner, outer) = closed::concentric(0.5, 1.0, 0.3, 0.8);
    let spp = [2048, 2048];
    by_all_estimators("outer", &stage("outer", [0.5, 0.3, 4.0]), 60, spp, outer);
    by_all_estimators("inner", &stage("inner", [0.0; 3]), 60, spp, inner);
}

#[test]
fn a_slab_transmits_what_its_faces_let_through() {
    for deg in [0.0f64, 30.0, 60.0, 80.0] {
        let (sin, cos) = deg.to_radians().sin_cos();
        let stage = Stage::new(&format!("slab_{deg}"))
            .file("cube.obj", &objs::cube(false))
            .file("square.obj", &objs::square(0.0, 1.0))
            .scene(&format!(
                r#"{} {HALF} entities: [(shape: Mesh("cube.obj"), normals: Flat, material: "glass",
                    transform: (scale: (60, 60, 0.05))), (shape: Mesh("square.obj"), normals: Flat,
                    transform: (translate: (0, 0, -1), scale: 60), emissive: (radiance: (1, 1, 1)))]"#,
                spot([3.0 * sin, 0.01, 3.0 * cos], [0.0, 0.013, 0.0])
            ));
        let picture = stage.luxel(0, 2048, &options(60));
        let truth = Mean::exact(closed::slab(deg, 1.5));
        assert_mean(
            &format!("slab at {deg}°"),
            picture.whole(0),
            truth,
            DETECTABLE,
        );
    }
}

#[test]
fn a_point_out_of_focus_blurs_to_a_disc() {
    const SIDE: u32 = 64;
    let (aperture, focus, z, lamp) = (0.05, 4.0f64, 6.5, 0.008);
    // The picture is 0.08 wide on the focal plane.
    let half: f64 = 0.04;
    let vfov = 2.0 * (half / focus).atan().to_degrees();
    let scene = |aperture: f64| {
        format!(
            r#"camera: (at: (0, 0, 0), look_at: (0, 0, -1), vfov_deg: {vfov},
                lens: (aperture_radius: {aperture}, focus_distance: {focus})),
               render: (size: ({SIDE}, {SIDE}), filter: Box), entities: [(shape: Sphere(radius: {lamp}),
                transform: (translate: (0, 0, -{z})), emissive: (radiance: (1, 1, 1)))]"#
        )
    };
    let stage = Stage::new("blur").scene(&scene(aperture));
    let picture = stage.luxel(0, 512, &options(0));
    let pixel = 2.0 * half / f64::from(SIDE);
    // A disc's mean square radius is half its squared radius: of the blur, of the lamp; a pixel adds its own.
    let c = closed::blur(aperture, focus, z);
    let image = lamp / z * focus;
    let truth = (c * c + image * image) / 2.0 + pixel * pixel / 6.0;
    let found = mean_square_radius(&picture, pixel);
    assert_mean(
        "mean square of the blur",
        found,
        Mean::exact(truth),
        2.0 * DETECTABLE,
    );

    let sharp = Stage::new("sharp")
        .scene(&scene(0.0))
        .luxel(0, 512, &options(0));
    assert_mean(
        "energy of the blur",
        picture.whole(0),
        sharp.whole(0),
        3.0 * DETECTABLE,
    );
}

/// Σ w r² / Σ w about the middle, with its standard error by linearisation.
fn mean_square_radius(picture: &Picture, pixel: f64) -> Mean {
    let r2 = |i: usize| {
        let x = (i % picture.width) as f64 + 0.5 - picture.width as f64 / 2.0;
        let y = (i / picture.width) as f64 + 0.5 - picture.height as f64 / 2.0;
        (x * x + y * y) * pixel * pixel
    };
    let pixels: Vec<(f64, f64, f64)> = (0..picture.count.len())
        .map(|i| (r2(i), picture.pixel(i, 0).0, picture.pixel(i, 0).1))
        .collect();
    let total: f64 = pixels.iter().map(|(_, w, _)| w).sum();
    let value = pixels.iter().map(|(r, w, _)| r * w).sum::<f64>() / total;
    let variance: f64 = pixels.iter().map(|(r, _, v)| (r - value).powi(2) * v).sum();
    Mean {
        value,
        error: variance.sqrt() / total,
    }
}
