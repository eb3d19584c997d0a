//! Rows for people and for spreadsheets, and the verdict.

use super::super::{Report, Row, Wrongs};
use super::{power, short};
use std::fmt::Write;

/// The columns of the CSV.
const HEADER: &str = "scale,offset,rays,leaks,self_hits,non_finite_samples,pixels_differ,rmse,relmse,of_noise,culprit";

/// A row for every placing. `name` tells what an entity is called.
#[must_use]
pub fn table(report: &Report, name: impl Fn(u32) -> String) -> String {
    let (width, height) = report.size;
    let room = if report.room { ", a closed room" } else { "" };
    // Writing to a string does not fail: the results are dropped here and below.
    let mut text = format!(
        "{width}×{height} pixels, {} samples each; {} shared edges, {} closed parts and {} with holes{room}; an offset of 1 is \
         {} units\n",
        report.spp,
        report.edges,
        report.closed,
        report.open,
        power(report.width)
    );
    let _ = writeln!(
        text,
        "{:>8}{:>8}{:>10}{:>8}{:>11}{:>12}{:>15}{:>10}{:>10}{:>10}  worst",
        "scale",
        "offset",
        "rays",
        "leaks",
        "self-hits",
        "not finite",
        "pixels differ",
        "RMSE",
        "relMSE",
        "of noise"
    );
    for row in &report.rows {
        let worst = row.culprit().filter(|_| row.is_wrong());
        let line = format!(
            "{:>8}{:>8}{:>10}{:>8}{:>11}{:>12}{:>15}{:>10}{:>10}{:>10}  {}",
            power(row.placing.scale),
            power(row.placing.offset),
            row.rays,
            row.wrongs.leaks,
            row.wrongs.self_hits,
            row.wrongs.non_finite,
            row.picture.pixels,
            short(row.picture.rmse),
            short(row.picture.relmse),
            short(row.picture.of_noise),
            worst.map_or(String::new(), &name)
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// One line: whether the scene is safe, and what goes wrong first.
#[must_use]
pub fn verdict(report: &Report, name: impl Fn(u32) -> String) -> String {
    let rays: u64 = report.rows.iter().map(|row| row.rays).sum();
    let Some(row) = report.first_wrong() else {
        let differs = report.rows.iter().map(|row| row.picture.of_noise);
        let most = differs.fold(0.0, f64::max);
        return format!(
            "safe: none of {rays} rays leaked or hit what it left, every sample was finite, and no picture differs from \
             home by more than {:.0} % of its noise\n",
            (100.0 * most).ceil()
        );
    };
    let at = match (row.placing.scale, row.placing.offset) {
        (1.0, 0.0) => "at home".to_owned(),
        (scale, 0.0) => format!("at scale {}", power(scale)),
        (1.0, offset) => format!("at offset {}", power(offset)),
        (scale, offset) => format!("at scale {}, offset {}", power(scale), power(offset)),
    };
    match row.culprit() {
        Some(entity) => format!(
            "not safe: {} is the first to go wrong, {at}: {}\n",
            name(entity),
            what(row, entity)
        ),
        None => format!("not safe, {at}: {}\n", what(row, u32::MAX)),
    }
}

/// What goes wrong with an entity.
fn what(row: &Row, entity: u32) -> String {
    let own = row.culprits.iter().find(|(known, _)| *known == entity);
    let Wrongs {
        leaks,
        self_hits,
        non_finite,
    } = own.map_or(row.wrongs, |(_, wrongs)| *wrongs);
    let counts = [
        (leaks, "leak", "leaks"),
        (self_hits, "self-hit", "self-hits"),
        (
            non_finite,
            "sample that is not finite",
            "samples that are not finite",
        ),
    ];
    let mut all: Vec<String> = counts
        .iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, one, more)| format!("{count} {}", if *count == 1 { one } else { more }))
        .collect();
    if row.picture.is_wrong() {
        let share = row.picture.of_noise;
        all.push(format!(
            "a picture that is off by {share:.1} times the noise"
        ));
    }
    all.join(", ")
}

/// Comma-separated values with a header.
#[must_use]
pub fn csv(report: &Report, name: impl Fn(u32) -> String) -> String {
    let mut text = format!("{HEADER}\n");
    for row in &report.rows {
        let culprit = row.culprit().map_or(String::new(), &name);
        let _ = writeln!(
            text,
            "{:e},{:e},{},{},{},{},{},{:e},{:e},{:e},\"{}\"",
            row.placing.scale,
            row.placing.offset,
            row.rays,
            row.wrongs.leaks,
            row.wrongs.self_hits,
            row.wrongs.non_finite,
            row.picture.pixels,
            row.picture.rmse,
            row.picture.relmse,
            row.picture.of_noise,
            culprit.replace('"', "\"\"")
        );
    }
    text
}
