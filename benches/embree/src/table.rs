//! Rows to text, Markdown and CSV.

use crate::bars::bar;
use crate::engine::Who;
use crate::measure::Row;
use luxel::measure::bench::{RayKind, Subject};
use luxel::measure::referee::Verdict;
use std::fmt::Write;

/// The first line of the CSV file.
pub(crate) const CSV_HEADER: &str = "subject,primitives,engine,set,rays,mrays_per_s,agree,ties,edges,wrong,build_ms_per_million,bytes_per_primitive";

/// The table of a subject.
pub(crate) fn text(name: &str, subject: &Subject, rows: &[Row], markdown: bool) -> String {
    let mut lines = vec![header()];
    lines.extend(rows.iter().map(|row| cells(row, subject)));
    for robust in [false, true] {
        lines.extend(ratios(name, subject, rows, robust));
    }
    let count = primitives(subject);
    if markdown {
        format!(
            "**{name}**, {count} primitives\n\n{}\n",
            in_markdown(&lines)
        )
    } else {
        format!("{name}, {count} primitives\n{}\n", aligned(&lines))
    }
}

/// The lines of the CSV file of a subject.
pub(crate) fn csv(name: &str, subject: &Subject, rows: &[Row]) -> String {
    let mut out = String::new();
    for row in rows {
        for (kind, set) in RayKind::ALL.iter().zip(&row.sets) {
            let [agree, ties, edges, wrong] = set.verdicts;
            let [ms, bytes] = per_primitive(row, subject);
            let _ = writeln!(
                out,
                "{name},{},{},{kind},{},{:.3},{agree},{ties},{edges},{wrong},{ms:.1},{bytes:.1}",
                primitives(subject),
                row.who,
                set.rays,
                set.mrays(),
            );
        }
    }
    out
}

fn primitives(subject: &Subject) -> usize {
    subject.triangles.len() + subject.spheres.len()
}

/// Build time in milliseconds per million, and bytes of one.
fn per_primitive(row: &Row, subject: &Subject) -> [f64; 2] {
    let count = primitives(subject) as f64;
    [
        row.build.as_secs_f64() * 1e9 / count,
        row.bytes as f64 / count,
    ]
}

fn header() -> Vec<String> {
    let kinds = RayKind::ALL.map(|kind| kind.to_string());
    let rest = ["build ms/M", "bytes each", "wrong", "edges", "ties"].map(str::to_owned);
    let first = std::iter::once("Mrays/s".to_owned());
    first.chain(kinds).chain(rest).collect()
}

fn cells(row: &Row, subject: &Subject) -> Vec<String> {
    let mut line = vec![row.who.to_string()];
    line.extend(row.sets.iter().map(|set| match set.rays {
        0 => "–".to_owned(),
        _ => format!("{:.2}", set.mrays()),
    }));
    let [ms, bytes] = per_primitive(row, subject);
    line.extend([format!("{ms:.0}"), format!("{bytes:.1}")]);
    for verdict in [Verdict::Wrong, Verdict::Edge, Verdict::Tie] {
        let count: usize = row.sets.iter().map(|s| s.verdicts[verdict as usize]).sum();
        line.push(count.to_string());
    }
    line
}

/// luxel over the better of Embree's kernels in a mode, and the bar, set by set.
fn ratios(name: &str, subject: &Subject, rows: &[Row], robust: bool) -> Option<Vec<String>> {
    let ours = rows.iter().find(|row| row.who == Who::Luxel)?;
    let theirs: Vec<&Row> = rows
        .iter()
        .filter(|row| matches!(row.who, Who::Embree { robust: r, .. } if r == robust))
        .collect();
    let mode = if robust { "robust" } else { "default" };
    let mut line = vec![format!("luxel / {mode}")];
    for (i, kind) in RayKind::ALL.into_iter().enumerate() {
        let best = theirs
            .iter()
            .map(|row| row.sets[i].mrays())
            .fold(0.0, f64::max);
        let bar = bar(name, subject, kind, robust);
        line.push(if best > 0.0 {
            let ratio = ours.sets[i].mrays() / best;
            let sign = if ratio >= bar { '≥' } else { '<' };
            format!("{ratio:.2} {sign} {bar:.2}")
        } else {
            "–".to_owned()
        });
    }
    (!theirs.is_empty()).then_some(line)
}

fn in_markdown(lines: &[Vec<String>]) -> String {
    let mut out = String::new();
    for (i, line) in lines.iter().enumerate() {
        let _ = writeln!(out, "| {} |", line.join(" | "));
        if i == 0 {
            let _ = writeln!(out, "|---|{}", "---:|".repeat(line.len() - 1));
        }
    }
    out
}

fn aligned(lines: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let cells = lines.iter().filter_map(|line| line.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let mut out = String::new();
    for line in lines {
        for (column, cell) in line.iter().enumerate() {
            let width = width(column);
            let _ = match column {
                0 => write!(out, "{cell:width$}"),
                _ => write!(out, "  {cell:>width$}"),
            };
        }
        out.push('\n');
    }
    out
}
