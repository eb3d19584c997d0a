//! Warnings about one file, where a file may earn any number of them.

use crate::diag::Diagnostic;
use std::collections::BTreeMap;

/// Warnings of one code that are told one by one; the last of them says how many more there are.
const TOLD_ALONE: usize = 20;

/// Warnings in the order of finding.
#[derive(Debug, Default)]
pub(super) struct Told {
    all: Vec<Diagnostic>,
    /// By code: how many there are, and the place in `all` of the last that is told.
    counts: BTreeMap<&'static str, (usize, usize)>,
}

impl Told {
    /// Adds a warning of a code. It is made only if it is told: finding its line takes a walk over the file.
    pub(super) fn add(&mut self, code: &'static str, make: impl FnOnce() -> Diagnostic) {
        let (count, last) = self.counts.entry(code).or_default();
        *count += 1;
        if *count <= TOLD_ALONE {
            *last = self.all.len();
            self.all.push(make());
        }
    }

    /// The warnings.
    pub(super) fn finish(mut self) -> Vec<Diagnostic> {
        for (count, last) in self.counts.into_values() {
            if let Some(more) = count.checked_sub(TOLD_ALONE).filter(|&more| more > 0)
                && let Some(last) = self.all.get_mut(last)
            {
                last.message += &format!(", and {more} more like it");
            }
        }
        self.all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_of_a_kind_are_counted() {
        let mut told = Told::default();
        for i in 0..TOLD_ALONE + 3 {
            told.add("W101", || Diagnostic::warning("W101", format!("file {i}")));
            if i < TOLD_ALONE {
                told.add("W102", || Diagnostic::warning("W102", "name"));
            }
        }
        let all = told.finish();
        assert_eq!(all.len(), 2 * TOLD_ALONE);
        assert_eq!(all[0].message, "file 0");
        let last = all.iter().rfind(|one| one.code == "W101");
        let message = last.map(|one| one.message.as_str());
        assert_eq!(message, Some("file 19, and 3 more like it"));
        assert!(
            all.iter()
                .all(|one| one.code == "W101" || one.message == "name")
        );
    }
}
