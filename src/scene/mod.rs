//! Text to [`SceneDesc`]: the scene format, every default and unit, and errors with their places.
//!
//! Enters: a RON file. Leaves: a [`SceneDesc`] whose names resolve and whose numbers are finite and in range, or every
//! error at once. Stages: `layer` cuts the text with its places, `reader` and `values` know types and ranges,
//! `background`, `settings`, `material`, `entity`, `light` and `motion` know the format, `resolve` what concerns several parts.
//!
//! Deliberately absent: hecs, pixels, the contents of asset files.

mod background;
mod entity;
mod layer;
mod light;
mod material;
mod motion;
mod reader;
mod resolve;
pub mod schema;
mod settings;
mod split;
mod srgb;
mod syntax;
mod values;
mod write;

pub use schema::*;
pub use write::write;

use crate::diag::{Diagnostic, Severity, codes};
use entity::RawEntity;
use layer::{LayerError, Node};
use reader::{Fields, Reader};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[cfg(test)]
mod tests;

/// The version of the format that this reader knows.
pub const VERSION: u32 = 1;

/// A scene file that was read, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub desc: SceneDesc,
    /// Warnings, in the order of the text.
    pub warnings: Vec<Diagnostic>,
}

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file does not exist.
    #[error("{}: no such file", .0.display())]
    Missing(PathBuf),
    /// The file exists but cannot be read.
    #[error("{}: {source}", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is not a scene: every error and warning, in the order of the text, and what could be read of it in
    /// spite of them, for a look at the files that it names.
    #[error("the scene has errors")]
    Invalid(Vec<Diagnostic>, Option<Box<SceneDesc>>),
}

/// Reads and checks a scene file.
///
/// # Errors
/// [`LoadError`]: the file is missing, unreadable, or not a scene.
pub fn load(path: &Path) -> Result<Loaded, LoadError> {
    let bytes = read(path).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => LoadError::Missing(path.to_owned()),
        _ => LoadError::Unreadable {
            path: path.to_owned(),
            source,
        },
    })?;
    let source = match std::str::from_utf8(&bytes) {
        Ok(text) => source(text),
        Err(error) => {
            let found = vec![not_text(&bytes, error.valid_up_to(), path)];
            return Err(LoadError::Invalid(found, None));
        }
    };
    drop(bytes);
    match read_text(&source, path) {
        (Some(desc), found) if !has_errors(&found) => Ok(Loaded {
            desc,
            warnings: found,
        }),
        (desc, found) => Err(LoadError::Invalid(found, desc.map(Box::new))),
    }
}

/// The bytes of a scene file, which may be a pipe.
fn read(path: &Path) -> std::io::Result<Vec<u8>> {
    /// A device that never ends must not fill the memory. Millions of entities fit.
    const MAX_BYTES: u64 = 1 << 30;
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path)?;
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(std::io::Error::other("it is longer than 1 GiB"));
    }
    Ok(bytes)
}

/// Reads and checks the text of a scene. `file` is what diagnostics name and what paths are relative to; it is not
/// opened. Gives the scene and its warnings.
///
/// # Errors
/// Every error of the scene, among its warnings, in the order of the text; of errors of syntax only the first.
pub fn parse(text: &str, file: &Path) -> Result<(SceneDesc, Vec<Diagnostic>), Vec<Diagnostic>> {
    match read_text(&source(text), file) {
        (Some(desc), found) if !has_errors(&found) => Ok((desc, found)),
        (_, found) => Err(found),
    }
}

fn has_errors(found: &[Diagnostic]) -> bool {
    found.iter().any(|d| d.severity == Severity::Error)
}

/// The text of a scene as it is kept.
fn source(text: &str) -> Arc<str> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    // A comment in the last line needs its line end.
    if text.ends_with('\n') {
        text.into()
    } else {
        format!("{text}\n").into()
    }
}

