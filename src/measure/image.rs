//! Images as measuring needs them: linear R, G, B in f32, read from PNG or EXR.

use crate::math::srgb_to_linear;
use ::exr::meta::MetaData;
use ::exr::prelude::{ReadChannels, ReadLayers, read};
use std::fmt::Display;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// First bytes of a PNG file (PNG specification, 5.2).
const PNG_SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
/// First bytes of an OpenEXR file (OpenEXR file layout, "magic number").
const EXR_SIGNATURE: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// Most pixels of an image, as of a render.
const MAX_PIXELS: u64 = 1 << 27;

/// Linear light by rows from the top. Never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: usize,
    pixels: Vec<[f32; 3]>,
}

/// Why a file is no image.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file cannot be read at all.
    #[error("cannot read \"{}\": {cause}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        cause: std::io::Error,
    },
    /// It can, but it holds no image that can be measured.
    #[error("\"{}\" is no image to measure: {reason}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
}

impl Image {
    /// Rows of `width` pixels; `None` if that is not a whole number of rows, at least one.
    #[must_use]
    pub fn new(width: usize, pixels: Vec<[f32; 3]>) -> Option<Image> {
        let whole = width > 0 && !pixels.is_empty() && pixels.len().is_multiple_of(width);
        whole.then_some(Image { width, pixels })
    }

    /// Reads a PNG or an EXR, told by its first bytes.
    ///
    /// A PNG is taken as sRGB-encoded, whatever it says of itself, and decoded; grey counts as three equal channels,
    /// alpha is left out. Of an EXR, the channels `R`, `G`, `B` of the first layer that has them are taken as they are.
    ///
    /// # Errors
    /// If the file cannot be read or holds no such image.
    pub fn read(path: &Path) -> Result<Image, ReadError> {
        let bytes = std::fs::read(path).map_err(|cause| ReadError::File {
            path: path.to_owned(),
            cause,
        })?;
        decode(&bytes).map_err(|reason| ReadError::Content {
            path: path.to_owned(),
            reason,
        })
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.pixels.len() / self.width
    }

    /// By rows from the top.
    #[must_use]
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }
}

fn decode(bytes: &[u8]) -> Result<Image, String> {
    if bytes.starts_with(&PNG_SIGNATURE) {
        decode_png(bytes)
    } else if bytes.starts_with(&EXR_SIGNATURE) {
        decode_exr(bytes)
    } else {
        Err("it is neither a PNG nor an EXR file".to_owned())
    }
}

