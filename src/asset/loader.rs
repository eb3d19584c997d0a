//! The loader: paths to ids while a scene is spawned, then the immutable store.

use super::scan::{Named, at_line};
use super::{
    AssetStore, Mesh, MeshId, MeshMaterial, Texture, TextureId, codes, mtl, obj, text, texture,
};
use crate::diag::Diagnostic;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Colour of a material that gives none, where nothing else does either.
const NEUTRAL: [f64; 3] = [0.8; 3];

/// Names in one `mtllib` line that are tried together as one name with spaces.
const MAX_WORDS_OF_NAME: usize = 8;

/// Reads files, each once, and gives ids for them.
///
/// Two paths to one file give one id. A file that failed fails again with the same diagnostics.
#[derive(Debug, Default)]
pub struct Loader {
    store: AssetStore,
    meshes: BTreeMap<PathBuf, Result<MeshId, Vec<Diagnostic>>>,
    textures: BTreeMap<PathBuf, Result<TextureId, Diagnostic>>,
    warnings: Vec<Diagnostic>,
    hash: Sha256,
    bytes: u64,
}

/// A material library as read: its file, its text, its materials.
struct Library {
    path: PathBuf,
    source: String,
    definitions: Vec<mtl::Definition>,
}

/// An OBJ file that is being loaded.
struct Source<'a> {
    path: &'a Path,
    text: &'a str,
}

impl Source<'_> {
    fn place(&self, diagnostic: Diagnostic, at: usize) -> Diagnostic {
        at_line(diagnostic, self.text, at).in_file(self.path)
    }
}

