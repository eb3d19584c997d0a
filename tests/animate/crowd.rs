//! What instances without number take of a process, where the system tells.
#![cfg(all(target_os = "linux", target_env = "gnu"))]

use crate::folder::folder;
use crate::support::Folder;
use std::fmt::Write;
use std::fs;
use std::process::Stdio;
use std::time::Duration;

/// Turning instances of one mesh.
const CROWD: usize = 10_000;

/// Bytes that each may take.
const EACH: usize = 1024;

fn scene(instances: usize) -> String {
    let mut text = String::from(
        "Scene(version: 1, camera: (at: (0, 0, 9), look_at: (0, 0, 0)), render: (size: (8, 8), spp: 1),
        background: Linear(1, 1, 1), animation: (frames: 0..8), entities: [",
    );
    for i in 0..instances {
        writeln!(
            text,
            "(shape: Mesh(\"cube.obj\"), transform: (translate: ({}, 0, {})), spin: (axis: (1, 2, {i}), deg_per_s: 90)),",
            3 * (i % 100),
            3 * (i / 100)
        )
        .expect("a string takes all");
    }
    text + "])"
}

/// The most bytes that `luxel animate` held at once, of memory that is its own or a file's. It grows only, and each of the
/// frames takes as much, so that looking now and then is enough.
fn most(folder: &Folder, scene: &str) -> usize {
    let args = ["animate", scene, "-o", "f_####.png", "--overwrite"];
    let mut child = folder
        .command(&args)
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .expect("luxel runs");
    let status = format!("/proc/{}/status", child.id());
    let mut most = 0;
    let ended = loop {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse().ok());
        most = most.max(1024 * kilobytes.unwrap_or(0));
        if let Some(ended) = child.try_wait().expect("it is ours") {
            break ended;
        }
        std::thread::sleep(Duration::from_micros(200));
    };
    assert!(ended.success());
    most
}

#[test]
fn ten_thousand_instances_take_a_kibibyte_each() {
    let folder = folder("crowd");
    for count in [1, CROWD] {
        let name = format!("{count}.ron");
        fs::write(folder.0.join(name), scene(count)).expect("writable");
    }
    let one = most(&folder, "1.ron");
    let all = most(&folder, &format!("{CROWD}.ron"));
    let each = all.saturating_sub(one) / CROWD;
    println!("{each} bytes each");
    assert!(one > 0 && all > one, "{one} {all}");
    assert!(
        each <= EACH,
        "{each} bytes of the process for each instance"
    );
}
