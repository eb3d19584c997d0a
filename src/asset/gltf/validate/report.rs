//! What the validator finds, with like findings told once.

use crate::diag::{Diagnostic, Severity};
use std::collections::BTreeMap;

/// Findings of one kind that are told one by one; of more, the first is told with their count.
const TOLD_ALONE: usize = 3;

/// Findings in the order of finding, grouped by code and wording.
#[derive(Debug, Default)]
pub(in crate::asset::gltf) struct Report {
    groups: Vec<Group>,
    by_wording: BTreeMap<(Severity, &'static str, String), usize>,
}

#[derive(Debug)]
struct Group {
    first: Vec<Diagnostic>,
    count: usize,
}

impl Report {
    /// Adds what keeps the file from being used.
    pub(in crate::asset::gltf) fn error(
        &mut self,
        code: &'static str,
        pointer: impl Into<String>,
        says: impl Into<String>,
    ) {
        self.add(Diagnostic::error(code, says).pointer(pointer));
    }

    /// Adds what is wrong and does no harm, or little.
    pub(in crate::asset::gltf) fn warning(
        &mut self,
        code: &'static str,
        pointer: impl Into<String>,
        says: impl Into<String>,
    ) {
        self.add(Diagnostic::warning(code, says).pointer(pointer));
    }

    /// Adds a finding.
    pub(in crate::asset::gltf) fn add(&mut self, found: Diagnostic) {
        let key = (found.severity, found.code, wording(&found.message));
        let index = *self.by_wording.entry(key).or_insert(self.groups.len());
        if index == self.groups.len() {
            let first = Vec::new();
            self.groups.push(Group { first, count: 0 });
        }
        let group = &mut self.groups[index];
        group.count += 1;
        if group.count <= TOLD_ALONE {
            group.first.push(found);
        }
    }

    /// Errors and warnings, in order.
    pub(in crate::asset::gltf) fn finish(self) -> (Vec<Diagnostic>, Vec<Diagnostic>) {
        let told = self.groups.into_iter().flat_map(Group::finish);
        told.partition(|one| one.severity == Severity::Error)
    }
}

impl Group {
    fn finish(mut self) -> Vec<Diagnostic> {
        if self.count > TOLD_ALONE {
            self.first.truncate(1);
            let more = self.count - 1;
            for first in &mut self.first {
                first.message += &format!(", and {more} more like it");
            }
        }
        self.first
    }
}

/// A message without its numbers and names: what findings of one rule have in common.
fn wording(message: &str) -> String {
    let outside_quotes = message.split('"').step_by(2);
    let letters = |c: &char| !c.is_ascii_digit() && !"+-.".contains(*c);
    outside_quotes
        .flat_map(|part| part.chars().filter(letters))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_of_a_kind_are_told_once() {
        let mut report = Report::default();
        for i in 0..5 {
            report.warning("W120", format!("/nodes/{i}"), format!("{i} is \"x{i}\""));
        }
        for i in 0..3 {
            report.error("E124", format!("/nodes/{i}"), format!("{i} is not"));
        }
        let (errors, warnings) = report.finish();
        assert_eq!(errors.len(), 3);
        assert_eq!(warnings.len(), 1);
        assert_eq!(warnings[0].message, "0 is \"x0\", and 4 more like it");
        assert_eq!(warnings[0].pointer.as_deref(), Some("/nodes/0"));
    }
}
