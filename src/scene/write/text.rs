//! Pieces of RON text: numbers, named fields, lines that are not too long.

use std::fmt::Write;

/// Longest line that is written if there is a place to break it.
const WIDTH: usize = 130;

/// Names longer than this do not push the column of all others to the right.
const MAX_COLUMN: usize = 24;

/// Named fields in parentheses, in the order of the calls.
#[derive(Default)]
pub(super) struct Fields(pub(super) Vec<String>);

impl Fields {
    pub(super) fn with(mut self, name: &str, value: impl std::fmt::Display) -> Fields {
        self.0.push(format!("{name}: {value}"));
        self
    }

    /// Leaves the field out where it would say the default.
    pub(super) fn unless<T: PartialEq>(
        self,
        default: &T,
        name: &str,
        value: &T,
        text: impl Fn(&T) -> String,
    ) -> Fields {
        if value == default {
            self
        } else {
            self.with(name, text(value))
        }
    }

    pub(super) fn number_unless(self, default: f64, name: &str, value: f64) -> Fields {
        self.unless(&default, name, &value, |x| number(*x))
    }

    /// `(a: .., b: ..)`.
    pub(super) fn close(self) -> String {
        format!("({})", self.0.join(", "))
    }

    /// The same behind a variant, which stands alone where there is no field.
    pub(super) fn close_variant(self, variant: &str) -> String {
        if self.0.is_empty() {
            variant.to_owned()
        } else {
            format!("{variant}{}", self.close())
        }
    }
}

/// Appends items to a line, and goes on in the same column below where it would become too long.
pub(super) fn fill(start: String, items: &[String]) -> String {
    let indent = start.chars().count();
    let mut length = indent;
    let mut text = start;
    for (i, item) in items.iter().enumerate() {
        let item_length = item.chars().count();
        // Before it ", ", behind it a comma or "),".
        if i > 0 && length + item_length + 4 > WIDTH {
            let _ = write!(text, ",\n{:indent$}", "");
            length = indent;
        } else if i > 0 {
            text.push_str(", ");
            length += 2;
        }
        text.push_str(item);
        length += item_length;
    }
    text
}

/// Width of a column that holds all texts but those that are too long.
pub(super) fn column<'t>(texts: impl Iterator<Item = &'t String>) -> usize {
    let lengths = texts.map(|text| text.chars().count());
    lengths
        .filter(|&length| length <= MAX_COLUMN)
        .max()
        .unwrap_or(0)
}

pub(super) fn vector(v: &[f64]) -> String {
    let numbers: Vec<String> = v.iter().map(|x| number(*x)).collect();
    format!("({})", numbers.join(", "))
}

/// The shortest digits that read back to the same bits, with an exponent where zeros would be counted otherwise.
pub(super) fn number(x: f64) -> String {
    if x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}
