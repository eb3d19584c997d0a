//! Tests of the tests: bugs that are planted on purpose, one at a time, each of which must turn a test red.
//!
//! Every `NN-name.patch` beside this file is a bug: a sentence that says what it breaks, the layer that it is in, the quick
//! tests that should catch it, and a unified diff. Nothing of them is in `src/`; that they still apply is tested here at
//! every run. The long part copies the tree, plants each bug in the copy, and writes `README.md`, the table of which test
//! caught which:
//!
//! `cargo test --release --test mutants -- --ignored --nocapture`
//!
//! `MUTANTS=07,31` before it runs these alone and leaves the table as it is.

mod patch;
mod tree;

use patch::Patch;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use tree::{Tree, Verdict};

/// How long the tests of one bug may take; a bug may well make one endless.
const PATIENCE: Duration = Duration::from_secs(300);

const HEAD: &str = "\
# Planted bugs

A test that cannot fail tests nothing. Each line is a bug that a patch beside this file plants in a copy of the tree, and the
tests that turn red.

```sh
cargo test --release --test mutants -- --ignored --nocapture
```

plants them one after the other, fails if one goes unseen, and writes this table. Pictures compared to the bit
(`tests/golden.rs`) would notice nearly every one of them, and are not asked.

| bug | in | what it breaks | caught by |
|---|---|---|---|
";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn folder() -> PathBuf {
    root().join("tests/mutants")
}

fn table() -> PathBuf {
    folder().join("README.md")
}

/// All bugs, in the order of their numbers.
fn patches() -> Vec<Patch> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder())
        .expect("the folder of this file")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "patch"))
        .collect();
    paths.sort();
    let read = |path: &PathBuf| Patch::read(path).unwrap_or_else(|error| panic!("{error}"));
    paths.iter().map(read).collect()
}

/// The first two cells of a bug's line, and the third.
fn cells(patch: &Patch) -> String {
    format!("| {} | {} | {} |", patch.name, patch.layer, patch.says)
}

#[test]
fn every_bug_can_be_planted() {
    let patches = patches();
    assert!(patches.len() >= 30, "only {} bugs", patches.len());
    let errors: Vec<String> = patches
        .iter()
        .filter_map(|patch| patch.planted(root()).err())
        .collect();
    assert!(errors.is_empty(), "\n{}", errors.join("\n"));
}

#[test]
fn the_table_lists_every_bug_as_caught() {
    let text = std::fs::read_to_string(table()).expect("the table: run the long part");
    assert!(text.starts_with(HEAD), "the table's head is another");
    let rows: Vec<&str> = text[HEAD.len()..].lines().collect();
    let patches = patches();
    assert_eq!(rows.len(), patches.len(), "run the long part again");
    for (row, patch) in rows.iter().zip(&patches) {
        let caught = row.strip_prefix(&cells(patch));
        let by = caught.unwrap_or_else(|| panic!("not {}: {row}", cells(patch)));
        assert!(by.contains('`'), "uncaught: {row}");
    }
}

#[test]
#[ignore = "long: builds luxel once for every planted bug; run with --ignored"]
fn every_planted_bug_is_caught() {
    let chosen = std::env::var("MUTANTS").unwrap_or_default();
    let chosen: Vec<&str> = chosen.split(',').filter(|word| !word.is_empty()).collect();
    let mut patches = patches();
    let all = patches.len();
    let named =
        |patch: &Patch| chosen.is_empty() || chosen.iter().any(|c| patch.name.starts_with(c));
    patches.retain(named);

    let start = Instant::now();
    let tree = Tree::copy(
        root(),
        &Path::new(env!("CARGO_TARGET_TMPDIR")).join("mutants"),
    );
    healthy(&tree, &patches);
    println!("without a bug all is green, {:.0?}", start.elapsed());

    let (mut rows, mut unseen) = (String::new(), Vec::new());
    for patch in &patches {
        let begun = Instant::now();
        let red = caught(&tree, patch);
        println!("{}: {:?}, {:.1?}", patch.name, red, begun.elapsed());
        if red.is_empty() {
            unseen.push(patch.name.as_str());
        }
        let red: Vec<String> = red.iter().map(|test| format!("`{test}`")).collect();
        let _ = writeln!(rows, "{} {} |", cells(patch), red.join(", "));
    }
    println!("{} bugs, {:.0?}", patches.len(), start.elapsed());
    assert!(unseen.is_empty(), "no test saw {}", unseen.join(", "));
    if patches.len() == all {
        std::fs::write(table(), format!("{HEAD}{rows}")).expect("the table");
    }
}

/// Asserts that every test that a bug names exists and is green without the bug.
fn healthy(tree: &Tree, patches: &[Patch]) {
    let mut targets: Vec<&str> = patches.iter().flat_map(Patch::targets).collect();
    targets.sort_unstable();
    targets.dedup();
    for target in targets {
        let mut filters: Vec<&str> = patches.iter().flat_map(|p| p.filters(target)).collect();
        filters.sort_unstable();
        filters.dedup();
        let binary = tree.build(target).unwrap_or_else(|error| panic!("{error}"));
        let Verdict { green, red, ended } = tree.run(&binary, &filters, PATIENCE);
        assert!(
            red.is_empty() && ended,
            "red without any bug: {target} {red:?}"
        );
        for filter in filters {
            let known = green.iter().any(|test| test.contains(filter));
            assert!(known, "{target} has no test `{filter}`: correct the patch");
        }
    }
}

/// The tests that a planted bug turns red.
fn caught(tree: &Tree, patch: &Patch) -> Vec<String> {
    let planted = patch
        .planted(root())
        .unwrap_or_else(|error| panic!("{error}"));
    for (file, text) in &planted {
        tree.write(file, text);
    }
    let mut caught = Vec::new();
    for target in patch.targets() {
        let binary = tree
            .build(target)
            .unwrap_or_else(|error| panic!("{}: a bug must compile\n{error}", patch.name));
        let Verdict { red, ended, .. } = tree.run(&binary, &patch.filters(target), PATIENCE);
        caught.extend(red.iter().map(|test| format!("{target} {test}")));
        if red.is_empty() && !ended {
            caught.push(format!("{target} dies or never ends"));
        }
        if !caught.is_empty() {
            break;
        }
    }
    for (file, _) in &planted {
        let text = std::fs::read_to_string(root().join(file)).expect("a source file");
        tree.write(file, &text);
    }
    caught
}
