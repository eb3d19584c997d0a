//! The materials of a mesh: from the `mtllib` and `usemtl` lines of an OBJ file to [`MeshMaterial`]s.

use super::loader::Loader;
use super::paths::{beside, library_names, most_similar, same_name_beside};
use super::scan::{Named, Scan, at_line};
use super::{MeshMaterial, TextureId, codes, mtl, text};
use crate::diag::Diagnostic;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A material library as read: its file, its text, its materials.
pub(super) struct Library {
    pub(super) path: PathBuf,
    pub(super) source: String,
    definitions: Vec<mtl::Definition>,
}

/// A text file that is being loaded.
pub(super) struct Source<'a> {
    pub(super) path: &'a Path,
    pub(super) text: &'a str,
}

impl Source<'_> {
    pub(super) fn place(&self, diagnostic: Diagnostic, at: usize) -> Diagnostic {
        at_line(diagnostic, self.text, at).in_file(self.path)
    }

    pub(super) fn in_file(&self, found: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let found = found.into_iter();
        found.map(|one| one.in_file(self.path)).collect()
    }
}

/// The materials of a mesh, and the index of one for each `usemtl` line.
type Resolved = (Vec<MeshMaterial>, Vec<Option<u32>>);

/// The material libraries of a mesh.
#[derive(Default)]
pub(super) struct Libraries {
    read: Vec<Library>,
    /// Library and definition of each name, the first of several.
    by_name: BTreeMap<String, (usize, usize)>,
    /// Whether one was missing, so that unknown names are no news.
    missing: bool,
}

impl Libraries {
    /// The first definition of a name; a name with a comment behind it is tried without.
    fn find(&self, name: &str) -> Option<(&Library, &mtl::Definition)> {
        [name, text::without_comment(name)]
            .into_iter()
            .find_map(|name| {
                let &(library, definition) = self.by_name.get(name)?;
                let library = self.read.get(library)?;
                Some((library, library.definitions.get(definition)?))
            })
    }

    fn keep(&mut self, library: Library) {
        let index = self.read.len();
        for (i, definition) in library.definitions.iter().enumerate() {
            let name = definition.name.clone();
            self.by_name.entry(name).or_insert((index, i));
        }
        self.read.push(library);
    }
}

impl Loader {
    /// The materials of a scanned file.
    ///
    /// # Errors
    /// Libraries and textures that cannot be used.
    pub(super) fn resolve(
        &mut self,
        source: &Source<'_>,
        scan: &Scan,
    ) -> Result<Resolved, Vec<Diagnostic>> {
        let libraries = self.libraries(source, &scan.libraries)?;
        self.materials(source, scan, &libraries)
    }