/// What can be read of a scene, and everything that there is to say about it.
fn read_text(source: &Arc<str>, file: &Path) -> (Option<SceneDesc>, Vec<Diagnostic>) {
    let reader = Reader::new(source, file);
    let desc = match Node::document(source) {
        Ok(document) => scene(&reader, document, source),
        Err(LayerError::Syntax(error, at)) => {
            reader.report(syntax::diagnostic(&error, at, source, file));
            None
        }
        Err(LayerError::OtherKind) => None,
    };
    (desc, reader.into_found())
}

fn scene<'a>(reader: &Reader<'a>, document: Node<'a>, source: &Arc<str>) -> Option<SceneDesc> {
    let body = match document.head() {
        (Some("Scene"), body) => body,
        (None, body) => body,
        (Some(_), _) => return reader.wrong_type(document.head_place(), "the file", "`Scene(..)`"),
    };
    let known = [
        "version",
        "camera",
        "render",
        "background",
        "materials",
        "entities",
        "animation",
    ];
    let fields = Fields::read(reader, body, "`Scene`", &known)?;
    fields.require("version", version);
    let render = fields.read_or("render", RenderDesc::default(), settings::render);
    let background = fields.read_or(
        "background",
        BackgroundDesc::Linear(SceneDesc::BACKGROUND),
        background::background,
    );
    let camera = fields.read_if("camera", settings::camera);
    let materials = fields.read_or("materials", Vec::new(), material::materials);
    let animation = fields.read_or("animation", AnimationDesc::default(), settings::animation);
    let mut entities = fields.read_or("entities", Vec::new(), entities);
    resolve::resolve(reader, &mut entities, &materials);
    resolve::check_cameras(reader, fields.get("camera"), &entities);
    let placed = |e: RawEntity<'_>| Placed {
        value: e.desc,
        at: e.node.at,
        len: e.node.text.len(),
    };
    let mut entities: Vec<_> = entities.into_iter().map(placed).collect();
    // They were collected in place, where what is read of an entity took more.
    entities.shrink_to_fit();
    Some(SceneDesc {
        file: reader.file.to_owned(),
        source: Arc::clone(source),
        render,
        background,
        camera,
        materials,
        entities,
        animation,
    })
}

fn version<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<()> {
    let version = reader.whole(node, "`version`", 0, u32::MAX)?;
    if version != VERSION {
        let message = format!("version {version} of the scene format is not known");
        reader.error_hint(
            codes::UNKNOWN_VERSION,
            node,
            message,
            format!("this program reads version {VERSION}"),
        );
    }
    Some(())
}

fn entities<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<Vec<RawEntity<'a>>> {
    let nodes = reader.layer(node, node.list(), "`entities`", "a list [(..), ..]")?;
    Some(
        nodes
            .into_iter()
            .filter_map(|n| entity::entity(reader, n))
            .collect(),
    )
}

fn not_text(bytes: &[u8], valid: usize, path: &Path) -> Diagnostic {
    let text = String::from_utf8_lossy(bytes);
    Diagnostic::error(codes::NOT_TEXT, "the file is not UTF-8 text")
        .in_file(path)
        .at(&text, valid, 1)
        .hint("save it as UTF-8")
}

impl SceneDesc {
    /// The bytes (offset and length in [`SceneDesc::source`]) of a component of an entity, such as `"material"`;
    /// `None` where it is not written.
    #[must_use]
    pub fn place(&self, entity: usize, component: &str) -> Option<(usize, usize)> {
        let Placed { at, len, .. } = *self.entities.get(entity)?;
        let text = self.source.get(at..at + len)?;
        let place = Node { text, at }.field(component)?;
        Some((place.at, place.text.len()))
    }

    /// The bytes of a setting such as `["render", "spp"]`; `None` where it is not written.
    #[must_use]
    pub fn setting_place(&self, path: &[&str]) -> Option<(usize, usize)> {
        let document = Node::document(&self.source).ok()?;
        let place = path
            .iter()
            .try_fold(document, |node, name| node.field(name))?;
        Some((place.at, place.text.len()))
    }
}
