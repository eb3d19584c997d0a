//! The `luxel` command. Everything it does is in the library.

fn main() -> std::process::ExitCode {
    luxel::cli::run()
}
