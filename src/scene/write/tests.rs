//! What is written reads back as the same scene, and as a person would write it.

use super::super::{parse, tests::GOOD};
use super::*;
use std::path::Path;

fn read(text: &str) -> SceneDesc {
    match parse(text, Path::new("scene.ron")) {
        Ok((desc, _)) => desc,
        Err(found) => panic!("{text}\n{found:#?}"),
    }
}

/// Everything but places and source; `{:?}` of a number is exact.
fn content(desc: &SceneDesc) -> String {
    let mut desc = desc.clone();
    desc.source = "".into();
    if let BackgroundDesc::Hdr(hdr) = &mut desc.background {
        (hdr.path.at, hdr.path.len) = (0, 0);
    }
    for named in &mut desc.materials {
        (named.at, named.len) = (0, 0);
        let (MaterialDesc::Diffuse { color }
        | MaterialDesc::Mirror { color }
        | MaterialDesc::Glass { color, .. }
        | MaterialDesc::Plastic { color, .. }
        | MaterialDesc::Metal { color, .. }) = &mut named.material;
        forget_path(color);
    }
    for entity in &mut desc.entities {
        (entity.at, entity.len) = (0, 0);
        if let Some(ShapeDesc::Mesh { path, .. }) = &mut entity.value.shape {
            (path.at, path.len) = (0, 0);
        }
        if let Some(gltf) = &mut entity.value.gltf {
            (gltf.path.at, gltf.path.len) = (0, 0);
        }
    }
    format!("{desc:?}")
}

fn forget_path(color: &mut ColorDesc) {
    if let ColorDesc::Image { path, .. } = color {
        (path.at, path.len) = (0, 0);
    }
}

#[track_caller]
fn assert_round_trip(desc: &SceneDesc) -> String {
    let text = write(desc);
    let again = read(&text);
    assert_eq!(content(&again), content(desc), "{text}");
    assert_eq!(write(&again), text, "writing is stable");
    text
}

#[test]
fn the_content_sees_every_change() {
    let desc = read(GOOD);
    for (from, to) in [
        ("55)", "56)"),
        ("0.6)", "0.61)"),
        ("1.5)", "1.6)"),
        ("cat.png", "dog.png"),
        ("cat.obj", "dog.obj"),
        ("material: \"fur\"", "material: \"glass\""),
    ] {
        let other = read(&GOOD.replacen(from, to, 1));
        assert_ne!(content(&other), content(&desc), "{from}");
    }
}

#[test]
fn every_shipped_scene_survives() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("scenes/").flatten() {
        let text = std::fs::read_to_string(entry.path()).expect("text");
        assert_round_trip(&read(&text));
        count += 1;
    }
    assert!(count >= 12, "only {count} scenes");
}

#[test]
fn the_sample_is_written_as_a_person_would() {
    let text = assert_round_trip(&read(GOOD));
    let wanted = r#"Scene(
    version: 1,
    camera: (at: (0, 0, 55), look_at: (0, 0, 0)),
    materials: {
        "chalk":  Diffuse,
        "fur":    Diffuse(color: Texture("../assets/cat.png")),
        "chrome": Mirror,
        "glass":  Glass,
    },
    entities: [
        (name: "lamp",  shape: Sphere(radius: 8), transform: (translate: (-10, 20, 40)), emissive: (radiance: (60, 60, 60))),
        (name: "floor", shape: Sphere(radius: 990), material: "chalk", transform: (translate: (0, -1000, 0))),
        (name: "ball",  shape: Sphere(radius: 10), material: "glass", transform: (translate: (25, 0, 0))),
        (name: "hub",   transform: (translate: (0, -10, 0)), spin: (axis: (0, 1, 0), deg_per_s: 90)),
        (name: "cat",   parent: "hub", shape: Mesh("../assets/cat.obj"), material: "fur", normals: Smooth,
                        transform: (rotate: Euler(0, 45, 0), scale: 0.6)),
        (name: "coin",  shape: Sphere(radius: 1), material: "chrome"),
    ],
    animation: (frames: 0..48),
)
"#;
    assert_eq!(text, wanted);
}

