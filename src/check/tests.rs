//! Every warning fires where it should and is silent where it should be.

use super::*;
use crate::asset::Loader;
use crate::scene;
use crate::world::spawn;
use std::path::{Path, PathBuf};

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
fn single_precision_blurs_what_is_far() {
    let body = |x: f64| {
        format!(
            "{CAMERA} {LIT} entities: [(name: \"box\", shape: Mesh(\"cube.obj\")),
             (name: \"moon\", shape: Sphere(radius: 1), transform: (translate: ({x}, 0, 0)))]"
        )
    };
    let said = expect("moon", &body(1e7), &["W304"]);
    assert!(
        said.contains("\"box\" is 2 wide") && said.contains("\"moon\" is 1.00e7 away"),
        "{said}"
    );
    expect("hill", &body(1e4), &[]);
}

#[test]
fn single_precision_has_an_end() {
    let wall = |radius: f64| {
        format!(
            "{CAMERA} {LIT} entities: [(shape: Mesh(\"cube.obj\")), (name: \"wall\",
             shape: Sphere(radius: {radius}), transform: (translate: (0, {}, 0)))]",
            -radius - 2.0
        )
    };
    let said = expect("wall", &wall(1e60), &["W304"]);
    assert!(said.contains("\"wall\" reaches"), "{said}");
    expect("floor", &wall(1e9), &[]);
}

