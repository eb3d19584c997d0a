//! The command line: arguments, progress, printing, exit codes. Only the binary calls it.
//!
//! Results go to stdout (the path written, JSON), talk goes to stderr. Deliberately absent: anything that decides what
//! a picture looks like.

mod advice;
mod animate;
mod animate_args;
mod args;
mod author_args;
mod bench;
mod bench_args;
mod check;
mod compare;
mod contents;
mod convert;
pub mod diagnostics;
mod dial_args;
mod explain;
mod failure;
mod farm;
mod finish;
mod frame_list;
mod frames;
mod goal_args;
mod info;
mod interrupt;
mod load;
mod merge;
mod merge_args;
mod names;
mod output;
mod part;
mod part_args;
mod patience;
mod progress;
mod render;
mod replay;
mod replay_args;
mod sequence;
mod share;
mod stability;
mod stability_args;
mod start;
mod stats;
mod threads;
mod tracing;
mod tune;
mod tune_args;
mod tuned;
mod turntable;
mod versus;
mod video;
mod writer;

use crate::math::pages;
use args::{Cli, Command};
use clap::Parser;
use failure::{Failure, code};
use std::io::Write;
use std::process::ExitCode;

/// Parses the arguments of the process and does what they say.
#[must_use]
pub fn run() -> ExitCode {
    install_panic_hook();
    pages::give_back_what_is_freed();
    // Usage errors, help and version leave here: 2, 0, 0.
    let cli = Cli::parse();
    threads::allot(cli.command.threads());
    let done = match &cli.command {
        Command::Render(args) => render::run(args),
        Command::Animate(args) => animate::run(args),
        Command::Turntable(args) => turntable::run(args),
        Command::Convert(args) => convert::run(args),
        Command::Check(args) => check::run(args),
        Command::Explain(args) => explain::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Bench(args) => bench::run(args),
        Command::Stability(args) => stability::run(args),
        Command::Tune(args) => tune::run(args),
        Command::Merge(args) => merge::run(args),
        Command::Info(args) => info::run(args),
        Command::Farm(args) => farm::run(args),
    };
    match done {
        Ok(()) => ExitCode::from(code::DONE),
        Err(failure) => {
            failure.print();
            ExitCode::from(failure.code)
        }
    }
}

/// Writes to stdout. A reader that has left is no error: it has what it wanted.
fn print_result(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::io("stdout", &e)),
        _ => Ok(()),
    }
}

/// Writes a line of talk to stderr; if nobody listens, so be it.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// A panic is a bug of luxel, never of its user: say so, and where, and leave at once with the code that says the same.
fn install_panic_hook() {
    std::panic::set_hook(Box::new(|info| {
        say("");
        say(&format!("luxel: this is a bug in luxel: {info}"));
        say(
            "Please report it with the scene and this command line; the output file was not written.",
        );
        std::process::exit(i32::from(code::BUG));
    }));
}
