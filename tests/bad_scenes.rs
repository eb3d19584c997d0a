//! Every scene under `tests/bad_scenes` says exactly what its `.txt` says.
//!
//! `BLESS=1` writes the expectations and fails, so that nothing approves itself: read the difference, then run again.

use luxel::cli::diagnostics::{Style, render};
use luxel::{check, diag::codes::CODES, scene};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_scenes");
    let mut scenes: Vec<PathBuf> = fs::read_dir(folder)
        .expect("the folder of bad scenes")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "ron"))
        .collect();
    scenes.sort();
    scenes
}

/// What a scene says, with its file's name for a path.
fn said(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("a scene");
    let name = Path::new(path.file_name().expect("a name"));
    let found = match scene::parse(&text, name) {
        Err(found) => found,
        Ok((desc, mut warnings)) => {
            warnings.extend(check::check(&desc));
            warnings.extend(check::check_light(&desc));
            warnings
        }
    };
    render(&found, Style::Plain)
}

#[test]
fn every_bad_scene_says_what_is_expected() {
    let bless = std::env::var_os("BLESS").is_some_and(|v| v == "1");
    let mut wrong = Vec::new();
    for path in scenes() {
        let said = said(&path);
        assert!(!said.is_empty(), "{} says nothing", path.display());
        let expectation = path.with_extension("txt");
        let wanted = fs::read_to_string(&expectation).unwrap_or_default();
        if said != wanted {
            wrong.push(format!(
                "{}\n--- wanted\n{wanted}\n--- said\n{said}",
                path.display()
            ));
            if bless {
                fs::write(&expectation, said).expect("the expectation is written");
            }
        }
    }
    assert!(
        !bless,
        "blessed {} scenes: read the difference, then run without BLESS",
        wrong.len()
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn every_code_of_a_scene_has_a_bad_scene() {
    let said: String = scenes().iter().map(|path| said(path)).collect();
    // E001 is about bytes that are not text: a unit test has it.
    let silent: BTreeSet<&str> = CODES
        .iter()
        .map(|&(code, _)| code)
        .filter(|code| *code != "E001" && !said.contains(&format!("[{code}]")))
        .collect();
    assert_eq!(silent, BTreeSet::new());
}
