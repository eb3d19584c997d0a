//! `luxel turntable` and `luxel convert` from outside.

use crate::studio::Folder;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Output, Stdio};

const QUICK: [&str; 6] = ["--size", "24x20", "--spp", "2", "--frames", "3"];

impl Folder {
    fn luxel(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
        command.args(args).current_dir(&self.0).env("NO_COLOR", "1");
        command
    }

    /// Runs `turntable` with few pixels.
    fn turn(&self, args: &[&str]) -> Output {
        let mut command = self.luxel(&["turntable"]);
        command.args(args).args(QUICK);
        command.output().expect("luxel runs")
    }

    fn with_mesh(name: &str) -> Folder {
        let folder = Folder::new(name);
        folder.file(
            "wedge.obj",
            "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
        );
        folder
    }

    fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).expect("there").flatten();
        let mut names: Vec<_> = entries
            .map(|e| e.file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.0.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }
}

#[track_caller]
fn expect(output: &Output, code: i32, words: &[&str]) -> String {
    let talk = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{talk}");
    for word in words {
        assert!(talk.contains(word), "no \"{word}\" in:\n{talk}");
    }
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn a_mesh_alone_makes_a_gif_here() {
    let folder = Folder::with_mesh("gif");
    let printed = expect(
        &folder.turn(&["wedge.obj"]),
        0,
        &["wedge.gif", "24×20", "3 frames"],
    );
    assert_eq!(printed, "wedge.gif\n");
    assert_eq!(folder.names(), ["wedge.gif", "wedge.obj"]);
    let bytes = folder.bytes("wedge.gif");
    let mut decoder = gif::DecodeOptions::new()
        .read_info(bytes.as_slice())
        .expect("a GIF");
    assert_eq!((decoder.width(), decoder.height()), (24, 20));
    assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
    let mut delays = Vec::new();
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        delays.push(frame.delay);
    }
    assert_eq!(delays, [107, 106, 107], "3.2 seconds in all");
    for threads in ["1", "2"] {
        let again = folder.turn(&["wedge.obj", "-o", "again.gif", "--threads", threads]);
        expect(&again, 0, &[]);
        assert!(folder.bytes("again.gif") == bytes, "{threads} threads");
    }
    std::fs::create_dir(folder.0.join("deep")).expect("ours");
    let mut elsewhere = folder.luxel(&["turntable", "../wedge.obj"]);
    let output = elsewhere
        .args(QUICK)
        .current_dir(folder.0.join("deep"))
        .output();
    expect(&output.expect("luxel runs"), 0, &[]);
    assert!(
        folder.bytes("deep/wedge.gif") == bytes,
        "from another folder"
    );
}

#[test]
fn its_frames_are_those_of_render() {
    let folder = Folder::with_mesh("frames");
    std::fs::create_dir(folder.0.join("deep")).expect("ours");
    let output = folder.turn(&[
        "wedge.obj",
        "--up",
        "-z",
        "-o",
        "f_##.png",
        "--scene",
        "deep/spin.ron",
    ]);
    let printed = expect(&output, 0, &["luxel render deep/spin.ron --frame 0"]);
    assert_eq!(printed, "f_00.png\nf_01.png\nf_02.png\n");
    for frame in ["0", "1", "2"] {
        let args = ["render", "deep/spin.ron", "--frame", frame, "-o", "one.png"];
        expect(&folder.luxel(&args).output().expect("luxel runs"), 0, &[]);
        assert!(
            folder.bytes("one.png") == folder.bytes(&format!("f_0{frame}.png")),
            "{frame}"
        );
    }
    let checked = folder
        .luxel(&["check", "deep/spin.ron"])
        .output()
        .expect("luxel runs");
    expect(&checked, 0, &["no errors"]);
    let text = String::from_utf8(folder.bytes("deep/spin.ron")).expect("text");
    assert!(text.contains("Mesh(\"../wedge.obj\")"), "{text}");
    // The same again is no harm; another one is.
    let args = [
        "wedge.obj",
        "--up",
        "-z",
        "-o",
        "g_#.png",
        "--scene",
        "deep/spin.ron",
    ];
    expect(&folder.turn(&args), 0, &[]);
    let args = ["wedge.obj", "-o", "g_#.png", "--scene", "deep/spin.ron"];
    expect(&folder.turn(&args), 2, &["deep/spin.ron", "edited"]);
}

