//! The command line: arguments, progress, printing, exit codes.

pub mod diagnostics;
