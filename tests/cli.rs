//! The command from outside: exit codes, messages, files written whole or not at all.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

const SCENE: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 0, 5), look_at: (0, 0, 0)),
    render: (size: (40, 24), spp: 3, max_bounces: 3),
    materials: { "chalk": Diffuse(color: Linear(0.8, 0.6, 0.4)) },
    entities: [
        (name: "lamp", shape: Sphere(radius: 1), transform: (translate: (0, 4, 2)), emissive: (radiance: (9, 9, 9))),
        (name: "ball", shape: Sphere(radius: 1), material: "chalk"),
    ],
)
"#;

/// A folder of this test's own, with `scene.ron` in it; gone when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("luxel-cli-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).expect("a temporary folder");
        fs::write(path.join("scene.ron"), SCENE).expect("writable");
        Folder(path)
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
        command.args(args).current_dir(&self.0).env("NO_COLOR", "1");
        command
    }

    fn run(&self, args: &[&str]) -> Output {
        self.command(args).output().expect("luxel runs")
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Names in the folder, sorted.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("there").flatten();
        let mut names: Vec<String> = entries
            .map(|e| e.file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
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

/// Asserts the exit code and that stderr has all the words, and shows stderr if not.
#[track_caller]
fn expect(output: &Output, code: i32, words: &[&str]) {
    let talk = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{talk}");
    for word in words {
        assert!(talk.contains(word), "no \"{word}\" in:\n{talk}");
    }
}

#[test]
fn help_shows_what_exists_and_how() {
    let folder = Folder::new("help");
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
    let folder = Folder::new("usage");
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
    let folder = Folder::new("inputs");
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
    let folder = Folder::new("unwritable");
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
fn a_render_leaves_its_file_its_path_and_a_summary() {
    let folder = Folder::new("render");
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
    let folder = Folder::new("memory");
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
fn a_scene_is_never_written_over() {
    let folder = Folder::new("itself");
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
fn equal_renders_are_equal_files() {
    let folder = Folder::new("equal");
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
    let folder = Folder::new("stdout");
    let piped = folder.run(&["render", "scene.ron", "-o", "-"]);
    expect(&piped, 0, &["stdout · 40×24"]);
    assert_eq!(folder.names(), ["scene.ron"]);
    expect(&folder.run(&["render", "scene.ron"]), 0, &[]);
    assert!(piped.stdout == folder.bytes("scene.png"));
}

#[test]
fn check_and_explain_answer_people_and_scripts() {
    let folder = Folder::new("inspect");
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
    let folder = Folder::new("punctual");
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
fn a_reader_that_leaves_is_no_panic() {
    let folder = Folder::new("pipe");
    for args in [
        &["explain", "scene.ron"][..],
        &["render", "scene.ron", "-o", "-"],
    ] {
        let mut child = folder
            .command(args)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("luxel runs");
        drop(child.stdout.take());
        expect(&child.wait_with_output().expect("it ends"), 0, &[]);
    }
}

#[test]
fn time_ends_a_render_with_a_whole_picture() {
    let folder = Folder::new("time");
    let args = [
        "render",
        "scene.ron",
        "--time",
        "300ms",
        "--spp",
        "16777216",
        "--stats",
        "s.json",
    ];
    let start = Instant::now();
    expect(&folder.run(&args), 0, &["scene.png"]);
    assert!(start.elapsed() < Duration::from_secs(20));
    let stats: serde_json::Value = serde_json::from_slice(&folder.bytes("s.json")).expect("JSON");
    let spp = stats["spp"].as_u64().expect("a number");
    assert!((1..16_777_216).contains(&spp), "{spp}");
    assert_eq!(stats["samples"], 40 * 24 * spp, "every pixel has as many");
    assert_eq!(stats["stopped"], false);
    // The recorded count makes the same file again.
    let spp = spp.to_string();
    expect(
        &folder.run(&["render", "scene.ron", "--spp", &spp, "-o", "again.png"]),
        0,
        &[],
    );
    assert!(folder.bytes("again.png") == folder.bytes("scene.png"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_without_an_end_is_refused() {
    let folder = Folder::new("endless");
    expect(
        &folder.run(&["check", "/dev/zero"]),
        66,
        &["/dev/zero", "1 GiB"],
    );
}

#[cfg(unix)]
#[test]
fn an_interrupt_saves_what_there_is() {
    let folder = Folder::new("interrupt");
    // An unused material: its warning on stderr says that the signal has its handler.
    let scene = SCENE.replace("{ \"chalk\"", "{ \"gold\": Metal, \"chalk\"");
    fs::write(folder.path("scene.ron"), scene).expect("writable");
    for (signal, name) in [("INT", "a.png"), ("TERM", "b.exr")] {
        let args = ["render", "scene.ron", "--spp", "16777216", "-o", name];
        let mut child = folder
            .command(&args)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("luxel runs");
        let mut talk = BufReader::new(child.stderr.take().expect("piped"));
        let mut line = String::new();
        talk.read_line(&mut line).expect("a warning");
        assert!(line.contains("gold"), "{line}");
        std::thread::sleep(Duration::from_millis(700));
        let pid = child.id().to_string();
        let sent = Command::new("kill").args(["-s", signal, &pid]).status();
        assert!(sent.expect("kill runs").success());
        let said: Vec<String> = talk.lines().map_while(Result::ok).collect();
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(130), "{said:?}");
        let partial = name.replace('.', ".partial.");
        assert_eq!(text(&output.stdout), format!("{partial}\n"));
        assert!(
            said.iter().any(|l| l.contains("samples per pixel")),
            "{said:?}"
        );
        assert!(folder.path(&partial).is_file());
        assert!(!folder.path(name).exists());
    }
    assert_eq!(
        folder.names(),
        ["a.partial.png", "b.partial.exr", "scene.ron"]
    );
}

#[test]
fn nothing_is_left_beside_the_picture() {
    let folder = Folder::new("beside");
    expect(&folder.run(&["render", "scene.ron", "-o", "a.exr"]), 0, &[]);
    expect(&folder.run(&["render", "scene.ron", "-o", "a.exr"]), 0, &[]);
    assert_eq!(folder.names(), ["a.exr", "scene.ron"]);
    assert!(Path::new(&folder.path("a.exr")).is_file());
}

#[test]
fn the_scene_of_the_readme_reads() {
    let readme = include_str!("../README.md");
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

/// Two renders of the scene with other noise: `a.exr`, `b.exr`, and `a.png`.
fn renders(name: &str) -> Folder {
    let folder = Folder::new(name);
    for (output, seed) in [("a.exr", "1"), ("b.exr", "2"), ("a.png", "1")] {
        let args = ["render", "scene.ron", "-o", output, "--seed", seed];
        expect(&folder.run(&args), 0, &[]);
    }
    folder
}

#[test]
fn an_image_compared_with_itself_has_no_error() {
    let folder = renders("compare-same");
    for image in ["a.exr", "a.png"] {
        for metric in ["rmse", "relmse", "flip"] {
            let args = ["compare", image, image, "--metric", metric, "--max", "0"];
            let output = folder.run(&args);
            expect(&output, 0, &[]);
            let table = text(&output.stdout);
            for row in ["RMSE  0\n", "relMSE  0\n", "PSNR  inf dB\n", "FLIP  0\n"] {
                assert!(table.contains(row), "no {row:?} in:\n{table}");
            }
        }
    }
}

#[test]
fn noise_is_measured_and_judged() {
    let folder = renders("compare-noise");
    let output = folder.run(&["compare", "a.exr", "b.exr", "--json"]);
    expect(&output, 0, &[]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["size"], serde_json::json!([40, 24]));
    assert_eq!(value["pixels"], 960);
    let of = |name: &str| value[name].as_f64().expect("a number");
    assert!(of("rmse") > 0.0 && of("relmse") > 0.0);
    assert!(of("flip") > 0.0 && of("flip") < 1.0);
    assert!((of("psnr") + 20.0 * of("rmse").log10()).abs() < 1e-9);
    for metric in ["rmse", "relmse", "flip"] {
        let judged = |max: f64| {
            let max = max.to_string();
            folder.run(&[
                "compare", "a.exr", "b.exr", "--metric", metric, "--max", &max,
            ])
        };
        expect(&judged(of(metric) * 1.01), 0, &[]);
        let output = judged(of(metric) * 0.99);
        expect(&output, 1, &["is above"]);
        assert!(text(&output.stdout).contains("reference  b.exr"));
    }
}

#[test]
fn the_mask_leaves_lamps_and_their_rims_out() {
    let folder = Folder::new("compare-mask");
    let write = |name: &str, lamp: f32| {
        let pixel = |x, y| {
            let light = if (x, y) == (6, 6) { lamp } else { 0.5 };
            (light, light, light)
        };
        exr::prelude::write_rgb_file(folder.path(name), 12, 12, pixel).expect("writable");
    };
    write("image.exr", 100.0);
    write("reference.exr", 9.0);
    let measured = |args: &[&str]| -> serde_json::Value {
        let args = [&["compare", "image.exr", "reference.exr", "--json"], args].concat();
        serde_json::from_slice(&folder.run(&args).stdout).expect("JSON")
    };
    let (whole, masked) = (measured(&[]), measured(&["--mask", "peers"]));
    assert_eq!(
        (&whole["pixels"], &masked["pixels"]),
        (&144.into(), &95.into())
    );
    assert_eq!(masked["mask"], "peers");
    // 91 off in one pixel of 144.
    let rmse = whole["rmse"].as_f64().expect("a number");
    assert!((rmse - 91.0 / 12.0).abs() < 1e-12, "{rmse}");
    assert_eq!(masked["rmse"], 0.0);
}

#[test]
fn heat_maps_are_pictures_of_the_same_size() {
    let folder = renders("compare-heat");
    for metric in ["flip", "rmse"] {
        let args = [
            "compare",
            "a.exr",
            "b.exr",
            "--heatmap",
            "e.png",
            "--metric",
            metric,
        ];
        expect(&folder.run(&args), 0, &[]);
        expect(&folder.run(&["compare", "e.png", "a.exr"]), 0, &[]);
        fs::remove_file(folder.path("e.png")).expect("written");
    }
}

#[test]
fn what_cannot_be_compared_is_told() {
    let folder = renders("compare-bad");
    let small = ["render", "scene.ron", "-o", "small.png", "--size", "8x5"];
    expect(&folder.run(&small), 0, &[]);
    fs::write(folder.path("cut.exr"), &folder.bytes("a.exr")[..300]).expect("writable");
    let before = folder.names();
    let cases: &[(&[&str], i32, &[&str])] = &[
        (&["a.exr", "small.png"], 2, &["40×24", "8×5"]),
        (&["a.exr", "none.exr"], 66, &["none.exr"]),
        (&["scene.ron", "a.exr"], 65, &["scene.ron", "neither"]),
        (&["cut.exr", "a.exr"], 65, &["cut.exr", "EXR"]),
        (&["a.exr"], 2, &["REFERENCE"]),
        (
            &["a.exr", "b.exr", "--metric", "psnr", "--max", "30"],
            2,
            &["psnr", "--metric rmse"],
        ),
        (&["a.exr", "b.exr", "--max", "NaN"], 2, &["0.01"]),
        (&["a.exr", "b.exr", "--ppd", "1"], 2, &["10 to 1000"]),
        (&["a.exr", "b.exr", "--heatmap", "e.exr"], 2, &[".png"]),
        (
            &["a.png", "b.exr", "--heatmap", "./a.png"],
            2,
            &["overwrite"],
        ),
        (
            &["a.exr", "b.exr", "--heatmap", "no/e.png"],
            74,
            &["no/e.png"],
        ),
    ];
    for (args, code, words) in cases {
        let args = [&["compare"], *args].concat();
        expect(&folder.run(&args), *code, words);
    }
    assert_eq!(folder.names(), before);
}

#[test]
fn values_that_are_not_finite_fail() {
    use exr::prelude::write_rgb_file;
    let folder = Folder::new("compare-nan");
    let write = |name: &str, bad: f32| {
        let pixel = |x, y| match (x, y) {
            (3, 2) | (1, 4) => (0.5f32, bad, 0.5),
            _ => (0.5, 0.5, 0.5),
        };
        write_rgb_file(folder.path(name), 6, 5, pixel).expect("writable");
    };
    write("good.exr", 0.5);
    for (name, bad) in [("nan.exr", f32::NAN), ("inf.exr", f32::INFINITY)] {
        write(name, bad);
        let place = ["2 pixels", "not finite", "column 3, row 2"];
        expect(&folder.run(&["compare", name, "good.exr"]), 1, &place);
        let output = folder.run(&["compare", "good.exr", name, "--mask", "peers"]);
        expect(&output, 1, &["the reference has 2 pixels"]);
        expect(&folder.run(&["compare", name, name]), 1, &["the image has"]);
    }
}
