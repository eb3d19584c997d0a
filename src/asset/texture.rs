//! Image files to textures.
//!
//! Deliberately absent: colour profiles and EXIF orientation, which are ignored; filtering and wrapping.

use super::{Texture, codes};
use crate::diag::Diagnostic;
use image::{DynamicImage, ImageError, ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

/// Texels of the largest texture: 16384 × 8192, 402 MB. A header that claims more is refused before it is decoded.
const MAX_TEXELS: u64 = 1 << 27;

/// Bytes per texel of the widest format decoded, 16-bit RGBA.
const MAX_TEXEL_BYTES: u64 = 8;

/// Decodes a PNG or JPEG image, told apart by content, to 8-bit sRGB-encoded RGB: 16-bit values are rounded, grey is
/// repeated. Alpha is kept apart, and dropped where all of it is 255.
///
/// # Errors
/// A file that is neither, is damaged, or is larger than 2^27 texels.
pub(super) fn decode(path: &Path, bytes: &[u8]) -> Result<Texture, Diagnostic> {
    let error = |code, says: String| Diagnostic::error(code, says).in_file(path);
    let format = image::guess_format(bytes).ok();
    let format = match format {
        Some(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
        Some(ImageFormat::Hdr) => {
            let says = "an HDR image holds radiance, and cannot be a colour texture";
            return Err(error(codes::IMAGE_FORMAT, says.into()).hint("convert it to PNG"));
        }
        _ => {
            let says = "neither a PNG nor a JPEG image";
            return Err(error(codes::IMAGE_FORMAT, says.into()).hint("convert it to PNG"));
        }
    };
    let corrupt = |e: ImageError| error(codes::IMAGE_CORRUPT, format!("damaged image: {e}"));
    let reader = || ImageReader::with_format(Cursor::new(bytes), format);
    let (width, height) = reader().into_dimensions().map_err(corrupt)?;
    let texels = u64::from(width) * u64::from(height);
    if texels == 0 {
        return Err(error(
            codes::IMAGE_CORRUPT,
            format!("empty image: {width} x {height}"),
        ));
    }
    if texels > MAX_TEXELS {
        let says = format!("the image is {width} x {height}: more than {MAX_TEXELS} texels");
        return Err(error(codes::TOO_LARGE, says).hint("scale it down"));
    }
    let mut decoder = reader();
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_TEXELS * MAX_TEXEL_BYTES);
    decoder.limits(limits);
    let image = decoder.decode().map_err(corrupt)?;
    let (texels, alpha) = split(image);
    Ok(Texture {
        path: path.to_owned(),
        width,
        height,
        texels,
        alpha,
    })
}

/// Colour and alpha, each in its own plane.
fn split(image: DynamicImage) -> (Arc<[u8]>, Option<Arc<[u8]>>) {
    if !image.color().has_alpha() {
        return (image.into_rgb8().into_raw().into(), None);
    }
    let rgba = image.into_rgba8().into_raw();
    let (texels, _) = rgba.as_chunks::<4>();
    let mut rgb = Vec::with_capacity(3 * texels.len());
    for [r, g, b, _] in texels {
        rgb.extend_from_slice(&[*r, *g, *b]);
    }
    let transparent = texels.iter().any(|[.., a]| *a != u8::MAX);
    let alpha = || texels.iter().map(|[.., a]| *a).collect();
    (rgb.into(), transparent.then(alpha))
}
