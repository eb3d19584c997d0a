//! Structs, variants and references over [`Node`]s: what is missing, unknown or given twice is reported with its place.
//!
//! A reader returns `None` when it has reported an error; the caller goes on, so that every error is found.

use super::layer::{LayerError, Node, Pair};
use super::syntax;
use crate::diag::{Diagnostic, Lines, Severity, codes};
use std::cell::{Cell, RefCell};
use std::path::Path;

/// So many names are compared with wrong ones in all: a fraction of a second. Where so much is wrong, the first
/// suggestions tell what.
const MAX_COMPARISONS: usize = 1 << 17;

/// The file being read and what was found in it.
pub(super) struct Reader<'a> {
    pub(super) source: &'a str,
    pub(super) file: &'a Path,
    lines: Lines<'a>,
    found: RefCell<Vec<Diagnostic>>,
    /// Names that may still be compared for suggestions.
    comparisons: Cell<usize>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a str, file: &'a Path) -> Reader<'a> {
        Reader {
            source,
            file,
            lines: Lines::of(source),
            found: RefCell::default(),
            comparisons: Cell::new(MAX_COMPARISONS),
        }
    }

    pub(super) fn report(&self, diagnostic: Diagnostic) {
        self.found.borrow_mut().push(diagnostic);
    }

    /// An error at `place`.
    pub(super) fn error(&self, code: &'static str, place: Node<'_>, message: impl Into<String>) {
        self.report(self.diagnostic(code, place, message));
    }

    /// An error at `place` with what to do about it.
    pub(super) fn error_hint(
        &self,
        code: &'static str,
        place: Node<'_>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.report(self.diagnostic(code, place, message).hint(hint));
    }

    pub(super) fn diagnostic(
        &self,
        code: &'static str,
        place: Node<'_>,
        message: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::error(code, message).in_file(self.file).on(
            &self.lines,
            place.at,
            place.text.len(),
        )
    }

    /// A warning at `place`.
    pub(super) fn warn(&self, code: &'static str, place: Node<'_>, message: &str) {
        let error = self.diagnostic(code, place, message);
        self.report(Diagnostic {
            severity: Severity::Warning,
            ..error
        });
    }

    /// Line of a place, from 1.
    pub(super) fn line(&self, place: Node<'_>) -> usize {
        self.lines.number(place.at)
    }

    /// The name among `known` that `found` was probably meant to be; after very many wrong names, none.
    pub(super) fn meant<'n>(
        &self,
        found: &str,
        known: impl ExactSizeIterator<Item = &'n str>,
    ) -> Option<&'n str> {
        let left = self.comparisons.get().checked_sub(known.len())?;
        self.comparisons.set(left);
        suggest(found, known)
    }

    /// Everything found, in the order of the text; what has no place comes last.
    pub(super) fn into_found(self) -> Vec<Diagnostic> {
        let mut found = self.found.into_inner();
        found.sort_by_key(|d| {
            d.span
                .as_ref()
                .map_or((u32::MAX, 0), |s| (s.line, s.column))
        });
        found
    }

    /// Unwraps a layer, or reports that `name` must be `wanted`.
    pub(super) fn layer<T>(
        &self,
        node: Node<'a>,
        layer: Result<T, LayerError>,
        name: &str,
        wanted: &str,
    ) -> Option<T> {
        match layer {
            Ok(parts) => Some(parts),
            Err(LayerError::OtherKind) => self.wrong_type(node, name, wanted),
            Err(LayerError::Syntax(error, at)) => {
                self.report(syntax::diagnostic(&error, at, self.source, self.file));
                None
            }
        }
    }

    /// Reports that `name` must be `wanted`.
    pub(super) fn wrong_type<T>(&self, node: Node<'_>, name: &str, wanted: &str) -> Option<T> {
        let place = if node.head().0.is_some() {
            node.head_place()
        } else {
            node
        };
        self.error(
            codes::WRONG_TYPE,
            place,
            format!("{name} must be {wanted}, found {}", node.kind()),
        );
        None
    }

    /// Splits a variant into its name, one of `known`, and what follows it.
    pub(super) fn variant(
        &self,
        node: Node<'a>,
        name: &str,
        known: &[&'static str],
    ) -> Option<(&'static str, Node<'a>)> {
        let (Some(found), body) = node.head() else {
            return self.wrong_type(node, name, &format!("one of {}", known.join(", ")));
        };
        if let Some(&variant) = known.iter().find(|&&k| k == found) {
            return Some((variant, body));
        }
        self.error_hint(
            codes::UNKNOWN_VARIANT,
            node.head_place(),
            format!("{name} cannot be `{found}`"),
            self.meant(found, known.iter().copied()).map_or_else(
                || format!("it is one of {}", known.join(", ")),
                |best| format!("did you mean `{best}`?"),
            ),
        );
        None
    }

    /// Reports what follows a variant that has no fields.
    pub(super) fn no_fields(&self, body: Node<'a>, variant: &str) -> Option<()> {
        let empty = self.layer(
            body,
            body.fields(),
            &format!("`{variant}`"),
            "without values",
        )?;
        match empty.first() {
            None => Some(()),
            Some(pair) => {
                self.error(
                    codes::UNKNOWN_FIELD,
                    pair.key,
                    format!("`{variant}` has no fields"),
                );
                None
            }
        }
    }
}

