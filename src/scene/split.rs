//! The parts of a list, a tuple, a struct or a map, found by their brackets and commas.
//!
//! Enters: text that `ron` has read as a whole and found right. Leave: the texts of its parts. `ron` reads some ten
//! megabytes a second, and every layer reads its text again, so that this pays from ten thousand entities on.
//! Deliberately absent: raw strings, byte strings, characters and whatever else is rare: these are `ron`'s, and so is
//! every error.

/// A part as written, without the blanks and comments around it, and what stands before its colon, if it has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part<'a> {
    pub(super) key: Option<&'a str>,
    pub(super) value: &'a str,
}

/// The parts of `text`, which begins with a bracket and ends with its counterpart; `None` where `ron` has to look.
pub(super) fn parts(text: &str) -> Option<Vec<Part<'_>>> {
    let bytes = text.as_bytes();
    let close = counterpart(*bytes.first()?)?;
    let mut scan = Scan {
        text,
        at: 1,
        first: None,
        last: 1,
        key: None,
    };
    let mut parts = Vec::new();
    let mut open = vec![close];
    loop {
        scan.skip_blank()?;
        let byte = *bytes.get(scan.at)?;
        let outermost = open.len() == 1;
        match byte {
            b',' if outermost => parts.push(scan.part()?),
            b':' if outermost => scan.colon()?,
            b',' | b':' => scan.token(1),
            b'(' | b'[' | b'{' => {
                open.push(counterpart(byte)?);
                scan.token(1);
            }
            b')' | b']' | b'}' => {
                if open.pop()? != byte {
                    return None;
                }
                if open.is_empty() {
                    let whole = scan.at + 1 == bytes.len();
                    if scan.first.is_some() || scan.key.is_some() {
                        parts.push(scan.part()?);
                    }
                    return whole.then_some(parts);
                }
                scan.token(1);
            }
            b'"' => scan.string()?,
            _ => scan.word()?,
        }
    }
}

fn counterpart(open: u8) -> Option<u8> {
    match open {
        b'(' => Some(b')'),
        b'[' => Some(b']'),
        b'{' => Some(b'}'),
        _ => None,
    }
}

/// A walk over tokens.
struct Scan<'a> {
    text: &'a str,
    at: usize,
    /// Where the part begins, once it does.
    first: Option<usize>,
    /// Behind the last token.
    last: usize,
    key: Option<&'a str>,
}

impl<'a> Scan<'a> {
    /// The part that ends here, and on to the next one behind the comma.
    fn part(&mut self) -> Option<Part<'a>> {
        let value = self.text.get(self.first.take()?..self.last)?;
        self.at += 1;
        Some(Part {
            key: self.key.take(),
            value,
        })
    }

    /// What came so far was a key.
    fn colon(&mut self) -> Option<()> {
        if self.key.is_some() {
            return None;
        }
        self.key = self.text.get(self.first.take()?..self.last);
        self.at += 1;
        Some(())
    }

    fn token(&mut self, len: usize) {
        self.first.get_or_insert(self.at);
        self.at += len;
        self.last = self.at;
    }

    fn string(&mut self) -> Option<()> {
        let rest = &self.text.as_bytes()[self.at + 1..];
        let mut len = 0;
        loop {
            match rest.get(len)? {
                b'"' => break,
                b'\\' => len += 2,
                _ => len += 1,
            }
        }
        self.token(len + 2);
        Some(())
    }

    /// A number, a name, a range: anything of letters, digits, signs and dots.
    fn word(&mut self) -> Option<()> {
        let rest = &self.text.as_bytes()[self.at..];
        let plain =
            |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'.' | b'+' | b'-' | b'=');
        let len = rest.iter().take_while(|b| plain(b)).count();
        // What follows a letter at once may be a raw string.
        if len == 0 || matches!(rest.get(len), Some(b'"' | b'\'' | b'#')) {
            return None;
        }
        self.token(len);
        Some(())
    }

    fn skip_blank(&mut self) -> Option<()> {
        let bytes = self.text.as_bytes();
        loop {
            match (bytes.get(self.at)?, bytes.get(self.at + 1)) {
                (b' ' | b'\n' | b'\t' | b'\r', _) => self.at += 1,
                (b'/', Some(b'/')) => {
                    self.at += bytes[self.at..].iter().position(|b| *b == b'\n')?;
                }
                (b'/', _) => return None,
                _ => return Some(()),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Option<Vec<(Option<&str>, &str)>> {
        Some(parts(text)?.iter().map(|p| (p.key, p.value)).collect())
    }

    #[test]
    fn parts_come_without_blanks_and_comments() {
        let list = "[ (a: 1, b: \"),\\\"(\") // one\n , // two\n Name ( x ) , -1.5e+3,\n]";
        let wanted = ["(a: 1, b: \"),\\\"(\")", "Name ( x )", "-1.5e+3"];
        assert_eq!(texts(list), Some(wanted.map(|w| (None, w)).to_vec()));
        let map = "{ \"a:b\" : Mirror, 3: [1, 2] }";
        let wanted = vec![(Some("\"a:b\""), "Mirror"), (Some("3"), "[1, 2]")];
        assert_eq!(texts(map), Some(wanted));
        assert_eq!(texts("()"), Some(vec![]));
        assert_eq!(
            texts("(frames: 0..48)"),
            Some(vec![(Some("frames"), "0..48")])
        );
    }

    #[test]
    fn what_is_rare_or_wrong_is_left_to_ron() {
        let rare = [
            "(r\"(\")",
            "(r#\"a\"#)",
            "('(')",
            "(b\"x\")",
            "(/* c */ 1)",
            "(é: 1)",
        ];
        let wrong = [
            "",
            "x",
            "(",
            "(1]",
            "(1))",
            "(1) 2",
            "(,)",
            "(a: b: c)",
            "(a:)",
            "(\"x)",
            "([1)",
            "(1 // )",
        ];
        for text in rare.into_iter().chain(wrong) {
            assert_eq!(texts(text), None, "{text}");
        }
    }
}
