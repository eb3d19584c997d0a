//! What a file is told once, however often it applies.

use crate::diag::Diagnostic;
use std::path::Path;

/// Names of materials in one message.
const NAMES: usize = 4;

/// Something to say of a file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Topic {
    pub(super) code: &'static str,
    /// What of the things counted: `primitives of points are skipped`.
    pub(super) says: &'static str,
    /// What to do about it.
    pub(super) hint: &'static str,
}

/// The topics of a file, each with how many times it applies and the first place.
#[derive(Debug, Default)]
pub(super) struct Notes {
    topics: Vec<(&'static Topic, usize, String)>,
    /// What is told in words of its own.
    others: Vec<Diagnostic>,
}

impl Notes {
    /// Counts one place, a JSON pointer.
    pub(super) fn add(&mut self, topic: &'static Topic, pointer: impl Into<String>) {
        self.add_many(topic, 1, pointer);
    }

    /// Counts several, of which the first is at `pointer`; none says nothing.
    pub(super) fn add_many(
        &mut self,
        topic: &'static Topic,
        count: usize,
        pointer: impl Into<String>,
    ) {
        if count == 0 {
            return;
        }
        match self.topics.iter_mut().find(|(known, ..)| *known == topic) {
            Some((_, sum, _)) => *sum += count,
            None => self.topics.push((topic, count, pointer.into())),
        }
    }

    /// Adds a warning of its own.
    pub(super) fn tell(&mut self, warning: Diagnostic) {
        self.others.push(warning);
    }

    /// Adds what another part of the file has to say, which comes after this one's.
    pub(super) fn absorb(&mut self, other: Notes) {
        for (topic, count, first) in other.topics {
            self.add_many(topic, count, first);
        }
        self.others.extend(other.others);
    }

    /// The warnings, in order of first mention.
    pub(super) fn warnings(self, file: &Path) -> impl Iterator<Item = Diagnostic> {
        let counted = self.topics.into_iter().map(|(topic, count, first)| {
            let says = format!("{count} {}; the first is here", topic.says);
            let warning = Diagnostic::warning(topic.code, says).pointer(first);
            warning.hint(topic.hint)
        });
        counted.chain(self.others).map(move |one| one.in_file(file))
    }
}

/// `"a", "b" and 3 more`.
pub(super) fn names(names: &[String]) -> String {
    let shown: Vec<String> = names.iter().take(NAMES).map(|n| format!("{n:?}")).collect();
    let shown = shown.join(", ");
    match names.len().saturating_sub(NAMES) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}
