//! The `luxel` command: arguments in, pictures and words out. Everything it does is a call of the library.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
