//! The command: what it measures is so, and `luxel render -q` renders what it says.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// So few pixels that they are measured as they are, whatever the machine: pictures are the same on every one.
const SCENE: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 1, 6), look_at: (0, 0, 0)),
    render: (size: (16, 15), spp: 3, max_bounces: 4),
    background: Linear(0.3, 0.35, 0.4),
    materials: { "chalk": Diffuse(color: Linear(0.8, 0.7, 0.6)), "coat": Plastic(color: Linear(0.3, 0.5, 0.7)) },
    entities: [
        (name: "lamp", shape: Sphere(radius: 2), transform: (translate: (0, 6, 2)), emissive: (radiance: (3, 3, 3))),
        (name: "ball", shape: Sphere(radius: 1), material: "coat"),
        (name: "floor", shape: Sphere(radius: 100), transform: (translate: (0, -101, 0)), material: "chalk"),
    ],
)
"#;

struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Place {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("tune_{name}"));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("scene.ron"), SCENE).unwrap();
        Place(folder)
    }

    /// Runs luxel; the exit code, stdout and stderr.
    fn run(&self, args: &[&str]) -> (i32, String, String) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
        let output = command.args(args).current_dir(&self.0).env("NO_COLOR", "1");
        let Output {
            status,
            stdout,
            stderr,
        } = output.output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        (status.code().unwrap(), text(stdout), text(stderr))
    }

    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.0.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
}

/// On an idle machine it takes a second or two: all seeds are rendered long before the budget is spent.
const LONG: Duration = Duration::from_secs(60);