/// The fields of a struct or of a variant, all known and none given twice.
pub(super) struct Fields<'r, 'a> {
    pub(super) reader: &'r Reader<'a>,
    node: Node<'a>,
    what: &'static str,
    pairs: Vec<Pair<'a>>,
    /// Known fields that an unknown one was probably meant to be; that they are missing goes without saying.
    misspelt: Vec<&'static str>,
}

impl<'r, 'a> Fields<'r, 'a> {
    /// The fields of `node`, which `what` names in messages: "`Glass`", "an entity".
    pub(super) fn read(
        reader: &'r Reader<'a>,
        node: Node<'a>,
        what: &'static str,
        known: &[&'static str],
    ) -> Option<Fields<'r, 'a>> {
        let wanted = format!("written with named fields ({})", known.join(", "));
        let pairs = reader.layer(node, node.fields(), what, &wanted)?;
        let mut misspelt = Vec::new();
        let mut kept: Vec<Pair<'a>> = Vec::with_capacity(pairs.len());
        for pair in pairs {
            let key = pair.key.text;
            if !known.contains(&key) {
                let meant = reader.meant(key, known.iter().copied());
                misspelt.extend(meant);
                let hint = meant.map_or_else(
                    || format!("its fields are {}", known.join(", ")),
                    |best| format!("did you mean `{best}`?"),
                );
                reader.error_hint(
                    codes::UNKNOWN_FIELD,
                    pair.key,
                    format!("{what} has no field `{key}`"),
                    hint,
                );
            } else if let Some(first) = kept.iter().find(|p| p.key.text == key) {
                let line = reader.line(first.key);
                reader.error_hint(
                    codes::DUPLICATE_FIELD,
                    pair.key,
                    format!("`{key}` is given twice"),
                    format!("the first one is in line {line}"),
                );
            } else {
                kept.push(pair);
            }
        }
        Some(Fields {
            reader,
            node,
            what,
            pairs: kept,
            misspelt,
        })
    }

    /// The value of a field that is there and not `None`; `Some` around it is taken off.
    pub(super) fn get(&self, name: &str) -> Option<Node<'a>> {
        let pair = self.pairs.iter().find(|p| p.key.text == name)?;
        pair.value.given()
    }

    /// The name of a field that is there, for a place.
    pub(super) fn key(&self, name: &str) -> Option<Node<'a>> {
        self.get(name)?;
        self.pairs.iter().map(|p| p.key).find(|k| k.text == name)
    }

    /// Reads a field if it is there.
    pub(super) fn read_if<T>(
        &self,
        name: &str,
        read: impl FnOnce(&Reader<'a>, Node<'a>) -> Option<T>,
    ) -> Option<T> {
        read(self.reader, self.get(name)?)
    }

    /// Reads a field, or takes its default.
    pub(super) fn read_or<T>(
        &self,
        name: &str,
        default: T,
        read: impl FnOnce(&Reader<'a>, Node<'a>) -> Option<T>,
    ) -> T {
        self.read_if(name, read).unwrap_or(default)
    }

    /// Reads a field that has no default.
    pub(super) fn require<T>(
        &self,
        name: &str,
        read: impl FnOnce(&Reader<'a>, Node<'a>) -> Option<T>,
    ) -> Option<T> {
        if let Some(node) = self.get(name) {
            return read(self.reader, node);
        }
        if !self.misspelt.contains(&name) {
            let message = format!("{} needs `{name}`", self.what);
            self.reader
                .error(codes::MISSING_FIELD, self.place(), message);
        }
        None
    }

    /// Where the fields stand; behind a bare variant, its last letter.
    fn place(&self) -> Node<'a> {
        let at = self.node.at - usize::from(self.node.text.is_empty() && self.node.at > 0);
        Node { at, ..self.node }
    }
}

/// The name among `known` that `found` was probably meant to be.
fn suggest<'n>(found: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    /// One slip per so many letters is still taken for the same word.
    const LETTERS_PER_SLIP: usize = 3;
    /// So many letters that begin a name are taken for it.
    const LETTERS_OF_STEM: usize = 3;
    let lower = found.to_lowercase();
    let letters = lower.chars().count();
    let slips = (letters / LETTERS_PER_SLIP).max(1);
    let distance = |name: &str| {
        let name = name.to_lowercase();
        let begins = letters >= LETTERS_OF_STEM && name.starts_with(&lower);
        if begins {
            slips
        } else {
            strsim::osa_distance(&lower, &name)
        }
    };
    known
        .into_iter()
        .map(|name| (distance(name), name))
        .filter(|&(distance, _)| distance <= slips)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, name)| name)
}