impl Loader {
    /// A loader that has read nothing.
    #[must_use]
    pub fn new() -> Loader {
        Loader::default()
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
        let loaded = self.read_mesh(path).map(|mesh| {
            self.store.meshes.push(Arc::new(mesh));
            MeshId(self.store.meshes.len() as u32 - 1)
        });
        self.meshes.insert(key, loaded.clone());
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
        let loaded = self.read_texture(path).map(|texture| {
            self.store.textures.push(Arc::new(texture));
            TextureId(self.store.textures.len() as u32 - 1)
        });
        self.textures.insert(key, loaded.clone());
        loaded
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
            ..self.store
        }
    }

    /// The bytes of a regular file, which enter the hash.
    fn read(&mut self, path: &Path) -> Result<Vec<u8>, Diagnostic> {
        let error = |says: String| Diagnostic::error(codes::UNREADABLE, says).in_file(path);
        let is_file = std::fs::metadata(path).map(|meta| meta.is_file());
        let bytes = match is_file {
            Ok(true) => std::fs::read(path),
            Ok(false) => return Err(error("this is not a file".into())),
            Err(e) => Err(e),
        };
        let bytes = bytes.map_err(|e| {
            let error = error(format!("cannot be read: {e}"));
            match similar_file(path) {
                Some(name) => error.hint(format!("did you mean \"{name}\"?")),
                None => error,
            }
        })?;
        self.hash.update(Sha256::digest(&bytes));
        self.bytes += bytes.len() as u64;
        Ok(bytes)
    }

    fn read_texture(&mut self, path: &Path) -> Result<Texture, Diagnostic> {
        let bytes = self.read(path)?;
        texture::decode(path, &bytes)
    }

    fn read_mesh(&mut self, path: &Path) -> Result<Mesh, Vec<Diagnostic>> {
        let bytes = self.read(path).map_err(|e| vec![e])?;
        let text = text::decode(&bytes);
        let source = Source { path, text: &text };
        let in_file = |found: Vec<Diagnostic>| -> Vec<Diagnostic> {
            found.into_iter().map(|one| one.in_file(path)).collect()
        };
        let scan = obj::scan(&text).map_err(in_file)?;
        let libraries = self.libraries(&source, &scan.libraries)?;
        let (materials, by_use) = self.materials(&source, &scan, &libraries)?;
        let mut warnings = Vec::new();
        let mesh = obj::triangles(&text, &scan, &by_use, &mut warnings);
        self.warnings.extend(in_file(warnings));
        let mesh = mesh.map_err(|e| in_file(vec![e]))?;
        Ok(Mesh {
            path: path.to_owned(),
            materials,
            ..mesh
        })
    }

    /// Reads the material libraries that the `mtllib` lines name; a missing one is a warning.
    fn libraries(
        &mut self,
        source: &Source<'_>,
        lines: &[Named],
    ) -> Result<Libraries, Vec<Diagnostic>> {
        let mut libraries = Libraries::default();
        let mut errors = Vec::new();
        for line in lines {
            for name in library_names(source.path, &line.name) {
                let Some(path) = self.locate(source, line.at, &name) else {
                    libraries.missing = true;
                    let says = format!(
                        "the material file \"{name}\" is missing: its materials are the default one"
                    );
                    let warning = Diagnostic::warning(codes::MTL_MISSING, says);
                    self.warnings.push(source.place(warning, line.at));
                    continue;
                };
                if libraries.read.iter().any(|known| known.path == path) {
                    continue;
                }
                let bytes = self.read(&path).map_err(|e| vec![e])?;
                let text = text::decode(&bytes).into_owned();
                match mtl::read(&text) {
                    Ok(definitions) => libraries.read.push(Library {
                        path,
                        source: text,
                        definitions,
                    }),
                    Err(found) => errors.extend(found.into_iter().map(|e| e.in_file(&path))),
                }
            }
        }
        if errors.is_empty() {
            Ok(libraries)
        } else {
            Err(errors)
        }
    }

    /// The materials that faces use, in order of first use, and which of them each `usemtl` line means.
    fn materials(
        &mut self,
        source: &Source<'_>,
        scan: &super::scan::Scan,
        libraries: &Libraries,
    ) -> Result<(Vec<MeshMaterial>, Vec<Option<u32>>), Vec<Diagnostic>> {
        let mut used = vec![false; scan.uses.len()];
        for face in &scan.faces {
            if let Some(line) = face.used {
                used[line as usize] = true;
            }
        }
        self.warn_of_duplicates(libraries);
        let mut materials = Vec::new();
        let mut errors = Vec::new();
        let mut known: BTreeMap<&str, Option<u32>> = BTreeMap::new();
        let mut by_use = vec![None; scan.uses.len()];
        for (i, line) in scan.uses.iter().enumerate().filter(|(i, _)| used[*i]) {
            by_use[i] = *known.entry(&line.name).or_insert_with(|| {
                let Some((library, definition)) = libraries.find(&line.name) else {
                    self.warn_unknown(source, line, libraries);
                    return None;
                };
                let material = self.material(library, definition);
                match material {
                    Ok(material) => {
                        materials.push(material);
                        Some(materials.len() as u32 - 1)
                    }
                    Err(e) => {
                        errors.push(e);
                        None
                    }
                }
            });
        }
        if errors.is_empty() {
            Ok((materials, by_use))
        } else {
            Err(errors)
        }
    }

    fn material(
        &mut self,
        library: &Library,
        definition: &mtl::Definition,
    ) -> Result<MeshMaterial, Diagnostic> {
        let source = Source {
            path: &library.path,
            text: &library.source,
        };
        let name = &definition.name;
        let mut texture = None;
        if let Some((path, at)) = &definition.texture {
            texture = self.material_texture(&source, path, *at)?;
        }
        let color = match (definition.color, texture) {
            (Some(color), _) => color,
            (None, Some(_)) => [1.0; 3],
            (None, None) => NEUTRAL,
        };
        let mut warn = |code, at, says: String| {
            self.warnings
                .push(source.place(Diagnostic::warning(code, says), at));
        };
        if texture.is_some() && color == [0.0; 3] {
            warn(
                codes::BLACK_FACTOR,
                definition.at,
                format!("the colour (Kd) of \"{name}\" is black, which hides its texture"),
            );
        }
        if color.iter().any(|&c| c > 1.0) {
            warn(
                codes::BRIGHT_COLOR,
                definition.at,
                format!("the colour (Kd) of \"{name}\" is above 1, and taken as 1"),
            );
        }
        if let Some((_, at)) = definition.not_modelled.first() {
            let mut keywords: Vec<&str> = definition
                .not_modelled
                .iter()
                .map(|(k, _)| k.as_str())
                .collect();
            keywords.dedup();
            let says = format!(
                "not modelled, and ignored, in material \"{name}\": {}",
                keywords.join(", ")
            );
            warn(codes::NOT_MODELLED, *at, says);
        }
        Ok(MeshMaterial {
            name: name.clone(),
            color: color.map(|c| c.min(1.0)),
            texture,
            emission: definition.emission,
        })
    }

    /// The texture of a material; a missing file is a warning, a damaged one an error.
    fn material_texture(
        &mut self,
        source: &Source<'_>,
        name: &str,
        at: usize,
    ) -> Result<Option<TextureId>, Diagnostic> {
        if let Some(path) = self.locate(source, at, name) {
            return self.texture(&path).map(Some);
        }
        let says =
            format!("the texture \"{name}\" is missing: the material keeps its plain colour");
        let mut warning = Diagnostic::warning(codes::TEXTURE_MISSING, says);
        if let Some(similar) = similar_file(&beside(source.path, name)) {
            warning = warning.hint(format!("did you mean \"{similar}\"?"));
        }
        self.warnings.push(source.place(warning, at));
        Ok(None)
    }

    /// The file that a line of another file names: where its path says, or else, with a warning, beside that file.
    fn locate(&mut self, source: &Source<'_>, at: usize, name: &str) -> Option<PathBuf> {
        let named = [name, text::without_comment(name)].map(|name| beside(source.path, name));
        if let Some(found) = named.iter().find(|path| path.is_file()) {
            return Some(found.clone());
        }
        let file_name = named[0].file_name()?;
        let found = source.path.with_file_name(file_name);
        if !found.is_file() {
            return None;
        }
        let says = format!("\"{name}\" does not exist: taken from beside this file instead");
        let warning = Diagnostic::warning(codes::FOUND_BESIDE, says);
        self.warnings.push(source.place(warning, at));
        Some(found)
    }

    fn warn_unknown(&mut self, source: &Source<'_>, line: &Named, libraries: &Libraries) {
        if libraries.missing {
            return;
        }
        let says = format!(
            "no material file defines \"{}\": the default material stands in",
            line.name
        );
        let mut warning = Diagnostic::warning(codes::UNKNOWN_MATERIAL, says);
        let names = libraries
            .read
            .iter()
            .flat_map(|library| &library.definitions)
            .map(|d| d.name.as_str());
        if let Some(similar) = most_similar(&line.name, names) {
            warning = warning.hint(format!("did you mean \"{similar}\"?"));
        }
        self.warnings.push(source.place(warning, line.at));
    }

    fn warn_of_duplicates(&mut self, libraries: &Libraries) {
        for library in &libraries.read {
            let mut first: BTreeMap<&str, ()> = BTreeMap::new();
            for definition in &library.definitions {
                if first.insert(&definition.name, ()).is_some() {
                    let says = format!(
                        "material \"{}\" is defined twice: the first counts",
                        definition.name
                    );
                    let warning =
                        Diagnostic::warning(codes::DUPLICATE_MATERIAL, says).in_file(&library.path);
                    self.warnings
                        .push(at_line(warning, &library.source, definition.at));
                }
            }
        }
    }
}

