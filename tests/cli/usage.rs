//! Help, arguments, inputs and outputs: what is refused, how, and before what.

use crate::SCENE;
use crate::folder;
use crate::support::{expect, text};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

#[test]
fn help_shows_what_exists_and_how() {
    let folder = folder("help");
    let top = folder.run(&["--help"]);
    expect(&top, 0, &[]);
    let top = text(&top.stdout);
    for word in [
        "render",
        "animate",
        "turntable",
        "convert",
        "check",
        "explain",
        "compare",
        "Examples:",
        "Exit codes:",
    ] {
        assert!(top.contains(word), "no {word} in:\n{top}");
    }
    let render = text(&folder.run(&["render", "--help"]).stdout);
    let flags = [
        "--output",
        "--spp",
        "--time",
        "--noise",
        "--vs",
        "--size",
        "--frame",
        "--bounces",
        "--exposure",
        "--seed",
        "--sampler",
        "--threads",
        "--isa",
        "--accel",
        "--tree",
        "--tile",
        "--aov",
        "--nee",
        "--mis",
        "--roulette",
        "--fresnel",
        "--stats",
        "Examples:",
        "[default: 32]",
        "geonormal",
    ];
    for flag in flags {
        assert!(render.contains(flag), "no {flag} in:\n{render}");
    }
    expect(&folder.run(&[]), 2, &["Usage:"]);
    assert_eq!(text(&folder.run(&["--version"]).stdout), "luxel 0.1.0\n");
}

#[test]
fn wrong_arguments_are_explained_and_cost_nothing() {
    let folder = folder("usage");
    let cases: &[(&[&str], &[&str])] = &[
        (&["--threads", "0"], &["--threads", "1..=1024"]),
        (&["--spp", "0"], &["--spp", "1..="]),
        (&["--spp", "many"], &["--spp", "many"]),
        (&["--tile", "0"], &["--tile", "1..="]),
        (&["--bounces", "-1"], &["-1"]),
        (&["--size", "0x5"], &["--size", "640x360"]),
        (&["--size", "32768x32768"], &["pixels"]),
        (&["--time", "5"], &["--time", "30s"]),
        (&["--noise", "0"], &["--noise", "1%"]),
        (&["--exposure", "NaN"], &["--exposure", "stops"]),
        (&["--isa", "neon"], &["neon", "scalar"]),
        (&["--nee", "maybe"], &["on, off"]),
        (&["--aov", "normall"], &["normall", "'normal'"]),
        (&["--aov", "normal"], &["PNG", "normal", ".exr"]),
        (&["-o", "a.bmp"], &["a.bmp", ".png", ".exr"]),
        (&["-o", "a"], &["\"a\"", ".png"]),
        (&["--stats", "scene.ron"], &["scene.ron", ".json"]),
        (
            &["-o", "a.exr", "--aov", "depth,depth"],
            &["depth", "twice"],
        ),
        (&["--sp", "3"], &["--spp"]),
    ];
    for (flags, words) in cases {
        let args: Vec<&str> = ["render", "scene.ron"]
            .iter()
            .chain(*flags)
            .copied()
            .collect();
        expect(&folder.run(&args), 2, words);
    }
    expect(&folder.run(&["rendr", "scene.ron"]), 2, &["render"]);
    assert_eq!(folder.names(), ["scene.ron"]);
}

#[test]
fn missing_and_bad_inputs_have_their_codes() {
    let folder = folder("inputs");
    for command in ["render", "check", "explain"] {
        expect(
            &folder.run(&[command, "no.ron"]),
            66,
            &["no.ron", "no such file"],
        );
    }
    let bad = SCENE.replace("\"chalk\")", "\"chalck\")");
    fs::write(folder.path("bad.ron"), bad).expect("writable");
    for command in ["render", "check", "explain"] {
        let words = ["bad.ron:8:", "chalck", "did you mean"];
        expect(&folder.run(&[command, "bad.ron"]), 65, &words);
    }
    let mesh = SCENE.replace("Sphere(radius: 1), material", "Mesh(\"no.obj\"), material");
    fs::write(folder.path("mesh.ron"), mesh).expect("writable");
    expect(
        &folder.run(&["render", "mesh.ron"]),
        65,
        &["mesh.ron", "no.obj"],
    );
    fs::write(folder.path("noise.ron"), [0xff, 0x00, 0xfe]).expect("writable");
    expect(&folder.run(&["render", "noise.ron"]), 65, &["noise.ron"]);
    expect(&folder.run(&["check", "."]), 66, &["cannot read"]);
    assert_eq!(
        folder.names(),
        ["bad.ron", "mesh.ron", "noise.ron", "scene.ron"]
    );
}