    /// Warns at a place of a file.
    pub(super) fn tell(&mut self, source: &Source<'_>, at: usize, warning: Diagnostic) {
        self.told.add(warning.code, || source.place(warning, at));
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
                    self.tell(source, line.at, warning);
                    continue;
                };
                if libraries.read.iter().any(|known| known.path == path) {
                    continue;
                }
                let bytes = self.read(&path).map_err(|e| vec![e])?;
                let text = text::decode(&bytes).into_owned();
                match mtl::read(&text) {
                    Ok(definitions) => libraries.keep(Library {
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
        scan: &Scan,
        libraries: &Libraries,
    ) -> Result<Resolved, Vec<Diagnostic>> {
        let ends = scan.uses.iter().skip(1).map(|line| line.first);
        let ends = ends.chain([scan.corners.len() / 3]);
        let used: Vec<bool> = scan
            .uses
            .iter()
            .zip(ends)
            .map(|(line, end)| end > line.first)
            .collect();
        self.warn_of_duplicates(libraries);
        if let Some(first) = used.iter().position(|&used| used)
            && libraries.read.is_empty()
            && !libraries.missing
        {
            let says = "the file uses materials and names no material file: the default stands in";
            let warning = Diagnostic::warning(codes::UNKNOWN_MATERIAL, says);
            self.tell(source, scan.uses[first].at, warning);
        }
        let names = scan.uses.iter().zip(&used).filter(|(_, used)| **used);
        self.material_textures_ahead(names.map(|(line, _)| line.name.as_str()), libraries);
        let mut seen = BTreeSet::new();
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
                seen.insert((&library.path, definition.at));
                match self.material(library, definition) {
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
        for library in &libraries.read {
            let used = |d: &&mtl::Definition| seen.contains(&(&library.path, d.at));
            self.warn_not_modelled(library, library.definitions.iter().filter(used));
        }
        if errors.is_empty() {
            Ok((materials, by_use))
        } else {
            Err(errors)
        }
    }

    /// Reads the images of the materials of these names, in the order in which they will be asked for.
    fn material_textures_ahead<'a>(
        &mut self,
        names: impl Iterator<Item = &'a str>,
        libraries: &Libraries,
    ) {
        let mut seen = BTreeSet::new();
        let names = names.filter(|name| seen.insert(*name));
        let found = names.filter_map(|name| libraries.find(name));
        let paths = found.flat_map(|(library, definition)| {
            let images = [
                &definition.texture,
                &definition.emission_texture,
                &definition.opacity_texture,
            ];
            let images = images.into_iter().flatten();
            images.filter_map(|line| find(&library.path, &line.path).map(|(path, _)| path))
        });
        self.textures_ahead(paths);
    }

    /// The texture of a material; a missing file is a warning, a damaged one an error.
    pub(super) fn material_texture(
        &mut self,
        source: &Source<'_>,
        name: &str,
        at: usize,
    ) -> Result<Option<TextureId>, Diagnostic> {
        if let Some(path) = self.locate(source, at, name) {
            return self.texture(&path).map(Some);
        }
        let says = format!("the texture \"{name}\" is missing: the material does without");
        let mut warning = Diagnostic::warning(codes::TEXTURE_MISSING, says);
        if let Some(similar) = self.similar(&beside(source.path, name)) {
            warning = warning.hint(format!("did you mean \"{similar}\"?"));
        }
        self.tell(source, at, warning);
        Ok(None)
    }

    /// The file that a line of another file names: where its path says, or else, with a warning, beside that file.
    fn locate(&mut self, source: &Source<'_>, at: usize, name: &str) -> Option<PathBuf> {
        let (found, is_beside) = find(source.path, name)?;
        if is_beside {
            let says = format!("\"{name}\" does not exist: taken from beside this file instead");
            let warning = Diagnostic::warning(codes::FOUND_BESIDE, says);
            self.tell(source, at, warning);
        }
        Some(found)
    }

    /// One warning for all that the used materials of a library ask for and do not get.
    fn warn_not_modelled<'a>(
        &mut self,
        library: &Library,
        used: impl Iterator<Item = &'a mtl::Definition>,
    ) {
        let asked: Vec<_> = used
            .flat_map(|definition| &definition.not_modelled)
            .collect();
        let Some((_, at)) = asked.first() else {
            return;
        };
        let keywords: BTreeSet<&str> = asked.iter().map(|(keyword, _)| keyword.as_str()).collect();
        let keywords: Vec<&str> = keywords.into_iter().collect();
        let says = format!(
            "not modelled, and ignored: {}; the first is here",
            keywords.join(", ")
        );
        let warning = Diagnostic::warning(codes::NOT_MODELLED, says).in_file(&library.path);
        self.told
            .add(warning.code, || at_line(warning, &library.source, *at));
    }

    fn warn_unknown(&mut self, source: &Source<'_>, line: &Named, libraries: &Libraries) {
        if libraries.missing || libraries.read.is_empty() {
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
        if self.may_guess()
            && let Some(similar) = most_similar(&line.name, names)
        {
            warning = warning.hint(format!("did you mean \"{similar}\"?"));
        }
        self.tell(source, line.at, warning);
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
                    let at = definition.at;
                    self.told
                        .add(warning.code, || at_line(warning, &library.source, at));
                }
            }
        }
    }
}

/// The file that another file names, and whether it was only found beside that.
fn find(file: &Path, name: &str) -> Option<(PathBuf, bool)> {
    let named = [name, text::without_comment(name)].map(|name| beside(file, name));
    if let Some(found) = named.into_iter().find(|path| path.is_file()) {
        return Some((found, false));
    }
    let found = same_name_beside(file, text::without_comment(name))?;
    Some((found, true))
}
