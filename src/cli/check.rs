//! `luxel check`: a scene with its files, or a mesh file by itself.

use super::args::CheckArgs;
use super::contents::Contents;
use super::failure::Failure;
use super::{diagnostics, load, print_result, say};
use crate::check::{all_codes, check_mesh};
use crate::diag::Diagnostic;
use serde_json::{Value, json};
use std::path::Path;

/// Prints every diagnostic of a scene and of the files that it names, or of a mesh file.
pub(crate) fn run(args: &CheckArgs) -> Result<(), Failure> {
    let Some(path) = args.file.as_deref() else {
        return print_codes(args.json);
    };
    let (contents, checked) = if is_mesh(path) {
        match mesh_file(path, args.max_memory) {
            Ok((contents, warnings)) => (Some(contents), Ok(warnings)),
            Err(failure) => (None, Err(failure)),
        }
    } else {
        (
            None,
            load::scene(path, args.max_memory).map(|(_, warnings)| warnings),
        )
    };
    if args.json {
        return answer(args, contents.as_ref(), checked);
    }
    let warnings = checked?;
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(&warnings);
    if let Some(contents) = contents {
        print_result(format!("{}: {contents}\n", path.display()).as_bytes())?;
    }
    let count = diagnostics::summary(&warnings).unwrap_or_else(|| "no warnings".to_owned());
    say(&format!("{}: no errors, {count}", path.display()));
    strictly(args, &warnings)
}

/// The same as JSON on stdout.
fn answer(
    args: &CheckArgs,
    contents: Option<&Contents>,
    checked: Result<Vec<Diagnostic>, Failure>,
) -> Result<(), Failure> {
    let found = match &checked {
        Ok(warnings) => Some(warnings.as_slice()),
        Err(failure) => failure.diagnostics(),
    };
    let Some(found) = found else {
        return checked.map(drop);
    };
    let mut json = diagnostics::json(found);
    if let (Some(contents), Some(object)) = (contents, json.as_object_mut()) {
        object.insert("contents".to_owned(), contents.json());
    }
    print_result(format!("{json:#}\n").as_bytes())?;
    let warnings = checked.map_err(Failure::said)?;
    strictly(args, &warnings).map_err(Failure::said)
}

fn strictly(args: &CheckArgs, warnings: &[Diagnostic]) -> Result<(), Failure> {
    if args.strict {
        return Failure::if_any(warnings);
    }
    Ok(())
}

/// The table of codes.
fn print_codes(as_json: bool) -> Result<(), Failure> {
    let text = if as_json {
        let object = |(code, meaning)| json!({"code": code, "meaning": meaning});
        let codes: Vec<Value> = all_codes().map(object).collect();
        format!("{:#}\n", Value::from(codes))
    } else {
        let line = |(code, meaning)| format!("{code}  {meaning}\n");
        all_codes().map(line).collect()
    };
    print_result(text.as_bytes())
}

/// Whether a path names a mesh file by its suffix.
fn is_mesh(path: &Path) -> bool {
    let suffix = path.extension().and_then(|s| s.to_str());
    suffix.is_some_and(|s| {
        ["obj", "gltf", "glb"]
            .iter()
            .any(|m| s.eq_ignore_ascii_case(m))
    })
}

/// Reads a mesh file with all that it names.
fn mesh_file(path: &Path, max_memory: u64) -> Result<(Contents, Vec<Diagnostic>), Failure> {
    if let Err(e) = std::fs::metadata(path) {
        return Err(Failure::no_input(path, &e));
    }
    let (mut loader, _patience) = load::loader(max_memory);
    let is_obj = path
        .extension()
        .is_some_and(|s| s.eq_ignore_ascii_case("obj"));
    let loaded = match is_obj {
        true => loader.mesh(path).map(|_| None),
        false => loader.model(path).map(Some),
    };
    let mut found = loader.warnings().to_vec();
    let store = loader.finish();
    found.extend(store.meshes.iter().filter_map(|mesh| check_mesh(mesh)));
    match loaded {
        Ok(model) => Ok((Contents::of(&store, model), found)),
        Err(mut errors) => {
            errors.extend(found);
            Err(Failure::scene(errors))
        }
    }
}
