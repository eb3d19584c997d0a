//! Images of the sky: Radiance HDR and OpenEXR, first what the header claims, then, when there is memory for it, radiance.
//!
//! Deliberately absent: colour spaces (the primaries are taken as those of Rec. 709), layers but the first with colours,
//! alpha, and which texel is where in the sky.

use super::codes;
use crate::diag::Diagnostic;
use ::exr::meta::MetaData;
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers, read};
use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;
use std::fmt::Display;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest radiance: sums and products of a path still fit single precision.
pub const MAX_RADIANCE: f32 = 1e18;

/// First bytes of a Radiance picture ("The RADIANCE Picture File Format"); some programs write another name behind them.
const HDR_SIGNATURE: &[u8] = b"#?";
const HDR_NAME: &[u8] = b"#?RADIANCE";
/// First bytes of an OpenEXR file (OpenEXR file layout, "magic number").
const EXR_SIGNATURE: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

const TEXEL_BYTES: u64 = size_of::<[f32; 3]>() as u64;

/// Radiance by direction, as an image of longitudes and latitudes.
#[derive(Clone, Debug)]
pub struct Panorama {
    /// The file.
    pub path: PathBuf,
    /// Texels per row.
    pub width: u32,
    /// Rows; row 0 is the top of the sky.
    pub height: u32,
    /// Linear R, G, B, row by row from the top, each from 0 to [`MAX_RADIANCE`]; length `width * height`.
    pub texels: Arc<[[f32; 3]]>,
}

impl Panorama {
    /// The largest number of all texels.
    #[must_use]
    pub fn brightest(&self) -> f32 {
        let all = self.texels.as_flattened();
        all.iter()
            .fold(0.0, |most, c| if *c > most { *c } else { most })
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Format {
    Hdr,
    Exr,
}

/// An image of which only the header was read.
pub(super) struct Image<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    format: Format,
    width: u32,
    height: u32,
}

impl<'a> Image<'a> {
    /// Reads the header of an image, its format told by its content.
    ///
    /// # Errors
    /// A file of another format, or whose header is damaged.
    pub(super) fn open(path: &'a Path, bytes: &'a [u8]) -> Result<Image<'a>, Diagnostic> {
        let (format, size) = if bytes.starts_with(HDR_SIGNATURE) {
            let header = hdr(bytes).map_err(|e| corrupt(path, &e))?;
            (Format::Hdr, header.dimensions())
        } else if bytes.starts_with(EXR_SIGNATURE) {
            (Format::Exr, exr_size(path, bytes)?)
        } else {
            let says = "neither a Radiance HDR nor an OpenEXR image";
            let hint = "an image of the sky holds radiance, which 8-bit formats cannot: save it as .hdr or .exr";
            return Err(unsuitable(path, says, hint));
        };
        let (width, height) = size;
        if width == 0 || height == 0 {
            return Err(corrupt(path, &format!("{width} x {height} texels")));
        }
        Ok(Image {
            path,
            bytes,
            format,
            width,
            height,
        })
    }

    /// What it claims to be.
    pub(super) fn says(&self) -> String {
        format!("the sky of {} x {} texels", self.width, self.height)
    }

    /// Bytes of the texels.
    pub(super) fn kept(&self) -> u64 {
        (u64::from(self.width) * u64::from(self.height)).saturating_mul(TEXEL_BYTES)
    }

    /// Bytes while it is decoded, its file included.
    pub(super) fn passing(&self) -> u64 {
        let twice = self.kept().saturating_mul(2);
        twice.saturating_add(self.bytes.len() as u64)
    }

    /// A warning where it hardly shows all directions.
    pub(super) fn odd_shape(&self) -> Option<Diagnostic> {
        let square = u64::from(self.width) == 2 * u64::from(self.height);
        (!square).then(|| {
            let says = format!(
                "an image of the whole sky is twice as wide as high, and this has {} x {} texels: it is stretched",
                self.width, self.height
            );
            Diagnostic::warning(codes::NOT_A_PANORAMA, says)
                .in_file(self.path)
                .hint("use one in latitude-longitude (equirectangular) projection")
        })
    }

    /// Decodes to linear radiance.
    ///
    /// # Errors
    /// A damaged file; texels that are no radiance.
    pub(super) fn decode(self) -> Result<Panorama, Diagnostic> {
        let texels = match self.format {
            Format::Hdr => decode_hdr(self.bytes),
            Format::Exr => decode_exr(self.bytes),
        };
        let texels = texels.map_err(|e| corrupt(self.path, &e))?;
        // Both decoders fill what the header claims.
        if texels.len() as u64 * TEXEL_BYTES != self.kept() {
            return Err(corrupt(self.path, &"it has another size than it says"));
        }
        self.check(&texels)?;
        Ok(Panorama {
            path: self.path.to_owned(),
            width: self.width,
            height: self.height,
            texels: texels.into(),
        })
    }

