//! Samples that are not finite have a name, and every sample can be traced again: library and command.

#![allow(clippy::unwrap_used, reason = "a test may")]

use luxel::render::{Renderer, Settings};
use luxel::trace::replay::{Fate, Replay};
use luxel::trace::{Rect, TileSums, TraceOptions, Tracer, replay};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Four strong lamps a hundredth of a ball's radius above it, as a scene in wrong units has them: one of four light
/// samples counts four times, and the irradiance below is as much as single precision holds.
const BOUNCE_0: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 2e-10, 3e-10), look_at: (0, 0, 0), vfov_deg: 40),
    render: (size: (32, 24), spp: 16, max_bounces: 2),
    materials: { "white": Diffuse(color: Linear(1, 1, 1)) },
    entities: [
        (name: "floor", shape: Sphere(radius: 1e-9), transform: (translate: (0, -1e-9, 0)), material: "white"),
        (light: Point(intensity: (1e18, 1e18, 1e18)), transform: (translate: (0, 5.5e-11, 0))),
        (light: Point(intensity: (1e18, 1e18, 1e18)), transform: (translate: (0, 5.5e-11, 0))),
        (light: Point(intensity: (1e18, 1e18, 1e18)), transform: (translate: (0, 5.5e-11, 0))),
        (light: Point(intensity: (1e18, 1e18, 1e18)), transform: (translate: (0, 5.5e-11, 0))),
    ],
)
"#;

/// A lamp in six boxes, one in the other, each of which multiplies radiance by 4096, since what is in it is thinner than
/// what is around it. The filter sends all rays of a pixel through its middle: those of the middle pixel meet every box
/// head on, and the others are reflected. Nothing of it is worth a warning.
fn bounce_6() -> String {
    let boxes = (0..6).map(|k| {
        format!(
            "(name: \"box {k}\", shape: Mesh(\"cube.obj\"), normals: Flat, material: \"thin\",
             transform: (scale: {})),",
            7 - k
        )
    });
    format!(
        r#"Scene(
    version: 1,
    camera: (at: (0.25, 0.125, 20), look_at: (0.25, 0.125, 0), vfov_deg: 40),
    render: (size: (3, 3), spp: 2, max_bounces: 8, filter: Gaussian(radius_px: 1e-12)),
    materials: {{ "thin": Glass(ior: 0.015625) }},
    entities: [
        {}
        (name: "lamp", shape: Mesh("cube.obj"), normals: Flat, emissive: (radiance: (1e18, 1e18, 1e18))),
    ],
)
"#,
        boxes.collect::<String>()
    )
}

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, scene: &str) -> Folder {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("replay_{name}"));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        std::fs::write(path.join("scene.ron"), scene).unwrap();
        std::fs::write(path.join("cube.obj"), CUBE).unwrap();
        Folder(path)
    }

    fn run(&self, args: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
        command.args(args).current_dir(&self.0).env("NO_COLOR", "1");
        command.output().unwrap()
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A shipped scene, small, and the samples of all its pixels.
fn check_scene(name: &str, size: (u32, u32), bounces: u32) {
    const SPP: u32 = 3;
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name);
    let read = luxel::scene::load(&file).unwrap();
    let spawned = luxel::world::spawn(&read.desc, luxel::asset::Loader::new()).unwrap();
    let options = TraceOptions {
        max_bounces: bounces,
        seed: 5,
        caustics: true,
        ..TraceOptions::default()
    };
    let settings = Settings {
        size,
        threads: Some(1),
        trace: options,
        ..Settings::of_scene(&read.desc)
    };
    let renderer = Renderer::new(&read.desc, spawned.world, &spawned.assets, settings);
    let (flat, _) = renderer.unwrap().build(2);
    let (width, height) = size;
    let rect = Rect {
        x: 0,
        y: 0,
        width,
        height,
    };
    let mut sums = TileSums::default();
    Tracer::new(&flat, &options).trace_tile(rect, 0..SPP, &mut sums);
    let (mut longest, mut lights, mut caustics) = (0, 0, 0);
    for pixel in 0..width * height {
        let (x, y) = (pixel % width, pixel / width);
        let paths: Vec<Replay> = (0..SPP)
            .map(|s| replay(&flat, &options, (x, y), s))
            .collect();
        let mut sum = [0.0; 3];
        for path in &paths {
            for (sum, c) in sum.iter_mut().zip(path.radiance) {
                *sum += f64::from(c);
            }
            check_path(path, bounces);
            longest = longest.max(path.vertices.len());
            lights += path.vertices.iter().filter(|v| v.light.is_some()).count();
            let lit = path.vertices.iter().filter(|v| v.caustic != [0.0; 3]);
            caustics += lit.count();
        }
        assert_eq!(sum, sums.rgb[pixel as usize], "{name}, pixel ({x}, {y})");
    }
    assert!(
        longest > 2 && lights > 0,
        "{name}: {longest} vertices, {lights} light samples"
    );
    assert_eq!(caustics > 0, !flat.chains.is_empty(), "{name}");
}

