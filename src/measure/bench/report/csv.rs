//! All numbers of a run, a row each.

use super::super::Record;
use std::fmt::Write;

/// The columns.
const HEADER: &str = "subject,primitives,rays,tree,layout,isa,timed_rays,passes,mrays_per_s,ns_per_ray,nodes_per_ray,\
primitives_per_ray,lanes_per_ray,bytes_per_primitive,build_ms,checksum";

/// Comma-separated values with a header; what an arm does not count is empty.
#[must_use]
pub fn csv(records: &[Record]) -> String {
    let mut text = format!("{HEADER}\n");
    for r in records {
        let per_ray = |count: fn(&crate::measure::arms::Work) -> u64| {
            let count = r.work.as_ref().map(count);
            count.map_or(String::new(), |n| {
                format!("{:.3}", n as f64 / r.timed as f64)
            })
        };
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{},{:.4},{:.3},{},{},{},{:.1},{:.3},{:016x}",
            quoted(&r.subject),
            r.primitives,
            r.rays,
            r.tree,
            r.layout,
            r.isa,
            r.timed,
            r.passes,
            r.mrays(),
            r.ns(),
            per_ray(|w| w.nodes),
            per_ray(|w| w.primitives),
            per_ray(|w| w.lanes),
            r.bytes,
            r.build_ms,
            r.checksum,
        );
    }
    text
}

/// A field that may hold anything (RFC 4180).
fn quoted(text: &str) -> String {
    if text.contains(['"', ',', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