    /// Refuses texels that are no radiance, naming the first.
    fn check(&self, texels: &[[f32; 3]]) -> Result<(), Diagnostic> {
        let wrong = |texel: &&[f32; 3]| !texel.iter().all(|c| (0.0..=MAX_RADIANCE).contains(c));
        let Some(first) = texels.iter().position(|texel| wrong(&texel)) else {
            return Ok(());
        };
        let count = texels.iter().filter(wrong).count();
        let [r, g, b] = texels[first];
        let (x, y) = (first % self.width as usize, first / self.width as usize);
        let more = match count {
            1 => String::new(),
            n => format!(", and {} more are such", n - 1),
        };
        let says = format!(
            "the pixel ({x}, {y}) is ({r}, {g}, {b}), but radiance is from 0 to {MAX_RADIANCE:e}{more}"
        );
        let hint = "repair it, for instance by `oiiotool sky.exr --fixnan box3 --clamp:min=0 -o sky_fixed.exr`";
        Err(Diagnostic::error(codes::BAD_RADIANCE, says)
            .in_file(self.path)
            .hint(hint))
    }
}

fn corrupt(path: &Path, error: &dyn Display) -> Diagnostic {
    Diagnostic::error(codes::IMAGE_CORRUPT, format!("damaged image: {error}")).in_file(path)
}

fn unsuitable(path: &Path, says: &str, hint: &str) -> Diagnostic {
    Diagnostic::error(codes::IMAGE_FORMAT, says)
        .in_file(path)
        .hint(hint)
}

fn hdr(bytes: &[u8]) -> Result<HdrDecoder<&[u8]>, String> {
    // Only the usual name passes for a signature where one is asked for.
    HdrDecoder::with_strictness(bytes, bytes.starts_with(HDR_NAME)).map_err(|e| e.to_string())
}

/// The numbers of the file are radiance times its exposures and colour corrections, which are taken out again.
fn decode_hdr(bytes: &[u8]) -> Result<Vec<[f32; 3]>, String> {
    let decoder = hdr(bytes)?;
    let header = decoder.metadata();
    let exposure = header.exposure.unwrap_or(1.0);
    let (r, g, b) = header.color_correction.unwrap_or((1.0, 1.0, 1.0));
    let mut raw = vec![0; decoder.total_bytes() as usize];
    decoder.read_image(&mut raw).map_err(|e| e.to_string())?;
    let floats = raw.as_chunks::<4>().0.as_chunks::<3>().0;
    Ok(floats
        .iter()
        .map(|texel| {
            let [x, y, z] = texel.map(f32::from_ne_bytes);
            [x / (exposure * r), y / (exposure * g), z / (exposure * b)]
        })
        .collect())
}

/// Width and height of the first layer that has colours.
fn exr_size(path: &Path, bytes: &[u8]) -> Result<(u32, u32), Diagnostic> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false);
    let meta = meta.map_err(|e| corrupt(path, &e))?;
    let has = |layer: &Header, name: &str| layer.channels.list.iter().any(|c| c.name == *name);
    let colored = |layer: &&Header| ["R", "G", "B"].iter().all(|name| has(layer, name));
    let Some(layer) = meta.headers.iter().find(colored) else {
        let says = "no layer of the OpenEXR image has the channels R, G and B";
        return Err(unsuitable(path, says, "save it in RGB"));
    };
    let window = layer.shared_attributes.display_window;
    if window.size != layer.layer_size || window.position != layer.own_attributes.layer_position {
        let says = "the OpenEXR image is cropped: its data window is not its display window";
        let hint =
            "save all of it, for instance by `oiiotool sky.exr --croptofull -o sky_full.exr`";
        return Err(unsuitable(path, says, hint));
    }
    let side = |n: usize| u32::try_from(n).map_err(|e| corrupt(path, &e));
    Ok((
        side(layer.layer_size.width())?,
        side(layer.layer_size.height())?,
    ))
}

fn decode_exr(bytes: &[u8]) -> Result<Vec<[f32; 3]>, String> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (size.width(), vec![[0.0f32; 3]; size.area()]),
            |(width, texels), at, (r, g, b): (f32, f32, f32)| {
                texels[at.y() * *width + at.x()] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| e.to_string())?;
    Ok(image.layer_data.channel_data.pixels.1)
}
