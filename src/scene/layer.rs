//! RON text, one layer at a time: the text of a value enters, the texts of its parts leave, each with its place.
//!
//! The `ron` crate is the grammar: it reads the whole once, cuts the layers (`RawValue` borrows from the source, so an
//! offset is a difference of addresses) where `split` cannot, and reads the literals. Reading layer by layer keeps an error in one part from hiding
//! those in the others. Deliberately absent: meaning, defaults, diagnostics.

use super::split::{self, Part};
use ron::Options;
use ron::error::{Position, SpannedError};
use ron::value::RawValue;
use serde::Deserializer as _;
use serde::de::{Deserialize, Error as _, MapAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// A value as written: without the white space and comments around it, and where it starts in the source.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node<'a> {
    pub(super) text: &'a str,
    pub(super) at: usize,
}

/// A name and its value: a field of a struct, or an entry of a map (whose key is any value).
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair<'a> {
    pub(super) key: Node<'a>,
    pub(super) value: Node<'a>,
}

/// Why a value did not come apart.
#[derive(Debug)]
pub(super) enum LayerError {
    /// It is something else.
    OtherKind,
    /// It is not RON: what, and the byte of the source.
    Syntax(Box<ron::Error>, usize),
}

impl<'a> Node<'a> {
    /// The one value of a document.
    pub(super) fn document(source: &'a str) -> Result<Node<'a>, LayerError> {
        let raw: &RawValue = Options::default()
            .from_str(source)
            .map_err(|error| syntax(source, 0, error))?;
        Ok(Node {
            text: source,
            at: 0,
        }
        .part(raw))
    }

    /// The identifier that the value starts with, and the rest of it.
    pub(super) fn head(self) -> (Option<&'a str>, Node<'a>) {
        let len = identifier_len(self.text);
        let (name, rest) = self.text.split_at(len);
        if len == 0 || rest.starts_with(['"', '\'', '#']) {
            return (None, self);
        }
        let rest = skip_blank(rest);
        let at = self.at + self.text.len() - rest.len();
        (Some(name), Node { text: rest, at })
    }

    /// The identifier alone, for a place.
    pub(super) fn head_place(self) -> Node<'a> {
        let text = &self.text[..identifier_len(self.text)];
        Node { text, at: self.at }
    }