/// What a path says of itself agrees with itself.
fn check_path(path: &Replay, bounces: u32) {
    let last = path.vertices.last().unwrap();
    assert_eq!(last.radiance, path.radiance);
    assert_ne!(last.fate, Fate::Scattered);
    assert_eq!(
        last.fate == Fate::Spent,
        path.vertices.len() == bounces as usize + 1
    );
    for vertex in &path.vertices {
        assert_eq!(
            vertex.fate == Fate::Missed,
            vertex.hit.is_none() && vertex.fate != Fate::Spent
        );
        let brought = vertex.light.as_ref().filter(|light| !light.blocked);
        let added = brought.map_or([0.0; 3], |light| light.radiance);
        let sum = [0, 1, 2].map(|k| vertex.emitted[k] + added[k] + vertex.caustic[k]);
        assert_eq!(vertex.radiance, sum, "{vertex:?}");
    }
    for pair in path.vertices.windows(2) {
        assert_eq!(pair[0].fate, Fate::Scattered);
        let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
        assert!(near(pair[0].hit.as_ref().unwrap().position, pair[1].from));
    }
}

#[test]
fn a_replay_is_the_sample_that_the_film_takes() {
    check_scene("hero.ron", (24, 16), 7);
    check_scene("materials.ron", (24, 12), 12);
    check_scene("cat_spin.ron", (16, 16), 4);
    check_scene("lights.ron", (16, 12), 3);
}

#[test]
fn samples_that_are_not_finite_are_named() {
    let folder = Folder::new("named", BOUNCE_0);
    let output = folder.run(&["render", "scene.ron", "--stats", "s.json"]);
    let talk = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{talk}");
    let stats: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.0.join("s.json")).unwrap()).unwrap();
    let count = stats["non_finite_samples"].as_u64().unwrap();
    assert!(count > 40, "{count}");
    assert_eq!(stats["samples"].as_u64(), Some(32 * 24 * 16 - count));
    let listed = stats["non_finite"].as_array().unwrap();
    assert_eq!(listed.len(), 32);
    let number = |v: &serde_json::Value| v.as_u64().unwrap();
    let names: Vec<[u64; 5]> = listed
        .iter()
        .map(|n| {
            let [x, y] = [&n["pixel"][0], &n["pixel"][1]].map(number);
            [
                number(&n["frame"]),
                y,
                x,
                number(&n["sample"]),
                number(&n["bounce"]),
            ]
        })
        .collect();
    assert!(
        names.is_sorted() && names.iter().all(|n| n[4] == 0),
        "{names:?}"
    );
    let [_, y, x, sample, _] = names[0];
    for words in [
        format!("{count} samples were not finite"),
        format!("frame 0, pixel ({x}, {y}), sample {sample}, bounce 0"),
        format!("and {} more", count - 4),
        "--replay".to_owned(),
    ] {
        assert!(talk.contains(&words), "no {words:?} in {talk}");
    }
    // Threads and tiles change nothing of it.
    let again = ["--tile", "7", "--threads", "2", "--stats", "t.json"];
    folder.run(&[&["render", "scene.ron"], &again[..]].concat());
    let other: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.0.join("t.json")).unwrap()).unwrap();
    assert_eq!(other["non_finite"], stats["non_finite"]);

    let path = folder.run(&[
        "render",
        "scene.ron",
        "--replay",
        &format!("0,{x},{y},{sample}"),
    ]);
    let path = text(&path.stdout);
    for words in [
        "not finite from bounce 0 on",
        "bounce 0: \"floor\", sphere, material \"white\" (diffuse)",
        "brings (inf, inf, inf)",
        "throughput  (1, 1, 1)",
    ] {
        assert!(path.contains(words), "no {words:?} in {path}");
    }
    let fine = folder.run(&["render", "scene.ron", "--replay", "0,0,0,0"]);
    assert!(!text(&fine.stdout).contains("not finite"));
    assert!(!folder.0.join("replay.png").exists());
}

#[test]
fn strict_makes_them_an_error_once_the_image_is_there() {
    let folder = Folder::new("strict", &bounce_6());
    let args = ["render", "scene.ron", "--fresnel", "off"];
    let fine = folder.run(&args);
    let talk = text(&fine.stderr);
    assert_eq!(fine.status.code(), Some(0), "{talk}");
    assert!(
        talk.contains("2 samples were not finite")
            && talk.contains("frame 0, pixel (1, 1), sample 1, bounce 6"),
        "{talk}"
    );
    let strict = folder.run(&[&args[..], &["--strict", "-o", "strict.png"]].concat());
    let talk = text(&strict.stderr);
    assert_eq!(strict.status.code(), Some(65), "{talk}");
    assert!(
        talk.contains("--strict allows no samples that are not finite: 2"),
        "{talk}"
    );
    assert_eq!(text(&strict.stdout), "strict.png\n");
    assert!(folder.0.join("strict.png").exists());
    // Without what makes it overflow, --strict is content.
    let dim = bounce_6().replace("1e18", "1e10");
    std::fs::write(folder.0.join("scene.ron"), dim).unwrap();
    let fine = folder.run(&[&args[..], &["--strict"]].concat());
    assert_eq!(fine.status.code(), Some(0), "{}", text(&fine.stderr));
}

#[test]
fn a_sample_that_is_not_there_is_refused() {
    let folder = Folder::new("refused", BOUNCE_0);
    for (at, words) in [
        ("0,32,0,0", "no pixel (32, 0) in an image of 32x24"),
        ("0,0,24,0", "no pixel (0, 24)"),
        ("0,0,0", "four whole numbers"),
        ("0,0,0,16777216", "samples count from 0"),
    ] {
        let output = folder.run(&["render", "scene.ron", "--replay", at]);
        let talk = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{talk}");
        assert!(talk.contains(words), "{at}: {talk}");
    }
    let both = folder.run(&["render", "scene.ron", "--replay", "0,0,0,0", "-o", "x.png"]);
    assert_eq!(both.status.code(), Some(2));
}
