//! The loader: paths to ids while a scene is spawned, then the immutable store.

use super::limits::{Budget, Limits};
use super::materials::Source;
use super::panorama;
use super::paths::{canonical, similar_file};
use super::reading::Reading;
use super::scan::{self, Scan};
use super::told::Told;
use super::{
    AssetStore, Mesh, MeshId, Model, ModelId, Panorama, PanoramaId, Texture, TextureId, codes,
    gltf, obj, text, texture,
};
use crate::diag::Diagnostic;
use rayon::prelude::*;
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Images whose bytes are in memory at once, to be decoded in parallel.
const IMAGES_AT_ONCE: usize = 16;

/// Reads files, each once, and gives ids for them.
///
/// Two paths to one file give one id. A file that failed fails again with the same diagnostics.
#[derive(Debug, Default)]
pub struct Loader {
    pub(super) store: AssetStore,
    meshes: BTreeMap<PathBuf, Result<MeshId, Vec<Diagnostic>>>,
    textures: BTreeMap<PathBuf, Result<TextureId, Diagnostic>>,
    models: BTreeMap<PathBuf, Result<ModelId, Vec<Diagnostic>>>,
    pub(super) warnings: Vec<Diagnostic>,
    budget: Budget,
    reading: Arc<Reading>,
    hash: Sha256,
    bytes: u64,
    /// Warnings about the mesh that is being read.
    pub(super) told: Told,
    guesses: usize,
}

/// So many wrong names are compared with those that exist: each takes a look at a folder or a list.
const MAX_GUESSES: usize = 100;

impl Loader {
    /// A loader that has read nothing.
    #[must_use]
    pub fn new() -> Loader {
        Loader::default()
    }

    /// A loader that has read nothing, and will not take more than this.
    #[must_use]
    pub fn with_limits(limits: Limits) -> Loader {
        Loader {
            budget: Budget::of(limits),
            ..Loader::default()
        }
    }

    /// Where another thread sees which file is being read.
    #[must_use]
    pub fn reading(&self) -> Arc<Reading> {
        self.reading.clone()
    }

    /// Reads an OBJ file with its materials and their textures.
    ///
    /// # Errors
    /// Everything that keeps the file from being used, with its lines. Errors carry the file that they are in.
    pub fn mesh(&mut self, path: &Path) -> Result<MeshId, Vec<Diagnostic>> {
        let key = canonical(path);
        if let Some(known) = self.meshes.get(&key) {
            return known.clone();
        }
        let loaded = self.read_mesh(path).map(|mesh| self.keep_mesh(mesh));
        self.meshes.insert(key, loaded.clone());
        loaded
    }

    /// Reads a glTF file: the nodes of its default scene, their meshes and materials.
    ///
    /// # Errors
    /// Everything that keeps the file from being used, each with its JSON pointer.
    pub fn model(&mut self, path: &Path) -> Result<ModelId, Vec<Diagnostic>> {
        let key = canonical(path);
        if let Some(known) = self.models.get(&key) {
            return known.clone();
        }
        let loaded = gltf::read(self, path).map(|model| {
            self.store.models.push(Arc::new(model));
            ModelId(self.store.models.len() as u32 - 1)
        });
        self.models.insert(key, loaded.clone());
        loaded
    }

    /// Reads an image as a colour texture.
    ///
    /// # Errors
    /// A file that is missing, is not a PNG or JPEG image, is damaged, or is too large.
    pub fn texture(&mut self, path: &Path) -> Result<TextureId, Diagnostic> {
        let key = canonical(path);
        if let Some(known) = self.textures.get(&key) {
            return known.clone();
        }
        self.read_textures(&[(key.clone(), path.to_owned())]);
        let unread = || Err(Diagnostic::error(codes::UNREADABLE, "not read").in_file(path));
        self.textures.get(&key).cloned().unwrap_or_else(unread)
    }

    /// Reads textures that will be asked for next, in this order, and decodes them in parallel: the same ids and
    /// diagnostics, sooner.
    pub fn textures_ahead(&mut self, paths: impl IntoIterator<Item = PathBuf>) {
        let mut seen = BTreeSet::new();
        let new: Vec<(PathBuf, PathBuf)> = paths
            .into_iter()
            .map(|path| (canonical(&path), path))
            .filter(|(key, _)| !self.textures.contains_key(key) && seen.insert(key.clone()))
            .collect();
        for batch in new.chunks(IMAGES_AT_ONCE) {
            self.read_textures(batch);
        }
    }

