//! Renders that are killed or stopped wherever it may be: the same line goes on, to the same bits, and no file is ever broken.

use crate::folder::{AOVS, Folder};
use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

fn spawn(folder: &Folder, line: &str) -> Child {
    let mut command = folder.command(line);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("luxel runs")
}

fn signal(child: &Child, name: &str) {
    let pid = child.id().to_string();
    let sent = Command::new("kill").args(["-s", name, &pid]).status();
    assert!(sent.expect("kill runs").success());
}

/// Kills a render at `rounds` moments, by SIGKILL and SIGTERM in turns, and lets it go on; every other time it is killed
/// twice.
fn kill(name: &str, line: &str, rounds: u32) {
    let folder = Folder::new(name);
    let start = Instant::now();
    folder.expect(&format!("{line} -o a.exr"), 0, &[]);
    let took = start.elapsed();
    let wanted = folder.bytes("a.exr");
    let line = format!("{line} -o a.exr --checkpoint 20ms");
    let (mut cut_short, mut said_75, mut went_on) = (0, 0, 0);
    for round in 0..rounds {
        folder.clear();
        for again in 0..1 + round % 2 {
            // The golden ratio's multiples spread over the run, each round elsewhere.
            let share = (f64::from(3 * round + again) * 0.618_034 + 0.1).fract();
            let mut child = spawn(&folder, &line);
            std::thread::sleep(took.mul_f64(share));
            let name = if round % 4 < 2 { "KILL" } else { "TERM" };
            signal(&child, name);
            let status = child.wait().expect("ours");
            cut_short += u32::from(!status.success());
            said_75 += u32::from(status.code() == Some(75));
            let there = folder.names();
            if there.iter().any(|name| name == "a.exr") {
                assert!(
                    folder.bytes("a.exr") == wanted,
                    "round {round}: a broken image"
                );
            }
            if there.iter().any(|name| name == "a.exr.part") {
                went_on += 1;
                folder.expect("info a.exr.part", 0, &[]);
            }
        }
        folder.expect(&line, 0, &[]);
        assert!(folder.bytes("a.exr") == wanted, "round {round}");
        assert_eq!(folder.names(), ["a.exr", "a.exr.part"], "round {round}");
    }
    println!("{cut_short} cut short, {said_75} of them with 75; {went_on} left a part");
    assert!(cut_short >= rounds / 2, "only {cut_short} were cut short");
    assert!(said_75 >= rounds / 8 && went_on >= rounds / 4);
}

#[cfg(unix)]
#[test]
fn killed_at_any_moment_it_goes_on_to_the_same_bits() {
    let line = format!("render s.ron --size 96x64 --spp 61 --tile 16 --aov {AOVS}");
    kill("killed", &line, 8);
}

/// `cargo test --release --test parts fifty -- --ignored --nocapture`, two minutes.
#[cfg(unix)]
#[test]
#[ignore = "two minutes"]
fn killed_at_fifty_moments_it_goes_on_to_the_same_bits() {
    let line = format!("render s.ron --size 320x200 --spp 93 --tile 16 --aov {AOVS}");
    kill("fifty", &line, 50);
}

#[cfg(unix)]
#[test]
fn a_share_that_is_stopped_says_75_and_goes_on() {
    let folder = Folder::new("share");
    let whole = "render s.ron --size 160x100 --spp 512 -o a.exr";
    let shares = [0, 1].map(|share| format!("{whole} --shard {share}/2"));
    for line in &shares {
        let child = spawn(&folder, line);
        std::thread::sleep(Duration::from_millis(250));
        signal(&child, "TERM");
        let output = child.wait_with_output().expect("ours");
        assert_eq!(output.status.code(), Some(75));
    }
    // Stopped before the first sample of a slow machine, there may be none.
    let parts = ["a.exr.0-of-2.part", "a.exr.1-of-2.part"];
    if parts.iter().all(|part| folder.path(part).exists()) {
        let line = format!("merge {} -o a.exr", parts.join(" "));
        folder.expect(&line, 2, &["no part has samples", "--allow-gaps"]);
        folder.expect(
            &format!("{line} --allow-gaps"),
            0,
            &["warning: no part has samples"],
        );
        assert!(folder.expect("info a.exr", 0, &[]).contains("gaps"));
        folder.expect("info a.exr.0-of-2.part", 0, &[]);
    }
    for line in &shares {
        folder.expect(line, 0, &[]);
    }
    folder.expect(&format!("merge {} -o a.exr", parts.join(" ")), 0, &[]);
    folder.expect(&format!("{whole} --checkpoint 1h"), 0, &[]);
    let again = folder.bytes("a.exr");
    folder.expect(&format!("merge {} -o a.exr", parts.join(" ")), 0, &[]);
    assert!(folder.bytes("a.exr") == again);
}