#[test]
fn unwritable_outputs_fail_before_rendering() {
    let folder = folder("unwritable");
    fs::create_dir(folder.path("folder.png")).expect("writable");
    let start = Instant::now();
    for output in ["no/such/a.png", "folder.png", "scene.ron/a.exr", "new.png/"] {
        // A minute of rendering if the check came late.
        let args = [
            "render",
            "scene.ron",
            "-o",
            output,
            "--spp",
            "16777216",
            "--time",
            "1m",
        ];
        expect(&folder.run(&args), 74, &[output, "cannot write"]);
    }
    let args = [
        "render",
        "scene.ron",
        "--stats",
        "no/such/s.json",
        "--time",
        "1m",
    ];
    expect(&folder.run(&args), 74, &["s.json"]);
    assert!(start.elapsed() < Duration::from_secs(30));
    assert_eq!(folder.names(), ["folder.png", "scene.ron"]);
}

#[test]
fn a_scene_is_never_written_over() {
    let folder = folder("itself");
    fs::copy(folder.path("scene.ron"), folder.path("room.png")).expect("writable");
    for args in [
        &["render", "room.png"][..],
        &["render", "room.png", "-o", "./room.png"],
    ] {
        expect(&folder.run(args), 2, &["room.png", "the scene itself"]);
    }
    assert_eq!(text(&folder.bytes("room.png")), SCENE);
}

#[test]
fn check_and_explain_answer_people_and_scripts() {
    let folder = folder("inspect");
    expect(
        &folder.run(&["check", "scene.ron"]),
        0,
        &["scene.ron: no errors, no warnings"],
    );
    let unused = SCENE.replace("{ \"chalk\"", "{ \"gold\": Metal, \"chalk\"");
    fs::write(folder.path("unused.ron"), unused).expect("writable");
    expect(
        &folder.run(&["check", "unused.ron"]),
        0,
        &["gold", "no errors, 1 warning"],
    );
    let json = folder.run(&["check", "--json", "unused.ron"]);
    expect(&json, 0, &[]);
    let found: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert_eq!(found["diagnostics"][0]["severity"], "warning");
    fs::write(folder.path("bad.ron"), SCENE.replace("spp: 3", "spp: 0")).expect("writable");
    let json = folder.run(&["check", "--json", "bad.ron"]);
    expect(&json, 65, &[]);
    let found: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert_eq!(found["diagnostics"][0]["line"], 4);

    let explained = text(&folder.run(&["explain", "scene.ron"]).stdout);
    for words in [
        "diffuse",
        "asked for by \"ball\"",
        "asked for by \"lamp\"",
        "not needed",
        "40x24",
    ] {
        assert!(explained.contains(words), "no {words} in:\n{explained}");
    }
    let json = folder.run(&["explain", "--json", "scene.ron"]);
    let explained: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert_eq!(explained["settings"]["spp"], "3");
    assert_eq!(explained["hash"].as_str().map(str::len), Some(64));
}

#[test]
fn lights_without_extent_are_explained_and_missed() {
    let folder = folder("punctual");
    let lit = SCENE.replace(
        "(name: \"ball\"",
        "(name: \"moon\", light: Sun(irradiance: (1, 1, 1))), (name: \"ball\"",
    );
    fs::write(folder.path("lit.ron"), lit).expect("writable");
    let explained = text(&folder.run(&["explain", "lit.ron"]).stdout);
    let line = explained
        .lines()
        .find(|line| line.contains("lights without extent"));
    assert!(line.is_some_and(|line| line.ends_with("asked for by \"moon\"")));
    let warning = "with --nee off, lights without extent";
    expect(
        &folder.run(&["render", "lit.ron", "--nee", "off"]),
        0,
        &[warning],
    );
    for args in [
        &["render", "lit.ron"][..],
        &["render", "scene.ron", "--nee", "off"],
    ] {
        let told = folder.run(args);
        expect(&told, 0, &[]);
        assert!(!text(&told.stderr).contains(warning));
    }
}

#[test]
fn the_scene_of_the_readme_reads() {
    let readme = include_str!("../../README.md");
    let scene = readme
        .split("```ron\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next())
        .expect("a scene");
    let read = luxel::scene::parse(scene, Path::new("scenes/readme.ron"));
    let (desc, warnings) = read.expect("no errors");
    assert!(warnings.is_empty(), "{warnings:?}");
    luxel::world::spawn(&desc, luxel::asset::Loader::new()).expect("its files are there");
}
