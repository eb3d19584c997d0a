//! Pictures of luxel's own, read back: what they say about themselves, and what they show.

use super::Metadata;
use super::srgb::Encoder;
use ::exr::prelude::{
    AttributeValue, FlatSamples, ReadChannels, ReadLayers, Text, read as read_exr,
};
use std::io::Cursor;

/// A file is no picture of luxel, or not a whole one.
#[derive(Debug, thiserror::Error)]
#[error("it is no whole {format} image of luxel: {reason}")]
pub struct DecodeError {
    /// `PNG` or `EXR`.
    pub format: &'static str,
    /// What the decoder says.
    pub reason: String,
}

/// A PNG or an EXR that [`super::encode_png`] or [`super::encode_exr`] wrote.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// What it was written with.
    pub metadata: Metadata,
    /// Columns and rows.
    pub size: (u32, u32),
    /// Names of an EXR's channels, sorted; none of a PNG's.
    pub channels: Vec<String>,
    /// Three sRGB bytes per pixel, row by row from the top.
    pub rgb: Vec<u8>,
}

/// Decodes a whole PNG file, checksums and all.
///
/// # Errors
/// If it is damaged, or none that luxel writes.
pub fn decode_png(bytes: &[u8]) -> Result<Stored, DecodeError> {
    let refuse = |reason: &dyn std::fmt::Display| DecodeError {
        format: "PNG",
        reason: reason.to_string(),
    };
    let mut reader = ::png::Decoder::new(Cursor::new(bytes))
        .read_info()
        .map_err(|e| refuse(&e))?;
    if reader.output_color_type() != (::png::ColorType::Rgb, ::png::BitDepth::Eight) {
        return Err(refuse(&"it is not of three channels of 8 bits"));
    }
    let size = reader.output_buffer_size();
    let mut rgb = vec![0; size.ok_or_else(|| refuse(&"it is too large"))?];
    reader.next_frame(&mut rgb).map_err(|e| refuse(&e))?;
    reader.finish().map_err(|e| refuse(&e))?;
    let mut metadata = Metadata::default();
    for text in &reader.info().uncompressed_latin1_text {
        if let Some(key) = text.keyword.strip_prefix("luxel:") {
            metadata.push(key, &text.text);
        }
    }
    Ok(Stored {
        metadata,
        size: reader.info().size(),
        channels: Vec::new(),
        rgb,
    })
}

/// Decodes a whole EXR file; `gain` is 2^EV, for its picture.
///
/// # Errors
/// If it is damaged, or none that luxel writes.
pub fn decode_exr(bytes: &[u8], gain: f64) -> Result<Stored, DecodeError> {
    let refuse = |reason: String| DecodeError {
        format: "EXR",
        reason,
    };
    let image = read_exr()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .pedantic()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| refuse(e.to_string()))?;
    let layer = &image.layer_data;
    let lines = match layer.attributes.other.get(&Text::from("luxel")) {
        Some(AttributeValue::Text(text)) => text.to_string(),
        _ => return Err(refuse("it is not of luxel".to_owned())),
    };
    let list = &layer.channel_data.list;
    let plane = |name: &str| match list.iter().find(|c| c.name.eq(name)) {
        Some(channel) => match &channel.sample_data {
            FlatSamples::F32(samples) => Ok(samples),
            _ => Err(refuse(format!(
                "its channel {name} is not of 32-bit floats"
            ))),
        },
        None => Err(refuse(format!("it has no channel {name}"))),
    };
    let [r, g, b] = [plane("R")?, plane("G")?, plane("B")?];
    let curve = Encoder::new();
    let pixels = r.iter().zip(g).zip(b);
    Ok(Stored {
        metadata: Metadata::from_lines(&lines),
        size: (layer.size.width() as u32, layer.size.height() as u32),
        channels: list.iter().map(|c| c.name.to_string()).collect(),
        rgb: pixels
            .flat_map(|((r, g), b)| [*r, *g, *b])
            .map(|linear| curve.encode(f64::from(linear) * gain))
            .collect(),
    })
}
