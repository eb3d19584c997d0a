//! Animations that do not come to their end: killed, stopped, out of room. What is there is whole, and the same line goes
//! on from it to the same files.

use crate::folder::{files, folder, names};
use crate::support::{Folder, expect, text};
use std::collections::BTreeMap;
use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const LINE: [&str; 6] = ["animate", "spin.ron", "--frames", "0..8", "--gif", "a.gif"];

fn reference(folder: &Folder) -> (BTreeMap<String, Vec<u8>>, Duration) {
    let start = Instant::now();
    folder.expect(&LINE, 0, &[]);
    (files(folder), start.elapsed())
}

fn clear(folder: &Folder) {
    for name in names(folder) {
        fs::remove_file(folder.0.join(name)).expect("ours");
    }
}

#[test]
fn killed_at_any_moment_it_goes_on_to_the_same_files() {
    let folder = folder("killed");
    let (wanted, took) = reference(&folder);
    let mut cut_short = 0;
    for round in 0..20u32 {
        clear(&folder);
        // The golden ratio's multiples spread over the run, each round elsewhere.
        let share = (f64::from(round) * 0.618_034 + 0.1).fract();
        let quiet = |line: &[&str]| {
            let mut command = folder.command(line);
            command.stdout(Stdio::null()).stderr(Stdio::null());
            command
        };
        let mut child = quiet(&LINE).spawn().expect("luxel runs");
        std::thread::sleep(took.mul_f64(share));
        child.kill().expect("ours");
        let status = child.wait().expect("ours");
        cut_short += u32::from(!status.success());
        for (name, bytes) in files(&folder) {
            // Neither is what asks whether a file can be written.
            if !name.ends_with(".partial") && !name.ends_with(".probe") {
                assert_eq!(wanted.get(&name), Some(&bytes), "{name} is whole");
            }
        }
        assert!(quiet(&LINE).status().expect("luxel runs").success());
        assert_eq!(files(&folder), wanted, "round {round}");
    }
    assert!(cut_short >= 10, "only {cut_short} of 20 were cut short");
}

#[cfg(unix)]
#[test]
fn stopped_it_says_75_and_goes_on() {
    let folder = folder("stopped");
    let line = ["animate", "spin.ron", "--spp", "64"];
    let mut child = folder
        .command(&line)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("luxel runs");
    let start = Instant::now();
    while names(&folder).is_empty() && start.elapsed() < Duration::from_secs(30) {
        std::thread::sleep(Duration::from_millis(2));
    }
    let pid = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &pid])
            .status()
            .expect("kill")
            .success()
    );
    let output = child.wait_with_output();
    let output = output.expect("ours");
    expect(
        &output,
        75,
        &[
            "stopped;",
            "of 12 frames are finished",
            "the same line goes on",
        ],
    );
    let there = files(&folder);
    assert!(
        !there.is_empty() && there.len() < 12,
        "{:?}",
        names(&folder)
    );
    folder.expect(&line, 0, &["of them are finished"]);
    let after = files(&folder);
    assert_eq!(after.len(), 12);
    assert!(there.iter().all(|(name, bytes)| after[name] == *bytes));
    child = folder
        .command(&line)
        .stderr(Stdio::null())
        .spawn()
        .expect("luxel runs");
    assert!(child.wait().expect("ours").success());
}

#[cfg(unix)]
#[test]
fn without_room_it_says_so_and_keeps_what_is_finished() {
    let folder = folder("full");
    // A limit on the size of files stands in for a full disk: frames pass it, the film of all of them does not.
    let luxel = env!("CARGO_BIN_EXE_luxel");
    let script =
        format!("trap '' XFSZ; ulimit -f 8; exec '{luxel}' animate spin.ron --spp 1 --y4m a.y4m");
    let output = Command::new("sh")
        .args(["-c", &script])
        .current_dir(&folder.0)
        .output()
        .expect("a shell");
    expect(&output, 74, &["a.y4m", "frames are finished and stay"]);
    let whole = names(&folder);
    assert!(
        !whole.is_empty() && whole.iter().all(|name| name.ends_with(".png")),
        "{whole:?}"
    );
    let small = format!(
        "trap '' XFSZ; ulimit -f 1; exec '{luxel}' animate spin.ron --spp 1 -o big_##.exr --aov normal,albedo"
    );
    let output = Command::new("sh")
        .args(["-c", &small])
        .current_dir(&folder.0)
        .output()
        .expect("a shell");
    expect(&output, 74, &["big_00.exr", "0 of 12 frames"]);
    assert_eq!(names(&folder), whole, "nothing half written");
    folder.expect(
        &["animate", "spin.ron", "--spp", "1", "--y4m", "a.y4m"],
        0,
        &["of them are finished"],
    );
    assert_eq!(names(&folder).len(), 13);
}

#[cfg(target_os = "linux")]
#[test]
fn an_encoder_that_fails_ends_it() {
    let folder = folder("encoder");
    let full = fs::File::options()
        .write(true)
        .open("/dev/full")
        .expect("Linux");
    let output = folder
        .command(&["animate", "spin.ron", "--y4m", "-"])
        .stdout(full)
        .output()
        .expect("luxel runs");
    expect(&output, 74, &["film to stdout"]);
    assert!(!text(&output.stderr).contains("bug"));
}
