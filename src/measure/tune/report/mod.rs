//! Reports: a table for people, a chart, and CSV.

mod chart;
mod csv;
mod table;

pub use chart::svg;
pub use csv::csv;
pub use table::{markdown, table};

use super::{Estimate, Pick, Report, Row};

/// What the exact dials are called, which have nothing to say.
const EXACT: &str = "exact (the defaults)";

/// How a setting is called.
#[must_use]
pub fn name(report: &Report, row: &Row) -> String {
    let words = row.dials.words(&report.exact().dials);
    match words.is_empty() {
        true => EXACT.to_owned(),
        false => words,
    }
}

/// The arguments of `luxel render` for a pick: those that differ from its defaults.
#[must_use]
pub fn arguments(report: &Report, pick: &Pick) -> String {
    let (width, height) = pick.size;
    let mut words = format!("--spp {}", pick.spp);
    if pick.size != report.full {
        words += &format!(" --size {width}x{height}");
    }
    let dials = report.rows[pick.row].dials.words(&report.exact().dials);
    match dials.is_empty() {
        true => words,
        false => format!("{words} {dials}"),
    }
}

/// Seconds of the clock, if all threads work all of the time and have processors of their own.
#[must_use]
pub fn wall(report: &Report, cpu: f64) -> f64 {
    cpu / report.threads.max(1) as f64
}

/// The root of a squared bias with its interval, in percent: `0.42–0.51 %`, `< 0.10 %`.
fn bias(squared: &Estimate) -> String {
    let percent = |x: f64| 100.0 * x.max(0.0).sqrt();
    match squared.value > squared.half_width {
        true => format!(
            "{:.2}–{:.2} %",
            percent(squared.value - squared.half_width),
            percent(squared.upper())
        ),
        false => format!("< {:.2} %", percent(squared.upper())),
    }
}

/// Three digits.
fn short(x: f64) -> String {
    match x {
        _ if x >= 99.5 => format!("{x:.0}"),
        _ if x >= 9.95 => format!("{x:.1}"),
        _ if x >= 0.0995 => format!("{x:.2}"),
        _ => format!("{x:.3}"),
    }
}