#[test]
fn every_variant_and_awkward_value_survives() {
    assert_round_trip(&read(
        "(version: 1, camera: (at: (0,0,1), look_at: (0,0,0)))",
    ));
    assert_round_trip(&read(
        r##"(version: 1,
        render: (size: (7, 9), spp: 3, max_bounces: 0, filter: Gaussian(radius_px: 2.25)),
        background: Srgb("#7f3a01"),
        materials: {
            "with \"quotes\", \\ and\nlines": Diffuse(color: Srgb("#c0ffee")),
            "": Metal(color: Linear(0.1, 0.30000000000000004, 1e-9)),
            "p": Plastic(color: Linear(0, 0, 0), ior: 1.33),
            "i": Diffuse(color: Image(path: "é ü\t.png", wrap: Mirror, filter: Nearest)),
            "w": Mirror(color: Image(path: "x.png", wrap: Clamp)),
            "g": Glass(ior: 0.667, color: Linear(1, 0.5, 1)),
        },
        entities: [
            (), (name: "only a name"),
            (name: "eye", transform: (translate: (1e-200, -12345678.9, 0.00001), rotate: Quat(0, 0.1, 0, 1)),
                camera: (vfov_deg: 12.5, lens: (aperture_radius: 0.25, focus_distance: 3))),
            (parent: "eye", shape: Sphere(radius: 1e100, inverted: true), emissive: (radiance: (1, 0, 1e18))),
            (parent: "only a name", shape: Mesh("a b.obj"), material: "", normals: Flat,
                transform: (rotate: AxisAngle(axis: (1, 2, 3), deg: 0), scale: (1, -2, 3)),
                spin: (axis: (0, 0, 1), deg_per_s: -7.5, pivot: (0, 0, 0))),
            (gltf: "room.glb"), (gltf: (path: "room.glb", lights: false)), (shape: Mesh(path: "room.glb", mesh: 3)),
            (name: "p", light: Point(intensity: (1, 2, 3))), (name: "s", light: Sun(irradiance: (0, 0.5, 0))),
            (light: Spot(intensity: (1, 1, 1), inner_deg: 12.5, outer_deg: 40)),
            (shape: Mesh("c.obj"), normals: File), (shape: Mesh("d.obj"), normals: Smooth(angle_deg: 30)),
        ],
        animation: (fps: 29.97, frames: 3..9))"##,
    ));
    for sky in [
        r#"Hdr("a sky.hdr")"#,
        r#"Hdr(path: "sky.exr", rotate_deg: -90, strength: 2.5, filter: Nearest)"#,
        r#"Hdr(path: "sky.exr", strength: 0)"#,
    ] {
        let camera = "camera: (at: (0, 0, 1), look_at: (0, 0, 0))";
        let text = format!("(version: 1, {camera}, background: {sky})");
        assert!(assert_round_trip(&read(&text)).contains(sky), "{sky}");
    }
    assert_round_trip(&read(
        "(version: 1, camera: (at: (1, 2, 3), look_at: (0, 0, 0.1), up: (1, 0, 0), vfov_deg: 1e-3,
          lens: (aperture_radius: 0.1)), render: (filter: Box))",
    ));
}

#[test]
fn numbers_are_short_and_exact() {
    for (x, text) in [
        (0.1 + 0.2, "0.30000000000000004"),
        (1000.0, "1000"),
        (1e7, "1e7"),
        (-0.00001, "-1e-5"),
        (0.0001, "0.0001"),
        (f64::MIN_POSITIVE, "2.2250738585072014e-308"),
    ] {
        assert_eq!(number(x), text);
        assert_eq!(number(x).parse(), Ok(x));
    }
}
