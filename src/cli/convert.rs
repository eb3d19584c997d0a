//! `luxel convert`.

use super::author_args::ConvertArgs;
use super::failure::Failure;
use super::{diagnostics, print_result, say, start};
use crate::author;
use crate::scene;
use std::path::{Path, PathBuf};

/// Writes a scene that shows a mesh or a glTF file, to be edited.
pub(crate) fn run(args: &ConvertArgs) -> Result<(), Failure> {
    let place = match &args.output {
        Some(path) => path.clone(),
        None => {
            PathBuf::from(args.mesh.file_stem().unwrap_or_default()).with_added_extension("ron")
        }
    };
    start::check_scene(&place)?;
    let read = start::mesh(&args.mesh, args.max_memory)?;
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(read.loader.warnings());
    let path = start::path_from(&place, &args.mesh)?;
    let converted = match read.what {
        start::What::Mesh(id) => {
            let name = args.mesh.file_stem().unwrap_or_default().to_string_lossy();
            author::convert_mesh(read.loader.loaded(id), &read.points, &path, &name)
        }
        start::What::Model(id) => {
            let model = read.loader.loaded_model(id);
            author::convert_model(model, &read.loader, &read.points, &path)
        }
    };
    let text = header(&path, &converted.notes, &place) + &scene::write(&converted.desc);
    // What the reader would refuse is not written.
    scene::parse(&text, &place).map_err(Failure::scene)?;
    start::write_scene(&place, &text)?;
    print_result(format!("{}\n", place.display()).as_bytes())?;
    for note in &converted.notes {
        say(note);
    }
    let entities = converted.desc.entities.len();
    say(&format!(
        "{0} · {entities} entities · render it with: luxel render {0}",
        place.display()
    ));
    Ok(())
}

/// What a person should know who opens the scene.
fn header(path: &str, notes: &[String], place: &Path) -> String {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    let mut lines = vec![format!(
        "{path} as a scene: its meshes stay in the file, everything else is here."
    )];
    lines.extend_from_slice(notes);
    lines.push(format!("    luxel render {name}"));
    let comment = |line: String| format!("// {}\n", line.replace(char::is_control, "?"));
    lines.into_iter().map(comment).collect()
}
