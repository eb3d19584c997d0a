//! A glTF file, opened: its JSON, its typed document, its bytes.
//!
//! Enter: a path. Leave: a [`Source`] whose buffers that the scene needs are read, or everything that keeps the file
//! from being used, with JSON pointers.

use super::accessor::{self, Elements};
use super::buffers::Buffers;
use super::container::Container;
use super::layout::{Layouts, items, natural};
use super::uri::{self, Uri};
use super::uses::Uses;
use super::validate::{self, Report, Rules, Usages};
use crate::asset::{Loader, codes};
use crate::diag::{Diagnostic, Severity};
use gltf::json::validation::Validate;
use serde_json::Value;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// A glTF file, opened.
#[derive(Debug)]
pub(super) struct Source {
    /// The file.
    pub(super) path: PathBuf,
    /// Its JSON as written.
    pub(super) json: Value,
    /// Its JSON as types, without what luxel does not read: animations, skins, morph targets, extras, unknown
    /// properties and extensions.
    pub(super) document: gltf::Document,
    layouts: Layouts,
    buffers: Buffers,
}

/// Where the bytes of an image are.
#[derive(Debug)]
pub(super) enum Image<'a> {
    /// A file of its own, not read.
    File(PathBuf),
    /// In the glTF file or one of its buffers.
    Embedded(Cow<'a, [u8]>),
}

impl Source {
    /// Opens a file and reads the buffers that its default scene needs. Warnings go to the loader.
    ///
    /// # Errors
    /// Everything that keeps the file from being used.
    pub(super) fn open(loader: &mut Loader, path: &Path) -> Result<Source, Vec<Diagnostic>> {
        let bytes = loader.read(path).map_err(|e| vec![e])?;
        let mut warnings = Vec::new();
        let source = Source::of_bytes(loader, path, bytes, &mut warnings);
        let here = |d: Diagnostic| if d.file.is_none() { d.in_file(path) } else { d };
        loader.warnings.extend(warnings.into_iter().map(here));
        source.map_err(|errors| errors.into_iter().map(here).collect())
    }

    /// Opens the bytes of a file.
    ///
    /// # Errors
    /// As for [`Source::open`], without the file's name.
    pub(super) fn of_bytes(
        loader: &mut Loader,
        path: &Path,
        bytes: Vec<u8>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Source, Vec<Diagnostic>> {
        let container = Container::open(bytes, warnings).map_err(|e| vec![e])?;
        let json = parse(container.json()).map_err(|e| vec![e])?;
        let layouts = Layouts::of(&json);
        let mut report = Report::default();
        let buffers = examine(loader, path, container, (&json, &layouts), &mut report);
        let (errors, found) = report.finish();
        warnings.extend(found);
        if !errors.is_empty() {
            return Err(errors);
        }
        Ok(Source {
            path: path.to_owned(),
            document: typed(&json).map_err(|e| vec![e])?,
            json,
            layouts,
            buffers,
        })
    }

    /// The elements of an accessor as f64.
    ///
    /// # Errors
    /// An accessor that cannot be read.
    pub(super) fn numbers(&self, accessor: usize) -> Result<Elements, Diagnostic> {
        accessor::numbers(&self.layouts, &self.buffers, accessor).map_err(|e| e.in_file(&self.path))
    }

    /// The elements of an accessor of indices.
    ///
    /// # Errors
    /// An accessor that cannot be read.
    pub(super) fn indices(&self, accessor: usize) -> Result<Vec<u32>, Diagnostic> {
        accessor::indices(&self.layouts, &self.buffers, accessor).map_err(|e| e.in_file(&self.path))
    }

    /// Where the bytes of an image are. Reads its buffer if need be.
    ///
    /// # Errors
    /// A URI that leads nowhere, a buffer that is not there.
    pub(super) fn image(
        &mut self,
        loader: &mut Loader,
        index: usize,
    ) -> Result<Image<'_>, Diagnostic> {
        let place = |d: Diagnostic, part| {
            d.pointer(format!("/images/{index}{part}"))
                .in_file(&self.path)
        };
        let error = |says: String| Diagnostic::error(codes::GLTF_BUFFER, says);
        let image = items(&self.json, "images").get(index);
        if let Some(text) = image
            .and_then(|image| image.get("uri"))
            .and_then(Value::as_str)
        {
            return match uri::resolve(&self.path, text) {
                Ok(Uri::File(path)) => Ok(Image::File(path)),
                Ok(Uri::Embedded(_, bytes)) => Ok(Image::Embedded(Cow::Owned(bytes))),
                Err(bad) => Err(place(error(bad.says).hint(bad.hint), "/uri")),
            };
        }
        let view_index = image
            .and_then(|image| image.get("bufferView"))
            .and_then(natural);
        let view = view_index.and_then(|view| self.layouts.view(view));
        let (Some(view_index), Some(view)) = (view_index, view) else {
            return Err(place(error("an image without a source".into()), ""));
        };
        self.buffers
            .load(loader, &self.path, &self.json, view.buffer)
            .map_err(|e| e.in_file(&self.path))?;
        let bytes = accessor::view_bytes(&self.buffers, view, view_index);
        bytes
            .map(|bytes| Image::Embedded(Cow::Borrowed(bytes)))
            .map_err(|e| e.in_file(&self.path))
    }
}

