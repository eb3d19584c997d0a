//! What `turntable` and `convert` start from: a mesh named on the command line, and a scene written for it.

use super::failure::Failure;
use super::load;
use super::output::check_writable;
use crate::asset::{Loader, MeshId, ModelId, codes};
use crate::author::{self, PathError, points};
use crate::diag::Diagnostic;
use crate::film;
use crate::math::DVec3;
use std::ffi::OsStr;
use std::path::Path;

/// A mesh or a glTF file that was read.
pub(crate) struct Read {
    /// Has read it, and will not read it again.
    pub(crate) loader: Loader,
    /// Which.
    pub(crate) what: What,
    /// Every position that a triangle uses, in the file's space.
    pub(crate) points: Vec<DVec3>,
}

/// What a file holds.
#[derive(Clone, Copy)]
pub(crate) enum What {
    /// An OBJ file.
    Mesh(MeshId),
    /// A glTF file.
    Model(ModelId),
}

/// Reads a mesh by its suffix.
pub(crate) fn mesh(path: &Path, max_memory: u64) -> Result<Read, Failure> {
    let suffix = path.extension().and_then(OsStr::to_str).unwrap_or("");
    let (mut loader, _patience) = load::loader(max_memory);
    let (what, points) = match suffix.to_ascii_lowercase().as_str() {
        "obj" => {
            let id = loader.mesh(path).map_err(|all| refuse(path, all))?;
            (What::Mesh(id), points::of_mesh(loader.loaded(id)))
        }
        "gltf" | "glb" => {
            let id = loader.model(path).map_err(|all| refuse(path, all))?;
            (
                What::Model(id),
                points::of_model(loader.loaded_model(id), &loader),
            )
        }
        _ => {
            return Err(Failure::usage(
                format!(
                    "the suffix of \"{}\" names no mesh that luxel reads",
                    path.display()
                ),
                "give it an .obj, .gltf or .glb file",
            ));
        }
    };
    Ok(Read {
        loader,
        what,
        points,
    })
}

/// A file that is missing is a mistake of the command line, a bad one is bad.
fn refuse(path: &Path, errors: Vec<Diagnostic>) -> Failure {
    let failure = Failure::scene(errors);
    let missing = failure.diagnostics().unwrap_or_default().iter();
    let missing = missing
        .filter(|e| e.code == codes::UNREADABLE)
        .any(|e| e.file.as_deref() == Some(path));
    if missing { failure.missing() } else { failure }
}

/// [`author::path_from`], before anything is written.
pub(crate) fn path_from(scene: &Path, mesh: &Path) -> Result<String, Failure> {
    author::path_from(scene, mesh).map_err(|e| match e {
        PathError::NotText(_) => Failure::usage(e, "rename it"),
        PathError::Missing {
            ref path,
            ref source,
        } if path == mesh => Failure::no_input(path, source),
        PathError::Missing { ref source, .. } => {
            Failure::io(format!("\"{}\"", scene.display()), source)
        }
    })
}

/// Writes a scene that a person may go on from. One that differs is not overwritten: it may be what became of the last.
pub(crate) fn write_scene(path: &Path, text: &str) -> Result<(), Failure> {
    match std::fs::read(path) {
        Ok(there) if there == text.as_bytes() => return Ok(()),
        Ok(_) => {
            return Err(Failure::usage(
                format!(
                    "\"{}\" is there already and may have been edited",
                    path.display()
                ),
                "give another name, or remove it first",
            ));
        }
        Err(_) => {}
    }
    film::write_file(path, text.as_bytes())
        .map_err(|e| Failure::io(format!("\"{}\"", path.display()), &e))
}

/// The suffix of a scene, and a folder that takes it.
pub(crate) fn check_scene(path: &Path) -> Result<(), Failure> {
    if path.extension() != Some(OsStr::new("ron")) {
        return Err(Failure::usage(
            format!("\"{}\" is no scene file", path.display()),
            "end its name in .ron",
        ));
    }
    check_writable(path)
}
