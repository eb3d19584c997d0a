//! Diagnostics for people (the line itself, marked) and for programs (JSON).
//!
//! Deliberately absent: where they come from, exit codes.

use crate::diag::{Diagnostic, Severity};
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::{self, IsTerminal, Write};
use std::path::Path;

/// Bytes of the longest line that is shown with its diagnostic: some scenes are written by programs, in one line.
const MAX_SHOWN: usize = 1000;

/// So many of one code in one file are shown; the others are counted.
const MAX_OF_A_KIND: usize = 20;

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
    let mut left = tally(diagnostics);
    let blocks: Vec<String> = diagnostics
        .iter()
        .filter_map(|d| {
            let (shown, all) = left.get_mut(&kind(d))?;
            *shown += 1;
            match *shown {
                shown if shown < MAX_OF_A_KIND || shown == *all => {
                    (shown <= MAX_OF_A_KIND).then(|| renderer.render(&[group(d)]))
                }
                MAX_OF_A_KIND => {
                    let more = *all - MAX_OF_A_KIND;
                    Some(format!(
                        "{}\n\n{}",
                        renderer.render(&[group(d)]),
                        and_more(d, more)
                    ))
                }
                _ => None,
            }
        })
        .collect();
    let mut text = blocks.join("\n\n");
    if !text.is_empty() {
        text.push('\n');
    }
    text
}

/// Diagnostics of one code in one file.
type Kind<'a> = (&'static str, Option<&'a Path>);

fn kind(diagnostic: &Diagnostic) -> Kind<'_> {
    (diagnostic.code, diagnostic.file.as_deref())
}

/// None shown yet, and how many there are, of each kind.
fn tally(diagnostics: &[Diagnostic]) -> HashMap<Kind<'_>, (usize, usize)> {
    let mut tally = HashMap::new();
    for diagnostic in diagnostics {
        tally.entry(kind(diagnostic)).or_insert((0, 0)).1 += 1;
    }
    tally
}

fn and_more(diagnostic: &Diagnostic, more: usize) -> String {
    let file = diagnostic.file.as_ref();
    let place = file.map_or(String::new(), |file| format!(" in {}", file.display()));
    format!(
        "... and {} more of {}{place} (`luxel check --json` lists them all)",
        grouped(more),
        diagnostic.code
    )
}

/// A count with commas between its thousands.
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let comma = |i: usize| i > 0 && (digits.len() - i).is_multiple_of(3);
    let grouped = digits.chars().enumerate().map(|(i, digit)| match comma(i) {
        true => format!(",{digit}"),
        false => digit.to_string(),
    });
    grouped.collect()
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

/// The diagnostics as a JSON object: the counts `errors` and `warnings`, and `diagnostics`, an array of objects with
/// `severity`, `code`, `message`, `file`, `line`, `column`, `length`, `text`, `pointer` and `hint`; what is not known is
/// null. Columns and lengths count characters, from 1; a pointer is a JSON pointer (RFC 6901) into a glTF file.
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
            "text": span.map(|s| &*s.text).filter(|text| text.len() <= MAX_SHOWN),
            "pointer": d.pointer,
            "hint": d.hint,
        })
    };
    let count = |severity| {
        diagnostics
            .iter()
            .filter(|d| d.severity == severity)
            .count()
    };
    json!({
        "errors": count(Severity::Error),
        "warnings": count(Severity::Warning),
        "diagnostics": diagnostics.iter().map(object).collect::<Vec<_>>(),
    })
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
        let place = match (&diagnostic.pointer, &diagnostic.span) {
            (Some(pointer), _) => format!("#{pointer}"),
            (None, Some(span)) if span.text.len() > MAX_SHOWN => {
                format!(":{}:{}", span.line, span.column)
            }
            _ => String::new(),
        };
        file.to_string_lossy().into_owned() + &place
    });
    if let Some(span) = diagnostic
        .span
        .as_ref()
        .filter(|s| s.text.len() <= MAX_SHOWN)
    {
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
            Snippet::source(&*span.text)
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
    fn many_of_one_code_are_counted() {
        let many = |n: usize, file: &str| {
            let one = Diagnostic::error("E012", "no").in_file(file);
            vec![one; n]
        };
        let shown = |text: &str| text.matches("error[E012]").count();
        let text = render(&[many(20, "a"), many(1, "b")].concat(), Style::Plain);
        assert_eq!((shown(&text), text.contains("more of")), (21, false));
        let text = render(&[many(20_000, "a"), many(3, "b")].concat(), Style::Plain);
        assert_eq!(shown(&text), 23);
        assert!(
            text.contains("\n\n... and 19,980 more of E012 in a ("),
            "{text}"
        );
        let all = json(&many(50, "a"));
        assert_eq!(all["diagnostics"].as_array().map(Vec::len), Some(50));
        assert_eq!(
            [1, 999, 1000, 1_234_567].map(grouped),
            ["1", "999", "1,000", "1,234,567"]
        );
    }

    #[test]
    fn a_line_without_end_is_not_shown() {
        let source = "x".repeat(2000);
        let one = Diagnostic::error("E012", "no")
            .in_file("a.ron")
            .at(&source, 1500, 1)
            .hint("yes");
        let wanted = "error[E012]: no\n--> a.ron:1:1501\n = help: yes\n";
        assert_eq!(render(std::slice::from_ref(&one), Style::Plain), wanted);
        assert!(json(&[one])["diagnostics"][0]["text"].is_null());
    }

    #[test]
    fn counts_are_in_the_right_number() {
        assert_eq!(summary(&sample()).as_deref(), Some("3 errors, 1 warning"));
        assert_eq!(summary(&[]), None);
    }

    #[test]
    fn json_says_the_same() {
        let object = json(&sample());
        assert_eq!(
            (&object["errors"], &object["warnings"]),
            (&3.into(), &1.into())
        );
        let array = &object["diagnostics"];
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
