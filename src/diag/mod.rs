//! Diagnostics: **data only**. Filled by scene, asset, world and check; printed by the command line.
//!
//! Deliberately absent: printing, colours, exit codes.

pub mod codes;
mod lines;

pub use lines::{Lines, Span};

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

    /// Adds the place of the byte range `at..at + len` of a text whose lines are known.
    #[must_use]
    pub fn on(mut self, lines: &Lines<'_>, at: usize, len: usize) -> Diagnostic {
        self.span = Some(lines.span(at, len));
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
