//! What luxel says of its own costs: `explain`, `--stats`, and the one change that would help most.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of this test's own; gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("luxel-cost-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a temporary folder");
        Folder(path)
    }

    fn run(&self, args: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
        let output = command
            .args(args)
            .current_dir(&self.0)
            .env("NO_COLOR", "1")
            .output();
        let output = output.expect("luxel runs");
        assert!(
            output.status.success(),
            "{args:?}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        output
    }

    /// What `--stats` writes of a render.
    fn stats(&self, scene: &str, args: &[&str]) -> Value {
        let scene = shipped(scene);
        let line = ["render", &scene, "-o", "x.exr", "--stats", "s.json"];
        self.run(&[&line, args].concat());
        let text = std::fs::read(self.0.join("s.json")).expect("statistics");
        serde_json::from_slice(&text).expect("JSON")
    }

    /// What `explain` says of a shipped scene, or of one of this folder.
    fn explained(&self, scene: &str) -> Value {
        let own = self.0.join(format!("{scene}.ron"));
        let path = if own.exists() {
            own.display().to_string()
        } else {
            shipped(scene)
        };
        let output = self.run(&["explain", "--json", &path]);
        serde_json::from_slice(&output.stdout).expect("JSON")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn shipped(scene: &str) -> String {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    scenes.join(format!("{scene}.ron")).display().to_string()
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

fn rows(value: &Value) -> &[Value] {
    value.as_array().expect("rows")
}

/// Something of the stage of this name; 0 where nothing went through it.
fn of_stage(tracing: &Value, name: &str, what: &str) -> f64 {
    let row = rows(tracing).iter().find(|row| row["name"] == name);
    row.map_or(0.0, |row| number(&row[what]))
}

fn assert_shares(tracing: &Value) {
    let shares: f64 = rows(tracing).iter().map(|row| number(&row["share"])).sum();
    assert!((shares - 1.0).abs() < 1e-9, "{shares}");
    for row in rows(tracing) {
        assert!(
            number(&row["items"]) > 0.0 && number(&row["nanoseconds"]) > 0.0,
            "{row}"
        );
    }
}

#[test]
fn statistics_have_the_stages() {
    let folder = Folder::new("stages");
    let args = ["--size", "60x40", "--spp", "12", "--threads", "2"];
    let stats = folder.stats("hero", &args);
    let tracing = &stats["tracing"];
    assert_shares(tracing);
    let items = |name: &str| of_stage(tracing, name, "items");
    for name in ["camera", "film"] {
        assert_eq!(items(name), number(&stats["samples"]), "{name}");
    }
    assert_eq!(items("surface"), number(&stats["rays"]["closest"]));
    assert_eq!(items("closest hit"), number(&stats["rays"]["closest"]));
    assert_eq!(items("occlusion"), number(&stats["rays"]["occlusion"]));
    assert_eq!(items("light sampling"), items("diffuse") + items("plastic"));
    // Of the time of all threads, and no more.
    let stages: f64 = rows(tracing)
        .iter()
        .map(|row| number(&row["items"]) * number(&row["nanoseconds"]))
        .sum();
    let threads = 2e9 * number(&stats["seconds"]["trace"]);
    assert!(stages < 1.01 * threads, "{stages} ns in {threads}");
    // Whoever traces which tile.
    let other = folder.stats(
        "hero",
        &[
            "--size",
            "60x40",
            "--spp",
            "12",
            "--threads",
            "1",
            "--tile",
            "7",
        ],
    );
    let counts = |stats: &Value| -> Vec<(Value, Value)> {
        let rows = rows(&stats["tracing"]).iter();
        rows.map(|row| (row["name"].clone(), row["items"].clone()))
            .collect()
    };
    assert_eq!(counts(&stats), counts(&other));
}

#[test]
fn what_is_needed_has_an_owner_and_a_cost_and_nothing_else_has() {
    let folder = Folder::new("needs");
    let ball = |k: u32| {
        let (x, y) = (k % 10, k / 10);
        format!("(shape: Sphere(radius: 0.4), transform: (translate: ({x}, {y}, 0)))")
    };
    let balls: Vec<String> = (0..80).map(ball).collect();
    let scene = format!(
        "Scene(version: 1, camera: (at: (5, 4, 20), look_at: (5, 4, 0)), render: (size: (64, 64)),
        background: Linear(1, 1, 1), entities: [{}])",
        balls.join(", ")
    );
    std::fs::write(folder.0.join("balls.ron"), scene).expect("writable");
    // Between them: every flag but those that only files bring.
    for (scene, needed) in [
        (
            "hero",
            &["triangles", "smooth normals", "textures", "glass", "metal"][..],
        ),
        (
            "diffuse_room",
            &["spheres outside the tree", "light sampling", "diffuse"],
        ),
        ("gears", &["instances"]),
        ("lens", &["lens"]),
        ("lights", &["lights without extent"]),
        ("sky", &["sky"]),
        ("lattice", &["opacity"]),
        ("balls", &["spheres in the tree", "background"]),
    ] {
        let explained = folder.explained(scene);
        let needs = rows(&explained["stages"]);
        for need in needs {
            let (on, cost) = (need["on"] == true, &need["cost"]);
            assert_eq!(need["asked_by"].is_string(), on, "{scene}: {need}");
            assert_eq!(cost.is_object(), on, "{scene}: {need}");
            if on {
                let share = number(&cost["share"]);
                // What is measured in turns may come out below nothing, and far below on a busy machine.
                let least = if cost["measured"] == "with and without" {
                    f64::MIN
                } else {
                    0.0
                };
                assert!((least..=1.0).contains(&share), "{scene}: {need}");
            }
        }
        for name in needed {
            let need = needs.iter().find(|need| need["name"] == *name);
            assert!(
                need.is_some_and(|need| need["on"] == true),
                "{scene}: {name}"
            );
        }
        let cost = &explained["cost"];
        assert_shares(&cost["tracing"]);
        let traced = of_stage(&cost["tracing"], "camera", "items");
        assert_eq!(traced, number(&cost["samples"]), "{scene}");
        assert!(number(&cost["a_ray"]["closest"]["rays"]) > 0.0, "{scene}");
        // The stages of what scatters are told twice, and the same.
        for name in ["diffuse", "mirror", "glass", "plastic", "metal"] {
            let need = needs
                .iter()
                .find(|need| need["name"] == name)
                .expect("a row");
            let share = of_stage(&cost["tracing"], name, "share");
            assert_eq!(
                need["cost"]["share"].as_f64().unwrap_or(0.0),
                share,
                "{scene}: {name}"
            );
        }
    }
}

#[test]
fn entities_that_ask_are_counted() {
    let folder = Folder::new("askers");
    let scene = r#"Scene(version: 1, camera: (at: (0, 0, 9), look_at: (0, 0, 0)), render: (size: (20, 20)),
        background: Linear(1, 1, 1), materials: {"chalk": Diffuse()},
        entities: [(name: "a", shape: Sphere(radius: 1), material: "chalk"),
            (name: "b", shape: Sphere(radius: 1), material: "chalk", transform: (translate: (3, 0, 0))),
            (name: "c", shape: Sphere(radius: 1), material: "chalk", transform: (translate: (-3, 0, 0)))])"#;
    std::fs::write(folder.0.join("s.ron"), scene).expect("writable");
    let output = folder.run(&["explain", "s.ron"]);
    let text = String::from_utf8_lossy(&output.stdout);
    let line = text
        .lines()
        .find(|line| line.trim_start().starts_with("diffuse"))
        .expect("a line");
    assert!(line.ends_with("asked for by \"a\" and 2 more"), "{line}");
    assert!(line.contains(" % of vertices"), "{line}");
    assert!(text.contains("not needed, costs nothing"), "{text}");
}

fn advice(stats: &Value) -> &str {
    stats["most_would_help"].as_str().unwrap_or("")
}

#[test]
fn advice_is_what_helps_there() {
    let folder = Folder::new("advice");
    let small = |spp: &'static str| ["--size", "64x64", "--spp", spp];
    let noisy = folder.stats("lights", &small("4"));
    let error = number(&noisy["error"]["relative_rmse"]);
    assert!(error > 0.1, "{error}");
    let told = advice(&noisy);
    assert!(
        told.starts_with("--spp ") || told.starts_with("--noise "),
        "{told}"
    );
    assert!(
        told.contains("relative RMSE 6.0 %") && told.contains("times the time"),
        "{told}"
    );
    let independent = folder.stats(
        "lights",
        &[&small("4")[..], &["--sampler", "independent"]].concat(),
    );
    assert!(
        advice(&independent).starts_with("--sampler sobol"),
        "{independent}"
    );
    let unlit = folder.stats(
        "diffuse_room",
        &[&small("16")[..], &["--nee", "off"]].concat(),
    );
    assert!(advice(&unlit).starts_with("--nee on"), "{}", advice(&unlit));
    let fine = folder.stats("diffuse_room", &small("64"));
    assert!(number(&fine["error"]["relative_rmse"]) < 0.03, "{fine}");
    assert!(!advice(&fine).contains("in place of"), "{}", advice(&fine));
}
