//! Rows as a table for people and as comma-separated values.

use super::Row;
use crate::trace::Isa;
use std::fmt::Write;

/// Times and errors side by side, and what was counted.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    let isa = Isa::best().level();
    let mut text = format!(
        "What exactness costs: nanoseconds on one thread ({isa}), and wrong answers among a million on hard inputs\n\n\
         {:20} {:12} {:>8} {:>9}   {:16} {:>8} {:>9}  {:>7}\n",
        "", "luxel", "ns", "wrong", "cheap twin", "ns", "wrong", "extra"
    );
    for row in rows {
        let [exact, cheap] = row.ns;
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{:20} {:12} {exact:8.2} {:9.0}   {:16} {cheap:8.2} {:9.0}  {:+6.1}%",
            row.choice,
            row.exact,
            row.wrong[0],
            row.cheap,
            row.wrong[1],
            1e2 * (exact / cheap - 1.0),
        );
    }
    text.push('\n');
    for row in rows {
        let Row {
            choice,
            unit,
            judged,
            counted,
            ..
        } = row;
        let _ = writeln!(text, "  {choice}: ns a {unit}; of {judged}: {counted}");
    }
    text
}

/// Comma-separated values with a header.
#[must_use]
pub fn csv(rows: &[Row]) -> String {
    let mut text = "choice,exact,cheap,unit,ns_exact,ns_cheap,wrong_per_million_exact,wrong_per_million_cheap,judged,counted\n"
        .to_owned();
    for r in rows {
        let _ = writeln!(
            text,
            "{},{},{},{},{:.4},{:.4},{:.3},{:.3},{},\"{}\"",
            r.choice,
            r.exact,
            r.cheap,
            r.unit,
            r.ns[0],
            r.ns[1],
            r.wrong[0],
            r.wrong[1],
            r.judged,
            r.counted,
        );
    }
    text
}
