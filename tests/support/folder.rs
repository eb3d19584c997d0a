//! A folder of a test's own, and the command in it.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses its part")]

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

/// Gone when dropped.
pub struct Folder(pub PathBuf);

impl Folder {
    /// With files in it; the name is one of this test binary's.
    pub fn new(name: &str, files: &[(&str, &str)]) -> Folder {
        let tests = env!("CARGO_CRATE_NAME");
        let name = format!("luxel-{tests}-{name}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a temporary folder");
        for (name, text) in files {
            fs::write(path.join(name), text).expect("writable");
        }
        Folder(path)
    }

    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luxel"));
        command.args(args).current_dir(&self.0).env("NO_COLOR", "1");
        command
    }

    pub fn run(&self, args: &[&str]) -> Output {
        self.command(args).output().expect("luxel runs")
    }

    /// Runs and asserts the exit code and that stderr has all the words.
    #[track_caller]
    pub fn expect(&self, args: &[&str], code: i32, words: &[&str]) -> Output {
        let output = self.run(args);
        expect(&output, code, words);
        output
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Names in the folder, sorted.
    pub fn names(&self) -> Vec<String> {
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

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Asserts the exit code and that stderr has all the words, and shows stderr if not.
#[track_caller]
pub fn expect(output: &Output, code: i32, words: &[&str]) {
    let talk = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{talk}");
    for word in words {
        assert!(talk.contains(word), "no \"{word}\" in:\n{talk}");
    }
}
