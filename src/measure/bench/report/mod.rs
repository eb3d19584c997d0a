//! Reports of a run: a table for people, a chart, and CSV.

mod chart;
mod csv;
mod summary;
mod table;

pub use chart::svg;
pub use csv::csv;
pub use summary::summary;
pub use table::table;

use super::Record;

/// The values of a key in the order of their first appearance.
fn distinct<K: PartialEq>(records: &[Record], key: impl Fn(&Record) -> K) -> Vec<K> {
    let mut found = Vec::new();
    for key in records.iter().map(key) {
        if !found.contains(&key) {
            found.push(key);
        }
    }
    found
}
