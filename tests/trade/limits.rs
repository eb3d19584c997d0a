//! The command line: what ends a render, what it says of it, and how the error falls.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Instant;

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/lens.ron");

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("a scratch folder");
    folder
}

fn luxel(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
    let command = command
        .current_dir(folder)
        .args(["render", SCENE, "--size", "48x32"]);
    command.args(arguments).output().expect("luxel")
}

fn said(output: &Output) -> String {
    assert!(output.status.success(), "{output:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn stats(folder: &Path) -> serde_json::Value {
    let text = std::fs::read(folder.join("s.json")).expect("stats");
    serde_json::from_slice(&text).expect("JSON")
}

#[test]
fn the_first_of_three_limits_ends_a_render() {
    let folder = folder("trade_limits");
    for (arguments, ended, words) in [
        (
            ["--noise", "50%", "--spp", "400", "--time", "60s"],
            "noise",
            "ended by --noise 50 %",
        ),
        (
            ["--noise", "1%", "--spp", "8", "--time", "60s"],
            "samples",
            "8 spp, ended by --spp",
        ),
        (
            ["--noise", "0.1%", "--spp", "100000", "--time", "300ms"],
            "time",
            "ended by --time",
        ),
    ] {
        let output = luxel(&folder, &[&arguments[..], &["--stats", "s.json"]].concat());
        let said = said(&output);
        assert!(
            said.contains(words) && said.contains("relative RMSE"),
            "{said}"
        );
        let stats = stats(&folder);
        assert_eq!(stats["ended_by"], ended, "{stats}");
        assert!(stats["error"]["relative_rmse"].as_f64().expect("an error") > 0.0);
    }
    let refused = luxel(&folder, &["--noise", "0"]);
    assert_eq!(refused.status.code(), Some(2));
}

/// Against itself with as many samples, the last pass has no error; the first has the most.
#[test]
fn the_error_falls_pass_by_pass() {
    let folder = folder("trade_versus");
    said(&luxel(&folder, &["--spp", "16", "-o", "r.exr"]));
    let output = luxel(&folder, &["--spp", "16", "-o", "x.png", "--vs", "r.exr"]);
    said(&output);
    let names = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(names, "x.png\nx.error.csv\nx.error.svg\n");
    let csv = std::fs::read_to_string(folder.join("x.error.csv")).expect("a table");
    let rows: Vec<Vec<&str>> = csv
        .lines()
        .skip(1)
        .map(|row| row.split(',').collect())
        .collect();
    let column = |k: usize| {
        rows.iter()
            .map(|row| row[k].parse().expect("a number"))
            .collect::<Vec<f64>>()
    };
    assert_eq!(column(0), [1.0, 2.0, 4.0, 8.0, 16.0]);
    let errors = column(3);
    assert!(errors[0] > errors[2] && errors[2] > errors[3], "{csv}");
    assert_eq!(errors[4], 0.0);
    assert!(column(1).windows(2).all(|two| two[0] <= two[1]));
    let svg = std::fs::read_to_string(folder.join("x.error.svg")).expect("a chart");
    assert_eq!(svg.matches("<circle").count(), 4);
    for (arguments, hint) in [
        (
            ["--vs", "r.exr", "--size", "24x16"],
            "only images of one size",
        ),
        (["--vs", "r.exr", "-o", "-"], "name the image"),
    ] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
        let command = command.current_dir(&folder).args(["render", SCENE]);
        let refused = command.args(arguments).output().expect("luxel");
        assert_eq!(refused.status.code(), Some(2), "{refused:?}");
        assert!(
            String::from_utf8_lossy(&refused.stderr).contains(hint),
            "{refused:?}"
        );
    }
}

#[test]
#[ignore = "long, and wrong on a machine that is busy; cargo test --release --test trade time_is -- --ignored --nocapture"]
fn the_time_is_met() {
    let folder = folder("trade_time");
    for (size, seconds) in [
        ("48x32", 1.0),
        ("512x340", 2.0),
        ("1920x1280", 5.0),
        ("512x340", 10.0),
    ] {
        let start = Instant::now();
        let time = format!("{seconds}s");
        let output = luxel_at(&folder, &["--size", size, "--time", &time]);
        let off = start.elapsed().as_secs_f64() - seconds;
        println!(
            "{size} --time {time}: off by {off:+.3} s: {}",
            said(&output)
        );
        assert!(off.abs() <= (0.03 * seconds).max(0.2), "{size}: {off}");
    }
}

fn luxel_at(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
    let command = command.current_dir(folder).args(["render", SCENE]);
    command.args(arguments).output().expect("luxel")
}
