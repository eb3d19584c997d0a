//! What is said of scenes and of the files that they name.

use crate::support::{Folder, text};
use crate::{CAMERA, TETRAHEDRON, answer, codes_of, expect};
use std::fs;

#[test]
fn a_mesh_file_is_checked_by_itself() {
    let spoilt = format!("{TETRAHEDRON}usemtl lost\nf 1 1 2\n");
    let folder = Folder::new(
        "mesh",
        &[
            ("good.obj", TETRAHEDRON),
            ("spoilt.obj", &spoilt),
            ("bad.OBJ", "v 0 0\nf 1 2 3\n"),
        ],
    );
    let contents = "good.obj: 4 triangles, 0 materials, no textures, 1 x 2 x 3 wide, from (0, 0, 0) to (1, 2, 3)";
    expect(
        &folder.run(&["check", "good.obj"]),
        0,
        &[contents, "good.obj: no errors, no warnings"],
    );
    let (code, json) = answer(&folder, "good.obj");
    assert_eq!((code, &json["contents"]["triangles"]), (0, &4.into()));
    assert_eq!(json["contents"]["max"], serde_json::json!([1.0, 2.0, 3.0]));
    let (code, json) = answer(&folder, "spoilt.obj");
    assert_eq!(
        (code, codes_of(&json)),
        (0, vec!["W102", "W105"]),
        "{json:#}"
    );
    assert_eq!(json["diagnostics"][1]["line"], 10);
    expect(
        &folder.run(&["check", "--strict", "spoilt.obj"]),
        65,
        &["2 warnings", "--strict"],
    );
    expect(
        &folder.run(&["check", "bad.OBJ"]),
        65,
        &["E104", "bad.OBJ:1:1", "error"],
    );
    expect(
        &folder.run(&["check", "none.glb"]),
        66,
        &["cannot read \"none.glb\""],
    );
}

#[test]
fn strict_takes_warnings_for_errors() {
    let scene = format!(
        "(version: 1, {CAMERA}, materials: {{\"gold\": Metal}}, entities: [(shape: Sphere(radius: 1))])"
    );
    let folder = Folder::new("strict", &[("a.ron", &scene)]);
    expect(
        &folder.run(&["check", "a.ron"]),
        0,
        &["W002", "no errors, 1 warning"],
    );
    expect(
        &folder.run(&["check", "--strict", "a.ron"]),
        65,
        &["W002", "--strict allows no warnings"],
    );
    let json = folder.run(&["check", "--strict", "--json", "a.ron"]);
    expect(&json, 65, &["W002"]);
    assert!(json.stderr.is_empty());
    let render = ["render", "a.ron", "--spp", "1", "--size", "8x8"];
    expect(
        &folder.run(&[&render[..], &["--strict"]].concat()),
        65,
        &["W002", "--strict"],
    );
    assert!(!folder.0.join("a.png").exists());
    expect(&folder.run(&render), 0, &["W002"]);
}

