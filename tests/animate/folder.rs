//! A folder with a scene, and the command in it.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

/// A cube that turns about a corner's axis beside a ball, under a lamp: a mesh, spheres, a full turn in 12 frames.
pub(crate) const SCENE: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 2, 7), look_at: (0, 0, 0)),
    render: (size: (40, 24), spp: 2, max_bounces: 2),
    entities: [
        (name: "lamp", shape: Sphere(radius: 1), transform: (translate: (0, 5, 2)), emissive: (radiance: (9, 9, 9))),
        (name: "ball", shape: Sphere(radius: 1), transform: (translate: (-2, 0, 0))),
        (name: "cube", shape: Mesh("cube.obj"), transform: (translate: (1, 0, 0)), spin: (axis: (0, 1, 0.5), deg_per_s: 720)),
    ],
    animation: (fps: 24, frames: 0..12),
)
"#;

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4\nf 2 3 7 6\n";

/// A folder of a test's own, with `spin.ron` in it; gone when dropped.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Folder {
        let path =
            std::env::temp_dir().join(format!("luxel-animate-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a temporary folder");
        fs::write(path.join("spin.ron"), SCENE).expect("writable");
        fs::write(path.join("cube.obj"), CUBE).expect("writable");
        Folder(path)
    }

    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
        command.args(args).current_dir(&self.0).env("NO_COLOR", "1");
        command
    }

    pub(crate) fn run(&self, args: &[&str]) -> Output {
        self.command(args).output().expect("luxel runs")
    }

    /// Runs and asserts the exit code and that stderr has all the words.
    #[track_caller]
    pub(crate) fn expect(&self, args: &[&str], code: i32, words: &[&str]) -> Output {
        let output = self.run(args);
        expect(&output, code, words);
        output
    }

    /// Every file with its bytes, but for the scene and its mesh.
    pub(crate) fn files(&self) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(&self.0).expect("there").flatten();
        let mut files: BTreeMap<String, Vec<u8>> = entries
            .map(|e| {
                let bytes = fs::read(e.path()).unwrap_or_default();
                (e.file_name().to_string_lossy().into_owned(), bytes)
            })
            .collect();
        files.remove("spin.ron");
        files.remove("cube.obj");
        files
    }

    pub(crate) fn names(&self) -> Vec<String> {
        self.files().into_keys().collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[track_caller]
pub(crate) fn expect(output: &Output, code: i32, words: &[&str]) {
    let talk = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{talk}");
    for word in words {
        assert!(talk.contains(word), "no \"{word}\" in:\n{talk}");
    }
}
