//! luxel against the reference: a tiny scene per material, light and lens feature.
//!
//! Welch's test on the mean of each channel, where a bias of half a percent would be seen, and on the four quarters.

use crate::luxel_side::{Stage, options};
use crate::objs;
use crate::reference::Estimator;
use crate::stats::{Picture, Z_BAR, assert_agree};

/// Most that a bias of a picture's mean may be and stay unseen.
const DETECTABLE: f64 = 0.005;

const CAMERA: &str = "camera: (at: (0, 1.2, 4), look_at: (0, 0.6, 0), vfov_deg: 40),";
/// Sees the floor alone, so that no pixel is dark.
const NIGHT_CAMERA: &str = "camera: (at: (0, 2.6, 2.6), look_at: (0, 0.3, 0), vfov_deg: 30),";
const SIZE: &str = "render: (size: (16, 16), filter: Box),";
const SKY: &str = "background: Linear(0.6, 0.8, 1.0),";
const FLOOR: &str = r#"(shape: Mesh("square.obj"), normals: Flat, material: "floor",
    transform: (rotate: Euler(-90, 0, 0), scale: 4)),"#;
const FLOOR_MATERIAL: &str = r#""floor": Diffuse(color: Linear(0.6, 0.5, 0.4)),"#;

/// Samples per pixel of luxel and of the reference, bounces, and whether the reference samples lamps.
struct Effort {
    luxel: u32,
    reference: u32,
    max_bounces: u32,
    lamps: bool,
}

/// Under a sky every path finds light.
const UNDER_SKY: Effort = Effort {
    luxel: 512,
    reference: 480,
    max_bounces: 6,
    lamps: false,
};

/// With lamps alone.
const LAMPLIT: Effort = Effort {
    luxel: 2048,
    reference: 3200,
    max_bounces: 2,
    lamps: true,
};

fn stage(name: &str) -> Stage {
    Stage::new(name)
        .file("square.obj", &objs::square(0.0, 1.0))
        .file("cube.obj", &objs::cube(false))
        .file("room.obj", &objs::cube(true))
        .file("smooth.obj", &objs::smooth_ball())
        .file("fan.obj", &objs::fan(5, 1.0))
}

/// Asserts that both agree; returns the picture of each.
fn agree(name: &str, stage: &Stage, frame: u32, effort: &Effort) -> [Picture; 2] {
    let found = stage.luxel(frame, effort.luxel, &options(effort.max_bounces));
    let estimator = Estimator {
        max_bounces: effort.max_bounces,
        lamps: effort.lamps,
    };
    let truth = stage.reference(frame, effort.reference, estimator);
    assert_agree(name, &found, &truth, DETECTABLE);
    [found, truth]
}

/// A scene under the sky: a floor, and `entities` with `materials`.
fn outdoors(name: &str, materials: &str, entities: &str) {
    let stage = stage(name).scene(&format!(
        "{CAMERA} {SIZE} {SKY} materials: {{{FLOOR_MATERIAL} {materials}}}, entities: [{FLOOR} {entities}]"
    ));
    agree(name, &stage, 0, &UNDER_SKY);
}

