//! What `ron` says about text that is not RON, in the words of someone who writes scenes.

use crate::diag::{Diagnostic, codes};
use ron::Error;
use std::path::Path;

/// The error at byte `at` of the source.
pub(super) fn diagnostic(error: &Error, at: usize, source: &str, file: &Path) -> Diagnostic {
    let written = source.trim_end().len();
    if written == 0 {
        return Diagnostic::error(codes::SYNTAX, "the file is empty").in_file(file);
    }
    let at = match error {
        // The cursor is behind the quote.
        Error::ExpectedStringEnd if at > 0 => at - 1,
        // At the end of the file the last thing written is the best place to point at.
        _ => at.min(written - 1),
    };
    let found = Diagnostic::error(codes::SYNTAX, message(error))
        .in_file(file)
        .at(source, at, 1);
    match hint(error) {
        Some(hint) => found.hint(hint),
        None => found,
    }
}

fn message(error: &Error) -> String {
    let text = match error {
        Error::Eof => "the file ends before the scene does",
        Error::ExpectedArray => "expected `[`",
        Error::ExpectedArrayEnd => "expected `,` or `]`",
        Error::ExpectedComma => "expected `,`",
        Error::ExpectedMap => "expected `{`",
        Error::ExpectedMapColon => "expected `:`",
        Error::ExpectedMapEnd => "expected `,` or `}`",
        Error::ExpectedOptionEnd | Error::ExpectedStructLikeEnd => "expected `,` or `)`",
        Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) => "expected `(`",
        Error::ExpectedString => "expected a string in double quotes",
        Error::ExpectedStringEnd => "this string is not closed",
        Error::ExpectedIdentifier => "expected a name",
        Error::ExpectedFloat | Error::ExpectedInteger => "expected a number",
        Error::UnclosedBlockComment => "a comment /* .. */ is not closed",
        Error::TrailingCharacters => "there is text after the end of the scene",
        Error::ExceededRecursionLimit => "the brackets are nested too deeply",
        Error::UnexpectedChar(c) => return format!("unexpected {c:?}"),
        Error::InvalidIdentifier(name) => return format!("{name:?} is not a name"),
        Error::SuggestRawIdentifier(name) => return format!("{name:?} is not a name"),
        Error::InvalidEscape(what) => return format!("a bad escape in a string: {what}"),
        Error::NoSuchExtension(name) => return format!("there is no RON extension `{name}`"),
        Error::ExpectedAttribute | Error::ExpectedAttributeEnd => "expected `#![enable(..)]`",
        _ => "this is not a value",
    };
    text.to_owned()
}

fn hint(error: &Error) -> Option<&'static str> {
    match error {
        Error::Eof => Some("a bracket or a string is not closed"),
        Error::ExpectedStructLikeEnd | Error::ExpectedComma => {
            Some("is a comma missing before this?")
        }
        Error::ExpectedIdentifier => Some("is a bracket not closed before this?"),
        Error::ExpectedArrayEnd | Error::ExpectedMapEnd => Some("is a comma missing before this?"),
        _ => None,
    }
}
