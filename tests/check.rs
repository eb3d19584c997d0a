//! `luxel check`: its codes, its answers to people and programs, and that everything is said at once and soon.

use luxel::asset::Loader;
use luxel::check::all_codes;
use luxel::math::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// A folder of this test's own; gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn of(name: &str, files: &[(&str, &str)]) -> Folder {
        let path = std::env::temp_dir().join(format!("luxel-said-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).expect("a temporary folder");
        for (name, text) in files {
            fs::write(path.join(name), text).expect("writable");
        }
        Folder(path)
    }

    fn run(&self, args: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_luxel"))
            .args(args)
            .current_dir(&self.0)
            .env("NO_COLOR", "1")
            .output()
            .expect("luxel runs")
    }

    /// Exit code and JSON of `check --json`.
    fn json(&self, file: &str) -> (i32, serde_json::Value) {
        let output = self.run(&["check", "--json", file]);
        let json = serde_json::from_slice(&output.stdout);
        (
            output.status.code().unwrap_or(-1),
            json.unwrap_or_else(|e| panic!("{e}: {}", text(&output.stderr))),
        )
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[track_caller]
fn expect(output: &Output, code: i32, words: &[&str]) {
    let talk = text(&output.stdout) + &text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{talk}");
    for word in words {
        assert!(talk.contains(word), "no \"{word}\" in:\n{talk}");
    }
}

/// Codes of a JSON answer, in order.
fn codes(json: &serde_json::Value) -> Vec<&str> {
    let found = json["diagnostics"].as_array().expect("an array");
    found.iter().filter_map(|d| d["code"].as_str()).collect()
}

const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

const CAMERA: &str = "camera: (at: (3, 2, 9), look_at: (0.5, 0.5, 1)), background: Linear(1, 1, 1)";

fn project() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Rust sources and expectations below a folder.
fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs" || e == "txt") {
            let text = fs::read_to_string(&path).expect("a source");
            found.push((path, text));
        }
    }
    found
}

/// Sources of the product without their tests, and the tests.
fn product_and_tests() -> (Vec<(PathBuf, String)>, String) {
    let mut tests: String = sources(&project().join("tests"))
        .into_iter()
        .map(|(_, t)| t)
        .collect();
    let mut product = Vec::new();
    for (path, text) in sources(&project().join("src")) {
        let is_test = path.components().any(|c| c.as_os_str() == "tests")
            || path.file_name().is_some_and(|n| n == "tests.rs");
        let inline = text.find("#[cfg(test)]\nmod tests {");
        let (code, test) = text.split_at(match is_test {
            true => 0,
            false => inline.unwrap_or(text.len()),
        });
        tests.push_str(test);
        product.push((path, code.to_owned()));
    }
    (product, tests)
}

/// Name of the constant, and the module it stands in, by code.
fn constants(product: &[(PathBuf, String)]) -> BTreeMap<String, String> {
    let tables = product.iter().filter(|(p, _)| p.ends_with("codes.rs"));
    let mut constants = BTreeMap::new();
    for line in tables.flat_map(|(_, text)| text.lines()) {
        if let Some((name, rest)) = line.trim().split_once(" = \"") {
            constants.insert(rest[..4].to_owned(), name.to_owned());
        }
    }
    constants
}

#[test]
fn codes_are_unique_and_ordered() {
    let mut seen = BTreeSet::new();
    for (code, meaning) in all_codes() {
        assert!(seen.insert(code), "{code} twice");
        let (kind, number) = code.split_at(1);
        assert!(["E", "W"].contains(&kind) && number.len() == 3, "{code}");
        assert!(number.parse::<u32>().is_ok(), "{code}");
        assert!(
            !meaning.is_empty() && !meaning.ends_with('.'),
            "{code}: {meaning}"
        );
    }
    assert!(seen.len() > 70, "{}", seen.len());
}

