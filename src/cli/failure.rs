//! Why a command ended without its result, and the exit code that says so to scripts.

use super::{diagnostics, say};
use crate::diag::Diagnostic;
use std::fmt;
use std::path::Path;

/// Exit codes, after BSD's `sysexits.h`.
pub(crate) mod code {
    /// Done.
    pub(crate) const DONE: u8 = 0;
    /// Images differ by more than was allowed, or one holds values that are not finite.
    pub(crate) const DIFFERENT: u8 = 1;
    /// The command line is wrong.
    pub(crate) const USAGE: u8 = 2;
    /// The scene, or a file that it names, is wrong or missing; an image is none.
    pub(crate) const DATA: u8 = 65;
    /// A file named on the command line is missing.
    pub(crate) const NO_INPUT: u8 = 66;
    /// A bug in luxel.
    pub(crate) const BUG: u8 = 70;
    /// Input or output failed.
    pub(crate) const IO: u8 = 74;
    /// Stopped by a signal, with work saved that the same line goes on from (BSD: "try again later").
    pub(crate) const RESUMABLE: u8 = 75;
    /// Stopped by a signal.
    pub(crate) const STOPPED: u8 = 130;
}

/// What went wrong.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The exit code.
    pub(crate) code: u8,
    what: What,
}

#[derive(Debug)]
enum What {
    /// Message, and what to do about it.
    Message(String, Option<String>),
    /// Everything that is wrong with the scene.
    Diagnostics(Vec<Diagnostic>),
    /// It has been said already.
    Said,
}

impl Failure {
    /// The command line cannot be obeyed.
    pub(crate) fn usage(message: impl fmt::Display, hint: &str) -> Failure {
        Failure {
            code: code::USAGE,
            what: What::Message(message.to_string(), Some(hint.to_owned())),
        }
    }

    /// A file named on the command line cannot be read.
    pub(crate) fn no_input(path: &Path, cause: &dyn fmt::Display) -> Failure {
        Failure {
            code: code::NO_INPUT,
            what: What::Message(format!("cannot read \"{}\": {cause}", path.display()), None),
        }
    }

    /// `-q`, and the scene was not tuned.
    pub(crate) fn untuned(
        quality: &str,
        file: &Path,
        scene: &Path,
        cause: &dyn fmt::Display,
    ) -> Failure {
        let message = format!(
            "what {quality} means stands in \"{}\", which cannot be read: {cause}",
            file.display()
        );
        let hint = format!(
            "measure it first, in a minute: luxel tune {}",
            scene.display()
        );
        Failure {
            code: code::NO_INPUT,
            what: What::Message(message, Some(hint)),
        }
    }

    /// The scene is wrong.
    pub(crate) fn scene(diagnostics: Vec<Diagnostic>) -> Failure {
        Failure {
            code: code::DATA,
            what: What::Diagnostics(diagnostics),
        }
    }

    /// `--strict`: warnings count as errors.
    pub(crate) fn if_any(warnings: &[Diagnostic]) -> Result<(), Failure> {
        if warnings.is_empty() {
            return Ok(());
        }
        Err(Failure {
            code: code::DATA,
            what: What::Message("--strict allows no warnings".to_owned(), None),
        })
    }

    /// `--strict`: samples that are not finite count as an error.
    pub(crate) fn lost_samples(lost: impl fmt::Display, hint: &str) -> Failure {
        Failure {
            code: code::DATA,
            what: What::Message(
                format!("--strict allows no samples that are not finite: {lost}"),
                Some(hint.to_owned()),
            ),
        }
    }

    /// A file named on the command line is there, but its content cannot be used. The message names the file.
    pub(crate) fn bad_file(message: impl fmt::Display) -> Failure {
        Failure {
            code: code::DATA,
            what: What::Message(message.to_string(), None),
        }
    }

    /// A part film cannot be used.
    pub(crate) fn bad_part(path: &Path, cause: &dyn fmt::Display, hint: &str) -> Failure {
        Failure {
            code: code::DATA,
            what: What::Message(
                format!("\"{}\" cannot be used: {cause}", path.display()),
                Some(hint.to_owned()),
            ),
        }
    }

    /// Images are not as equal as was asked.
    pub(crate) fn different(message: impl fmt::Display) -> Failure {
        Failure {
            code: code::DIFFERENT,
            what: What::Message(message.to_string(), None),
        }
    }

    /// A scene goes wrong somewhere, which has been said.
    pub(crate) fn unstable() -> Failure {
        Failure {
            code: code::DIFFERENT,
            what: What::Said,
        }
    }

    /// Reading or writing failed.
    pub(crate) fn io(what: impl fmt::Display, cause: &dyn fmt::Display) -> Failure {
        Failure {
            code: code::IO,
            what: What::Message(format!("cannot write {what}: {cause}"), None),
        }
    }

    /// The system gives no threads.
    pub(crate) fn threads(cause: &dyn fmt::Display) -> Failure {
        Failure {
            code: code::IO,
            what: What::Message(
                format!("cannot start the worker threads: {cause}"),
                Some("ask for fewer: --threads 1".to_owned()),
            ),
        }
    }

    /// Stopped by a signal; the same line goes on.
    pub(crate) fn resumable() -> Failure {
        Failure {
            code: code::RESUMABLE,
            what: What::Said,
        }
    }

    /// Stopped by a signal.
    pub(crate) fn stopped() -> Failure {
        Failure {
            code: code::STOPPED,
            what: What::Said,
        }
    }

    /// The diagnostics, if it is a scene that is wrong.
    pub(crate) fn diagnostics(&self) -> Option<&[Diagnostic]> {
        match &self.what {
            What::Diagnostics(all) => Some(all),
            _ => None,
        }
    }

    /// The same, but what is wrong is that the file is missing.
    pub(crate) fn missing(self) -> Failure {
        Failure {
            code: code::NO_INPUT,
            ..self
        }
    }

    /// The same end, but everything has been said.
    pub(crate) fn said(self) -> Failure {
        Failure {
            what: What::Said,
            ..self
        }
    }

    /// Says it on stderr.
    pub(crate) fn print(&self) {
        match &self.what {
            What::Message(message, hint) => {
                say(&format!("error: {message}"));
                if let Some(hint) = hint {
                    say(&format!("  = help: {hint}"));
                }
            }
            // If nobody listens, so be it.
            What::Diagnostics(all) => drop(diagnostics::print(all)),
            What::Said => {}
        }
    }
}
