//! Files that a scene names: loaded once each, their errors at the place that names them.

use super::codes;
use crate::asset::{AssetStore, Loader, MeshId, ModelId, Panorama, PanoramaId, TextureId};
use crate::diag::{Diagnostic, Lines};
use crate::scene::{Placed, SceneDesc};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The loader with the scene whose places it reports at.
pub(super) struct Files<'a> {
    desc: &'a SceneDesc,
    lines: Lines<'a>,
    loader: Loader,
    /// Files whose errors were reported, at the first place that names them.
    failed: BTreeSet<PathBuf>,
    errors: Vec<Diagnostic>,
}

impl<'a> Files<'a> {
    pub(super) fn new(desc: &'a SceneDesc, loader: Loader) -> Files<'a> {
        Files {
            desc,
            lines: Lines::of(&desc.source),
            loader,
            failed: BTreeSet::new(),
            errors: Vec::new(),
        }
    }

    /// A mesh: of an OBJ file, or one of a glTF file.
    pub(super) fn mesh(&mut self, named: &Placed<String>, index: Option<u32>) -> Option<MeshId> {
        let path = self.path(named);
        match (is_gltf(&path), index) {
            (false, None) => {
                let loaded = self.loader.mesh(&path);
                self.keep(loaded, path, named)
            }
            (true, Some(index)) => {
                let model = self.model(named)?;
                let model = self.loader.loaded_model(model);
                let mesh = model.meshes.get(index as usize).copied().flatten();
                if mesh.is_none() {
                    let says = format!(
                        "{} has no mesh {index} with triangles in its default scene",
                        path.display()
                    );
                    self.refuse(named, codes::NO_SUCH_MESH, &says);
                }
                mesh
            }
            (true, None) => {
                let says = "a glTF file holds a whole scene";
                let hint = format!(
                    "place it as a component of its own, `gltf: {0:?}`, or name one of its meshes, \
                     `Mesh(path: {0:?}, mesh: 0)`",
                    named.value
                );
                self.refuse_with(named, codes::WHOLE_SCENE, says, hint);
                None
            }
            (false, Some(_)) => {
                let says = "`mesh` counts the meshes of a glTF file, and this is none";
                let hint = format!("write `Mesh({:?})`", named.value);
                self.refuse_with(named, codes::NO_SUCH_MESH, says, hint);
                None
            }
        }
    }

    /// A glTF file.
    pub(super) fn model(&mut self, named: &Placed<String>) -> Option<ModelId> {
        let path = self.path(named);
        let loaded = self.loader.model(&path);
        self.keep(loaded, path, named)
    }

    /// Reads images that will be asked for next, in this order.
    pub(super) fn textures_ahead<'n>(&mut self, named: impl Iterator<Item = &'n Placed<String>>) {
        let paths: Vec<PathBuf> = named.map(|named| self.path(named)).collect();
        self.loader.textures_ahead(paths);
    }

    pub(super) fn texture(&mut self, named: &Placed<String>) -> Option<TextureId> {
        let path = self.path(named);
        let loaded = self.loader.texture(&path).map_err(|e| vec![e]);
        self.keep(loaded, path, named)
    }

    /// An image of the sky, which is there to be looked at already.
    pub(super) fn panorama(&mut self, named: &Placed<String>) -> Option<(PanoramaId, &Panorama)> {
        let path = self.path(named);
        let loaded = self.loader.panorama(&path).map_err(|e| vec![e]);
        let id = self.keep(loaded, path, named)?;
        Some((id, self.loader.loaded_panorama(id)))
    }

    /// Reports something about the place that names a file.
    pub(super) fn refuse(&mut self, named: &Placed<String>, code: &'static str, says: &str) {
        let error = self.at(named, Diagnostic::error(code, says));
        self.errors.push(error);
    }

    fn refuse_with(
        &mut self,
        named: &Placed<String>,
        code: &'static str,
        says: &str,
        hint: String,
    ) {
        let error = self.at(named, Diagnostic::error(code, says).hint(hint));
        self.errors.push(error);
    }

    fn at(&self, named: &Placed<String>, diagnostic: Diagnostic) -> Diagnostic {
        diagnostic
            .in_file(&self.desc.file)
            .on(&self.lines, named.at, named.len)
    }

    /// The store, warnings and errors.
    pub(super) fn finish(self) -> (AssetStore, Vec<Diagnostic>, Vec<Diagnostic>) {
        let warnings = self.loader.warnings().to_vec();
        (self.loader.finish(), warnings, self.errors)
    }

    /// Relative to the scene's folder.
    fn path(&self, named: &Placed<String>) -> PathBuf {
        let folder = self.desc.file.parent().unwrap_or(Path::new(""));
        folder.join(&named.value)
    }

    fn keep<T>(
        &mut self,
        loaded: Result<T, Vec<Diagnostic>>,
        path: PathBuf,
        named: &Placed<String>,
    ) -> Option<T> {
        match loaded {
            Ok(value) => Some(value),
            Err(found) => {
                if self.failed.insert(path.clone()) {
                    let placed = found.into_iter().map(|e| self.place(e, &path, named));
                    let placed: Vec<_> = placed.collect();
                    self.errors.extend(placed);
                }
                None
            }
        }
    }

    /// An error with a line or a pointer of its own keeps it and says who names the file; any other is put where the file is named.
    fn place(&self, error: Diagnostic, path: &Path, named: &Placed<String>) -> Diagnostic {
        let file = &self.desc.file;
        if error.span.is_none() && error.pointer.is_none() {
            let about = error.file.as_deref().unwrap_or(path).display();
            return Diagnostic {
                message: format!("{about}: {}", error.message),
                ..error
            }
            .in_file(file)
            .on(&self.lines, named.at, named.len);
        }
        let at = self.lines.span(named.at, named.len);
        let names = format!("named in {}:{}:{}", file.display(), at.line, at.column);
        let hint = match &error.hint {
            Some(hint) => format!("{hint}; {names}"),
            None => names,
        };
        error.hint(hint)
    }
}

/// Whether a name says glTF.
fn is_gltf(path: &Path) -> bool {
    let suffix = path.extension().and_then(|s| s.to_str());
    suffix.is_some_and(|s| s.eq_ignore_ascii_case("gltf") || s.eq_ignore_ascii_case("glb"))
}