/// `BLESS=1` writes the table and fails: read the difference, then run again.
#[test]
fn the_readme_lists_the_codes() {
    const HEAD: &str = "| code | stands for |\n|---|---|\n";
    let rows: String = all_codes()
        .map(|(c, m)| format!("| {c} | {m} |\n"))
        .collect();
    let path = project().join("README.md");
    let readme = fs::read_to_string(&path).expect("a README");
    let start = readme.find(HEAD).expect("a table of codes") + HEAD.len();
    let end = start + readme[start..].find("\n\n").expect("an end") + 1;
    if std::env::var_os("BLESS").is_some_and(|v| v == "1") {
        let blessed = format!("{}{rows}{}", &readme[..start], &readme[end..]);
        fs::write(&path, blessed).expect("the README is writable");
        panic!("blessed: read the difference, then run without BLESS");
    }
    assert_eq!(&readme[start..end], rows);
}

#[test]
fn every_code_of_the_source_is_in_the_table_and_used() {
    let (product, _) = product_and_tests();
    let known: BTreeSet<&str> = all_codes().map(|(code, _)| code).collect();
    let constants = constants(&product);
    assert_eq!(
        constants
            .keys()
            .map(String::as_str)
            .collect::<BTreeSet<_>>(),
        known
    );
    let others = || product.iter().filter(|(p, _)| !p.ends_with("codes.rs"));
    for (path, code) in others() {
        for quoted in code.split('"').filter(|s| s.len() == 4) {
            let like = quoted.starts_with(['E', 'W']) && quoted[1..].parse::<u32>().is_ok();
            assert!(!like, "{} has {quoted} beside the tables", path.display());
        }
    }
    for (code, name) in &constants {
        let used = others().any(|(_, text)| text.contains(&format!("codes::{name}")));
        assert!(used, "{code} ({name}) is used nowhere");
    }
}

#[test]
fn every_code_is_provoked_by_a_test() {
    /// Nothing that a file can do gives these: a bug of the OBJ parser, and what the validator of glTF refuses before.
    const INTERNAL: &[&str] = &["E110", "E131"];
    let (product, tests) = product_and_tests();
    let silent: Vec<String> = constants(&product)
        .into_iter()
        .filter(|(code, name)| {
            !tests.contains(&format!("\"{code}\""))
                && !tests.contains(&format!("[{code}]"))
                && !tests.contains(&format!("codes::{name}"))
        })
        .map(|(code, _)| code)
        .filter(|code| !INTERNAL.contains(&code.as_str()))
        .collect();
    assert_eq!(silent, Vec::<String>::new());
}

