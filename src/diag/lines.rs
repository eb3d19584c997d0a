//! Places in a text: line, column, and the line itself.
//!
//! Enters: a text. Leave: [`Span`]s of byte ranges of it. A text of many places finds its lines once.

use std::sync::Arc;

/// A place in a text file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Span {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// Length in characters, at least 1; a span ends with its line.
    pub len: u32,
    /// The line itself, without its line end; shared by the places in it.
    pub text: Arc<str>,
}

impl Span {
    /// The place of the bytes `at..at + len` of `source`, cut at the end of the line that it starts in.
    #[must_use]
    pub fn of_bytes(source: &str, at: usize, len: usize) -> Span {
        Lines::of(source).span(at, len)
    }
}

/// Where the lines of a text begin.
#[derive(Debug)]
pub struct Lines<'a> {
    source: &'a str,
    /// Byte offset of each line, ascending; the first is 0.
    starts: Vec<usize>,
    /// The line asked for last: places come in bunches, and a scene may be one line of a megabyte.
    last: std::cell::RefCell<Option<Cursor>>,
}

/// A line with the last place in it, from which the next one's column is counted.
#[derive(Clone, Debug)]
struct Cursor {
    line: usize,
    text: Arc<str>,
    /// Byte of the source, and the characters between the line's start and it.
    at: usize,
    chars: usize,
}

impl<'a> Lines<'a> {
    /// Finds the lines of a text.
    #[must_use]
    pub fn of(source: &'a str) -> Lines<'a> {
        let ends = source
            .bytes()
            .enumerate()
            .filter(|(_, byte)| *byte == b'\n');
        Lines {
            source,
            starts: std::iter::once(0)
                .chain(ends.map(|(at, _)| at + 1))
                .collect(),
            last: std::cell::RefCell::default(),
        }
    }

    /// The line of a byte, from 1.
    #[must_use]
    pub fn number(&self, at: usize) -> usize {
        self.starts.partition_point(|start| *start <= at)
    }

    /// The place of the bytes `at..at + len`, cut at the end of the line that it starts in.
    #[must_use]
    pub fn span(&self, at: usize, len: usize) -> Span {
        let at = floor_boundary(self.source, at);
        let line = self.number(at);
        let end = self
            .starts
            .get(line)
            .map_or(self.source.len(), |next| next - 1);
        let stop = floor_boundary(self.source, at.saturating_add(len).min(end));
        let cursor = self.cursor(line, at, end);
        let short = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Span {
            line: short(line),
            column: short(cursor.chars).saturating_add(1),
            len: short(self.source[at..stop.max(at)].chars().count()).max(1),
            text: cursor.text,
        }
    }

    /// The line `line`, which ends before byte `end`, and the characters before byte `at` of it.
    fn cursor(&self, line: usize, at: usize, end: usize) -> Cursor {
        let start = self.starts[line - 1];
        let mut last = self.last.borrow_mut();
        let (from, chars, text) = match last.take() {
            Some(known) if known.line == line && known.at <= at => {
                (known.at, known.chars, known.text)
            }
            Some(known) if known.line == line => (start, 0, known.text),
            _ => (
                start,
                0,
                self.source[start..end].trim_end_matches('\r').into(),
            ),
        };
        let cursor = Cursor {
            line,
            text,
            at,
            chars: chars + self.source[from..at].chars().count(),
        };
        *last = Some(cursor.clone());
        cursor
    }
}

fn floor_boundary(s: &str, i: usize) -> usize {
    let mut i = i.min(s.len());
    while !s.is_char_boundary(i) {
        i -= 1;
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Line, column and length as they are counted by hand, character by character.
    fn counted(source: &str, at: usize, len: usize) -> (u32, u32, u32) {
        let mut at = at.min(source.len());
        while !source.is_char_boundary(at) {
            at -= 1;
        }
        let (mut line, mut column) = (1, 1);
        for c in source[..at].chars() {
            (line, column) = if c == '\n' {
                (line + 1, 1)
            } else {
                (line, column + 1)
            };
        }
        let rest = source[at..].char_indices();
        let inside = rest.take_while(|(i, c)| *c != '\n' && i + c.len_utf8() <= len);
        (line, column, (inside.count() as u32).max(1))
    }

    #[test]
    fn places_are_those_counted_by_hand_in_any_order() {
        let source = "one\n  two é three\r\n\nfünf\nlast é";
        let lines = Lines::of(source);
        // A step that is no divisor goes to and fro between the lines.
        for step in 0..400 {
            let (at, len) = (step * 17 % (source.len() + 3), step % 7);
            let span = lines.span(at, len);
            let wanted = counted(source, at, len);
            assert_eq!((span.line, span.column, span.len), wanted, "{at} {len}");
            let text = source
                .split('\n')
                .nth(span.line as usize - 1)
                .unwrap_or_default();
            assert_eq!(&*span.text, text.trim_end_matches('\r'));
            assert_eq!(lines.number(at.min(source.len())), span.line as usize);
        }
    }

    #[test]
    fn places_in_one_line_share_it() {
        let source = "a".repeat(1 << 20);
        let lines = Lines::of(&source);
        let (a, b) = (lines.span(5, 1), lines.span(1 << 19, 3));
        assert!(Arc::ptr_eq(&a.text, &b.text));
        assert_eq!((b.column, b.len), ((1 << 19) + 1, 3));
    }
}