#[cfg(unix)]
#[test]
fn a_second_signal_stops_at_once() {
    let folder = Folder::new("twice");
    let mut child = spawn(
        &folder,
        "render s.ron --size 4000x4000 --checkpoint 1h -o a.exr",
    );
    std::thread::sleep(Duration::from_millis(600));
    signal(&child, "INT");
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(20) && child.try_wait().expect("ours").is_none() {
        signal(&child, "INT");
        std::thread::sleep(Duration::from_millis(2));
    }
    let status = child.wait().expect("ours");
    assert!(matches!(status.code(), Some(75 | 130) | None), "{status}");
    assert!(!folder.path("a.exr").exists());
}

#[test]
fn more_samples_are_added_to_those_that_are_there() {
    let folder = Folder::new("more");
    let line = |spp: &str, name: &str| format!("render s.ron --spp {spp} -o {name} --aov {AOVS}");
    for (spp, name) in [("13", "a.exr"), ("64", "b.exr"), ("128", "c.exr")] {
        folder.expect(&line(spp, name), 0, &[]);
    }
    for (spp, name, word) in [
        ("13", "a.exr", "13 spp"),
        ("64", "b.exr", "sample 13 is next"),
        ("64", "b.exr", "has all samples"),
        ("128", "c.exr", "sample 64 is next"),
    ] {
        let line = line(spp, "x.exr") + " --checkpoint 1h --tile 8";
        folder.expect(&line, 0, &[word]);
        assert!(folder.bytes("x.exr") == folder.bytes(name), "{spp}");
    }
    let fewer = line("64", "x.exr") + " --checkpoint 1h";
    folder.expect(&fewer, 2, &["128 samples", "--overwrite"]);
    folder.expect(&(fewer + " --overwrite"), 0, &[]);
    assert!(folder.bytes("x.exr") == folder.bytes("b.exr"));
}

#[test]
fn the_wanted_error_is_reached_with_the_same_samples() {
    let folder = Folder::new("noise");
    folder.expect(
        "render s.ron --noise 4% -o one.exr",
        0,
        &["ended by --noise"],
    );
    let line = "render s.ron -o x.exr --checkpoint 1h";
    folder.expect(&format!("{line} --noise 8%"), 0, &["ended by --noise"]);
    folder.expect(
        &format!("{line} --noise 4%"),
        0,
        &["is next", "ended by --noise"],
    );
    assert!(folder.bytes("x.exr") == folder.bytes("one.exr"));
    folder.expect(&format!("{line} --noise 4%"), 0, &["has all samples"]);
    assert!(folder.bytes("x.exr") == folder.bytes("one.exr"));
    folder.expect(&format!("{line} --noise 20%"), 2, &["more than the"]);
    let uniform = format!("{line} --noise 4% --adaptive off");
    folder.expect(
        &(uniform.clone() + " --overwrite"),
        0,
        &["ended by --noise"],
    );
    folder.expect(&uniform, 0, &["has all samples"]);
    folder.expect(&format!("{line} --noise 4%"), 2, &["--adaptive off"]);
    // Each run with a time adds to the part.
    let samples = |folder: &Folder| {
        let said = folder.expect("info t.exr", 0, &[]);
        let spp = said
            .split_once("spp")
            .and_then(|(_, rest)| rest.split_whitespace().next());
        spp.and_then(|spp| spp.parse::<u32>().ok()).expect("spp")
    };
    folder.expect(
        "render s.ron -o t.exr --checkpoint 1h --time 100ms",
        0,
        &["ended by --time"],
    );
    let before = samples(&folder);
    folder.expect(
        "render s.ron -o t.exr --checkpoint 1h --time 100ms",
        0,
        &["is next"],
    );
    assert!(samples(&folder) > before);
    fs::remove_file(folder.path("t.exr.part")).expect("it stays beside the image");
}
