//! `luxel check`.

use super::args::InspectArgs;
use super::failure::Failure;
use super::{diagnostics, load, print_result, say};

/// Prints every diagnostic of a scene and of the files that it names.
pub(crate) fn run(args: &InspectArgs) -> Result<(), Failure> {
    let checked = load::scene(&args.scene);
    if args.json {
        let found = match &checked {
            Ok((_, warnings)) => Some(warnings.as_slice()),
            Err(failure) => failure.diagnostics(),
        };
        if let Some(found) = found {
            let json = diagnostics::json(found);
            print_result(format!("{json:#}\n").as_bytes())?;
            return checked.map(drop).map_err(Failure::said);
        }
    }
    let (_, warnings) = checked?;
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(&warnings);
    let count = match warnings.len() {
        0 => "no warnings".to_owned(),
        1 => "1 warning".to_owned(),
        n => format!("{n} warnings"),
    };
    say(&format!("{}: no errors, {count}", args.scene.display()));
    Ok(())
}
