//! The table for people: a block for every subject, a row for every arm, a column for every ray set.

use super::super::{RayKind, Record};
use super::distinct;
use crate::measure::arms::Work;
use std::fmt::Write;

/// Width of what names a row.
const TITLE: usize = 26;

/// Width of a column of rays: `  12.34     81`.
const COLUMN: usize = 16;

/// Speeds of the arms, then the work behind them.
#[must_use]
pub fn table(records: &[Record]) -> String {
    let mut text = String::new();
    for subject in distinct(records, |r| r.subject.clone()) {
        let rows: Vec<&Record> = records.iter().filter(|r| r.subject == subject).collect();
        let kinds = distinct(records, |r| r.rays);
        head(&mut text, &rows, &kinds);
        speeds(&mut text, &rows, &kinds);
        work(&mut text, &rows, &kinds);
    }
    text
}

/// Writing to a string does not fail: the results are dropped here and below.
fn head(text: &mut String, rows: &[&Record], kinds: &[RayKind]) {
    let Some(first) = rows.first() else {
        return;
    };
    let rays = rows.iter().map(|r| r.timed).max().unwrap_or(0);
    let _ = writeln!(
        text,
        "\n{}: {} primitives, up to {rays} rays; its tree was built in {:.1} ms",
        first.subject, first.primitives, first.build_ms
    );
    let _ = write!(text, "{:TITLE$}", "  Mrays/s, ns a ray");
    for kind in kinds {
        let _ = write!(text, "{:>COLUMN$}", kind.to_string());
    }
    let _ = writeln!(text, "{:>12}", "bytes each");
}

fn speeds(text: &mut String, rows: &[&Record], kinds: &[RayKind]) {
    let mut arms = Vec::new();
    for row in rows {
        let arm = (row.tree, row.layout, row.isa);
        if !arms.contains(&arm) {
            arms.push(arm);
        }
    }
    for arm in arms {
        let (tree, layout, isa) = arm;
        let isa = isa.to_string();
        let _ = write!(text, "{:TITLE$}", format!("  {tree:5} {layout:8} {isa:6}"));
        let row = |kind| {
            let mine = |r: &&&Record| (r.tree, r.layout, r.isa) == arm && r.rays == kind;
            rows.iter().find(mine)
        };
        for &kind in kinds {
            let cell = row(kind).map(|r| format!("{:8.2} {:7.0}", r.mrays(), r.ns()));
            let _ = write!(text, "{:>COLUMN$}", cell.unwrap_or_default());
        }
        let bytes = kinds.iter().find_map(|&kind| row(kind)).map(|r| r.bytes);
        let _ = writeln!(text, "{:12.1}", bytes.unwrap_or(0.0));
    }
}

/// A number of [`Work`].
type Count = fn(&Work) -> u64;

const COUNTS: [(&str, Count); 3] = [
    ("nodes a ray", |work| work.nodes),
    ("primitives", |work| work.primitives),
    ("lanes", |work| work.lanes),
];

/// What the walks of the rivals take. Every layout that is tested in lanes takes the same number of them.
fn work(text: &mut String, rows: &[&Record], kinds: &[RayKind]) {
    let mut trees = Vec::new();
    for row in rows.iter().filter(|row| row.work.is_some()) {
        let of_tree = |r: &&&Record| r.tree == row.tree && r.work.is_some();
        // Structs are tested one by one.
        let padded = rows.iter().filter(of_tree).map(|r| r.layout).max();
        if trees.contains(&row.tree) {
            continue;
        }
        trees.push(row.tree);
        for (title, count) in COUNTS {
            let title = format!("  {:5} {title}", row.tree);
            let _ = write!(text, "{title:TITLE$}");
            for &kind in kinds {
                let same = |r: &&&Record| of_tree(r) && Some(r.layout) == padded && r.rays == kind;
                let per_ray = rows.iter().find(same).and_then(|r| {
                    let work = r.work.as_ref()?;
                    Some(format!("{:.1}", count(work) as f64 / r.timed as f64))
                });
                let _ = write!(text, "{:>COLUMN$}", per_ray.unwrap_or_default());
            }
            let _ = writeln!(text);
        }
    }
}
