//! Files that a scene names: loaded once each, their errors at the place that names them.

use crate::asset::{AssetStore, Loader, MeshId, TextureId};
use crate::diag::{Diagnostic, Span};
use crate::scene::{Placed, SceneDesc};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The loader with the scene whose places it reports at.
pub(super) struct Files<'a> {
    desc: &'a SceneDesc,
    loader: Loader,
    /// Files whose errors were reported, at the first place that names them.
    failed: BTreeSet<PathBuf>,
    errors: Vec<Diagnostic>,
}

impl<'a> Files<'a> {
    pub(super) fn new(desc: &'a SceneDesc) -> Files<'a> {
        Files {
            desc,
            loader: Loader::new(),
            failed: BTreeSet::new(),
            errors: Vec::new(),
        }
    }

    pub(super) fn mesh(&mut self, named: &Placed<String>) -> Option<MeshId> {
        let path = self.path(named);
        let loaded = self.loader.mesh(&path);
        self.keep(loaded, path, named)
    }

    pub(super) fn texture(&mut self, named: &Placed<String>) -> Option<TextureId> {
        let path = self.path(named);
        let loaded = self.loader.texture(&path).map_err(|e| vec![e]);
        self.keep(loaded, path, named)
    }

    /// Reports something about the place that names a file.
    pub(super) fn refuse(&mut self, named: &Placed<String>, code: &'static str, says: &str) {
        let error = Diagnostic::error(code, says).in_file(&self.desc.file).at(
            &self.desc.source,
            named.at,
            named.len,
        );
        self.errors.push(error);
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

    /// An error with a line of its own keeps it and says who names the file; any other is put where the file is named.
    fn place(&self, error: Diagnostic, path: &Path, named: &Placed<String>) -> Diagnostic {
        let SceneDesc { file, source, .. } = self.desc;
        if error.span.is_none() {
            let about = error.file.as_deref().unwrap_or(path).display();
            return Diagnostic {
                message: format!("{about}: {}", error.message),
                ..error
            }
            .in_file(file)
            .at(source, named.at, named.len);
        }
        let Span { line, column, .. } = Span::of_bytes(source, named.at, named.len);
        let names = format!("named in {}:{line}:{column}", file.display());
        let hint = match &error.hint {
            Some(hint) => format!("{hint}; {names}"),
            None => names,
        };
        error.hint(hint)
    }
}
