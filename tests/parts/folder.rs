//! A scene in a folder of its own, and the command run there.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

const SCENE: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 1, 5), look_at: (0, 0, 0)),
    render: (size: (40, 24), spp: 64, max_bounces: 5),
    background: Linear(0.1, 0.2, 0.3),
    materials: { "chalk": Diffuse(color: Linear(0.8, 0.6, 0.4)), "glass": Glass, "gold": Metal },
    entities: [
        (name: "lamp", shape: Sphere(radius: 1), transform: (translate: (0, 4, 2)), emissive: (radiance: (9, 9, 9))),
        (name: "ball", shape: Sphere(radius: 1), material: "glass"),
        (name: "moon", parent: "ball", shape: Sphere(radius: 0.4), transform: (translate: (1.6, 0, 0)), material: "gold",
                       spin: (axis: (0, 1, 0), deg_per_s: 90, pivot: (0, 0, 0))),
        (name: "floor", shape: Sphere(radius: 100), transform: (translate: (0, -101, 0)), material: "chalk"),
    ],
    animation: (fps: 4, frames: 0..8),
)
"#;

/// Everything that a file can hold.
pub(crate) const AOVS: &str = "albedo,normal,geonormal,depth,uv,prim,entity,samples,stderr";

/// Gone when dropped.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("luxel-parts-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).expect("a temporary folder");
        fs::write(path.join("s.ron"), SCENE).expect("writable");
        Folder(path)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// The command with the words of a line.
    pub(crate) fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
        command
            .args(line.split_whitespace())
            .current_dir(&self.0)
            .env("NO_COLOR", "1")
            .stdin(Stdio::null());
        command
    }

    /// Runs a line, asserts its exit code and that stderr has all the words, and gives stdout.
    #[track_caller]
    pub(crate) fn expect(&self, line: &str, code: i32, words: &[&str]) -> String {
        expect(
            &self.command(line).output().expect("luxel runs"),
            code,
            words,
        )
    }

    /// Names in the folder but for the scene's, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("there").flatten();
        let mut names: Vec<String> = entries
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .filter(|name| name != "s.ron")
            .collect();
        names.sort();
        names
    }

    pub(crate) fn clear(&self) {
        for name in self.names() {
            fs::remove_file(self.path(&name)).expect("ours");
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[track_caller]
pub(crate) fn expect(output: &Output, code: i32, words: &[&str]) -> String {
    let talk = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{talk}");
    for word in words {
        assert!(talk.contains(word), "no \"{word}\" in:\n{talk}");
    }
    String::from_utf8_lossy(&output.stdout).into_owned()
}
