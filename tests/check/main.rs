//! `luxel check`: its codes, its answers to people and programs, and that everything is said at once and soon.

mod codes;
mod files;
mod plain;
#[path = "../support/folder.rs"]
mod support;

use std::process::Output;
use support::{Folder, text};

const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

const CAMERA: &str = "camera: (at: (3, 2, 9), look_at: (0.5, 0.5, 1)), background: Linear(1, 1, 1)";

/// Exit code and JSON of `check --json`.
fn answer(folder: &Folder, file: &str) -> (i32, serde_json::Value) {
    let output = folder.run(&["check", "--json", file]);
    let json = serde_json::from_slice(&output.stdout);
    (
        output.status.code().unwrap_or(-1),
        json.unwrap_or_else(|e| panic!("{e}: {}", text(&output.stderr))),
    )
}

/// Asserts the exit code, and that stdout or stderr has all the words.
#[track_caller]
fn expect(output: &Output, code: i32, words: &[&str]) {
    let talk = text(&output.stdout) + &text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{talk}");
    for word in words {
        assert!(talk.contains(word), "no \"{word}\" in:\n{talk}");
    }
}

/// Codes of a JSON answer, in order.
fn codes_of(json: &serde_json::Value) -> Vec<&str> {
    let found = json["diagnostics"].as_array().expect("an array");
    found.iter().filter_map(|d| d["code"].as_str()).collect()
}