#[test]
fn an_error_in_the_scene_hides_none_in_the_files() {
    let scene = format!(
        "(version: 1, {CAMERA},
         entities: [
         (shape: Sphere(radius: -1)),
         (shape: Mesh(\"a.obj\"), material: \"lost\"),
         (shape: Mesh(\"b.obj\"), colour: 3),
         (gltf: \"c.gltf\"),
         ])"
    );
    let folder = Folder::new(
        "all",
        &[
            ("all.ron", &scene),
            ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
            ("b.obj", &format!("mtllib b.mtl\nusemtl m\n{TETRAHEDRON}")),
            ("b.mtl", "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd lost.png\n"),
            ("c.gltf", "{"),
        ],
    );
    let (code, json) = answer(&folder, "all.ron");
    let found = codes_of(&json);
    assert_eq!(code, 65);
    let expected = ["E011", "E012", "E004", "E103", "W103"];
    assert!(expected.iter().all(|code| found.contains(code)), "{json:#}");
    let place = |code: &str| {
        let all = json["diagnostics"].as_array().expect("an array");
        let one = all.iter().find(|d| d["code"] == code).expect("just found");
        let name = one["file"]
            .as_str()
            .map(|f| f.rsplit('/').next().unwrap_or(f).to_owned());
        (name.unwrap_or_default(), one["line"].as_u64())
    };
    assert_eq!(place("E103"), ("a.obj".into(), Some(4)));
    assert_eq!(place("W103"), ("b.mtl".into(), Some(3)));
    assert_eq!(place("E012"), ("all.ron".into(), Some(4)));
    let of_gltf = json["diagnostics"].as_array().expect("an array").iter();
    assert!(
        of_gltf
            .clone()
            .any(|d| d.to_string().contains("c.gltf") && d["severity"] == "error")
    );
    let errors = of_gltf.filter(|d| d["severity"] == "error").count();
    assert_eq!(json["errors"], errors);
    assert_eq!(json["warnings"], found.len() - errors);
}

#[test]
fn files_that_do_not_fit_the_scene() {
    let scene = |name: &str, entities: &str| {
        let materials = "materials: {\"fur\": Diffuse(color: Texture(\"t.png\"))}";
        (
            name.to_owned(),
            format!("(version: 1, {CAMERA}, {materials}, entities: [{entities}])"),
        )
    };
    let textured = format!("mtllib m.mtl\nusemtl m\n{TETRAHEDRON}");
    let twice = "newmtl m\nmap_Kd t.png\nnewmtl m\nKd 1 1 1\n";
    // A bow tie.
    let tangled = "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4\n";
    let scenes = [
        scene("e201.ron", "(shape: Mesh(\"a.obj\"), material: \"fur\")"),
        scene(
            "w201.ron",
            "(shape: Mesh(\"m.obj\")), (shape: Sphere(radius: 1), material: \"fur\")",
        ),
        scene(
            "e203.ron",
            "(shape: Mesh(path: \"a.obj\", mesh: 1), material: \"fur\")",
        ),
        scene("e204.ron", "(shape: Mesh(\"a.glb\"), material: \"fur\")"),
        (
            "e202.ron".to_owned(),
            format!(
                "(version: 1, {CAMERA}, entities: [(name: \"a\", transform: (scale: 1e140)),
                 (name: \"b\", parent: \"a\", transform: (scale: 1e140)),
                 (parent: \"b\", shape: Sphere(radius: 1e140))])"
            ),
        ),
        (
            "e205.ron".to_owned(),
            "(version: 1, entities: [(gltf: \"a.glb\")])".to_owned(),
        ),
    ];
    let mut files: Vec<(&str, &str)> = scenes
        .iter()
        .map(|(n, t)| (n.as_str(), t.as_str()))
        .collect();
    files.extend([
        ("a.obj", TETRAHEDRON),
        ("m.obj", &textured),
        ("m.mtl", twice),
        ("tangled.obj", tangled),
    ]);
    let folder = Folder::new("fit", &files);
    fs::copy(
        concat!(env!("CARGO_MANIFEST_DIR"), "/assets/uv_test.png"),
        folder.0.join("t.png"),
    )
    .expect("writable");
    for (name, code) in [
        ("e201.ron", "E201"),
        ("e202.ron", "E202"),
        ("e203.ron", "E203"),
        ("e204.ron", "E204"),
        ("e205.ron", "E205"),
        ("w201.ron", "W201"),
        ("w201.ron", "W111"),
        ("m.obj", "W201"),
        ("tangled.obj", "W114"),
    ] {
        let (exit, json) = answer(&folder, name);
        assert!(codes_of(&json).contains(&code), "{name}: {json:#}");
        assert_eq!(exit, if code.starts_with('E') { 65 } else { 0 }, "{name}");
    }
}

/// What is wrong with the image of a sky is told where the scene names it.
#[test]
fn skies_are_checked_where_they_are_named() {
    let scene = |hdr: &str| {
        let camera = "camera: (at: (3, 2, 9), look_at: (0, 0, 0))";
        let ball = "entities: [(shape: Sphere(radius: 1))]";
        format!("(version: 1, {camera},\nbackground: Hdr({hdr}), {ball})")
    };
    let scenes = [
        ("missing.ron", scene("\"skye.hdr\"")),
        ("other.ron", scene("\"other.hdr\"")),
        ("cut.ron", scene("\"cut.hdr\"")),
        ("negative.ron", scene("\"negative.exr\"")),
        ("square.ron", scene("\"square.hdr\"")),
        ("strong.ron", scene("path: \"sky.hdr\", strength: 1e18")),
        ("black.ron", scene("\"black.hdr\"")),
        ("dark.ron", scene("path: \"sky.hdr\", strength: 0")),
        ("good.ron", scene("\"sky.hdr\"")),
    ];
    let mut files: Vec<(&str, &str)> = scenes.iter().map(|(n, t)| (*n, t.as_str())).collect();
    files.push(("other.hdr", "no image at all"));
    let folder = Folder::new("skies", &files);
    let hdr = |name: &str, width: usize, texel: [f32; 3]| {
        let mut bytes = Vec::new();
        image::codecs::hdr::HdrEncoder::new(&mut bytes)
            .encode(&vec![image::Rgb(texel); width], width, 1)
            .expect("an HDR image");
        fs::write(folder.0.join(name), &bytes).expect("writable");
        bytes
    };
    let whole = hdr("sky.hdr", 2, [1.0, 2.0, 3.0]);
    fs::write(folder.0.join("cut.hdr"), &whole[..whole.len() - 1]).expect("writable");
    hdr("square.hdr", 1, [1.0; 3]);
    hdr("black.hdr", 2, [0.0; 3]);
    let negative = |_, _| (1.0f32, -1.0f32, 1.0f32);
    exr::prelude::write_rgb_file(folder.0.join("negative.exr"), 2, 1, negative).expect("writable");
    for (name, code, words) in [
        ("missing.ron", "E101", "did you mean \"sky.hdr\""),
        ("other.ron", "E107", "neither"),
        ("cut.ron", "E108", "damaged"),
        ("negative.ron", "E112", "oiiotool"),
        ("square.ron", "W119", "1 x 1"),
        ("strong.ron", "E011", "strength"),
        ("black.ron", "W001", "black"),
        ("dark.ron", "W001", "black"),
    ] {
        let (exit, json) = answer(&folder, name);
        assert_eq!(codes_of(&json), [code], "{name}: {json:#}");
        assert_eq!(exit, if code.starts_with('E') { 65 } else { 0 }, "{name}");
        let found = &json["diagnostics"][0];
        assert!(
            found.to_string().contains(&words.replace('"', "\\\"")),
            "{found:#}"
        );
        if code.starts_with('E') {
            assert_eq!(
                (&found["file"], &found["line"]),
                (&name.into(), &2.into()),
                "{found:#}"
            );
        }
    }
    let (exit, json) = answer(&folder, "good.ron");
    assert_eq!((exit, codes_of(&json)), (0, Vec::new()), "{json:#}");
    // It counts for the hash of the scene, and for the memory that files may take.
    let explained = |file: &str| text(&folder.run(&["explain", "--json", file]).stdout);
    let before = explained("good.ron");
    for word in ["sky texels", "sky row sums", "\"sky\""] {
        assert!(before.contains(word), "no {word} in {before}");
    }
    let hash = |text: &str| {
        serde_json::from_str::<serde_json::Value>(text)
            .map(|v| v["hash"].to_string())
            .ok()
    };
    hdr("sky.hdr", 2, [1.0, 2.0, 4.0]);
    assert!(hash(&before).is_some() && hash(&explained("good.ron")) != hash(&before));
}
