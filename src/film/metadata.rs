//! What an image says about how it was made.

/// Keys and values in the order in which they are written. Holds everything that can change a pixel, and nothing else:
/// equal renders are equal files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Metadata(Vec<(String, String)>);

impl Metadata {
    /// Appends an entry.
    pub fn push(&mut self, key: &str, value: impl ToString) {
        self.0.push((key.to_owned(), value.to_string()));
    }

    /// The entries in order.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(k, v)| (k.as_str(), v.as_str()))
    }

    /// The value of an entry.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<&str> {
        self.entries().find(|(k, _)| *k == key).map(|(_, v)| v)
    }

    /// Puts a value in the place of the one that is there, or at the end.
    pub fn set(&mut self, key: &str, value: impl ToString) {
        match self.0.iter_mut().find(|(k, _)| k == key) {
            Some((_, there)) => *there = value.to_string(),
            None => self.push(key, value),
        }
    }

    /// One `key: value` per line.
    #[must_use]
    pub fn to_lines(&self) -> String {
        self.entries().map(|(k, v)| format!("{k}: {v}\n")).collect()
    }

    /// What [`Metadata::to_lines`] wrote; lines that are no entries are left out.
    #[must_use]
    pub fn from_lines(lines: &str) -> Metadata {
        let entries = lines.lines().filter_map(|line| line.split_once(": "));
        Metadata(entries.map(|(k, v)| (k.to_owned(), v.to_owned())).collect())
    }
}
