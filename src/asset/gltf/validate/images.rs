//! Rules of what images hold (specification, section 3.8.2): PNG or JPEG, of the type that is declared.
//!
//! Images that the scene uses are decoded elsewhere, where what is wrong with them is an error; of the others only the
//! headers are read.

use super::Rules;
use super::extensions::declared;
use crate::asset::codes;
use crate::asset::gltf::accessor::view_bytes;
use crate::asset::gltf::buffers::Buffers;
use crate::asset::gltf::layout::items;
use crate::asset::gltf::uri::{self, Uri};
use crate::asset::gltf::uses::index;
use crate::asset::paths::similar_file;
use crate::diag::Diagnostic;
use image::{ImageFormat, ImageReader};
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::Path;

/// Missing files for which the folder is searched for a similar name.
const MAX_GUESSES: usize = 10;

/// Checks every image of a file.
pub(in crate::asset::gltf) fn check(rules: &mut Rules, buffers: &Buffers, document: &Path) {
    let mut guesses = 0;
    for (i, image) in items(rules.json, "images").iter().enumerate() {
        let mime = image.get("mimeType").and_then(Value::as_str);
        if let Some(text) = image.get("uri").and_then(Value::as_str) {
            match uri::resolve(document, text) {
                Ok(Uri::Embedded(media, bytes)) => {
                    let mime = mime.unwrap_or(&media);
                    content(rules, i, Some(mime), Cursor::new(bytes));
                }
                Ok(Uri::File(path)) => in_file(rules, i, mime, &path, &mut guesses),
                Err(bad) => {
                    if !rules.uses.images.contains(&i) {
                        let found = Diagnostic::warning(codes::GLTF_IMAGE, bad.says);
                        rules
                            .report
                            .add(found.pointer(format!("/images/{i}/uri")).hint(bad.hint));
                    }
                }
            }
        } else if let Some(view_index) = index(image, "bufferView")
            && let Some(view) = rules.layouts.view(view_index)
            && let Ok(bytes) = view_bytes(buffers, view, view_index)
        {
            content(rules, i, mime, Cursor::new(bytes));
        }
    }
}

fn in_file(rules: &mut Rules, i: usize, mime: Option<&str>, path: &Path, guesses: &mut usize) {
    match open(path) {
        Ok(file) => content(rules, i, mime, BufReader::new(file)),
        Err(_) if rules.uses.images.contains(&i) => {}
        Err(e) => {
            let says = format!("{} cannot be read: {e}", path.display());
            let found =
                Diagnostic::warning(codes::GLTF_IMAGE, says).pointer(format!("/images/{i}/uri"));
            *guesses += 1;
            let similar = (*guesses <= MAX_GUESSES).then(|| similar_file(path));
            rules.report.add(match similar.flatten() {
                Some(name) => found.hint(format!("did you mean \"{name}\"?")),
                None => found,
            });
        }
    }
}

/// Opens a regular file: a pipe might never answer.
fn open(path: &Path) -> std::io::Result<File> {
    match std::fs::metadata(path)?.is_file() {
        true => File::open(path),
        false => Err(std::io::Error::other("this is not a file")),
    }
}

/// The header of an image against what is declared.
fn content(rules: &mut Rules, i: usize, mime: Option<&str>, bytes: impl BufRead + Seek) {
    let pointer = format!("/images/{i}");
    let Ok(reader) = ImageReader::new(bytes).with_guessed_format() else {
        return;
    };
    let declared = match mime {
        Some("image/png") => Some(ImageFormat::Png),
        Some("image/jpeg") => Some(ImageFormat::Jpeg),
        _ => None,
    };
    let format = reader.format();
    if let (Some(declared), Some(format)) = (declared, format)
        && declared != format
    {
        let (is, says) = (format.to_mime_type(), declared.to_mime_type());
        let says = format!("the image is {is}, and is declared {says}");
        rules.warn(codes::GLTF_IMAGE, &pointer, says);
    }
    match format {
        _ if rules.uses.images.contains(&i) => {}
        Some(ImageFormat::Png | ImageFormat::Jpeg) => {
            if let Err(e) = reader.into_dimensions() {
                rules.warn(codes::GLTF_IMAGE, pointer, format!("damaged image: {e}"));
            }
        }
        Some(other) if !has_extension(rules, other) => {
            let says = format!(
                "the image is {}, neither PNG nor JPEG",
                other.to_mime_type()
            );
            rules.warn(codes::GLTF_IMAGE, pointer, says);
        }
        _ => {}
    }
}

/// Whether the file declares the extension that allows images of a format.
fn has_extension(rules: &Rules, format: ImageFormat) -> bool {
    let name = match format {
        ImageFormat::WebP => "EXT_texture_webp",
        ImageFormat::Avif => "EXT_texture_avif",
        ImageFormat::Dds => "MSFT_texture_dds",
        _ => return false,
    };
    declared(rules.json).contains(name)
}
