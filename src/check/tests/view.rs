//! The camera: inside of what, what it sees, how sharp, under which angles.

use super::*;
use std::f64::consts::{FRAC_PI_3, FRAC_PI_6};

#[test]
fn the_camera_is_inside_a_mesh() {
    let camera = "camera: (at: (0.2, 0, 0.5), look_at: (0, 0, 0)),";
    let body = format!("{camera} {LIT} entities: [(name: \"box\", shape: Mesh(\"cube.obj\"))]");
    let said = expect("inside", &body, &["W301"]);
    assert!(said.contains("inside the mesh \"box\""), "{said}");
    // Turned and mirrored it is the same.
    let body = format!(
        "{camera} {LIT} entities: [(shape: Mesh(\"cube.obj\"), transform: (rotate: Euler(10, 50, 20), scale: (-1, 2, 1)))]"
    );
    expect("mirrored", &body, &["W301"]);
    // A corner of the box that the cube does not fill.
    let body = format!(
        "camera: (at: (1.3, 1.3, 0), look_at: (0, 0, 0)), {LIT}
         entities: [(shape: Mesh(\"cube.obj\"), transform: (rotate: Euler(0, 0, 45)))]"
    );
    expect("corner", &body, &[]);
    // Rooms: faces that look inward, and walls around other things.
    let body = format!("{camera} {LIT} entities: [(shape: Mesh(\"room.obj\"))]");
    expect("room", &body, &[]);
    let body = format!(
        "{camera} {LIT} entities: [(shape: Mesh(\"cube.obj\"), transform: (scale: 9)),
         (shape: Sphere(radius: 0.2))]"
    );
    expect("furnished", &body, &[]);
}

#[test]
fn the_camera_is_inside_a_sphere() {
    let camera = "camera: (at: (0, 0, 1), look_at: (0, 0, -3)),";
    let with = |spheres: &str| {
        format!(
            "{camera} {LIT} materials: {{\"glass\": Glass, \"chalk\": Diffuse}},
             entities: [(shape: Sphere(radius: 0.1), transform: (translate: (0, 0, -9)), material: \"glass\"),
             (shape: Sphere(radius: 0.1), transform: (translate: (1, 0, -9)), material: \"chalk\"), {spheres}]"
        )
    };
    let ball = with("(name: \"ball\", shape: Sphere(radius: 3), material: \"glass\")");
    let said = expect("ball", &ball, &["W301"]);
    assert!(said.contains("inside the sphere \"ball\""), "{said}");
    expect(
        "chalk",
        &with("(shape: Sphere(radius: 3), material: \"chalk\")"),
        &["W301"],
    );
    // The air inside a hollow ball; a dome around everything.
    let hollow = "(shape: Sphere(radius: 3), material: \"glass\"),
                  (shape: Sphere(radius: 2.9, inverted: true), material: \"glass\")";
    expect("hollow", &with(hollow), &[]);
    expect(
        "dome",
        &with("(shape: Sphere(radius: 50), material: \"chalk\")"),
        &[],
    );
    let sky = |inverted: bool| {
        with(&format!(
            "(shape: Sphere(radius: 50, inverted: {inverted}), emissive: (radiance: (1, 1, 1)))"
        ))
    };
    let said = expect("sky", &sky(false), &["W301"]);
    assert!(said.contains("inverted: true"), "{said}");
    expect("inverted", &sky(true), &[]);
}

#[test]
fn nothing_is_in_view() {
    let body = format!(
        "camera: (at: (0, 0, 10), look_at: (0, 0, 20)), {LIT} entities: [(name: \"box\", shape: Mesh(\"cube.obj\"))]"
    );
    let said = expect("behind", &body, &["W302"]);
    assert!(
        said.contains("\"box\", is 10 units behind the camera"),
        "{said}"
    );
    assert!(said.contains("look_at: (0, 0, 0)"), "{said}");
    let body = format!(
        "camera: (at: (0, 0, 10), look_at: (20, 0, 0)), {LIT} entities: [(shape: Sphere(radius: 1))]"
    );
    let said = expect("aside", &body, &["W302"]);
    assert!(said.contains("10 units away, 63° off"), "{said}");
    let said = expect("empty", &format!("{CAMERA} {LIT}"), &["W302"]);
    assert!(said.contains("no shape"), "{said}");
    // What comes into view later is no mistake.
    let body = format!(
        "camera: (at: (0, 0, 10), look_at: (0, 0, 20)), {LIT} animation: (frames: 0..48),
         entities: [(shape: Sphere(radius: 1), spin: (axis: (0, 1, 0), deg_per_s: 90, pivot: (0, 0, 10)))]"
    );
    expect("later", &body, &[]);
}

#[test]
fn the_scene_is_smaller_than_a_pixel() {
    let body = format!(
        "camera: (at: (0, 0, 9000), look_at: (0, 0, 0)), {LIT} entities: [(shape: Sphere(radius: 1))]"
    );
    let said = expect("far", &body, &["W303"]);
    // 2 units at 9000, of which 512 pixels of 60° cover 2 · 9000 · tan 30°.
    assert!(said.contains("0.0985 of a pixel"), "{said}");
    let body = format!(
        "camera: (at: (0, 0, 800), look_at: (0, 0, 0)), {LIT} entities: [(shape: Sphere(radius: 1))]"
    );
    expect("near", &body, &[]);
}

#[test]
fn the_lens_blurs_everything() {
    let body = |lens: &str| {
        format!(
            "camera: (at: (0, 0, 90), look_at: (0, 0, 0), lens: ({lens})), {LIT}
             entities: [(shape: Mesh(\"cube.obj\"), transform: (scale: 20))]"
        )
    };
    expect(
        "blur",
        &body("aperture_radius: 2, focus_distance: 1"),
        &["W306"],
    );
    expect(
        "sharp",
        &body("aperture_radius: 2, focus_distance: 90"),
        &[],
    );
    expect("soft", &body("aperture_radius: 2, focus_distance: 60"), &[]);
}

#[test]
fn angles_in_radians() {
    let body = |vfov: f64, at: f64, rotate: &str| {
        format!(
            "camera: (at: (0, 0, {at}), look_at: (0, 0, 0), vfov_deg: {vfov}), {LIT}
             entities: [(shape: Mesh(\"cube.obj\"), transform: (rotate: {rotate}))]"
        )
    };
    let none = "Euler(0, 0, 0)";
    let said = expect("vfov", &body(FRAC_PI_3, 5.0, none), &["W307"]);
    assert!(said.contains("60 degrees"), "{said}");
    expect("tele", &body(2.0, 100.0, none), &[]);
    let said = expect("euler", &body(40.0, 5.0, "Euler(0, 1.5708, 0)"), &["W307"]);
    assert!(said.contains("1.5708 radians are 90 degrees"), "{said}");
    expect(
        "axis",
        &body(40.0, 5.0, "AxisAngle(axis: (0, 1, 0), deg: 0.785)"),
        &["W307"],
    );
    for (i, rotate) in [
        "Euler(0, 1.5, 0)",
        "Euler(3.14159, 45, 0)",
        "Euler(2, 3, 5)",
    ]
    .iter()
    .enumerate()
    {
        expect(&format!("deg{i}"), &body(40.0, 5.0, rotate), &[]);
    }
    let spot = |outer: f64| {
        format!(
            "{CAMERA} {LIT} entities: [(shape: Sphere(radius: 1)),
             (light: Spot(intensity: (9, 9, 9), inner_deg: 0.1, outer_deg: {outer}), transform: (translate: (0, 0, 5)))]"
        )
    };
    expect("spot", &spot(FRAC_PI_6), &["W307"]);
    expect("spot2", &spot(30.0), &[]);
}
