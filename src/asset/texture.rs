//! Image files to textures: first what the header claims, then, when there is memory for it, the texels.
//!
//! Deliberately absent: colour profiles and EXIF orientation, which are ignored; filtering and wrapping.

use super::{Texture, codes};
use crate::diag::Diagnostic;
use image::codecs::jpeg::JpegDecoder;
use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageResult, Limits};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

/// Bytes per texel while colour and alpha are told apart: both together and each for itself.
const SPLIT_BYTES: u64 = 8;

/// What a colour profile of a PNG image may unpack to: the largest in use take some 2 MiB. A larger one is skipped, as all
/// profiles are later.
const PNG_PROFILE_BYTES: u64 = 4 << 20;
/// Where the width stands in a PNG image (PNG third edition, sections 5.2 and 11.2.1), and the largest texel.
const PNG_WIDTH: std::ops::Range<usize> = 16..20;
const PNG_TEXEL_BYTES: u64 = 8;

/// An image of which only the header was read.
pub(super) struct Image<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    format: ImageFormat,
    width: u32,
    height: u32,
    has_alpha: bool,
    /// Bytes of the texels as the file has them.
    decoded: u64,
}

impl<'a> Image<'a> {
    /// Reads the header of a PNG or JPEG image, told apart by content.
    ///
    /// # Errors
    /// A file that is neither, or whose header is damaged.
    pub(super) fn open(path: &'a Path, bytes: &'a [u8]) -> Result<Image<'a>, Diagnostic> {
        let error = |code, says: &str| Diagnostic::error(code, says).in_file(path);
        let unsuitable = |says| error(codes::IMAGE_FORMAT, says).hint("convert it to PNG");
        let format = match image::guess_format(bytes) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
            Ok(ImageFormat::Hdr) => {
                let says = "an HDR image holds radiance, and cannot be a colour texture";
                return Err(unsuitable(says));
            }
            _ => return Err(unsuitable("neither a PNG nor a JPEG image")),
        };
        let header = decoder(bytes, format);
        let header = header.map_err(|e| corrupt(path, &e))?;
        let (width, height) = header.dimensions();
        if width == 0 || height == 0 {
            let says = format!("empty image: {width} x {height}");
            return Err(error(codes::IMAGE_CORRUPT, &says));
        }
        Ok(Image {
            path,
            bytes,
            format,
            width,
            height,
            has_alpha: header.color_type().has_alpha(),
            decoded: header.total_bytes(),
        })
    }

    /// What it claims to be.
    pub(super) fn says(&self) -> String {
        format!("the image of {} x {} texels", self.width, self.height)
    }

    /// Bytes of the texture.
    pub(super) fn kept(&self) -> u64 {
        self.texels()
            .saturating_mul(if self.has_alpha { 4 } else { 3 })
    }

    /// Bytes while it is decoded, its file included.
    pub(super) fn passing(&self) -> u64 {
        let split = self.texels().saturating_mul(SPLIT_BYTES);
        let file = self.bytes.len() as u64;
        self.decoded.saturating_add(split).saturating_add(file)
    }

    fn texels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Decodes to 8-bit sRGB-encoded RGB: 16-bit values are rounded, grey is repeated. Alpha is kept if the image has one
    /// that is not opaque everywhere.
    ///
    /// # Errors
    /// A damaged file.
    pub(super) fn decode(self) -> Result<Texture, Diagnostic> {
        let image = decoder(self.bytes, self.format).and_then(DynamicImage::from_decoder);
        let image = image.map_err(|e| corrupt(self.path, &e))?;
        let (texels, alpha) = if self.has_alpha {
            split(&image.into_rgba8())
        } else {
            (image.into_rgb8().into_raw(), None)
        };
        Ok(Texture {
            path: self.path.to_owned(),
            width: self.width,
            height: self.height,
            texels: texels.into(),
            alpha,
        })
    }
}

/// Reads the header. Memory for the texels is charged before they are decoded; that for what else a PNG image may hold is
/// limited here, since a profile of a thousand bytes can unpack to a million.
fn decoder(bytes: &[u8], format: ImageFormat) -> ImageResult<Box<dyn ImageDecoder + '_>> {
    let reader = Cursor::new(bytes);
    if format == ImageFormat::Jpeg {
        return Ok(Box::new(JpegDecoder::new(reader)?));
    }
    let mut limits = Limits::no_limits();
    let width = bytes.get(PNG_WIDTH).and_then(|bytes| bytes.try_into().ok());
    let row = PNG_TEXEL_BYTES * u64::from(width.map_or(0, u32::from_be_bytes));
    // Texts stay as they are packed; their buffer grows by doubling before they are copied out of it.
    limits.max_alloc = Some(PNG_PROFILE_BYTES + 3 * bytes.len() as u64 + row);
    Ok(Box::new(PngDecoder::with_limits(reader, limits)?))
}

fn corrupt(path: &Path, error: &ImageError) -> Diagnostic {
    Diagnostic::error(codes::IMAGE_CORRUPT, format!("damaged image: {error}")).in_file(path)
}

/// Colour, and alpha unless it is opaque everywhere.
fn split(image: &[u8]) -> (Vec<u8>, Option<Arc<[u8]>>) {
    let texels = image.as_chunks::<4>().0;
    let colors = texels
        .iter()
        .flat_map(|[r, g, b, _]| [*r, *g, *b])
        .collect();
    let opaque = texels.iter().all(|texel| texel[3] == u8::MAX);
    let alpha = || texels.iter().map(|texel| texel[3]).collect();
    (colors, (!opaque).then(alpha))
}
