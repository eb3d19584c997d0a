//! Diagnostics: **data only**. Filled by scene, asset, world and check; printed by the command line.
//!
//! Deliberately absent: printing, colours, exit codes.

pub mod codes;

use std::fmt;
use std::path::PathBuf;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene renders, but probably not as meant.
    Warning,
    /// The scene cannot be rendered.
    Error,
}

/// A place in a text file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Span {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// Length in characters, at least 1; a span ends with its line.
    pub len: u32,
    /// The line itself, without its line end.
    pub text: String,
}

/// One thing to say about an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// Stable code, `E012` or `W004`.
    pub code: &'static str,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// The file it is in.
    pub file: Option<PathBuf>,
    /// The place in that file.
    pub span: Option<Span>,
    /// The place in a JSON file as a pointer (RFC 6901): `/meshes/0/primitives/1`; empty for the whole of it.
    pub pointer: Option<String>,
    /// What to do about it, e.g. `did you mean "gold"?`.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// An error without a place.
    pub fn error(code: &'static str, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Error,
            code,
            message: message.into(),
            file: None,
            span: None,
            pointer: None,
            hint: None,
        }
    }

    /// A warning without a place.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Warning,
            ..Diagnostic::error(code, message)
        }
    }

    /// Adds the file.
    #[must_use]
    pub fn in_file(mut self, file: impl Into<PathBuf>) -> Diagnostic {
        self.file = Some(file.into());
        self
    }

    /// Adds the place of the byte range `at..at + len` of `source`.
    #[must_use]
    pub fn at(mut self, source: &str, at: usize, len: usize) -> Diagnostic {
        self.span = Some(Span::of_bytes(source, at, len));
        self
    }

    /// Adds the place in a JSON file as a pointer.
    #[must_use]
    pub fn pointer(mut self, pointer: impl Into<String>) -> Diagnostic {
        self.pointer = Some(pointer.into());
        self
    }

    /// Adds what to do about it.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Diagnostic {
        self.hint = Some(hint.into());
        self
    }
}

impl Span {
    /// The place of the bytes `at..at + len` of `source`, cut at the end of the line that it starts in.
    #[must_use]
    pub fn of_bytes(source: &str, at: usize, len: usize) -> Span {
        let at = floor_boundary(source, at);
        let start = source[..at].rfind('\n').map_or(0, |i| i + 1);
        let end = source[at..].find('\n').map_or(source.len(), |i| at + i);
        let text = source[start..end].trim_end_matches('\r').to_owned();
        let stop = floor_boundary(source, (at + len).min(end));
        let count = |s: &str| u32::try_from(s.chars().count()).unwrap_or(u32::MAX);
        let line = u32::try_from(source[..start].matches('\n').count() + 1).unwrap_or(u32::MAX);
        let column = count(&source[start..at]).saturating_add(1);
        Span {
            line,
            column,
            len: count(&source[at..stop.max(at)]).max(1),
            text,
        }
    }
}

fn floor_boundary(s: &str, i: usize) -> usize {
    let mut i = i.min(s.len());
    while !s.is_char_boundary(i) {
        i -= 1;
    }
    i
}

impl fmt::Display for Diagnostic {
    /// `error[E001]: scene.ron:4:12: message (hint)` on one line; `box.gltf#/nodes/3: message` with a pointer.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{name}[{}]: ", self.code)?;
        if let Some(file) = &self.file {
            write!(f, "{}", file.display())?;
            if let Some(pointer) = &self.pointer {
                write!(f, "#{pointer}")?;
            }
            write!(f, ":")?;
            if let Some(span) = &self.span {
                write!(f, "{}:{}:", span.line, span.column)?;
            }
            write!(f, " ")?;
        }
        write!(f, "{}", self.message)?;
        match &self.hint {
            Some(hint) => write!(f, " ({hint})"),
            None => Ok(()),
        }
    }
}
