//! Every warning fires where it should and is silent where it should be.

use super::*;
use crate::asset::Loader;
use crate::scene;
use crate::world::spawn;
use std::path::{Path, PathBuf};

mod size;
mod view;

/// A folder of files that goes with the test.
struct Folder(PathBuf);

impl Folder {
    fn of(name: &str, files: &[(&str, String)]) -> Folder {
        let folder =
            std::env::temp_dir().join(format!("luxel-check-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("the temporary folder is writable");
        for (name, text) in files {
            std::fs::write(folder.join(name), text).expect("the temporary folder is writable");
        }
        Folder(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder left behind harms nobody.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A cube from −1 to 1, counter-clockwise seen from outside, in the places of `v`.
fn cube(v: impl Fn(f64) -> f64) -> String {
    let mut text = String::new();
    for i in 0..8 {
        let side = |bit: i32| v(f64::from(2 * (i >> bit & 1) - 1));
        text += &format!("v {} {} {}\n", side(0), side(1), side(2));
    }
    text + "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n"
}

const LIT: &str = "background: Linear(1, 1, 1),";

/// All that is said of a scene beside a unit cube (`cube.obj`), one of 2000 units (`huge.obj`), one of 0.002
/// (`tiny.obj`) and one whose faces look inward (`room.obj`).
fn said(name: &str, body: &str) -> Vec<Diagnostic> {
    let room: String = cube(|x| 10.0 * x)
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            Some(face) => {
                let corners: Vec<&str> = face.split(' ').rev().collect();
                format!("f {}\n", corners.join(" "))
            }
            None => format!("{line}\n"),
        })
        .collect();
    let folder = Folder::of(
        name,
        &[
            ("cube.obj", cube(|x| x)),
            ("huge.obj", cube(|x| 1000.0 * x + 1800.0)),
            ("tiny.obj", cube(|x| 0.0005 * x)),
            ("room.obj", room),
        ],
    );
    let text = format!("(version: 1,\n{body})");
    let file = folder.0.join("scene.ron");
    let (desc, mut found) = scene::parse(&text, &file).expect("the scene reads");
    found.extend(check(&desc));
    let spawned = spawn(&desc, Loader::new()).expect("the files load");
    found.extend(check_world(&desc, &spawned.world, &spawned.assets));
    for one in &found {
        assert!(one.hint.is_some(), "no remedy: {one}");
        assert!(one.span.is_some() || one.code == "W001", "no place: {one}");
    }
    found
}

fn codes_of(found: &[Diagnostic]) -> Vec<&'static str> {
    found.iter().map(|d| d.code).collect()
}

/// Asserts the codes of a scene, and gives the first message.
#[track_caller]
fn expect(name: &str, body: &str, codes: &[&str]) -> String {
    let found = said(name, body);
    assert_eq!(codes_of(&found), codes, "{found:#?}");
    found.first().map(ToString::to_string).unwrap_or_default()
}

const CAMERA: &str = "camera: (at: (0, 0, 10), look_at: (0, 0, 0)),";

#[test]
fn a_plain_scene_is_silent() {
    for (i, shape) in ["Mesh(\"cube.obj\")", "Sphere(radius: 1)"]
        .iter()
        .enumerate()
    {
        let body = format!("{CAMERA} {LIT} entities: [(shape: {shape})]");
        expect(&format!("plain{i}"), &body, &[]);
    }
}

#[test]
fn nothing_shines() {
    let body = format!("{CAMERA} entities: [(shape: Mesh(\"cube.obj\"))]");
    expect("dark", &body, &["W001"]);
    let body = format!(
        "{CAMERA} entities: [(shape: Mesh(\"cube.obj\")), (light: Point(intensity: (0, 0, 0)))]"
    );
    expect("dark2", &body, &["W001"]);
    let body = format!(
        "{CAMERA} entities: [(shape: Mesh(\"cube.obj\"), emissive: (radiance: (1, 1, 1)))]"
    );
    expect("lit", &body, &[]);
    let body = format!(
        "{CAMERA} entities: [(shape: Mesh(\"cube.obj\")), (light: Sun(irradiance: (3, 3, 3)))]"
    );
    expect("sun", &body, &[]);
}

#[test]
fn a_file_shines_where_the_scene_lets_it() {
    let mtl = "newmtl a\nKd 0 0 0\nKe 5 5 5\nnewmtl b\nKd 1 1 1\n".to_owned();
    let cube = |used: &str| format!("mtllib m.mtl\nusemtl {used}\n{}", cube(|x| x));
    let folder = Folder::of(
        "shines",
        &[("m.mtl", mtl), ("a.obj", cube("a")), ("b.obj", cube("b"))],
    );
    let found = |entity: &str| {
        let text =
            format!("(version: 1, {CAMERA} materials: {{\"m\": Mirror}}, entities: [{entity}])");
        let file = folder.0.join("scene.ron");
        let (desc, _) = scene::parse(&text, &file).expect("the scene reads");
        let spawned = spawn(&desc, Loader::new()).expect("the files load");
        codes_of(&check_world(&desc, &spawned.world, &spawned.assets))
    };
    assert_eq!(found("(shape: Mesh(\"a.obj\"))"), Vec::<&str>::new());
    assert_eq!(found("(shape: Mesh(\"b.obj\"))"), ["W001"]);
    assert_eq!(found("(shape: Mesh(\"a.obj\"), material: \"m\")"), ["W001"]);
    assert_eq!(
        found("(shape: Mesh(\"a.obj\"), emissive: (radiance: (0, 0, 0)))"),
        ["W001"]
    );
}

#[test]
fn lights_in_other_units() {
    let body = |light: &str| {
        format!(
            "{CAMERA} entities: [(shape: Sphere(radius: 1)),
             (light: {light}, transform: (translate: (0, 10, 0)))]"
        )
    };
    // White paper 10 away under I W/sr: I / 100 π.
    let said = expect(
        "candela",
        &body("Point(intensity: (1e6, 1e6, 1e6))"),
        &["W308"],
    );
    assert!(
        said.contains("3.2e3") && said.contains("--exposure -13"),
        "{said}"
    );
    expect(
        "weak",
        &body("Point(intensity: (1e-3, 1e-3, 1e-3))"),
        &["W308"],
    );
    expect("right", &body("Point(intensity: (300, 300, 300))"), &[]);
    expect(
        "lux",
        &body("Sun(irradiance: (100000, 100000, 100000))"),
        &["W308"],
    );
    expect("sunny", &body("Sun(irradiance: (1000, 1000, 1000))"), &[]);
}

#[test]
fn shipped_scenes_are_silent() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut checked = 0;
    for entry in std::fs::read_dir(folder).expect("the folder of scenes") {
        let path = entry.expect("an entry").path();
        let loaded = scene::load(&path).expect("a shipped scene reads");
        let mut found = loaded.warnings;
        found.extend(check(&loaded.desc));
        let spawned = spawn(&loaded.desc, Loader::new()).expect("its files load");
        found.extend(check_world(&loaded.desc, &spawned.world, &spawned.assets));
        found.extend(spawned.warnings);
        assert_eq!(found, [], "{}", path.display());
        checked += 1;
    }
    assert!(checked >= 10, "{checked}");
}

#[test]
fn a_gltf_file_that_brings_nothing_is_told_of_once() {
    let text = "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{}]}".to_owned();
    let folder = Folder::of("nothing", &[("a.gltf", text)]);
    let text = format!("(version: 1, {CAMERA} {LIT} entities: [(gltf: \"a.gltf\")])");
    let (desc, _) = scene::parse(&text, &folder.0.join("scene.ron")).expect("the scene reads");
    let spawned = spawn(&desc, Loader::new()).expect("the file loads");
    assert_eq!(codes_of(&spawned.warnings), ["W135"]);
    let found = check_world(&desc, &spawned.world, &spawned.assets);
    assert_eq!(found, []);
}