    /// The fields of `(a: x, b: y)`, of `()` and of nothing, which is what a bare variant leaves behind its name.
    pub(super) fn fields(self) -> Result<Vec<Pair<'a>>, LayerError> {
        let Some(inside) = self.text.strip_prefix('(') else {
            let nothing = self.text.is_empty();
            return nothing.then(Vec::new).ok_or(LayerError::OtherKind);
        };
        let inside = skip_blank(inside);
        let after_name = skip_blank(&inside[identifier_len(inside)..]);
        if !inside.starts_with(')')
            && (after_name.len() == inside.len() || !after_name.starts_with(':'))
        {
            return Err(LayerError::OtherKind);
        }
        if let Some(pairs) = self.pairs(|key| identifier_len(key) == key.len()) {
            return Ok(pairs);
        }
        let pairs = self.cut(|de| de.deserialize_struct("", &[], Pairs::<&str>(PhantomData)))?;
        Ok(pairs
            .into_iter()
            .map(|(key, value)| Pair {
                key: self.node(key),
                value: self.part(value),
            })
            .collect())
    }

    /// The value of a field that may be `None`; `Some` around it is taken off.
    pub(super) fn given(self) -> Option<Node<'a>> {
        match self.head() {
            (Some("None"), _) => None,
            (Some("Some"), body) => match body.tuple().as_deref() {
                Ok([inner]) => Some(*inner),
                _ => Some(self),
            },
            _ => Some(self),
        }
    }

    /// The value of one field, whatever stands before the parentheses.
    pub(super) fn field(self, name: &str) -> Option<Node<'a>> {
        let fields = self.head().1.fields().ok()?;
        fields
            .iter()
            .find(|pair| pair.key.text == name)
            .map(|pair| pair.value)
    }

    /// The entries of `{key: value, ..}`, in order, duplicates included.
    pub(super) fn entries(self) -> Result<Vec<Pair<'a>>, LayerError> {
        if !self.text.starts_with('{') {
            return Err(LayerError::OtherKind);
        }
        if let Some(pairs) = self.pairs(|_| true) {
            return Ok(pairs);
        }
        let pairs = self.cut(|de| de.deserialize_map(Pairs::<&RawValue>(PhantomData)))?;
        Ok(pairs
            .into_iter()
            .map(|(key, value)| Pair {
                key: self.part(key),
                value: self.part(value),
            })
            .collect())
    }

    /// The items of `(x, y)`.
    pub(super) fn tuple(self) -> Result<Vec<Node<'a>>, LayerError> {
        if !self.text.starts_with('(') {
            return Err(LayerError::OtherKind);
        }
        if let Some(items) = self.items() {
            return Ok(items);
        }
        let items = self.cut(|de| de.deserialize_tuple(0, Items))?;
        Ok(items.into_iter().map(|raw| self.part(raw)).collect())
    }

    /// The items of `[x, y]`.
    pub(super) fn list(self) -> Result<Vec<Node<'a>>, LayerError> {
        if !self.text.starts_with('[') {
            return Err(LayerError::OtherKind);
        }
        if let Some(items) = self.items() {
            return Ok(items);
        }
        let items = self.cut(|de| de.deserialize_seq(Items))?;
        Ok(items.into_iter().map(|raw| self.part(raw)).collect())
    }

    /// Reads a number. The usual digits need no `ron`.
    pub(super) fn number(self) -> Option<f64> {
        let digits = self.text.strip_prefix('-').unwrap_or(self.text);
        let plain = |b: u8| b.is_ascii_digit() || b == b'.';
        let usual = digits.starts_with(|c: char| c.is_ascii_digit()) && digits.bytes().all(plain);
        match usual {
            true => self.text.parse().ok(),
            false => self.literal().ok(),
        }
    }

    /// Reads a string. One without escapes needs no `ron`.
    pub(super) fn string(self) -> Option<String> {
        let inside = self
            .text
            .strip_prefix('"')
            .and_then(|t| t.strip_suffix('"'));
        match inside.filter(|inside| !inside.contains(['"', '\\'])) {
            Some(inside) => Some(inside.to_owned()),
            None => self.literal().ok(),
        }
    }

    /// Reads a literal.
    pub(super) fn literal<T: Deserialize<'a>>(self) -> Result<T, SpannedError> {
        ron::from_str(self.text)
    }

    /// What the value looks like, for "found ..".
    pub(super) fn kind(self) -> String {
        let (name, body) = self.head();
        match name {
            Some("true" | "false") => return format!("the truth value {}", self.text),
            Some(name) => return format!("`{name}`"),
            None => {}
        }
        let kind = match body.text.as_bytes().first() {
            Some(b'"' | b'r') => "a string",
            Some(b'\'') => "a character",
            Some(b'[') => "a list [..]",
            Some(b'{') => "a map {..}",
            Some(b'(') => return self.kind_of_parentheses(),
            Some(b'0'..=b'9' | b'-' | b'+' | b'.') if body.text.contains("..") => {
                return format!("the range {}", body.text);
            }
            Some(b'0'..=b'9' | b'-' | b'+' | b'.') => return format!("the number {}", body.text),
            _ => "something else",
        };
        kind.to_owned()
    }

    fn kind_of_parentheses(self) -> String {
        match (self.fields(), self.tuple()) {
            (Ok(fields), _) if !fields.is_empty() => "named fields".to_owned(),
            (_, Ok(items)) if items.len() == 1 => "one value in parentheses".to_owned(),
            (_, Ok(items)) if !items.is_empty() => format!("{} values", items.len()),
            _ => "empty parentheses".to_owned(),
        }
    }

    /// Names and values by their brackets; `None` where `ron` has to look.
    fn pairs(self, is_key: impl Fn(&str) -> bool) -> Option<Vec<Pair<'a>>> {
        let parts = split::parts(self.text)?.into_iter();
        let pair = |part: Part<'a>| {
            let key = part.key.filter(|key| is_key(key))?;
            Some(Pair {
                key: self.node(key),
                value: self.node(part.value),
            })
        };
        parts.map(pair).collect()
    }

    /// Values by their brackets; `None` where `ron` has to look.
    fn items(self) -> Option<Vec<Node<'a>>> {
        let parts = split::parts(self.text)?.into_iter();
        let item = |part: Part<'a>| match part.key {
            None => Some(self.node(part.value)),
            Some(_) => None,
        };
        parts.map(item).collect()
    }

    fn node(self, text: &'a str) -> Node<'a> {
        let at = self.offset(text);
        Node { text, at }
    }

    fn cut<T>(
        self,
        read: impl FnOnce(&mut ron::Deserializer<'a>) -> ron::Result<T>,
    ) -> Result<T, LayerError> {
        let failed = |error| syntax(self.text, self.at, error);
        let mut de = ron::Deserializer::from_str(self.text).map_err(failed)?;
        let value = read(&mut de).map_err(|code| failed(de.span_error(code)))?;
        de.end().map_err(|code| failed(de.span_error(code)))?;
        Ok(value)
    }

    fn part(self, raw: &'a RawValue) -> Node<'a> {
        let text = raw.get_ron();
        let commented = text.contains("//") || text.contains("/*");
        let text = if commented {
            raw.trim().get_ron()
        } else {
            text.trim()
        };
        self.node(text)
    }

    fn offset(self, part: &'a str) -> usize {
        self.at + (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }
}

/// What follows the white space and comments at the front.
fn skip_blank(mut text: &str) -> &str {
    loop {
        text = text.trim_start();
        if text.starts_with("//") {
            text = &text[text.find('\n').unwrap_or(text.len())..];
        } else if text.starts_with("/*") {
            text = &text[block_comment_len(text)..];
        } else {
            return text;
        }
    }
}

/// Length of the comment, which may hold others, that `text` starts with.
fn block_comment_len(text: &str) -> usize {
    let bytes = text.as_bytes();
    let (mut depth, mut i) = (0_usize, 0);
    while i + 1 < bytes.len() {
        match &bytes[i..i + 2] {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                i += 1;
                continue;
            }
        }
        i += 2;
        if depth == 0 {
            return i;
        }
    }
    text.len()
}

fn identifier_len(text: &str) -> usize {
    if !text.starts_with(|c: char| c.is_alphabetic() || c == '_') {
        return 0;
    }
    text.find(|c: char| !c.is_alphanumeric() && c != '_')
        .unwrap_or(text.len())
}

fn syntax(text: &str, at: usize, error: SpannedError) -> LayerError {
    // `ron` reports the cursor before and after its last step; what is wrong lies at the second.
    LayerError::Syntax(Box::new(error.code), at + byte_of(text, error.span.end))
}

fn byte_of(text: &str, position: Position) -> usize {
    let line: usize = text
        .split_inclusive('\n')
        .take(position.line - 1)
        .map(str::len)
        .sum();
    let column: usize = text[line..]
        .chars()
        .take(position.col - 1)
        .map(char::len_utf8)
        .sum();
    line + column
}

struct Pairs<K>(PhantomData<K>);

impl<'de, K: Deserialize<'de>> Visitor<'de> for Pairs<K> {
    type Value = Vec<(K, &'de RawValue)>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("names and values")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut pairs = Vec::new();
        while let Some(pair) = map.next_entry()? {
            pairs.push(pair);
        }
        Ok(pairs)
    }
}

struct Items;

impl<'de> Visitor<'de> for Items {
    type Value = Vec<&'de RawValue>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("values")
    }

    fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = seq.next_element()? {
            items.push(item);
        }
        Ok(items)
    }

    fn visit_map<A: MapAccess<'de>>(self, _: A) -> Result<Self::Value, A::Error> {
        Err(A::Error::custom("values without names are needed here"))
    }
}