    /// Reads an image of the sky.
    ///
    /// # Errors
    /// A file that is missing, is neither a Radiance HDR nor an OpenEXR image, is damaged, holds what is no radiance, or
    /// is too large.
    pub fn panorama(&mut self, path: &Path) -> Result<PanoramaId, Diagnostic> {
        let bytes = self.read(path)?;
        let image = panorama::Image::open(path, &bytes)?;
        let says = image.says();
        self.budget
            .allow(image.passing(), &format!("decoding {says}"), path)?;
        self.charge(image.kept(), &says, path)?;
        self.warnings.extend(image.odd_shape());
        let kept = image.kept();
        let panorama = image
            .decode()
            .inspect_err(|_| self.budget.give_back(kept))?;
        self.store.panoramas.push(Arc::new(panorama));
        Ok(PanoramaId(self.store.panoramas.len() as u32 - 1))
    }

    /// A mesh that was read, by its id.
    #[must_use]
    pub fn loaded(&self, id: MeshId) -> &Arc<Mesh> {
        self.store.mesh(id)
    }

    /// A texture that was read, by its id.
    #[must_use]
    pub fn loaded_texture(&self, id: TextureId) -> &Arc<Texture> {
        self.store.texture(id)
    }

    /// An image of the sky that was read, by its id.
    #[must_use]
    pub fn loaded_panorama(&self, id: PanoramaId) -> &Arc<Panorama> {
        self.store.panorama(id)
    }

    /// A glTF file that was read, by its id.
    #[must_use]
    pub fn loaded_model(&self, id: ModelId) -> &Arc<Model> {
        self.store.model(id)
    }

    /// What the files read so far should be told of, in order of loading.
    #[must_use]
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// The store, with everything loaded.
    #[must_use]
    pub fn finish(self) -> AssetStore {
        AssetStore {
            content_hash: self.hash.finalize().into(),
            bytes: self.bytes,
            memory: self.budget.used(),
            ..self.store
        }
    }

    /// Takes memory for what a file decodes to, before it is allocated: every reader asks here for what its file claims.
    ///
    /// # Errors
    /// If it is not left, with the number and what to do.
    pub(super) fn charge(&mut self, bytes: u64, what: &str, path: &Path) -> Result<(), Diagnostic> {
        self.budget.charge(bytes, what, path)
    }

    /// What is left of the budget, to ask of where the loader is not at hand.
    pub(super) fn budget(&self) -> &Budget {
        &self.budget
    }

    /// The bytes of a regular file, which enter the hash.
    pub(super) fn read(&mut self, path: &Path) -> Result<Vec<u8>, Diagnostic> {
        let error = |says: String| Diagnostic::error(codes::UNREADABLE, says).in_file(path);
        let bytes = match std::fs::metadata(path) {
            Ok(meta) if meta.is_file() => {
                self.budget.allow(meta.len(), "the file", path)?;
                self.reading.begin(path, meta.len());
                std::fs::read(path)
            }
            Ok(_) => return Err(error("this is not a file".into())),
            Err(e) => Err(e),
        };
        let bytes = bytes.map_err(|e| {
            let error = error(format!("cannot be read: {e}"));
            match self.similar(path) {
                Some(name) => error.hint(format!("did you mean \"{name}\"?")),
                None => error,
            }
        })?;
        self.hash.update(Sha256::digest(&bytes));
        self.bytes += bytes.len() as u64;
        Ok(bytes)
    }

    /// Whether it is worth the time to look for the name that a wrong one may have meant.
    pub(super) fn may_guess(&mut self) -> bool {
        self.guesses += 1;
        self.guesses <= MAX_GUESSES
    }

    /// The name of a file that a missing file may have meant.
    pub(super) fn similar(&mut self, path: &Path) -> Option<String> {
        self.may_guess().then(|| similar_file(path)).flatten()
    }