fn decode_png(bytes: &[u8]) -> Result<Image, String> {
    let mut decoder = ::png::Decoder::new(Cursor::new(bytes));
    // Palettes become colours, and less than 8 bits become 8.
    decoder.set_transformations(::png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(of_format("PNG"))?;
    let (width, height) = reader.info().size();
    check_size(width.into(), height.into())?;
    let size = reader.output_buffer_size();
    let mut samples = vec![0; size.ok_or("it is too large")?];
    let frame = reader.next_frame(&mut samples).map_err(of_format("PNG"))?;
    samples.truncate(frame.buffer_size());
    let encoded: Vec<f64> = match frame.bit_depth {
        ::png::BitDepth::Sixteen => samples
            .chunks_exact(2)
            .map(|two| f64::from(u16::from_be_bytes([two[0], two[1]])) / f64::from(u16::MAX))
            .collect(),
        _ => samples
            .iter()
            .map(|&byte| f64::from(byte) / f64::from(u8::MAX))
            .collect(),
    };
    let pixels = encoded
        .chunks_exact(frame.color_type.samples())
        .map(|pixel| {
            let rgb = match *pixel {
                [r, g, b] | [r, g, b, _] => [r, g, b],
                _ => [pixel[0]; 3],
            };
            rgb.map(|c| srgb_to_linear(c) as f32)
        })
        .collect();
    Image::new(width as usize, pixels).ok_or_else(|| "it is empty".to_owned())
}

fn decode_exr(bytes: &[u8]) -> Result<Image, String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(of_format("EXR"))?;
    let mut layers = meta.headers.iter();
    let names = |layer: &::exr::meta::header::Header| -> Vec<String> {
        let channels = layer.channels.list.iter();
        channels.map(|c| c.name.to_string()).collect()
    };
    let has_rgb = |layer: &&::exr::meta::header::Header| {
        let names = names(layer);
        ["R", "G", "B"].iter().all(|c| names.iter().any(|n| n == c))
    };
    let Some(layer) = layers.find(has_rgb) else {
        let all: Vec<String> = meta.headers.iter().flat_map(names).collect();
        return Err(format!(
            "no layer has the channels R, G and B; there are {}",
            all.join(", ")
        ));
    };
    let size = layer.layer_size;
    check_size(size.width() as u64, size.height() as u64)?;
    let read = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (size.width(), vec![[0.0f32; 3]; size.area()]),
            |(width, pixels), at, (r, g, b): (f32, f32, f32)| {
                pixels[at.y() * *width + at.x()] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(of_format("EXR"))?;
    let (width, pixels) = read.layer_data.channel_data.pixels;
    Image::new(width, pixels).ok_or_else(|| "it is empty".to_owned())
}

fn check_size(width: u64, height: u64) -> Result<(), String> {
    match width.checked_mul(height) {
        Some(1..=MAX_PIXELS) => Ok(()),
        _ => Err(format!(
            "it has {width}×{height} pixels; 1 to {MAX_PIXELS} can be measured"
        )),
    }
}

fn of_format<E: Display>(format: &'static str) -> impl Fn(E) -> String {
    move |e| format!("as {format} it is broken: {e}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::png::{BitDepth, ColorType};

    fn png(color: ColorType, depth: BitDepth, samples: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ColorType::Indexed {
            encoder.set_palette(vec![0, 0, 0, 255, 188, 0]);
        }
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(samples).expect("two pixels");
        writer.finish().expect("an end");
        bytes
    }

    /// sRGB 188/255 in linear light, by the standard's formula.
    const CODE_188: f32 = 0.502_886_5;

    #[test]
    fn png_of_every_kind_is_decoded() {
        let pixels = |color, depth, samples: &[u8]| {
            let image = decode(&png(color, depth, samples)).expect("a PNG");
            assert_eq!((image.width(), image.height()), (2, 1));
            image.pixels
        };
        let near = |a: [f32; 3], b: [f32; 3]| {
            for (a, b) in a.into_iter().zip(b) {
                assert!((a - b).abs() < 1e-6, "{a} {b}");
            }
        };
        use BitDepth::{Eight, One, Sixteen};
        let rgb = pixels(ColorType::Rgb, Eight, &[0, 188, 255, 255, 0, 188]);
        near(rgb[0], [0.0, CODE_188, 1.0]);
        near(rgb[1], [1.0, 0.0, CODE_188]);
        let alpha = pixels(ColorType::Rgba, Eight, &[0, 188, 255, 9, 255, 0, 188, 0]);
        assert_eq!(alpha, rgb);
        let grey = pixels(ColorType::Grayscale, Eight, &[188, 255]);
        assert_eq!(grey, [[rgb[0][1]; 3], [1.0; 3]]);
        assert_eq!(
            pixels(ColorType::GrayscaleAlpha, Eight, &[188, 1, 255, 2]),
            grey
        );
        let bits = pixels(ColorType::Indexed, One, &[0b0100_0000]);
        assert_eq!(bits, [[0.0; 3], [1.0, rgb[0][1], 0.0]]);
        // 188 · 257 is the same light in 16 bits.
        let wide = 48316u16.to_be_bytes();
        let wide = pixels(
            ColorType::Grayscale,
            Sixteen,
            &[wide[0], wide[1], 0xff, 0xff],
        );
        assert_eq!(wide, grey);
    }

    #[test]
    fn damage_is_an_error() {
        let whole = png(ColorType::Rgb, BitDepth::Eight, &[7; 6]);
        for end in 0..whole.len() - 12 {
            assert!(decode(&whole[..end]).is_err(), "{end} bytes");
        }
        let reason = decode(b"#?RADIANCE").expect_err("another format");
        assert!(reason.contains("neither a PNG nor an EXR"), "{reason}");
        let mut exr = EXR_SIGNATURE.to_vec();
        exr.extend([2, 0, 0, 0, 1, 2, 3]);
        let reason = decode(&exr).expect_err("no header");
        assert!(reason.contains("EXR"), "{reason}");
    }

    #[test]
    fn images_have_whole_rows() {
        assert!(Image::new(2, vec![[0.0; 3]; 4]).is_some());
        assert!(Image::new(2, vec![[0.0; 3]; 3]).is_none());
        assert!(Image::new(0, vec![[0.0; 3]; 3]).is_none());
        assert!(Image::new(2, Vec::new()).is_none());
    }

    #[test]
    fn exr_keeps_its_light_in_every_sample_type() {
        use ::exr::prelude::*;
        let channels = vec![
            AnyChannel::new("R", FlatSamples::F32(vec![0.25, 1e6])),
            AnyChannel::new("G", FlatSamples::F16(vec![f16::from_f32(0.5); 2])),
            AnyChannel::new("B", FlatSamples::U32(vec![3, 7])),
            AnyChannel::new("depth.Z", FlatSamples::F32(vec![f32::INFINITY; 2])),
        ];
        let file = |channels: Vec<AnyChannel<FlatSamples>>| {
            let mut bytes = Cursor::new(Vec::new());
            Image::from_channels((1, 2), AnyChannels::sort(channels.into()))
                .write()
                .to_buffered(&mut bytes)
                .expect("small");
            bytes.into_inner()
        };
        let image = decode(&file(channels.clone())).expect("an EXR");
        assert_eq!((image.width(), image.height()), (1, 2));
        assert_eq!(image.pixels, [[0.25, 0.5, 3.0], [1e6, 0.5, 7.0]]);
        let reason = decode(&file(channels[1..].to_vec())).expect_err("no R");
        assert!(reason.contains("G, depth.Z"), "{reason}");
    }
}
