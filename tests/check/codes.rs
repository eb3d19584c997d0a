//! The list of the codes: unique, documented, used, and each provoked by a test.

use crate::expect;
use crate::support::{Folder, text};
use luxel::check::all_codes;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

fn project() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Rust sources and expectations below a folder.
fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs" || e == "txt") {
            let text = fs::read_to_string(&path).expect("a source");
            found.push((path, text));
        }
    }
    found
}

/// Sources of the product without their tests, and the tests.
fn product_and_tests() -> (Vec<(PathBuf, String)>, String) {
    let mut tests: String = sources(&project().join("tests"))
        .into_iter()
        .map(|(_, t)| t)
        .collect();
    let mut product = Vec::new();
    for (path, text) in sources(&project().join("src")) {
        let is_test = path.components().any(|c| c.as_os_str() == "tests")
            || path.file_name().is_some_and(|n| n == "tests.rs");
        let inline = text.find("#[cfg(test)]\nmod tests {");
        let (code, test) = text.split_at(match is_test {
            true => 0,
            false => inline.unwrap_or(text.len()),
        });
        tests.push_str(test);
        product.push((path, code.to_owned()));
    }
    (product, tests)
}

/// Name of the constant, and the module it stands in, by code.
fn constants(product: &[(PathBuf, String)]) -> BTreeMap<String, String> {
    let tables = product.iter().filter(|(p, _)| p.ends_with("codes.rs"));
    let mut constants = BTreeMap::new();
    for line in tables.flat_map(|(_, text)| text.lines()) {
        if let Some((name, rest)) = line.trim().split_once(" = \"") {
            constants.insert(rest[..4].to_owned(), name.to_owned());
        }
    }
    constants
}

#[test]
fn codes_are_unique_and_ordered() {
    let mut seen = BTreeSet::new();
    for (code, meaning) in all_codes() {
        assert!(seen.insert(code), "{code} twice");
        let (kind, number) = code.split_at(1);
        assert!(["E", "W"].contains(&kind) && number.len() == 3, "{code}");
        assert!(number.parse::<u32>().is_ok(), "{code}");
        assert!(
            !meaning.is_empty() && !meaning.ends_with('.'),
            "{code}: {meaning}"
        );
    }
    assert!(seen.len() > 70, "{}", seen.len());
}

/// `BLESS=1` writes the table and fails: read the difference, then run again.
#[test]
fn the_readme_lists_the_codes() {
    const HEAD: &str = "| code | stands for |\n|---|---|\n";
    let rows: String = all_codes()
        .map(|(c, m)| format!("| {c} | {m} |\n"))
        .collect();
    let path = project().join("README.md");
    let readme = fs::read_to_string(&path).expect("a README");
    let start = readme.find(HEAD).expect("a table of codes") + HEAD.len();
    let end = start + readme[start..].find("\n\n").expect("an end") + 1;
    if std::env::var_os("BLESS").is_some_and(|v| v == "1") {
        let blessed = format!("{}{rows}{}", &readme[..start], &readme[end..]);
        fs::write(&path, blessed).expect("the README is writable");
        panic!("blessed: read the difference, then run without BLESS");
    }
    assert_eq!(&readme[start..end], rows);
}

#[test]
fn every_code_of_the_source_is_in_the_table_and_used() {
    let (product, _) = product_and_tests();
    let known: BTreeSet<&str> = all_codes().map(|(code, _)| code).collect();
    let constants = constants(&product);
    assert_eq!(
        constants
            .keys()
            .map(String::as_str)
            .collect::<BTreeSet<_>>(),
        known
    );
    let others = || product.iter().filter(|(p, _)| !p.ends_with("codes.rs"));
    for (path, code) in others() {
        for quoted in code.split('"').filter(|s| s.len() == 4) {
            let like = quoted.starts_with(['E', 'W']) && quoted[1..].parse::<u32>().is_ok();
            assert!(!like, "{} has {quoted} beside the tables", path.display());
        }
    }
    for (code, name) in &constants {
        let used = others().any(|(_, text)| text.contains(&format!("codes::{name}")));
        assert!(used, "{code} ({name}) is used nowhere");
    }
}

#[test]
fn every_code_is_provoked_by_a_test() {
    /// Nothing that a file can do gives these: a bug of the OBJ parser, and what the validator of glTF refuses before.
    const INTERNAL: &[&str] = &["E110", "E131"];
    let (product, tests) = product_and_tests();
    let silent: Vec<String> = constants(&product)
        .into_iter()
        .filter(|(code, name)| {
            !tests.contains(&format!("\"{code}\""))
                && !tests.contains(&format!("[{code}]"))
                && !tests.contains(&format!("codes::{name}"))
        })
        .map(|(code, _)| code)
        .filter(|code| !INTERNAL.contains(&code.as_str()))
        .collect();
    assert_eq!(silent, Vec::<String>::new());
}

#[test]
fn codes_are_listed_for_people_and_programs() {
    let folder = Folder::new("codes", &[]);
    let listed = folder.run(&["check", "--codes"]);
    expect(&listed, 0, &["E012  no material or entity has this name\n"]);
    assert_eq!(text(&listed.stdout).lines().count(), all_codes().count());
    let listed = folder.run(&["check", "--codes", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&listed.stdout).expect("JSON");
    assert_eq!(json[0]["code"], "E001");
    assert_eq!(json[0]["meaning"], "the file is not UTF-8 text");
    expect(&folder.run(&["check"]), 2, &["<FILE>"]);
}
