//! The official validator's corpus of glTF files: every file with errors is refused or warned of by what is wrong in it,
//! every file without is read.
//!
//! Runs where `LUXEL_DATA` names a folder with `zoo/bad/gltf-validator`; says that it skips elsewhere. Beside `x.gltf`
//! stands `x.gltf.report.json`, what the official validator says of it.

use luxel::asset::Loader;
use luxel::diag::{Diagnostic, Severity};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Files without errors that are refused, and why.
const REFUSED: [(&str, &str); 1] = [
    // Its scene shows a mesh whose buffer has neither a URI nor a binary chunk: there are no bytes to show.
    ("root/unused_objects.gltf", "E126"),
];

/// Files without errors that the validator of luxel warns of, and why.
const WARNED: [(&str, &str); 3] = [
    // The type of an accessor is none of glTF 2.0: nobody could read it.
    ("accessor/unknown_type.gltf", "W120"),
    // Optional extensions that luxel does not have are named.
    ("node/node_empty.gltf", "W122"),
    ("root/invalid_extension_name.gltf", "W122"),
];

/// Codes of what is wrong with a file, as opposed to what luxel makes of a right one.
fn is_finding(code: &str) -> bool {
    ("E120".."E130").contains(&code) || ("W120".."W135").contains(&code)
}

#[test]
fn every_file_of_the_corpus_gets_its_verdict() {
    let Some(data) = std::env::var_os("LUXEL_DATA").map(PathBuf::from) else {
        eprintln!("skipped: LUXEL_DATA is not set");
        return;
    };
    let corpus = data.join("zoo/bad/gltf-validator");
    let mut differences = Vec::new();
    let (mut files, mut told, mut errors) = (0, 0, 0);
    for report in reports(&corpus) {
        let text = std::fs::read_to_string(&report).expect("a report");
        let verdict: Value = serde_json::from_str(&text).expect("JSON");
        let file = PathBuf::from(report.to_string_lossy().trim_end_matches(".report.json"));
        let name = file
            .strip_prefix(&corpus)
            .expect("in the corpus")
            .to_string_lossy();
        let found = open(&file);
        files += 1;
        let wrong = errors_of(&verdict);
        let named = wrong.iter().filter(|error| names(&found, error)).count();
        (told, errors) = (told + named, errors + wrong.len());
        let difference = match wrong.first() {
            Some(first) if named == 0 => Some(format!("not told: {first}\n{found:#?}")),
            Some(_) => None,
            None => unfounded(&name, &found),
        };
        differences.extend(difference.map(|difference| format!("{name}: {difference}")));
    }
    eprintln!("{files} files; {told} of {errors} errors are told by their own place");
    assert!(files >= 80, "only {files} files");
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

/// Every report below a folder, in order.
fn reports(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.to_string_lossy().ends_with(".report.json") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Everything that luxel says of a file.
fn open(file: &Path) -> Vec<Diagnostic> {
    let mut loader = Loader::new();
    let refused = loader.model(file).err().unwrap_or_default();
    let mut found = loader.warnings().to_vec();
    found.extend(refused);
    found
}

fn errors_of(verdict: &Value) -> Vec<&Value> {
    let messages = verdict["issues"]["messages"].as_array();
    let is_error = |message: &&Value| message["severity"] == 0;
    messages.into_iter().flatten().filter(is_error).collect()
}

/// Whether something that we say stands at the place of an error, above or below it. Errors of the container and of the
/// JSON text have no pointer: they are told by their code.
fn names(found: &[Diagnostic], error: &Value) -> bool {
    let place = error["pointer"].as_str().unwrap_or_default();
    let mut at_place = found
        .iter()
        .map(|one| match (place, one.pointer.as_deref()) {
            ("", None) => matches!(one.code, "E120" | "E121" | "E122" | "W134"),
            ("/", Some("")) => one.severity == Severity::Error,
            (place, Some(pointer)) => below(place, pointer) || below(pointer, place),
            _ => false,
        });
    at_place.any(|is| is)
}

/// Whether a pointer is another one or leads on from it; the pointer to the whole file counts for nothing.
fn below(pointer: &str, above: &str) -> bool {
    let rest = pointer.strip_prefix(above);
    above.len() > 1 && rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// What luxel has against a file that the official validator has nothing against.
fn unfounded(name: &str, found: &[Diagnostic]) -> Option<String> {
    let listed = |list: &[(&str, &str)], code| list.contains(&(name, code));
    let not_listed = |one: &&Diagnostic| match one.severity {
        Severity::Error => !listed(&REFUSED, one.code),
        Severity::Warning => is_finding(one.code) && !listed(&WARNED, one.code),
    };
    let found = found.iter().find(not_listed)?;
    Some(found.to_string())
}
