//! Lines of OBJ and MTL files: bytes to text, continuations, comments, and the places of what they say.

use memchr::{memchr, memchr_iter};
use std::borrow::Cow;

/// The text of a file: UTF-8 or UTF-16 by its byte order mark or its first letters, else UTF-8, or else Latin-1, which
/// every byte string is. A line that ends in a carriage return alone ends in a line feed.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    let text = match bytes {
        [0xFF, 0xFE, rest @ ..] => Cow::Owned(utf16(rest, u16::from_le_bytes)),
        [0xFE, 0xFF, rest @ ..] => Cow::Owned(utf16(rest, u16::from_be_bytes)),
        &[a, 0, b, 0, ..] if a != 0 && b != 0 => Cow::Owned(utf16(bytes, u16::from_le_bytes)),
        &[0, a, 0, b, ..] if a != 0 && b != 0 => Cow::Owned(utf16(bytes, u16::from_be_bytes)),
        _ => eight_bit(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)),
    };
    if has_bare_return(&text) {
        // Of the same length, so that every place stays where it is.
        let text = text.replace("\r\n", " \n").replace('\r', "\n");
        return Cow::Owned(text);
    }
    text
}

fn eight_bit(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect()),
    }
}

/// An odd byte at the end is dropped, half a pair of surrogates replaced.
fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let (pairs, _) = bytes.as_chunks();
    let units = pairs.iter().map(|&pair| unit(pair));
    let letters = char::decode_utf16(units);
    letters
        .map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect()
}

fn has_bare_return(text: &str) -> bool {
    let text = text.as_bytes();
    memchr_iter(b'\r', text).any(|at| text.get(at + 1) != Some(&b'\n'))
}

/// A logical line: a keyword and what follows it.
pub(super) struct Line<'a> {
    /// Byte offset of the keyword in the file.
    pub(super) at: usize,
    /// The first word.
    pub(super) keyword: &'a str,
    /// What follows, trimmed; with its comment, since names may contain `#`.
    pub(super) rest: Cow<'a, str>,
}

impl Line<'_> {
    /// What follows, without a comment: for lines of numbers, where `#` has no other meaning.
    pub(super) fn values(&self) -> &str {
        match memchr(b'#', self.rest.as_bytes()) {
            Some(at) => self.rest[..at].trim_end(),
            None => &self.rest,
        }
    }
}

/// What follows without a comment that stands apart, ` # …`: the second reading of a name.
pub(super) fn without_comment(name: &str) -> &str {
    let cut = name
        .match_indices('#')
        .find(|&(at, _)| name[..at].ends_with([' ', '\t']))
        .map_or(name.len(), |(at, _)| at);
    name[..cut].trim_end()
}

/// The logical lines of a file that are neither empty nor comments. A `\` before the line's end continues the line,
/// except in a comment.
pub(super) struct Lines<'a> {
    source: &'a str,
    next: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn of(source: &'a str) -> Lines<'a> {
        Lines::from(source, 0)
    }

    /// The lines from the one that starts at byte `at`.
    pub(super) fn from(source: &'a str, at: usize) -> Lines<'a> {
        Lines { source, next: at }
    }

    /// The next physical line, without its end.
    fn physical(&mut self) -> Option<(usize, &'a str)> {
        let at = self.next;
        let text = self.source.get(at..).filter(|text| !text.is_empty())?;
        let len = memchr(b'\n', text.as_bytes()).unwrap_or(text.len());
        self.next = at + len + 1;
        Some((at, &text[..len]))
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        loop {
            let (start, physical) = self.physical()?;
            let text = physical.trim_ascii_start();
            let at = start + (physical.len() - text.len());
            let text = text.trim_ascii_end();
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            let end = text.bytes().position(|byte| byte.is_ascii_whitespace());
            let (keyword, rest) = text.split_at(end.unwrap_or(text.len()));
            let mut rest = Cow::Borrowed(rest.trim_ascii_start());
            while let Some(cut) = rest.strip_suffix('\\').map(str::len) {
                let joined = rest.to_mut();
                joined.truncate(cut);
                let Some((_, more)) = self.physical() else {
                    break;
                };
                joined.push(' ');
                joined.push_str(more.trim());
            }
            return Some(Line { at, keyword, rest });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(source: &str) -> Vec<(usize, String, String)> {
        Lines::of(source)
            .map(|l| (l.at, l.keyword.to_owned(), l.rest.into_owned()))
            .collect()
    }

    #[test]
    fn lines_carry_their_place_and_join_continuations() {
        let lines = read("# a \\\r\n\tv 1 2 \\\r\n  3\r\n\n f\t1 2 3");
        let expect = |at, keyword: &str, rest: &str| (at, keyword.to_owned(), rest.to_owned());
        assert_eq!(lines, [expect(8, "v", "1 2  3"), expect(24, "f", "1 2 3")]);
    }

    #[test]
    fn a_continuation_at_the_end_of_the_file_ends_the_line() {
        assert_eq!(read("f 1 \\"), [(0, "f".to_owned(), "1 ".to_owned())]);
        assert_eq!(read("f\\"), [(0, "f\\".to_owned(), String::new())]);
    }

    #[test]
    fn text_that_is_not_utf8_is_latin_1() {
        assert_eq!(decode(b"caf\xE9"), "caf\u{e9}");
        assert_eq!(decode("\u{feff}v".as_bytes()), "v");
    }

    #[test]
    fn names_keep_a_hash_that_touches_them() {
        assert_eq!(without_comment("Material #3"), "Material");
        assert_eq!(without_comment("tex#1.png # note"), "tex#1.png");
    }
}
