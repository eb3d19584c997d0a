//! Items of the catalogue: how often they are tried, and the table of what came out.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Mutex;

/// What trying an item came to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outcome {
    /// How often it was tried.
    pub(crate) trials: u64,
    /// How often it failed.
    pub(crate) failures: u64,
    /// What was measured on the way: the largest error, the limit up to which it holds.
    pub(crate) measured: String,
}

impl Outcome {
    pub(crate) fn new(trials: usize, failures: usize) -> Outcome {
        Outcome {
            trials: trials as u64,
            failures: failures as u64,
            measured: String::new(),
        }
    }

    /// Both together; the words are those of the last.
    pub(crate) fn add(&mut self, more: Outcome) {
        self.trials += more.trials;
        self.failures += more.failures;
        if !more.measured.is_empty() {
            self.measured = more.measured;
        }
    }

    pub(crate) fn saying(self, measured: String) -> Outcome {
        Outcome { measured, ..self }
    }
}

/// Runs an item as often as every commit can wait for.
pub(crate) fn quick(id: &str, trials: f64, item: fn(u64) -> Outcome) {
    let start = std::time::Instant::now();
    let outcome = item(trials as u64);
    println!("{id}: {outcome:?} in {:.2?}", start.elapsed());
    assert!(outcome.trials > 0, "{id}: nothing was tried");
    assert_eq!(outcome.failures, 0, "{id}: {outcome:?}");
}

/// Runs an item as often as its bar asks, or as `CATALOGUE_TRIALS` allows, and enters it into the table.
pub(crate) fn deep(id: &'static str, what: &str, trials: f64, item: fn(u64) -> Outcome) {
    let start = std::time::Instant::now();
    let outcome = item(trials.min(most()) as u64);
    println!("{id}: {outcome:?} in {:.0?}", start.elapsed());
    enter(id, what, &outcome);
    assert!(outcome.trials > 0, "{id}: nothing was tried");
    assert_eq!(outcome.failures, 0, "{id}: {outcome:?}");
}

/// What `CATALOGUE_TRIALS` says, or no limit.
fn most() -> f64 {
    std::env::var("CATALOGUE_TRIALS").map_or(f64::INFINITY, |text| {
        text.parse()
            .expect("CATALOGUE_TRIALS is a number, such as 1e7")
    })
}

/// Rows by id: tests run side by side.
static ROWS: Mutex<BTreeMap<(char, u32), String>> = Mutex::new(BTreeMap::new());

/// Adds a row and writes the table as it is so far.
fn enter(id: &'static str, what: &str, outcome: &Outcome) {
    let letter = id.chars().next().expect("an id");
    let number = id[1..].parse().expect("an id is a letter and a number");
    let row = format!(
        "| {id} | {what} | {} | {} | {} |\n",
        count(outcome.trials),
        count(outcome.failures),
        outcome.measured
    );
    let mut rows = ROWS.lock().expect("no test panics here");
    rows.insert((letter, number), row);
    let mut table =
        String::from("| | what | trials | failures | measured |\n|---|---|---:|---:|---|\n");
    rows.values()
        .for_each(|row| table.write_str(row).expect("a string takes all"));
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("catalogue.md");
    std::fs::write(&path, table).expect("the table is written");
    println!("the table so far: {}", path.display());
}

/// 123 or 1.23e8.
fn count(n: u64) -> String {
    if n < 1_000_000 {
        return n.to_string();
    }
    let text = format!("{:.2e}", n as f64);
    text.replace(".00e", "e").replace("0e", "e")
}

/// Tests of the items of a letter: `name(quick, deep): id, what;`.
macro_rules! items {
    ($($name:ident($quick:expr, $deep:expr): $id:literal, $what:literal;)*) => {
        mod quick {
            $(#[test]
            fn $name() {
                crate::book::quick($id, $quick, super::$name);
            })*
        }

        mod deep {
            $(#[test]
            #[ignore = "deep: see the head of tests/catalogue/main.rs"]
            fn $name() {
                crate::book::deep($id, $what, $deep, super::$name);
            })*
        }
    };
}
pub(crate) use items;

#[test]
fn counts_read_well() {
    for (n, text) in [
        (999_999, "999999"),
        (100_000_000, "1e8"),
        (1_250_000, "1.25e6"),
        (1_200_000, "1.2e6"),
    ] {
        assert_eq!(count(n), text);
    }
}