#[test]
fn codes_are_listed_for_people_and_programs() {
    let folder = Folder::of("codes", &[]);
    let listed = folder.run(&["check", "--codes"]);
    expect(&listed, 0, &["E012  no material or entity has this name\n"]);
    assert_eq!(text(&listed.stdout).lines().count(), all_codes().count());
    let listed = folder.run(&["check", "--codes", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&listed.stdout).expect("JSON");
    assert_eq!(json[0]["code"], "E001");
    assert_eq!(json[0]["meaning"], "the file is not UTF-8 text");
    expect(&folder.run(&["check"]), 2, &["<FILE>"]);
}

#[test]
fn a_mesh_file_is_checked_by_itself() {
    let spoilt = format!("{TETRAHEDRON}usemtl lost\nf 1 1 2\n");
    let folder = Folder::of(
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
    let (code, json) = folder.json("good.obj");
    assert_eq!((code, &json["contents"]["triangles"]), (0, &4.into()));
    assert_eq!(json["contents"]["max"], serde_json::json!([1.0, 2.0, 3.0]));
    let (code, json) = folder.json("spoilt.obj");
    assert_eq!((code, codes(&json)), (0, vec!["W102", "W105"]), "{json:#}");
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
    let folder = Folder::of("strict", &[("a.ron", &scene)]);
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
    let folder = Folder::of(
        "all",
        &[
            ("all.ron", &scene),
            ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
            ("b.obj", &format!("mtllib b.mtl\nusemtl m\n{TETRAHEDRON}")),
            ("b.mtl", "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd lost.png\n"),
            ("c.gltf", "{"),
        ],
    );
    let (code, json) = folder.json("all.ron");
    let found = codes(&json);
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
    let folder = Folder::of("fit", &files);
    fs::copy(project().join("assets/uv_test.png"), folder.0.join("t.png")).expect("writable");
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
        let (exit, json) = folder.json(name);
        assert!(codes(&json).contains(&code), "{name}: {json:#}");
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
    let folder = Folder::of("skies", &files);
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
        let (exit, json) = folder.json(name);
        assert_eq!(codes(&json), [code], "{name}: {json:#}");
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
    let (exit, json) = folder.json("good.ron");
    assert_eq!((exit, codes(&json)), (0, Vec::new()), "{json:#}");
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

/// Each mesh of the given data before a camera that fits: nothing is said of the scene as a whole.
#[test]
fn plain_files_give_no_false_alarm() {
    let Some(data) = std::env::var_os("LUXEL_DATA").map(PathBuf::from) else {
        println!("skipped: LUXEL_DATA does not say where the data is");
        return;
    };
    let mut checked = 0;
    for path in meshes(&data.join("zoo/obj")) {
        let mut loader = Loader::new();
        let Ok(id) = loader.mesh(&path) else {
            continue;
        };
        let mesh = loader.loaded(id);
        let used = mesh.corners.iter().map(|c| mesh.positions[*c as usize]);
        let (min, max) = used.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| {
            (a.min(p), b.max(p))
        });
        let (center, size) = (0.5 * (min + max), (max - min).length());
        let eye = center + DVec3::new(0.3, 0.4, 1.2) * size;
        let text = format!(
            "(version: 1, camera: (at: ({:?}, {:?}, {:?}), look_at: ({:?}, {:?}, {:?})),
             background: Linear(1, 1, 1), entities: [(shape: Mesh({:?}))])",
            eye.x,
            eye.y,
            eye.z,
            center.x,
            center.y,
            center.z,
            path.display().to_string()
        );
        let (desc, _) = luxel::scene::parse(&text, &data.join("s.ron")).expect("the scene reads");
        let spawned = luxel::world::spawn(&desc, Loader::new()).expect("the file loads");
        let found = luxel::check::check_world(&desc, &spawned.world, &spawned.assets);
        assert!(found.is_empty(), "{}: {found:#?}", path.display());
        checked += 1;
    }
    assert!(checked >= 50, "{checked}");
}

/// OBJ files below a folder.
fn meshes(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(meshes(&path));
        } else if path.extension().is_some_and(|e| e == "obj") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Release only: what these bounds tell apart is a second and more than a minute.
#[test]
#[cfg_attr(debug_assertions, ignore = "times of the release build")]
fn many_entities_and_many_errors_take_no_time() {
    let entity = |i: usize, wrong: &str| {
        let at = format!(
            "({}, {}, {})",
            i % 100,
            i / 100 % 100,
            -((i / 10_000) as i32)
        );
        format!(
            "(name: \"ball {i}\", shape: Sphere(radius: 0.3), transform: (translate: {at}){wrong}),\n"
        )
    };
    let scene = |entities: String| {
        let camera =
            "camera: (at: (50, 50, 150), look_at: (50, 50, 0)), background: Linear(1, 1, 1)";
        format!("(version: 1, {camera}, entities: [\n{entities}])")
    };
    let many = scene((0..100_000).map(|i| entity(i, "")).collect());
    let wrong = |i: usize| entity(i, &format!(", parent: \"bull {i}\""));
    let wrong = scene((0..20_000).map(wrong).collect());
    let line = wrong.replace('\n', " ");
    let folder = Folder::of(
        "many",
        &[
            ("many.ron", &many),
            ("wrong.ron", &wrong),
            ("line.ron", &line),
        ],
    );
    for (name, code, limit) in [
        ("many.ron", 0, 10),
        ("wrong.ron", 65, 5),
        ("line.ron", 65, 10),
    ] {
        let start = Instant::now();
        let output = folder.run(&["check", name]);
        let took = start.elapsed();
        println!("{name}: {took:?}");
        assert_eq!(output.status.code(), Some(code), "{name}");
        assert!(took < Duration::from_secs(limit), "{name}: {took:?}");
        if code != 0 {
            expect(&output, code, &["and 19,980 more of E012", "20000 errors"]);
        }
    }
}
