//! Renders that end early: by time, by a signal, by a reader that leaves, by a file without an end.

use crate::SCENE;
use crate::folder;
use crate::support::{expect, text};
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

#[test]
fn a_reader_that_leaves_is_no_panic() {
    let folder = folder("pipe");
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
    let folder = folder("time");
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
    let folder = folder("endless");
    expect(
        &folder.run(&["check", "/dev/zero"]),
        66,
        &["/dev/zero", "1 GiB"],
    );
}

#[cfg(unix)]
#[test]
fn an_interrupt_saves_what_there_is() {
    let folder = folder("interrupt");
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