/// The material libraries of a mesh.
#[derive(Default)]
struct Libraries {
    read: Vec<Library>,
    /// Whether one was missing, so that unknown names are no news.
    missing: bool,
}

impl Libraries {
    /// The first definition of a name; a name with a comment behind it is tried without.
    fn find(&self, name: &str) -> Option<(&Library, &mtl::Definition)> {
        [name, text::without_comment(name)]
            .into_iter()
            .find_map(|name| {
                self.read.iter().find_map(|library| {
                    let definition = library.definitions.iter().find(|d| d.name == name)?;
                    Some((library, definition))
                })
            })
    }
}

/// The files that a `mtllib` line names: of words that exist together as one name with spaces, the longest first.
fn library_names(obj: &Path, names: &str) -> Vec<String> {
    if beside(obj, names).is_file() {
        return vec![names.to_owned()];
    }
    let words: Vec<&str> = names
        .split_whitespace()
        .take_while(|word| !word.starts_with('#'))
        .collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < words.len() {
        let longest = (at + 1..=words.len().min(at + MAX_WORDS_OF_NAME)).rev();
        let joined = |end: usize| words[at..end].join(" ");
        let end = longest
            .into_iter()
            .find(|&end| beside(obj, &joined(end)).is_file())
            .unwrap_or(at + 1);
        found.push(joined(end));
        at = end;
    }
    found
}

/// A path that a file names, relative to that file; backslashes separate too.
fn beside(file: &Path, name: &str) -> PathBuf {
    let name = mtl::unquote(name.trim()).replace('\\', "/");
    file.parent().unwrap_or(Path::new("")).join(name)
}

fn canonical(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// The name of a file in the same folder that a missing file may have meant.
fn similar_file(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let mut names: Vec<String> = std::fs::read_dir(folder.unwrap_or(Path::new(".")))
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort();
    most_similar(name, names.iter().map(String::as_str)).filter(|similar| similar != name)
}

/// The name nearest to a wrong one, if it is near: at most a third of the letters differ, or only their case.
fn most_similar<'a>(wrong: &str, names: impl Iterator<Item = &'a str>) -> Option<String> {
    let distance =
        |name: &str| strsim::damerau_levenshtein(&wrong.to_lowercase(), &name.to_lowercase());
    let (distance, name) = names.map(|name| (distance(name), name)).min()?;
    (distance <= wrong.chars().count() / 3).then(|| name.to_owned())
}
