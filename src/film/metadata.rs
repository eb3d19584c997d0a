//! What an image says about how it was made.

/// Keys and values in the order in which they are written. Holds everything that can change a pixel, and nothing else:
/// equal renders are equal files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Metadata(Vec<(&'static str, String)>);

impl Metadata {
    /// Appends an entry.
    pub fn push(&mut self, key: &'static str, value: impl ToString) {
        self.0.push((key, value.to_string()));
    }

    /// The entries in order.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.0.iter().map(|(key, value)| (*key, value.as_str()))
    }

    /// One `key: value` per line.
    #[must_use]
    pub fn to_lines(&self) -> String {
        self.entries().map(|(k, v)| format!("{k}: {v}\n")).collect()
    }
}
