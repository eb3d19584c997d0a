//! `luxel stability` from outside: scenes that are safe, and scenes of which it names what goes wrong.

#![allow(clippy::unwrap_used, reason = "a test may")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

fn run(name: &str, scene: &str, args: &[&str]) -> (Output, PathBuf) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("stability_{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("cube.obj"), CUBE).unwrap();
    std::fs::write(folder.join("scene.ron"), scene).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
    command.args(["stability", "scene.ron"]).args(args);
    let output = command.current_dir(&folder).env("NO_COLOR", "1").output();
    (output.unwrap(), folder)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A room with a lamp, a glass ball, an instance that turns and a lens: lengths that are short in binary.
const ROOM: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 0.5, 3.5), look_at: (0, 0, 0), lens: (aperture_radius: 0.125, focus_distance: 3.5)),
    render: (size: (64, 48), max_bounces: 5),
    materials: { "chalk": Diffuse(color: Linear(0.8, 0.6, 0.4)), "glass": Glass(ior: 1.5) },
    entities: [
        (name: "room", shape: Mesh("cube.obj"), normals: Flat, material: "chalk", transform: (scale: 4)),
        (name: "lamp", shape: Sphere(radius: 0.5), transform: (translate: (0, 3, 1)), emissive: (radiance: (9, 9, 9))),
        (name: "bulb", light: Point(intensity: (4, 4, 4)), transform: (translate: (2, 2, 2))),
        (name: "ball", shape: Sphere(radius: 1), material: "glass", transform: (translate: (1.5, 0, 0))),
        (name: "hub", transform: (translate: (-1.5, 0, 0)), spin: (axis: (0, 1, 0), deg_per_s: 90)),
        (name: "box", parent: "hub", shape: Mesh("cube.obj"), normals: Flat, transform: (translate: (0.5, 0, 0), scale: 0.5)),
    ],
)
"#;

#[test]
fn a_room_is_safe_and_exact_at_powers_of_two() {
    let files = [
        "--csv", "t.csv", "--svg", "t.svg", "--json", "--rays", "4000",
    ];
    let exact = [
        "--scales",
        "0.0009765625,1,1048576",
        "--offsets",
        "0,64,1048576",
    ];
    let (output, folder) = run("room", ROOM, &[&files[..], &exact].concat());
    let talk = text(&output.stderr);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{talk}{}",
        text(&output.stdout)
    );
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["safe"], true);
    assert_eq!(found["room"], true, "nothing leaves it");
    // Twelve triangles have eighteen edges; two boxes, two balls.
    assert_eq!(
        (&found["shared_edges"], &found["closed_parts"]),
        (&36.into(), &4.into())
    );
    let rows = found["placings"].as_array().unwrap();
    assert_eq!(rows.len(), 9);
    for row in rows {
        assert_eq!(row["pixels_differ"], 0, "{row}");
        assert!(row["rays"].as_u64().unwrap() > 10_000, "{row}");
        assert_eq!(row["rays"], rows[0]["rays"], "the same probes everywhere");
    }
    let csv = std::fs::read_to_string(folder.join("t.csv")).unwrap();
    assert_eq!(csv.lines().count(), 10);
    assert!(csv.starts_with("scale,offset,rays,leaks"), "{csv}");
    let svg = std::fs::read_to_string(folder.join("t.svg")).unwrap();
    assert!(
        svg.starts_with("<svg") && svg.matches("<circle").count() >= 9,
        "{svg}"
    );
}

#[test]
fn between_powers_of_two_a_room_is_safe() {
    let args = [
        "--scales",
        "1e-6,1e6",
        "--offsets",
        "0.3,1e7",
        "--rays",
        "4000",
    ];
    let (output, _) = run("between", ROOM, &args);
    let told = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{told}");
    let last = told.lines().last().unwrap();
    assert!(last.starts_with("safe: none of "), "{told}");
}

/// A box a hundred million times smaller than the scene is wide is no more than a few of single precision's steps.
#[test]
fn what_is_too_small_for_single_precision_is_named() {
    let far = r#"(name: "moon", shape: Sphere(radius: 1), transform: (translate: (1e7, 0, 0))),
        (name: "lamp","#;
    let scene = ROOM.replace("(name: \"lamp\",", far);
    let (output, _) = run("far", &scene, &["--offsets", "0,1", "--rays", "4000"]);
    let told = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{told}");
    let last = told.lines().last().unwrap();
    assert!(
        last.starts_with("not safe: \"") && last.contains("first to go wrong, at home: "),
        "{told}"
    );
    assert!(last.contains("leaks"), "{last}");
    assert!(!last.contains("moon"), "{last}");
}

/// Samples that are not finite count, at the entity where they came to be.
#[test]
fn samples_that_are_not_finite_are_told() {
    let lamp = r#"(light: Point(intensity: (1e18, 1e18, 1e18)), transform: (translate: (0, 5.5e-11, 0))),"#;
    let scene = format!(
        r#"Scene(version: 1, camera: (at: (0, 2e-10, 3e-10), look_at: (0, 0, 0), vfov_deg: 40),
        render: (size: (32, 24), max_bounces: 2), materials: {{ "white": Diffuse(color: Linear(1, 1, 1)) }},
        entities: [(name: "floor", shape: Sphere(radius: 1e-9), transform: (translate: (0, -1e-9, 0)), material: "white"),
        {lamp}{lamp}{lamp}{lamp}])"#
    );
    let (output, _) = run("lost", &scene, &["--scales", "2", "--rays", "1000"]);
    let told = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{told}");
    let last = told.lines().last().unwrap();
    let words = "not safe: \"floor\" (a sphere) is the first to go wrong, at home: ";
    assert!(
        last.starts_with(words) && last.contains("not finite"),
        "{told}"
    );
}

#[test]
fn files_and_numbers_are_checked_first() {
    for (args, code, words) in [
        (&["--scales", "0"][..], 2, "1e-30"),
        (&["--offsets=-1"], 2, "widths"),
        (&["--svg", "no/such/t.svg"], 74, "t.svg"),
    ] {
        let (output, _) = run("args", ROOM, args);
        let talk = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{talk}");
        assert!(talk.contains(words), "{talk}");
    }
}