#[test]
fn what_is_found_is_so_and_renders() {
    let place = Place::new("whole");
    let start = Instant::now();
    let args = [
        "tune",
        "scene.ron",
        "--budget",
        "60s",
        "--json",
        "--csv",
        "t.csv",
        "--svg",
        "t.svg",
    ];
    let (code, out, talk) = place.run(&args);
    assert_eq!(code, 0, "{talk}");
    assert!(start.elapsed() < LONG, "the budget was 60 s");
    let found: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(found["size"], found["full_size"]);
    let settings = found["settings"].as_array().unwrap();
    let mut told = Vec::new();
    for row in settings {
        let arguments = row["arguments"].as_str().unwrap();
        let biased = ["--bounces", "--fresnel"]
            .iter()
            .any(|d| arguments.contains(d));
        assert_eq!(row["biased"], biased, "{row}");
        let number = |key: &str| row["squared_bias"][key].as_f64().unwrap();
        let (value, half) = (number("value"), number("half_width"));
        // Half of a 95 % interval is two standard deviations: five of them never happen.
        assert!(
            biased || value.abs() < 2.5 * half,
            "{arguments}: {value} {half}"
        );
        if arguments.starts_with("--bounces 1") {
            assert!(value > half, "{arguments} has a bias: {row}");
            told.push(arguments);
        }
        let levels = row["levels"].as_array().unwrap();
        let squared = |k: usize| levels[k]["variance"]["value"].as_f64().unwrap();
        let fall = squared(0) / squared(levels.len() - 1);
        let spp = levels[levels.len() - 1]["spp"].as_f64().unwrap();
        assert!(
            fall > 0.5 * spp,
            "{arguments}: variance falls by {fall} in {spp} samples"
        );
    }
    assert!(settings.len() > 12, "{out}");
    assert!(!told.is_empty(), "{out}");
    // Equal pictures: trees change no bit.
    for row in settings {
        let arguments = row["arguments"].as_str().unwrap();
        let parent = arguments.strip_suffix("--tree fast").map(str::trim_end);
        let parent = settings
            .iter()
            .find(|row| row["arguments"].as_str() == parent);
        if let Some(parent) =
            parent.filter(|p| p["levels"][1]["seeds"] == row["levels"][1]["seeds"])
        {
            let squared = |row: &serde_json::Value| row["levels"][1]["squared_error"].clone();
            assert_eq!(squared(row), squared(parent), "{arguments}");
        }
    }
    let csv = String::from_utf8(place.read("t.csv")).unwrap();
    let levels = settings
        .iter()
        .map(|row| row["levels"].as_array().unwrap().len());
    assert_eq!(csv.lines().count(), 1 + levels.sum::<usize>());
    let svg = String::from_utf8(place.read("t.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("<polyline") && svg.contains("final: "));
    renders_what_it_says(&place, &found);
    tells_of_another_scene(&place);
}

/// The line to paste and `-q` make the same file.
fn renders_what_it_says(place: &Place, found: &serde_json::Value) {
    let picks = found["picks"].as_array().unwrap();
    assert_eq!(picks.len(), 3);
    for pick in picks {
        let quality = pick["quality"].as_str().unwrap();
        let (code, _, talk) = place.run(&["render", "scene.ron", "-q", quality, "-o", "q.exr"]);
        assert_eq!(code, 0, "{talk}");
        assert!(!talk.contains("changed"), "{talk}");
        let line = pick["arguments"].as_str().unwrap();
        let mut args = vec!["render", "scene.ron", "-o", "line.exr"];
        args.extend(line.split(' '));
        let (code, _, talk) = place.run(&args);
        assert_eq!(code, 0, "{line}: {talk}");
        assert!(
            place.read("q.exr") == place.read("line.exr"),
            "{quality}: {line}"
        );
    }
    let args = [
        "render",
        "scene.ron",
        "-q",
        "draft",
        "--spp",
        "1",
        "--size",
        "5x5",
    ];
    let (code, _, talk) = place.run(&args);
    assert!(code == 0 && talk.contains("5×5 · 1 spp"), "{talk}");
}

fn tells_of_another_scene(place: &Place) {
    std::fs::write(place.0.join("scene.ron"), SCENE.replace("0.7", "0.71")).unwrap();
    let (code, _, talk) = place.run(&["render", "scene.ron", "-q", "draft"]);
    assert_eq!(code, 0, "{talk}");
    assert!(
        talk.contains("has changed") && talk.contains("luxel tune scene.ron"),
        "{talk}"
    );
}

#[test]
fn what_cannot_be_is_said() {
    let place = Place::new("errors");
    let render = ["render", "scene.ron", "-q", "draft"];
    let cases: [(&[&str], i32, &str); 6] = [
        (&render, 66, "luxel tune scene.ron"),
        (&["render", "scene.ron", "-q", "best"], 2, "draft"),
        (
            &["render", "scene.ron", "-q", "draft", "--sampler", "sobol"],
            2,
            "--sampler",
        ),
        (&["tune", "scene.ron", "-o", "scene.ron"], 2, ".json"),
        (
            &["tune", "scene.ron", "--svg", "no/such/t.svg"],
            74,
            "t.svg",
        ),
        (&["tune", "scene.ron", "--final", "0"], 2, "0.01%"),
    ];
    for (args, wanted, words) in cases {
        let (code, _, talk) = place.run(args);
        assert_eq!(code, wanted, "{args:?}: {talk}");
        assert!(talk.contains(words), "{args:?}: {talk}");
    }
    let (code, _, talk) = place.run(&["tune", "scene.ron", "--budget", "1ms"]);
    assert!(code == 2 && talk.contains("too short"), "{talk}");
    assert!(!place.0.join("scene.tune.json").exists());
    let dials = r#""size": "9x9", "bounces": 1, "nee": "on", "mis": "on", "sampler": "sobol", "roulette": "on",
        "fresnel": "exact", "accel": "bvh", "tree": "good""#;
    for (text, words) in [
        ("{", "EOF"),
        ("{}", "`scene`"),
        (r#"{"scene": "x"}"#, "no settings for draft"),
        (
            &format!(r#"{{"scene": "x", "qualities": {{"draft": {{{dials}}}}}}}"#),
            "`spp`",
        ),
        (
            &format!(r#"{{"scene": "x", "qualities": {{"draft": {{"spp": 0, {dials}}}}}}}"#),
            "`spp`",
        ),
    ] {
        std::fs::write(place.0.join("scene.tune.json"), text).unwrap();
        let (code, _, talk) = place.run(&render);
        assert_eq!(code, 65, "{text}: {talk}");
        assert!(
            talk.contains(words) && talk.contains("scene.tune.json"),
            "{text}: {talk}"
        );
    }
}