/// A ball on the floor under the sky.
fn ball(name: &str, material: &str) {
    let ball =
        r#"(shape: Sphere(radius: 0.8), transform: (translate: (0, 0.8, 0)), material: "it"),"#;
    outdoors(name, &format!(r#""it": {material}"#), ball);
}

/// Dark but for lamps: a floor, and `entities`.
fn at_night(name: &str, entities: &str, effort: &Effort) {
    let stage = stage(name).scene(&format!(
        "{NIGHT_CAMERA} {SIZE} materials: {{{FLOOR_MATERIAL}}}, entities: [{FLOOR} {entities}]"
    ));
    agree(name, &stage, 0, effort);
}

#[test]
fn diffuse() {
    ball("diffuse", "Diffuse(color: Linear(0.8, 0.3, 0.1))");
}

#[test]
fn mirror() {
    ball("mirror", "Mirror(color: Linear(0.9, 0.8, 0.7))");
}

#[test]
fn glass() {
    ball("glass", "Glass(ior: 1.5, color: Linear(0.9, 0.95, 1.0))");
}

#[test]
fn plastic() {
    ball("plastic", "Plastic(color: Linear(0.7, 0.2, 0.1), ior: 1.5)");
}

#[test]
fn metal() {
    ball("metal", "Metal(color: Linear(0.9, 0.6, 0.2))");
}

#[test]
fn hollow_glass() {
    let shells = r#"(shape: Sphere(radius: 0.8), transform: (translate: (0, 0.8, 0)), material: "glass"),
        (shape: Sphere(radius: 0.7, inverted: true), transform: (translate: (0, 0.8, 0)), material: "glass"),"#;
    outdoors("hollow_glass", r#""glass": Glass(ior: 1.5)"#, shells);
}

#[test]
fn a_bubble_of_lesser_index() {
    ball("bubble", "Glass(ior: 0.75)");
}

#[test]
fn a_glass_block() {
    let block = r#"(shape: Mesh("cube.obj"), normals: Flat, material: "glass",
        transform: (translate: (0, 0.9, 0), rotate: Euler(10, 30, 5), scale: (0.5, 0.8, 0.4))),"#;
    outdoors("glass_block", r#""glass": Glass(ior: 1.5)"#, block);
}

#[test]
fn a_textured_quad() {
    let rgb: Vec<u8> = (0..7 * 5 * 3).map(|k| (k * 89 % 256) as u8).collect();
    let stage = stage("textured_quad")
        .file("uv.obj", &objs::square(-0.7, 1.9))
        .png("coat.png", &rgb, 7, 5)
        .scene(&format!(
            r#"{CAMERA} {SIZE} {SKY} materials: {{{FLOOR_MATERIAL} "coat": Diffuse(color: Texture("coat.png"))}},
                entities: [{FLOOR} (shape: Mesh("uv.obj"), normals: Flat, material: "coat",
                transform: (translate: (0, 0.9, 0), rotate: Euler(-15, 25, 40), scale: (0.9, 0.7, 1)))]"#
        ));
    agree("textured quad", &stage, 0, &UNDER_SKY);
}

#[test]
fn a_smooth_mesh() {
    let ball = r#"(shape: Mesh("smooth.obj"), material: "it", transform: (translate: (0, 0.8, 0), scale: 0.8)),"#;
    outdoors(
        "smooth_mesh",
        r#""it": Diffuse(color: Linear(0.7, 0.7, 0.2))"#,
        ball,
    );
}

#[test]
fn a_smooth_mirror() {
    let ball = r#"(shape: Mesh("smooth.obj"), material: "it", transform: (translate: (0, 0.8, 0), scale: (0.8, 0.6, 0.8))),"#;
    outdoors("smooth_mirror", r#""it": Mirror"#, ball);
}

#[test]
fn instances() {
    let entities = r#"(name: "left", shape: Mesh("cube.obj"), normals: Flat, material: "it",
            transform: (translate: (-0.8, 0.6, 0), rotate: Euler(0, 30, 0), scale: (0.3, 0.6, 0.4))),
        (name: "right", shape: Mesh("cube.obj"), normals: Flat, material: "glass",
            transform: (translate: (0.7, 0.5, 0.3), rotate: AxisAngle(axis: (1, 2, 0.5), deg: 50), scale: (-0.4, 0.4, 0.3))),
        (shape: Mesh("smooth.obj"), material: "it", transform: (translate: (0, 1.2, -0.5), scale: (0.5, -0.4, 0.3))),
        (shape: Mesh("smooth.obj"), material: "glass", parent: "left",
            transform: (translate: (0, 1.6, 0), rotate: Quat(0.1, 0.5, -0.2, 0.7), scale: 0.5)),"#;
    outdoors(
        "instances",
        r#""it": Diffuse(color: Linear(0.7, 0.7, 0.2)), "glass": Mirror(color: Linear(0.9, 0.9, 0.9))"#,
        entities,
    );
}

#[test]
fn a_turning_mesh() {
    let stage = stage("turning").scene(&format!(
        r#"{CAMERA} {SIZE} {SKY} materials: {{{FLOOR_MATERIAL} "it": Diffuse(color: Linear(0.7, 0.2, 0.2))}},
            entities: [{FLOOR} (name: "hub", transform: (translate: (0.2, 0.7, 0)), spin: (axis: (0, 1, 0), deg_per_s: 90)),
            (shape: Mesh("cube.obj"), parent: "hub", normals: Flat, material: "it",
                spin: (axis: (1, 0, 1), deg_per_s: -120, pivot: (0.3, 0, 0)),
                transform: (translate: (0.6, 0, 0), rotate: Euler(0, 20, 10), scale: (0.3, 0.5, 0.4)))],
            animation: (fps: 24, frames: 0..48)"#
    ));
    agree("turning, frame 17", &stage, 17, &UNDER_SKY);
}

#[test]
fn a_thin_lens() {
    let stage = stage("thin_lens").scene(&format!(
        r#"camera: (at: (0, 1.2, 4), look_at: (0, 0.6, 0), vfov_deg: 40, lens: (aperture_radius: 0.3, focus_distance: 2.5)),
            {SIZE} {SKY} materials: {{{FLOOR_MATERIAL} "it": Diffuse(color: Linear(0.1, 0.3, 0.8))}},
            entities: [{FLOOR} (shape: Sphere(radius: 0.5), transform: (translate: (-0.3, 0.5, 1)), material: "it"),
                (shape: Sphere(radius: 0.6), transform: (translate: (0.6, 0.6, -1)))]"#
    ));
    agree("thin lens", &stage, 0, &UNDER_SKY);
}

/// The whole mean hardly knows the filter; a bright disc a few pixels wide, and its quarters, do. Sharper: pixel by
/// pixel, below.
#[test]
fn a_gaussian_filter() {
    let stage = stage("gaussian").scene(
        r#"camera: (at: (0, 0, 4), look_at: (0, 0, 0), vfov_deg: 24), render: (size: (8, 8), filter: Gaussian(radius_px: 1.5)),
            entities: [(shape: Sphere(radius: 0.5), transform: (translate: (0.2, 0.1, 0)), emissive: (radiance: (1, 2, 3)))]"#,
    );
    let effort = Effort {
        luxel: 4096,
        reference: 32_000,
        max_bounces: 0,
        lamps: false,
    };
    let [found, truth] = agree("gaussian", &stage, 0, &effort);
    for pixel in 0..64 {
        let only = |x: usize, y: usize| y * 8 + x == pixel;
        let (z, _) = found.mean(0, only).against(truth.mean(0, only));
        assert!(z < Z_BAR, "pixel {pixel}: z {z:.2}");
    }
}

#[test]
fn a_room_with_a_lamp() {
    let stage = stage("room").scene(&format!(
        r#"camera: (at: (0, 0, 0.9), look_at: (0, -0.1, 0), vfov_deg: 80), {SIZE}
            materials: {{"wall": Diffuse(color: Linear(0.7, 0.5, 0.3))}},
            entities: [(shape: Mesh("room.obj"), normals: Flat, material: "wall"),
                (shape: Sphere(radius: 0.4), transform: (translate: (0.3, -0.6, -0.3)), material: "wall"),
                (shape: Sphere(radius: 0.25), transform: (translate: (-0.2, 0.5, -0.1)), emissive: (radiance: (5, 5, 5)))]"#
    ));
    agree("room", &stage, 0, &LAMPLIT);
}

#[test]
fn an_emitting_mesh() {
    let lamp = r#"(shape: Mesh("fan.obj"), normals: Flat, transform: (translate: (0.2, 2, 0), rotate: Euler(170, 0, 20), scale: (0.9, 1, 0.6)),
        emissive: (radiance: (3, 4, 5))), (shape: Sphere(radius: 0.5), transform: (translate: (0, 0.5, 0))),"#;
    let effort = Effort {
        luxel: 3072,
        reference: 4800,
        ..LAMPLIT
    };
    at_night("emitting_mesh", lamp, &effort);
}

/// One emitting mesh in three places, twice mirrored: each shines from the image of its outside alone.
#[test]
fn mirrored_lamps() {
    let lamps = r#"(shape: Mesh("fan.obj"), normals: Flat, transform: (translate: (-0.8, 1.8, 0), rotate: Euler(170, 0, 20), scale: (0.6, 1, 0.6)),
            emissive: (radiance: (3, 4, 5))),
        (shape: Mesh("fan.obj"), normals: Flat, transform: (translate: (0.8, 1.7, 0.2), rotate: Euler(10, 0, -15), scale: (0.5, -1, 0.7)),
            emissive: (radiance: (5, 4, 3))),
        (shape: Mesh("fan.obj"), normals: Flat, transform: (translate: (0, 1.9, -0.6), rotate: Euler(190, 0, 5), scale: (-0.5, 1, 0.4)),
            emissive: (radiance: (6, 5, 5))),"#;
    let effort = Effort {
        luxel: 1024,
        reference: 960,
        ..LAMPLIT
    };
    at_night("mirrored_lamps", lamps, &effort);
}

#[test]
fn two_lamps() {
    let lamps = r#"(shape: Sphere(radius: 0.5), transform: (translate: (-1, 2.2, 0)), emissive: (radiance: (4, 3, 2))),
        (shape: Sphere(radius: 0.3), transform: (translate: (1, 1.6, 0.2)), material: "floor", emissive: (radiance: (2, 3, 4))),"#;
    at_night("two_lamps", lamps, &LAMPLIT);
}

#[test]
fn plastic_under_a_lamp() {
    let stage = stage("plastic_lamp").scene(&format!(
        r#"{NIGHT_CAMERA} {SIZE} materials: {{{FLOOR_MATERIAL} "coat": Plastic(color: Linear(0.8, 0.7, 0.6), ior: 1.6)}},
            entities: [{FLOOR} (shape: Sphere(radius: 0.7), transform: (translate: (0, 0.7, 0)), material: "coat"),
                (shape: Sphere(radius: 1.3), transform: (translate: (-2, 3.4, 0.5)), emissive: (radiance: (1.5, 1.5, 1.5)))]"#
    ));
    // Direct light alone: the coat's caustics on the floor are too rare for the reference.
    let effort = Effort {
        max_bounces: 1,
        luxel: 4096,
        reference: 6400,
        ..LAMPLIT
    };
    agree("plastic under a lamp", &stage, 0, &effort);
}

#[test]
fn an_inverted_lamp_around_everything() {
    let dome = r#"(shape: Sphere(radius: 9, inverted: true), emissive: (radiance: (0.5, 0.7, 0.9))),
        (shape: Sphere(radius: 0.7), transform: (translate: (0, 0.7, 0))),"#;
    let effort = Effort {
        lamps: false,
        ..UNDER_SKY
    };
    at_night("inverted_lamp", dome, &effort);
}

#[test]
fn a_textured_sphere() {
    let rgb: Vec<u8> = (0..7 * 5 * 3).map(|k| (k * 89 % 256) as u8).collect();
    let stage = stage("textured_sphere").png("coat.png", &rgb, 7, 5).scene(&format!(
        r#"{CAMERA} {SIZE} {SKY} materials: {{{FLOOR_MATERIAL} "coat": Diffuse(color: Texture("coat.png"))}},
            entities: [{FLOOR} (name: "hub", transform: (translate: (0.2, 0.8, 0), rotate: Euler(20, 0, -35))),
                (shape: Sphere(radius: 0.4), material: "coat", parent: "hub",
                transform: (rotate: Euler(-15, 130, 40), scale: 2))]"#
    ));
    agree("textured sphere", &stage, 0, &UNDER_SKY);
}

/// The camera of an entity: its parents carry it, and its spin turns it.
#[test]
fn a_carried_camera() {
    let stage = stage("carried_camera").scene(&format!(
        r#"{SIZE} {SKY} materials: {{{FLOOR_MATERIAL} "it": Diffuse(color: Linear(0.7, 0.2, 0.2))}},
            entities: [{FLOOR} (name: "arm", transform: (translate: (0.3, 0.9, 0), rotate: Euler(0, 20, 0), scale: (2, 2, 2)),
                    spin: (axis: (0, 1, 0), deg_per_s: 30)),
                (parent: "arm", transform: (translate: (0, 0.3, 2), rotate: Euler(-12, 5, 25)),
                    spin: (axis: (0, 0, 1), deg_per_s: -60, pivot: (0.1, 0.2, 2)), camera: (vfov_deg: 45)),
                (shape: Mesh("cube.obj"), normals: Flat, material: "it",
                    transform: (translate: (0.2, 0.6, 0), rotate: Euler(0, 20, 10), scale: (0.3, 0.5, 0.4)))],
            animation: (fps: 24, frames: 0..48)"#
    ));
    agree("carried camera, frame 11", &stage, 11, &UNDER_SKY);
}