    /// Reads the header of an image and takes the memory that its texels will need.
    pub(super) fn open_image<'a>(
        &mut self,
        path: &'a Path,
        bytes: &'a [u8],
    ) -> Result<texture::Image<'a>, Diagnostic> {
        let image = texture::Image::open(path, bytes)?;
        let says = image.says();
        self.budget
            .allow(image.passing(), &format!("decoding {says}"), path)?;
        self.charge(image.kept(), &says, path)?;
        Ok(image)
    }

    /// What reading a texture file gave, if it was read.
    pub(super) fn known_texture(&self, path: &Path) -> Option<Result<TextureId, Diagnostic>> {
        self.textures.get(&canonical(path)).cloned()
    }

    /// Keeps a texture that was decoded elsewhere; under the path of its file, if it has one of its own.
    pub(super) fn keep_texture(&mut self, texture: Texture, file: Option<&Path>) -> TextureId {
        self.store.textures.push(Arc::new(texture));
        let id = TextureId(self.store.textures.len() as u32 - 1);
        if let Some(file) = file {
            self.textures.insert(canonical(file), Ok(id));
        }
        id
    }

    /// Keeps a mesh that has no file of its own.
    pub(super) fn keep_mesh(&mut self, mesh: Mesh) -> MeshId {
        self.store.meshes.push(Arc::new(mesh));
        MeshId(self.store.meshes.len() as u32 - 1)
    }

    /// Reads and decodes images, of which each is kept under its key.
    fn read_textures(&mut self, files: &[(PathBuf, PathBuf)]) {
        let bytes: Vec<_> = files.iter().map(|(_, path)| self.read(path)).collect();
        let opened: Vec<_> = files
            .iter()
            .zip(&bytes)
            .map(|((_, path), bytes)| self.open_image(path, bytes.as_ref().map_err(Clone::clone)?))
            .collect();
        let kept: Vec<u64> = opened
            .iter()
            .map(|image| image.as_ref().map_or(0, texture::Image::kept))
            .collect();
        let together = opened.iter().flatten().map(texture::Image::passing);
        let together = together.fold(0, u64::saturating_add);
        let decode = |image: Result<texture::Image<'_>, Diagnostic>| image?.decode();
        let decoded: Vec<_> = if self.budget.has(together) {
            opened.into_par_iter().map(decode).collect()
        } else {
            opened.into_iter().map(decode).collect()
        };
        for (((key, _), kept), decoded) in files.iter().zip(kept).zip(decoded) {
            let loaded = decoded.map(|texture| self.keep_texture(texture, None));
            if loaded.is_err() {
                self.budget.give_back(kept);
            }
            self.textures.insert(key.clone(), loaded);
        }
    }

    fn read_mesh(&mut self, path: &Path) -> Result<Mesh, Vec<Diagnostic>> {
        let bytes = self.read(path).map_err(|e| vec![e])?;
        let text = text::decode(&bytes);
        let decoded = match &text {
            Cow::Borrowed(_) => 0,
            Cow::Owned(text) => text.len(),
        };
        let held = (bytes.len() + decoded) as u64;
        self.budget.hold(held);
        let mesh = self.mesh_of(&Source { path, text: &text });
        self.budget.let_go(held);
        mesh
    }

    /// The mesh of a text. What was charged for its triangles is given back if there are none in the end.
    fn mesh_of(&mut self, source: &Source<'_>) -> Result<Mesh, Vec<Diagnostic>> {
        let before = self.budget.used();
        let scan = scan::scan(source.text, source.path, &mut self.budget);
        let charged = self.budget.used() - before;
        let in_file = |found| source.in_file(found);
        let mesh = scan
            .map_err(in_file)
            .and_then(|scan| self.finish_mesh(source, scan));
        if mesh.is_err() {
            self.budget.give_back(charged);
        }
        mesh
    }

    fn finish_mesh(&mut self, source: &Source<'_>, scan: Scan) -> Result<Mesh, Vec<Diagnostic>> {
        let resolved = self.resolve(source, &scan);
        let told = std::mem::take(&mut self.told);
        self.warnings.extend(told.finish());
        let (materials, by_use) = resolved?;
        let mut warnings = Vec::new();
        let mesh = obj::triangles(source.text, scan, &by_use, &mut warnings);
        self.warnings.extend(source.in_file(warnings));
        let mesh = mesh.map_err(|e| source.in_file(vec![e]))?;
        Ok(Mesh {
            path: source.path.to_owned(),
            materials,
            ..mesh
        })
    }
}