/// Validates a file, and reads those of its buffers that the scene needs or that cost little to look at.
fn examine(
    loader: &mut Loader,
    path: &Path,
    container: Container,
    (json, layouts): (&Value, &Layouts),
    report: &mut Report,
) -> Buffers {
    let is_binary = container.is_binary();
    let uses = Uses::of(json, layouts);
    let mut buffers = Buffers::of(container, json, loader.budget());
    let mut rules = Rules {
        json,
        layouts,
        uses: &uses,
        report,
        usages: Usages::default(),
    };
    if !validate::check(&mut rules) {
        return buffers;
    }
    for index in 0..items(json, "buffers").len() {
        let needed = uses.buffers.contains(&index);
        if needed || worth_reading(json, path, index, is_binary) {
            let read = buffers.load(loader, path, json, index);
            read.unwrap_or_else(|e| rules.report.add(if needed { e } else { unneeded(e) }));
        }
    }
    validate::check_elements(&mut rules, &buffers);
    validate::check_images(&mut rules, &buffers, path);
    buffers
}

/// The JSON of a text.
fn parse(text: &str) -> Result<Value, Diagnostic> {
    serde_json::from_str(text).map_err(|e| {
        let before: usize = text
            .split_inclusive('\n')
            .take(e.line().saturating_sub(1))
            .map(str::len)
            .sum();
        let at = before + e.column().saturating_sub(1);
        let says = e.to_string();
        let says = says.split(" at line").next().unwrap_or(&says);
        Diagnostic::error(codes::GLTF_JSON, format!("not JSON: {says}"))
            .at(text, at, 1)
            .hint("export the file again as glTF 2.0")
    })
}

/// The typed document of a JSON that the validator has passed. The typed crate's own validation is the last net.
fn typed(json: &Value) -> Result<gltf::Document, Diagnostic> {
    let error = |pointer: &str, says: String| {
        Diagnostic::error(codes::GLTF_VALUE, says)
            .pointer(pointer)
            .hint("export the file again as glTF 2.0")
    };
    let read = gltf::json::deserialize::from_value(validate::strip(json));
    let root: gltf::json::Root = read.map_err(|e| error("", e.to_string()))?;
    let mut first = None;
    root.validate(&root, gltf::json::Path::new, &mut |path, flaw| {
        let path = path().to_string();
        // A primitive without positions shows nothing, and the validator has said so.
        if !path.contains("attributes[\"POSITION\"]") {
            first.get_or_insert((path, flaw));
        }
    });
    match first {
        Some((path, flaw)) => Err(error(&pointer(&path), flaw.to_string())),
        None => Ok(gltf::Document::from_json_without_validation(root)),
    }
}

/// `meshes[0].primitives[1]` as `/meshes/0/primitives/1`.
fn pointer(path: &str) -> String {
    let steps = path
        .split(['.', '[', ']', '"', ' ', '='])
        .filter(|step| !step.is_empty());
    steps.map(|step| format!("/{step}")).collect()
}

/// What is wrong with a buffer that the scene does not need.
fn unneeded(error: Diagnostic) -> Diagnostic {
    Diagnostic {
        severity: Severity::Warning,
        code: codes::GLTF_ODD_BUFFER,
        ..error
    }
}

/// Whether a buffer that the scene does not need is read for the validator: where that costs little.
fn worth_reading(json: &Value, document: &Path, index: usize, is_binary: bool) -> bool {
    /// Bytes of the largest file that is read for nothing else.
    const LARGEST: u64 = 1 << 24;
    let uri = json
        .pointer(&format!("/buffers/{index}/uri"))
        .and_then(Value::as_str);
    match uri.map(|uri| uri::resolve(document, uri)) {
        Some(Ok(Uri::File(path))) => {
            !std::fs::metadata(path).is_ok_and(|meta| meta.len() > LARGEST)
        }
        Some(_) => true,
        // Only in a GLB must it be somewhere.
        None => is_binary,
    }
}