#[test]
fn a_stray_vertex_makes_points_of_triangles() {
    let stray = |x: f64| {
        let text = format!("{}v {x} 0 0\nf 1 2 9\n", cube(|x| x));
        let folder = Folder::of(&format!("stray{x}"), &[("stray.obj", text)]);
        let text = format!(
            "(version: 1, camera: (at: (0, 0, {}), look_at: ({x}, 0, 0), vfov_deg: 120), {LIT}
             entities: [(shape: Mesh(\"stray.obj\")), (shape: Mesh(\"stray.obj\"))])",
            3.0 * x
        );
        let (desc, _) = scene::parse(&text, &folder.0.join("s.ron")).expect("the scene reads");
        let spawned = spawn(&desc, Loader::new()).expect("the files load");
        check_world(&desc, &spawned.world, &spawned.assets)
    };
    let found = stray(1e9);
    assert_eq!(codes_of(&found), ["W304"], "{found:#?}");
    assert!(
        found[0].message.starts_with("12 of the 13 triangles"),
        "{}",
        found[0]
    );
    assert_eq!(stray(1e5), []);
}

#[test]
fn files_in_other_units() {
    let body = |file: &str, transform: &str| {
        format!(
            "camera: (at: (0, 0.5, 6), look_at: (0, 0, 0)), {LIT}
             entities: [(shape: Sphere(radius: 1)), (name: \"it\", shape: Mesh(\"{file}\"), {transform})]"
        )
    };
    let near = "transform: (translate: (1.5, 0, 0))";
    let said = expect("tiny", &body("tiny.obj", near), &["W305"]);
    assert!(
        said.contains("2000 times smaller") && said.contains("scale: 1000"),
        "{said}"
    );
    let said = expect(
        "huge",
        &body("huge.obj", "transform: (translate: (-2000, -1500, -6000))"),
        &["W305"],
    );
    assert!(
        said.contains("1000 times larger") && said.contains("scale: 0.001"),
        "{said}"
    );
    let scaled = "transform: (translate: (1.5, 0, 0), scale: 1000)";
    expect("scaled", &body("tiny.obj", scaled), &[]);
    // A floor may be as large as it likes.
    let flat = "transform: (translate: (0, -2, 0), scale: (5000, 0.001, 5000))";
    expect("floor", &body("cube.obj", flat), &[]);
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
    let said = expect("vfov", &body(1.0472, 5.0, none), &["W307"]);
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
    expect("spot", &spot(0.5236), &["W307"]);
    expect("spot2", &spot(30.0), &[]);
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
fn faces_without_uv() {
    let quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    let folder = Folder::of(
        "uv",
        &[
            ("all.obj", format!("{quad}f 1/1 2/2 3/3 4/4\n")),
            ("some.obj", format!("{quad}f 1/1 2/2 3/3\nf 1 3 4\n")),
        ],
    );
    let png = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/uv_test.png");
    std::fs::copy(png, folder.0.join("t.png")).expect("the temporary folder is writable");
    let found = |mesh: &str, material: &str| {
        let text = format!(
            "(version: 1, {CAMERA} {LIT} materials: {{\"m\": {material}}},
             entities: [(shape: Mesh({mesh:?}), material: \"m\")])"
        );
        let (desc, _) = scene::parse(&text, &folder.0.join("scene.ron")).expect("the scene reads");
        let spawned = spawn(&desc, Loader::new()).expect("the files load");
        check_world(&desc, &spawned.world, &spawned.assets)
    };
    let textured = "Diffuse(color: Texture(\"t.png\"))";
    let some = found("some.obj", textured);
    assert_eq!(codes_of(&some), ["W309"]);
    assert!(
        some[0].message.starts_with("1 of the 2 textured triangles"),
        "{}",
        some[0]
    );
    assert!(
        some[0].message.contains("the first is triangle 1"),
        "{}",
        some[0]
    );
    assert_eq!(found("all.obj", textured), []);
    assert_eq!(found("some.obj", "Mirror"), []);
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
fn a_gltf_file_that_brings_nothing() {
    use crate::math::DVec3;
    use crate::world::{AuthoringIndex, Camera, Light, Shape, Transform, pose};
    let text = format!("(version: 1, {CAMERA} {LIT} entities: [(gltf: \"a.glb\")])");
    let (desc, _) = scene::parse(&text, Path::new("scene.ron")).expect("the scene reads");
    let index = |entity, node| AuthoringIndex { entity, node };
    let camera = Camera {
        vfov_deg: 40.0,
        aperture_radius: 0.0,
        focus_distance: 1.0,
    };
    let at = Transform {
        translate: DVec3::new(0.0, 0.0, 9.0),
        ..Transform::default()
    };
    let found = |light: Option<Light>| {
        let mut world = World::new();
        world.spawn((index(1, 0), at, camera));
        let shape = Shape::Sphere {
            radius: 1.0,
            inverted: false,
        };
        world.spawn((index(2, 0), Transform::default(), shape));
        if let Some(light) = light {
            world.spawn((index(0, 1), at, light));
        }
        pose(&mut world, 0.0);
        codes_of(&check_world(&desc, &world, &AssetStore::default()))
    };
    assert_eq!(found(None), ["W310"]);
    let intensity = [300.0; 3];
    assert_eq!(found(Some(Light::Point { intensity })), Vec::<&str>::new());
}

#[test]
fn extremes_neither_panic_nor_show_what_is_no_number() {
    const ANY: &[&str] = &[
        "0", "1", "-1", "1e-150", "-3.5", "100", "1e9", "-1e60", "1e149",
    ];
    const POSITIVE: &[&str] = &[
        "1", "0.01", "1e-150", "1e-30", "100", "1e9", "1e60", "1e149",
    ];
    const POWER: &[&str] = &["0", "1", "1e9", "1e-30"];
    const VFOV: &[&str] = &["0.001", "1", "60", "179.9"];
    let files = [("cube.obj", cube(|x| x)), ("huge.obj", cube(|x| 1e90 * x))];
    let folder = Folder::of("extremes", &files);
    let mut state = 7_u64;
    let mut pick = |of: &[&'static str]| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        of[(state >> 33) as usize % of.len()]
    };
    let (mut checked, mut said) = (0, 0);
    for _ in 0..200 {
        let mut three = |of| format!("({}, {}, {})", pick(of), pick(of), pick(of));
        let (eye, aim, cube_at, turn) = (three(ANY), three(ANY), three(ANY), three(ANY));
        let stretch = three(POSITIVE);
        let spheres: Vec<[String; 3]> = (0..3)
            .map(|_| [three(ANY), three(ANY), three(POWER)])
            .collect();
        let lens = format!(
            "aperture_radius: {}, focus_distance: {}",
            pick(POSITIVE),
            pick(POSITIVE)
        );
        let mut text = format!(
            "(version: 1, camera: (at: {eye}, look_at: {aim}, vfov_deg: {}, lens: ({lens})), entities: [
             (shape: Mesh(\"cube.obj\"), transform: (translate: {cube_at}, scale: {})),
             (shape: Mesh(\"huge.obj\"), transform: (rotate: Euler{turn}, scale: {stretch})),",
            pick(VFOV),
            pick(POSITIVE)
        );
        for [at, place, power] in spheres {
            text += &format!(
                "(shape: Sphere(radius: {}), transform: (translate: {at})),
                 (light: Point(intensity: {power}), transform: (translate: {place})),",
                pick(POSITIVE)
            );
        }
        let Ok((desc, _)) = scene::parse(&(text + "])"), &folder.0.join("s.ron")) else {
            continue;
        };
        let Ok(spawned) = spawn(&desc, Loader::new()) else {
            continue;
        };
        checked += 1;
        let loaded = check_world(&desc, &spawned.world, &spawned.assets);
        for one in check(&desc).into_iter().chain(loaded) {
            said += 1;
            assert!(!one.to_string().contains("NaN"), "{one}\n{}", desc.source);
        }
    }
    assert!(checked > 50 && said > 50, "{checked} scenes, {said} said");
}