#[test]
fn mistakes_have_their_codes_and_remedies() {
    let folder = Folder::with_mesh("mistakes");
    folder.file("bad.obj", "v 0 0 0\nf 1 2 3\n");
    folder.file("mesh.stl", "solid\n");
    let cases: &[(i32, &[&str], &[&str])] = &[
        (
            66,
            &["wedgs.obj"],
            &["wedgs.obj", "did you mean \"wedge.obj\""],
        ),
        (65, &["bad.obj"], &["bad.obj:2"]),
        (2, &["mesh.stl"], &[".obj, .gltf or .glb"]),
        (2, &["wedge.obj", "-o", "x.png"], &["frame_####.png"]),
        (
            2,
            &["wedge.obj", "-o", "x.mp4"],
            &[".gif", "frame_####.png"],
        ),
        (
            2,
            &["wedge.obj", "-o", "x.gif", "--gif", "y.gif"],
            &["cannot be used with"],
        ),
        (2, &["wedge.obj", "--up", "w"], &["--up", "-z"]),
        (2, &["wedge.obj", "--seconds", "0"], &["0.01 to 600"]),
        (
            2,
            &["wedge.obj", "--seconds", "0.03"],
            &["50 frames", "--seconds 0.06"],
        ),
        (2, &["wedge.obj", "--scene", "x.txt"], &[".ron"]),
        (
            74,
            &["wedge.obj", "--gif", "no/such/x.gif"],
            &["no/such/x.gif"],
        ),
        (
            74,
            &["wedge.obj", "--scene", "no/such/x.ron"],
            &["no/such/x.ron"],
        ),
    ];
    for (code, args, words) in cases {
        let printed = expect(&folder.turn(args), *code, words);
        assert_eq!(printed, "", "{args:?}");
    }
    assert_eq!(folder.names(), ["bad.obj", "mesh.stl", "wedge.obj"]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_the_frames_that_are_finished() {
    let folder = Folder::with_mesh("interrupt");
    let mut child = folder
        .luxel(&["turntable", "wedge.obj", "-o", "f_####.png"])
        .args(["--frames", "3000", "--size", "64x64"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("luxel runs");
    let mut paths = BufReader::new(child.stdout.take().expect("piped"));
    let mut first = String::new();
    paths.read_line(&mut first).expect("a path");
    assert_eq!(first, "f_0000.png\n");
    let pid = child.id().to_string();
    let sent = Command::new("kill").args(["-s", "INT", &pid]).status();
    assert!(sent.expect("kill runs").success());
    let printed = 1 + paths.lines().map_while(Result::ok).count();
    let output = child.wait_with_output().expect("it ends");
    expect(&output, 130, &["stopped", "of 3000 frames"]);
    let mut names = folder.names();
    assert_eq!(names.pop().as_deref(), Some("wedge.obj"));
    assert_eq!(
        names.len(),
        printed,
        "each file was said, and nothing else is left"
    );
    for name in &names {
        image::open(folder.0.join(name)).expect("a whole picture");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_gif_is_partial() {
    let folder = Folder::with_mesh("partial");
    // A missing material: its warning on stderr says that rendering is about to begin.
    let mesh = String::from_utf8(folder.bytes("wedge.obj")).expect("text");
    folder.file("wedge.obj", &format!("{mesh}usemtl gold\nf 1 2 3\n"));
    let mut child = folder
        .luxel(&[
            "turntable",
            "wedge.obj",
            "--frames",
            "3000",
            "--size",
            "32x32",
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("luxel runs");
    let mut talk = BufReader::new(child.stderr.take().expect("piped"));
    let mut line = String::new();
    talk.read_line(&mut line).expect("a warning");
    std::thread::sleep(std::time::Duration::from_millis(700));
    let pid = child.id().to_string();
    let sent = Command::new("kill").args(["-s", "INT", &pid]).status();
    assert!(sent.expect("kill runs").success());
    let said: Vec<String> = talk.lines().map_while(Result::ok).collect();
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130), "{line}{said:?}");
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "wedge.partial.gif\n",
        "{said:?}"
    );
    assert_eq!(folder.names(), ["wedge.obj", "wedge.partial.gif"]);
    let bytes = folder.bytes("wedge.partial.gif");
    let mut decoder = gif::DecodeOptions::new()
        .read_info(bytes.as_slice())
        .expect("a GIF");
    let mut frames = 0;
    while decoder.read_next_frame().expect("a whole frame").is_some() {
        frames += 1;
    }
    let told = format!("has {frames} of 3000 frames");
    assert!(said.iter().any(|l| l.contains(&told)), "{told}: {said:?}");
}

#[test]
fn convert_writes_a_scene_that_renders() {
    let folder = Folder::with_mesh("convert");
    let cat = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/cat.obj");
    let cat = cat.to_str().expect("text");
    for (mesh, args, scene) in [
        ("wedge.obj", &[][..], "wedge.ron"),
        (cat, &["-o", "mine.ron"][..], "mine.ron"),
    ] {
        let output = folder
            .luxel(&["convert", mesh])
            .args(args)
            .output()
            .expect("luxel runs");
        let printed = expect(&output, 0, &["no camera", "no light", "luxel render"]);
        assert_eq!(printed, format!("{scene}\n"));
        let text = String::from_utf8(folder.bytes(scene)).expect("text");
        assert!(
            text.starts_with("// ") && text.contains("no camera: this one is luxel's"),
            "{text}"
        );
        let args = ["render", scene, "--size", "16x16", "--spp", "1"];
        expect(&folder.luxel(&args).output().expect("luxel runs"), 0, &[]);
    }
    folder.file("wedge.ron", "mine");
    let output = folder
        .luxel(&["convert", "wedge.obj"])
        .output()
        .expect("luxel runs");
    expect(&output, 2, &["wedge.ron", "edited"]);
    assert_eq!(folder.bytes("wedge.ron"), b"mine");
    let output = folder
        .luxel(&["convert", "dog.obj"])
        .output()
        .expect("luxel runs");
    expect(&output, 66, &["dog.obj"]);
    let output = folder
        .luxel(&["convert", "wedge.obj", "-o", "w.png"])
        .output()
        .expect("luxel runs");
    expect(&output, 2, &[".ron"]);
}

#[test]
fn samples_that_are_not_finite_are_told_of() {
    let folder = Folder::with_mesh("lost");
    let wedge = String::from_utf8(folder.bytes("wedge.obj")).expect("text");
    folder.file("a.mtl", "newmtl a\nKd 1 1 1\nKe 3e38 3e38 3e38\n");
    folder.file("bright.obj", &format!("mtllib a.mtl\nusemtl a\n{wedge}"));
    let words = [
        "samples were not finite and were left out",
        "frame 0, pixel (",
        "--scene FILE",
    ];
    expect(&folder.turn(&["bright.obj"]), 0, &words);
    let fine = folder.turn(&["wedge.obj"]);
    let talk = String::from_utf8_lossy(&fine.stderr);
    assert!(!talk.contains("not finite"), "{talk}");
}
