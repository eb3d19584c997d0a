//! Diagnostics for people (the line itself, marked) and for programs (JSON).
//!
//! Deliberately absent: where they come from, exit codes.

use crate::diag::{Diagnostic, Severity};
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use serde_json::{Value, json};
use std::io::{self, IsTerminal, Write};

/// Whether the text is coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// No escape sequence at all.
    Plain,
    /// ANSI colours.
    Coloured,
}

impl Style {
    /// Colours on a terminal only, and not where `NO_COLOR` is set to something (<https://no-color.org>) or `TERM` is
    /// `dumb`.
    #[must_use]
    pub fn for_stream(stream: &impl IsTerminal) -> Style {
        let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|v| v == "dumb");
        if stream.is_terminal() && !refused && !dumb {
            Style::Coloured
        } else {
            Style::Plain
        }
    }
}

/// The diagnostics as text, one block each, an empty line between two.
#[must_use]
pub fn render(diagnostics: &[Diagnostic], style: Style) -> String {
    let renderer = match style {
        Style::Plain => Renderer::plain(),
        Style::Coloured => Renderer::styled(),
    };
    let blocks: Vec<String> = diagnostics
        .iter()
        .map(|d| renderer.render(&[group(d)]))
        .collect();
    let mut text = blocks.join("\n\n");
    if !text.is_empty() {
        text.push('\n');
    }
    text
}

/// Writes the diagnostics and their count to standard error.
///
/// # Errors
/// Those of writing.
pub fn print(diagnostics: &[Diagnostic]) -> io::Result<()> {
    let mut stream = io::stderr().lock();
    stream.write_all(render(diagnostics, Style::for_stream(&stream)).as_bytes())?;
    match summary(diagnostics) {
        Some(summary) => writeln!(stream, "\n{summary}"),
        None => Ok(()),
    }
}

/// `2 errors, 1 warning`; `None` where there is nothing.
#[must_use]
pub fn summary(diagnostics: &[Diagnostic]) -> Option<String> {
    let count = |severity, name: &str| {
        let n = diagnostics
            .iter()
            .filter(|d| d.severity == severity)
            .count();
        let plural = if n == 1 { "" } else { "s" };
        (n > 0).then(|| format!("{n} {name}{plural}"))
    };
    let parts: Vec<String> = [
        count(Severity::Error, "error"),
        count(Severity::Warning, "warning"),
    ]
    .into_iter()
    .flatten()
    .collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// The diagnostics as a JSON array of objects with `severity`, `code`, `message`, `file`, `line`, `column`, `length`,
/// `text`, `pointer` and `hint`; what is not known is null. Columns and lengths count characters, from 1; a pointer is
/// a JSON pointer (RFC 6901) into a glTF file.
#[must_use]
pub fn json(diagnostics: &[Diagnostic]) -> Value {
    let object = |d: &Diagnostic| {
        let span = d.span.as_ref();
        json!({
            "severity": match d.severity { Severity::Error => "error", Severity::Warning => "warning" },
            "code": d.code,
            "message": d.message,
            "file": d.file.as_ref().map(|f| f.to_string_lossy()),
            "line": span.map(|s| s.line),
            "column": span.map(|s| s.column),
            "length": span.map(|s| s.len),
            "text": span.map(|s| &s.text),
            "pointer": d.pointer,
            "hint": d.hint,
        })
    };
    diagnostics.iter().map(object).collect()
}

/// A message with its middle left out where it repeats something endless from the input.
fn clipped(message: &str) -> String {
    /// Characters kept at either end: more than any message has of its own.
    const KEPT: usize = 200;
    let count = message.chars().count();
    if count <= 2 * KEPT {
        return message.to_owned();
    }
    let start: String = message.chars().take(KEPT).collect();
    let end: String = message.chars().skip(count - KEPT).collect();
    format!("{start}...{end}")
}

fn group(diagnostic: &Diagnostic) -> Group<'_> {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let title = level
        .primary_title(clipped(&diagnostic.message))
        .id(diagnostic.code);
    let path = diagnostic.file.as_ref().map(|file| {
        let pointer = diagnostic.pointer.as_ref();
        let place = pointer.map_or(String::new(), |pointer| format!("#{pointer}"));
        file.to_string_lossy().into_owned() + &place
    });
    if let Some(span) = &diagnostic.span {
        let byte = |chars: u32| {
            let end = span.text.len();
            span.text
                .char_indices()
                .nth(chars as usize)
                .map_or(end, |(at, _)| at)
        };
        let start = span.column.saturating_sub(1);
        let marked = byte(start)..byte(start.saturating_add(span.len));
        let mark = AnnotationKind::Primary
            .span(marked)
            .label(diagnostic.hint.as_deref());
        return title.element(
            Snippet::source(span.text.as_str())
                .line_start(span.line as usize)
                .path(path)
                .annotation(mark),
        );
    }
    let group = Group::with_title(title).elements(path.map(Origin::path));
    group.elements(
        diagnostic
            .hint
            .as_deref()
            .map(|hint| Level::HELP.message(hint)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Vec<Diagnostic> {
        let source = "one\n  two é three\n";
        vec![
            Diagnostic::error("E012", "there is no é")
                .in_file("a.ron")
                .at(source, 10, 2)
                .hint("did you mean e?"),
            Diagnostic::warning("W001", "nothing shines")
                .in_file("a.ron")
                .hint("add a light"),
            Diagnostic::error("E900", "alone"),
            Diagnostic::error("E128", "no such node: 7")
                .in_file("box.gltf")
                .pointer("/nodes/3/children/0")
                .hint("there are 4"),
        ]
    }

    #[test]
    fn text_marks_the_place_in_its_line() {
        let wanted = "\
error[E012]: there is no é
 --> a.ron:2:7
  |
2 |   two é three
  |       ^ did you mean e?

warning[W001]: nothing shines
--> a.ron
 = help: add a light

error[E900]: alone

error[E128]: no such node: 7
--> box.gltf#/nodes/3/children/0
 = help: there are 4
";
        assert_eq!(render(&sample(), Style::Plain), wanted);
        assert!(render(&sample(), Style::Coloured).contains('\u{1b}'));
        assert_eq!(render(&[], Style::Plain), "");
    }

    #[test]
    fn endless_names_do_not_drown_the_message() {
        let message = format!("there is no material {:?}", "x".repeat(100_000));
        let text = render(&[Diagnostic::error("E012", message)], Style::Plain);
        assert!(text.starts_with("error[E012]: there is no material \"xxx"));
        assert!(text.contains("x...x") && text.ends_with("x\"\n") && text.len() < 450);
    }

    #[test]
    fn counts_are_in_the_right_number() {
        assert_eq!(summary(&sample()).as_deref(), Some("3 errors, 1 warning"));
        assert_eq!(summary(&[]), None);
    }

    #[test]
    fn json_says_the_same() {
        let array = json(&sample());
        assert_eq!(array[0]["line"], 2);
        assert_eq!(array[0]["column"], 7);
        assert_eq!(array[0]["length"], 1);
        assert_eq!(array[0]["text"], "  two é three");
        assert_eq!(array[1]["severity"], "warning");
        assert!(array[1]["line"].is_null() && array[2]["file"].is_null());
        assert!(array[2]["pointer"].is_null());
        assert_eq!(array[3]["pointer"], "/nodes/3/children/0");
        assert_eq!(
            sample()[3].to_string(),
            "error[E128]: box.gltf#/nodes/3/children/0: no such node: 7 (there are 4)"
        );
    }
}
