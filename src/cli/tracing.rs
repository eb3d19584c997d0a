//! The stages of tracing as rows for people and for scripts.

use crate::trace::{Stage, Tallies};
use serde_json::{Value, json};

/// The stages through which something went, with the share of the time, and items and nanoseconds of each item.
pub(super) fn json(tallies: &Tallies, samples: u64) -> Value {
    let row = |stage: Stage| {
        let tally = tallies.of(stage);
        json!({
            "name": stage.name(),
            "unit": stage.unit(),
            "items": tally.items,
            "per_sample": ratio(tally.items, samples),
            "nanoseconds": ratio(tally.nanoseconds, tally.items),
            "share": tallies.share(&[stage]),
        })
    };
    used(tallies).map(row).collect()
}

/// The same as a table.
pub(super) fn table(tallies: &Tallies, samples: u64) -> String {
    let mut text = format!(
        "  {:<28}{:>10}{:>12}{:>8}\n",
        "", "a sample", "ns each", "share"
    );
    for stage in used(tallies) {
        let tally = tallies.of(stage);
        let name = format!("{} ({})", stage.name(), plural(stage.unit()));
        text.push_str(&format!(
            "  {name:<28}{:>10.2}{:>12.1}{:>6.1} %\n",
            ratio(tally.items, samples),
            ratio(tally.nanoseconds, tally.items),
            100.0 * tallies.share(&[stage]),
        ));
    }
    text
}

fn used(tallies: &Tallies) -> impl Iterator<Item = Stage> {
    Stage::ALL
        .into_iter()
        .filter(|&stage| tallies.of(stage).items > 0)
}

fn plural(unit: &str) -> String {
    match unit {
        "vertex" => "vertices".to_owned(),
        unit => format!("{unit}s"),
    }
}

fn ratio(part: u64, whole: u64) -> f64 {
    part as f64 / whole.max(1) as f64
}
