//! The images that the materials of a file read: located, decoded once each, in parallel.
//!
//! Enter: indices of images, for colour or for gloss. Leave: textures in the store, and the means of images that are
//! only averaged. An image that nothing reads is not even looked for; a missing file is a warning, a damaged one an error.

use super::notes::Notes;
use super::source::{Image, Source};
use crate::asset::{Loader, Texture, TextureId, codes, texture};
use crate::diag::Diagnostic;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Indices of the images that materials read.
#[derive(Debug, Default)]
pub(super) struct Wanted {
    /// As colour, texel by texel.
    pub(super) colors: BTreeSet<usize>,
    /// As roughness and metalness, of which luxel takes the mean.
    pub(super) gloss: BTreeSet<usize>,
}

/// Means of the channels of a metallic-roughness texture, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gloss {
    /// Green (section 3.9.2).
    pub(super) roughness: f64,
    /// Blue.
    pub(super) metallic: f64,
}

/// The images that were found.
#[derive(Debug, Default)]
pub(super) struct Images {
    colors: BTreeMap<usize, TextureId>,
    gloss: BTreeMap<usize, Gloss>,
}

impl Images {
    /// An image as a texture; `None` where its file is missing.
    pub(super) fn texture(&self, image: usize) -> Option<TextureId> {
        self.colors.get(&image).copied()
    }

    /// The means of an image; `None` where its file is missing.
    pub(super) fn gloss(&self, image: usize) -> Option<Gloss> {
        self.gloss.get(&image).copied()
    }
}

/// The encoded bytes of an image.
struct Encoded {
    /// Indices in the glTF file: it may list one file more than once.
    images: Vec<usize>,
    /// The file, if it is one of its own.
    file: Option<PathBuf>,
    bytes: Vec<u8>,
}

/// Reads and decodes images.
///
/// # Errors
/// Images that are damaged, of an unsuitable format or too large, or whose bytes are out of reach.
pub(super) fn read(
    loader: &mut Loader,
    source: &mut Source,
    wanted: &Wanted,
    notes: &mut Notes,
) -> Result<Images, Vec<Diagnostic>> {
    let mut images = Images::default();
    let mut errors = Vec::new();
    let mut encoded = Vec::new();
    for &image in wanted.colors.union(&wanted.gloss) {
        match locate(loader, source, image, &mut encoded, notes) {
            Ok(Some(known)) => images.keep(wanted, image, loader.loaded_texture(known), known),
            Ok(None) => {}
            Err(error) => errors.push(error),
        }
    }
    let opened: Vec<_> = encoded
        .iter()
        .map(|one| loader.open_image(one.file.as_ref().unwrap_or(&source.path), &one.bytes))
        .collect();
    let decode = |image: Result<texture::Image<'_>, Diagnostic>| image?.decode();
    let decoded: Vec<_> = opened.into_par_iter().map(decode).collect();
    for (one, decoded) in encoded.iter().zip(decoded) {
        match decoded {
            Ok(texture) => images.keep_new(loader, wanted, one, texture),
            Err(error) => errors.push(at_image(error, source, one)),
        }
    }
    if errors.is_empty() {
        Ok(images)
    } else {
        Err(errors)
    }
}

impl Images {
    /// Notes what is wanted of an image that is in the store.
    fn keep(&mut self, wanted: &Wanted, image: usize, texture: &Texture, id: TextureId) {
        if wanted.colors.contains(&image) {
            self.colors.insert(image, id);
        }
        if wanted.gloss.contains(&image) {
            self.gloss.insert(image, mean(texture));
        }
    }

    /// Notes what is wanted of a decoded image, and stores it unless its means are all.
    fn keep_new(&mut self, loader: &mut Loader, wanted: &Wanted, of: &Encoded, texture: Texture) {
        if !of.images.iter().any(|image| wanted.colors.contains(image)) {
            let mean = mean(&texture);
            self.gloss
                .extend(of.images.iter().map(|&image| (image, mean)));
            return;
        }
        let id = loader.keep_texture(texture, of.file.as_deref());
        for &image in &of.images {
            self.keep(wanted, image, loader.loaded_texture(id), id);
        }
    }
}

/// Finds an image: in the store, or else its bytes, which join `encoded`. A missing file is said, and gives neither.
fn locate(
    loader: &mut Loader,
    source: &mut Source,
    image: usize,
    encoded: &mut Vec<Encoded>,
    notes: &mut Notes,
) -> Result<Option<TextureId>, Diagnostic> {
    let file = match source.image(loader, image)? {
        Image::Embedded(bytes) => {
            encoded.push(Encoded {
                images: vec![image],
                file: None,
                bytes: bytes.into_owned(),
            });
            return Ok(None);
        }
        Image::File(file) => file,
    };
    if let Some(Ok(texture)) = loader.known_texture(&file) {
        return Ok(Some(texture));
    }
    let same = |one: &&mut Encoded| one.file.as_ref() == Some(&file);
    if let Some(same) = encoded.iter_mut().find(same) {
        same.images.push(image);
        return Ok(None);
    }
    let pointer = format!("/images/{image}/uri");
    if !file.is_file() {
        notes.tell(missing(loader, &file).pointer(pointer));
        return Ok(None);
    }
    let bytes = loader.read(&file).map_err(|error| {
        let message = format!("{}: {}", file.display(), error.message);
        Diagnostic { message, ..error }
            .in_file(&source.path)
            .pointer(pointer)
    })?;
    encoded.push(Encoded {
        images: vec![image],
        file: Some(file),
        bytes,
    });
    Ok(None)
}

fn missing(loader: &mut Loader, file: &Path) -> Diagnostic {
    let says = format!(
        "the image {} is missing: materials keep their plain colour",
        file.display()
    );
    let warning = Diagnostic::warning(codes::GLTF_IMAGE_MISSING, says);
    match loader.similar(file) {
        Some(similar) => warning.hint(format!("did you mean \"{similar}\"?")),
        None => warning.hint("put it where the glTF file says"),
    }
}

/// An error of decoding, at the place in the glTF file.
fn at_image(error: Diagnostic, source: &Source, of: &Encoded) -> Diagnostic {
    let image = of.images.first().copied().unwrap_or_default();
    let (message, pointer) = match &of.file {
        Some(file) => {
            let message = format!("{}: {}", file.display(), error.message);
            (message, format!("/images/{image}/uri"))
        }
        None => (error.message, format!("/images/{image}")),
    };
    let error = Diagnostic { message, ..error };
    error.in_file(&source.path).pointer(pointer)
}

fn mean(texture: &Texture) -> Gloss {
    let (texels, _) = texture.texels.as_chunks::<3>();
    let sum = |channel: usize| -> u64 { texels.iter().map(|t| u64::from(t[channel])).sum() };
    let most = f64::from(u8::MAX) * texels.len().max(1) as f64;
    Gloss {
        roughness: sum(1) as f64 / most,
        metallic: sum(2) as f64 / most,
    }
}
