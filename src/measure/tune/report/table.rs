//! Rows for people: what every setting costs and errs, the fastest first.

use super::super::choose::pick_of;
use super::super::{Goal, Report, Row};
use super::{bias, name, short, wall};
use std::fmt::Write;

/// Samples of the column that compares noise.
const NOISE_AT: u32 = 16;

/// A line for every setting, in the order of the time that it takes for the last goal.
#[must_use]
pub fn table(report: &Report, goals: &[Goal]) -> String {
    let (width, height) = report.size;
    let (seeds, spp) = report.reference;
    let scaled = match report.scale {
        Some(_) => "scaled to",
        None => "as if of",
    };
    // Writing to a string does not fail: the results are dropped here and below.
    let mut text = format!(
        "{width}×{height} pixels, {scaled} {}×{}, {} threads; reference of {seeds} × {spp} samples; bias with 95 % intervals\n",
        report.full.0, report.full.1, report.threads
    );
    let cells = cells(report, goals);
    let widths: Vec<usize> = (0..cells[0].len())
        .map(|k| {
            let lengths = cells.iter().map(|row| row[k].chars().count());
            lengths.max().unwrap_or(0)
        })
        .collect();
    for row in &cells {
        let first = format!("{:<w$}", row[0], w = widths[0]);
        let rest = row.iter().zip(&widths).skip(1);
        let rest: String = rest.map(|(cell, w)| format!("  {cell:>w$}")).collect();
        let _ = writeln!(text, "{}", (first + &rest).trim_end());
    }
    text
}

/// The same for a page.
#[must_use]
pub fn markdown(report: &Report, goals: &[Goal]) -> String {
    let mut text = String::new();
    for (k, row) in cells(report, goals).iter().enumerate() {
        let _ = writeln!(text, "| {} |", row.join(" | "));
        if k == 0 {
            let _ = writeln!(text, "|---{}|", "|---:".repeat(row.len() - 1));
        }
    }
    text
}

/// A header, and a row for every setting.
fn cells(report: &Report, goals: &[Goal]) -> Vec<Vec<String>> {
    let mut header = vec!["setting".to_owned()];
    header.extend(
        goals
            .iter()
            .map(|g| format!("{} %, s", short(100.0 * g.error))),
    );
    header.extend([
        "× defaults".to_owned(),
        "µs/sample".to_owned(),
        format!("noise {NOISE_AT} spp"),
        "bias".to_owned(),
        "brightness".to_owned(),
        "seeds".to_owned(),
    ]);
    let mut order: Vec<usize> = (0..report.rows.len()).collect();
    let last = |k: usize| goals.last().and_then(|goal| pick_of(report, k, *goal));
    let seconds = |k: usize| last(k).map_or(f64::INFINITY, |pick| pick.seconds);
    order.sort_by(|&a, &b| {
        let noisy = |k: usize| report.rows[k].per_sample;
        let (a, b) = ((seconds(a), noisy(a)), (seconds(b), noisy(b)));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let exact = seconds(0);
    let row = |&k: &usize| cells_of(report, goals, k, exact / seconds(k));
    std::iter::once(header)
        .chain(order.iter().map(row))
        .collect()
}

fn cells_of(report: &Report, goals: &[Goal], k: usize, gain: f64) -> Vec<String> {
    let row = &report.rows[k];
    let mut cells = vec![name(report, row)];
    cells.extend(goals.iter().map(|goal| {
        let pick = pick_of(report, k, *goal);
        pick.map_or("never".to_owned(), |p| short(wall(report, p.seconds)))
    }));
    let level = row.levels.iter().find(|l| l.spp == NOISE_AT);
    let noise = level.map_or(String::new(), |l| {
        let variance = l.differences.variance.value * report.scale()[0];
        format!("{:.1} %", 100.0 * variance.sqrt())
    });
    let brightness = row.levels.last().map_or(String::new(), |l| {
        let b = l.differences.brightness;
        format!("{:+.2} ± {:.2} %", 100.0 * b.value, 100.0 * b.half_width)
    });
    cells.extend([
        match gain > 0.0 && gain.is_finite() {
            true => format!("{gain:.2}"),
            false => String::new(),
        },
        short(1e6 * row.per_sample * report.scale()[1]),
        noise,
        told_bias(row),
        brightness,
        format!("{}{}", seeds(row), if row.dropped { ", out" } else { "" }),
    ]);
    cells
}

/// Dials that bias are marked; what others seem to have is no more than the noise that hides it.
fn told_bias(row: &Row) -> String {
    match row.biases {
        0 => format!("none, {}", bias(&row.bias_squared)),
        _ => format!("BIASED, {}", bias(&row.bias_squared)),
    }
}

fn seeds(row: &Row) -> usize {
    row.levels.iter().map(|l| l.seeds).max().unwrap_or(0)
}
