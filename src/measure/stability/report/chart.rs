//! The chart: how much a picture differs, over size and over place, with what went wrong written beside its point.

use super::super::{Difference, Report, Row};
use super::power;
use crate::math::{ln, pow};
use crate::measure::svg::{document, text};
use std::fmt::Write;

/// Pixels: a panel, and what stands around it.
const PANEL: [f64; 2] = [330.0, 200.0];
const LEFT: f64 = 74.0;
const TOP: f64 = 64.0;
const GAP: f64 = 34.0;
const FOOT: f64 = 46.0;

/// Powers of ten of the noise that the axis shows; pictures that are equal to the bit stand below it.
const DECADES: [i32; 2] = [-4, 1];
/// Height of what is below the axis.
const SAME: f64 = 26.0;

/// Differences over scales on the left (those that are not moved), over offsets on the right (all others and home).
#[must_use]
pub fn svg(report: &Report, title: &str) -> String {
    let mut body = String::new();
    text(&mut body, [20.0, 26.0], "t", title);
    let says = "difference from the picture at home, in units of its noise";
    text(&mut body, [20.0, 44.0], "n", says);
    axis(&mut body);
    let scales = |row: &&Row| row.placing.offset == 0.0;
    let of_scale = |row: &Row| log10(row.placing.scale);
    let of_offset = |row: &Row| match row.placing.offset {
        0.0 => -1.0,
        offset => log10(offset),
    };
    let left: Vec<&Row> = report.rows.iter().filter(scales).collect();
    panel(&mut body, LEFT, "scale", &left, of_scale);
    let home = |row: &&Row| row.placing.offset > 0.0 || row.placing.scale == 1.0;
    let right: Vec<&Row> = report.rows.iter().filter(home).collect();
    let name = format!("offset, × {} units", power(report.width));
    panel(&mut body, LEFT + PANEL[0] + GAP, &name, &right, of_offset);
    let [width, height] = [
        LEFT + 2.0 * PANEL[0] + GAP + 20.0,
        TOP + PANEL[1] + SAME + FOOT,
    ];
    document([width, height], &body)
}

fn log10(x: f64) -> f64 {
    ln(x) / std::f64::consts::LN_10
}

/// Height of a difference.
fn height(of_noise: f64) -> f64 {
    let [low, high] = DECADES.map(f64::from);
    if of_noise <= 0.0 {
        return TOP + PANEL[1] + 0.5 * SAME;
    }
    let part = (log10(of_noise) - low) / (high - low);
    TOP + PANEL[1] * (1.0 - part.clamp(0.0, 1.0))
}

fn axis(body: &mut String) {
    for decade in DECADES[0]..=DECADES[1] {
        let label = match decade {
            0 => "1".to_owned(),
            1 => "10".to_owned(),
            _ => format!("1e{decade}"),
        };
        let y = height(pow(10.0, f64::from(decade))) + 4.0;
        text(body, [LEFT - 8.0, y], "a n", &label);
    }
    text(body, [LEFT - 8.0, height(0.0) + 4.0], "a n", "same bits");
}

/// Points from left to right, in even steps of `place`.
fn panel(body: &mut String, left: f64, name: &str, rows: &[&Row], place: impl Fn(&Row) -> f64) {
    let at: Vec<f64> = rows.iter().map(|row| place(row)).collect();
    let low = at.iter().copied().fold(f64::INFINITY, f64::min);
    let high = at.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let span = (high - low).max(1.0);
    // Writing to a string does not fail: the results are dropped here and below.
    let _ = write!(
        body,
        "<rect x=\"{left}\" y=\"{TOP}\" width=\"{}\" height=\"{}\" fill=\"#f6f7f9\"/>",
        PANEL[0],
        PANEL[1] + SAME
    );
    let limit = height(Difference::MOST_OF_NOISE);
    for (y, dashes) in [(height(1.0), ""), (limit, "stroke-dasharray=\"4 3\"")] {
        let _ = write!(
            body,
            "<line x1=\"{left}\" x2=\"{}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"#999\" {dashes}/>",
            left + PANEL[0]
        );
    }
    for (y, words) in [(height(1.0) + 13.0, "noise"), (limit - 5.0, "limit")] {
        text(body, [left + PANEL[0] - 6.0, y], "a n", words);
    }
    let mut ticks: Vec<(f64, String)> = Vec::new();
    for (row, at) in rows.iter().zip(&at) {
        let x = left + 18.0 + (PANEL[0] - 36.0) * (at - low) / span;
        point(body, [x, height(row.picture.of_noise)], row);
        ticks.push((x, tick(row)));
    }
    // Powers of ten come first where there is no room for all.
    ticks.sort_by(|a, b| {
        let binary = |tick: &(f64, String)| tick.1.starts_with("2^");
        binary(a).cmp(&binary(b)).then(a.0.total_cmp(&b.0))
    });
    let mut told: Vec<f64> = Vec::new();
    for (x, words) in ticks {
        if told.iter().all(|other| (x - other).abs() > 24.0) {
            text(body, [x, TOP + PANEL[1] + SAME + 16.0], "m n k", &words);
            told.push(x);
        }
    }
    let middle = left + 0.5 * PANEL[0];
    text(body, [middle, TOP + PANEL[1] + SAME + 34.0], "m", name);
}

/// What stands below a point.
fn tick(row: &Row) -> String {
    match (row.placing.scale, row.placing.offset) {
        (1.0, 0.0) => "home".to_owned(),
        (scale, 0.0) => power(scale),
        (_, offset) => power(offset),
    }
}

/// A row: red where something is wrong, hollow where it is both moved and scaled.
fn point(body: &mut String, [x, y]: [f64; 2], row: &Row) {
    let color = if row.is_wrong() { "#b3261e" } else { "#2f6db5" };
    let both = row.placing.offset > 0.0 && row.placing.scale != 1.0;
    let fill = if both { "#fff" } else { color };
    let _ = write!(
        body,
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.5\"/>"
    );
    let count = row.wrongs.total();
    if count > 0 {
        text(body, [x, y - 8.0], "m w", &count.to_string());
    }
}
