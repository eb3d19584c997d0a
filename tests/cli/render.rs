//! What a render leaves behind.

use crate::SCENE;
use crate::folder;
use crate::support::{expect, text};
use std::fs;
use std::path::Path;

#[test]
fn a_render_leaves_its_file_its_path_and_a_summary() {
    let folder = folder("render");
    let output = folder.run(&["render", "scene.ron", "--stats", "s.json"]);
    expect(
        &output,
        0,
        &[
            "scene.png · 40×24 · 3 spp",
            "relative RMSE",
            "Mrays/s",
            "extract",
            "tree",
            "what would help most",
        ],
    );
    assert_eq!(text(&output.stdout), "scene.png\n");
    assert_eq!(folder.names(), ["s.json", "scene.png", "scene.ron"]);
    let stats: serde_json::Value = serde_json::from_slice(&folder.bytes("s.json")).expect("JSON");
    assert_eq!(stats["spp"], 3);
    assert_eq!(stats["samples"], 40 * 24 * 3);
    assert_eq!(stats["stopped"], false);
    assert_eq!(stats["ended_by"], "samples");
    assert!(stats["error"]["relative_rmse"].as_f64() > Some(0.0));
    let shares = stats["shares"].as_object().expect("stages");
    let all: f64 = shares.values().filter_map(serde_json::Value::as_f64).sum();
    assert!((all - 1.0).abs() < 1e-9, "{shares:?}");
    assert!(stats["per_ray"]["rays_per_sample"].as_f64() >= Some(1.0));
    assert_eq!(stats["bytes"]["files"], 0);
    assert!(stats["bytes"]["buffers"].as_u64() > Some(0));
}

#[test]
fn files_may_take_only_so_much_memory() {
    let folder = folder("memory");
    let mesh = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", "f 1 2 3\n".repeat(100));
    fs::write(folder.path("large.obj"), mesh).expect("writable");
    let entity = "entities: [(shape: Mesh(\"large.obj\")),";
    let scene = SCENE.replacen("entities: [", entity, 1);
    fs::write(folder.path("scene.ron"), scene).expect("writable");
    for command in ["render", "check", "explain"] {
        let refused = folder.run(&[command, "scene.ron", "--max-memory", "1K"]);
        expect(&refused, 65, &["E111", "1.0 KiB", "--max-memory 1M"]);
        let done = folder.run(&[command, "scene.ron", "--max-memory", "1M"]);
        expect(&done, 0, &[]);
        let wrong = folder.run(&[command, "scene.ron", "--max-memory", "lots"]);
        expect(&wrong, 2, &["512M"]);
    }
}

#[test]
fn equal_renders_are_equal_files() {
    let folder = folder("equal");
    let aovs = "albedo,normal,geonormal,depth,uv,prim,entity,samples,stderr";
    let variants: [&[&str]; 5] = [
        &["--threads", "1", "--tile", "32"],
        &["--threads", "2", "--tile", "7"],
        &["--threads", "5", "--tile", "64", "--accel", "brute"],
        &["--isa", "scalar", "--accel", "box"],
        &["--tree", "fast"],
    ];
    for (i, flags) in variants.iter().enumerate() {
        let (png, exr) = (format!("{i}.png"), format!("{i}.exr"));
        let render = ["render", "scene.ron", "-o"];
        let for_png = [&render[..], &[&png], flags].concat();
        let for_exr = [&render[..], &[&exr, "--aov", aovs], flags].concat();
        expect(&folder.run(&for_png), 0, &[]);
        expect(&folder.run(&for_exr), 0, &[]);
        assert!(folder.bytes(&png) == folder.bytes("0.png"), "{flags:?}");
        assert!(folder.bytes(&exr) == folder.bytes("0.exr"), "{flags:?}");
    }
    expect(
        &folder.run(&["render", "scene.ron", "-o", "seed.exr", "--seed", "1"]),
        0,
        &[],
    );
    expect(
        &folder.run(&["render", "scene.ron", "-o", "none.exr"]),
        0,
        &[],
    );
    assert!(folder.bytes("seed.exr") != folder.bytes("none.exr"));
    // The scene's place is no part of what made the picture.
    fs::create_dir(folder.path("moved")).expect("writable");
    fs::copy(folder.path("scene.ron"), folder.path("moved/other.ron")).expect("writable");
    expect(&folder.run(&["render", "moved/other.ron"]), 0, &[]);
    assert!(folder.bytes("other.png") == folder.bytes("0.png"));
}

#[test]
fn stdout_takes_the_picture_and_nothing_else() {
    let folder = folder("stdout");
    let piped = folder.run(&["render", "scene.ron", "-o", "-"]);
    expect(&piped, 0, &["stdout · 40×24"]);
    assert_eq!(folder.names(), ["scene.ron"]);
    expect(&folder.run(&["render", "scene.ron"]), 0, &[]);
    assert!(piped.stdout == folder.bytes("scene.png"));
}

#[test]
fn nothing_is_left_beside_the_picture() {
    let folder = folder("beside");
    expect(&folder.run(&["render", "scene.ron", "-o", "a.exr"]), 0, &[]);
    expect(&folder.run(&["render", "scene.ron", "-o", "a.exr"]), 0, &[]);
    assert_eq!(folder.names(), ["a.exr", "scene.ron"]);
    assert!(Path::new(&folder.path("a.exr")).is_file());
}
