//! The chart: small multiples, a row of panels for every subject, a panel for every ray set, a bar for every arm.

use super::super::{RayKind, Record};
use super::distinct;
use crate::measure::arms::Layout;
use crate::measure::svg::{document, text};
use std::fmt::Write;

/// Pixels. Room for the arms' names on the left.
const LABELS: f64 = 150.0;
/// Width of a panel, with what is kept free to the right of its longest bar for the number, and the gap to the next.
const PANEL: f64 = 150.0;
const NUMBER: f64 = 36.0;
const GAP: f64 = 22.0;
/// Height of a bar, and from one to the next.
const BAR: f64 = 12.0;
const STEP: f64 = 16.0;
/// Above the first subject, above the bars of each, below the last.
const HEAD: f64 = 58.0;
const TITLE: f64 = 26.0;
const FOOT: f64 = 20.0;

/// A picture of Mrays/s. The bars of a subject share a scale.
#[must_use]
pub fn svg(records: &[Record]) -> String {
    let kinds = distinct(records, |r| r.rays);
    let mut body = String::new();
    let title = "Traversal on one thread, million rays a second";
    text(&mut body, [FOOT, 26.0], "t", title);
    for (i, kind) in kinds.iter().enumerate() {
        text(&mut body, [panel(i), HEAD - 8.0], "s", &kind.to_string());
    }
    let mut top = HEAD;
    for subject in distinct(records, |r| r.subject.clone()) {
        let rows: Vec<&Record> = records.iter().filter(|r| r.subject == subject).collect();
        top = panels(&mut body, &rows, &kinds, top);
    }
    let [width, height] = [panel(kinds.len()), top + FOOT];
    document([width, height], &body)
}

/// Left edge of a panel.
fn panel(i: usize) -> f64 {
    LABELS + i as f64 * (PANEL + GAP)
}

/// The panels of one subject below `top`; returns where they end.
fn panels(body: &mut String, rows: &[&Record], kinds: &[RayKind], top: f64) -> f64 {
    let Some(first) = rows.first() else {
        return top;
    };
    let longest = rows.iter().map(|r| r.mrays()).fold(0.0, f64::max);
    let name = format!("{} · {} primitives", first.subject, first.primitives);
    text(body, [FOOT, top + TITLE - 8.0], "s", &name);
    let mut arms = Vec::new();
    for row in rows {
        let arm = format!("{} {} {}", row.tree, row.layout, row.isa);
        let line = arms.iter().position(|known| *known == arm);
        let line = line.unwrap_or_else(|| {
            let y = top + TITLE + arms.len() as f64 * STEP + 0.8 * BAR;
            text(body, [LABELS - 8.0, y], "a", &arm);
            arms.push(arm);
            arms.len() - 1
        });
        let Some(column) = kinds.iter().position(|kind| *kind == row.rays) else {
            continue;
        };
        let (x, y) = (panel(column), top + TITLE + line as f64 * STEP);
        let width = (PANEL - NUMBER) * row.mrays() / longest;
        let color = color(row.layout);
        // Writing to a string does not fail.
        let _ = write!(
            body,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width:.1}\" height=\"{BAR}\" fill=\"{color}\"/>"
        );
        let number = format!("{:.2}", row.mrays());
        text(body, [x + width + 4.0, y + 0.8 * BAR], "n", &number);
    }
    top + TITLE + arms.len() as f64 * STEP
}

/// Shades of one hue for the rivals, plain to refined, another hue for the product; told apart in grey, too.
fn color(layout: Layout) -> &'static str {
    match layout {
        Layout::Structs => "#c6d3e1",
        Layout::Gathered => "#a3b8cf",
        Layout::Arrays => "#7c9abb",
        Layout::Fours => "#6689ad",
        Layout::Blocks => "#4f779f",
        Layout::Luxel => "#d9822b",
    }
}
