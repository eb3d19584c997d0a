//! Pictures in turn, as a GIF that repeats for ever.
//!
//! One palette for all frames: palettes of their own would make a still backdrop flicker. A pixel that changes by less
//! than the eye sees keeps the colour that it shows, so that the noise of drafts neither flickers nor fills the file.

use super::palette::{Histogram, Palette};
use super::{EncodeError, Metadata};
use ::gif::{AnyExtension, DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::borrow::Cow;

/// Colours of a GIF, less the one that stands for "as before".
const COLORS: usize = 255;

/// A channel may be off by this much (of 255) before a pixel is drawn anew.
const TOLERANCE: u8 = 5;

/// Longest text of a comment block.
const BLOCK: usize = 255;

/// Ticks of a GIF in a second.
pub const TICKS_PER_SECOND: f64 = 100.0;

/// A picture and how long it is shown.
#[derive(Clone, Debug)]
pub struct GifFrame {
    /// Three sRGB bytes per pixel, row by row from the top.
    pub rgb: Vec<u8>,
    /// In hundredths of a second.
    pub ticks: u16,
}

/// The frames as the bytes of a GIF file. The metadata become a comment.
///
/// # Errors
/// If the pictures are larger than GIF allows, or not all of `size`, or there is none.
pub fn encode_gif(
    size: (u32, u32),
    frames: &[GifFrame],
    metadata: &Metadata,
) -> Result<Vec<u8>, EncodeError> {
    let refuse = |reason: &str| EncodeError {
        format: "GIF",
        reason: reason.to_owned(),
    };
    let (Ok(width), Ok(height)) = (u16::try_from(size.0), u16::try_from(size.1)) else {
        return Err(refuse("a side is longer than 65535 pixels"));
    };
    let bytes = 3 * usize::from(width) * usize::from(height);
    if frames.is_empty() || frames.iter().any(|frame| frame.rgb.len() != bytes) {
        return Err(refuse("the frames are not all there"));
    }
    encode((width, height), frames, metadata).map_err(|e| refuse(&e.to_string()))
}

fn encode(
    (width, height): (u16, u16),
    frames: &[GifFrame],
    metadata: &Metadata,
) -> Result<Vec<u8>, EncodingError> {
    let mut histogram = Histogram::new();
    for frame in frames {
        histogram.add(&frame.rgb);
    }
    let palette = histogram.palette(COLORS);
    let same = palette.colors.len() as u8;
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height, &palette.colors.concat())?;
    encoder.set_repeat(Repeat::Infinite)?;
    let comment = comment(metadata);
    let blocks: Vec<&[u8]> = comment.as_bytes().chunks(BLOCK).collect();
    encoder.write_raw_extension(AnyExtension(COMMENT), &blocks)?;
    let mut shown = Vec::new();
    for frame in frames {
        encoder.write_frame(&Frame {
            delay: frame.ticks,
            dispose: DisposalMethod::Keep,
            transparent: (!shown.is_empty()).then_some(same),
            width,
            height,
            buffer: Cow::Owned(indices(&palette, &frame.rgb, same, &mut shown)),
            ..Frame::default()
        })?;
    }
    drop(encoder);
    Ok(bytes)
}

/// Label of a comment extension (GIF89a, section 24).
const COMMENT: u8 = 0xfe;

/// `luxel key=value; key=value`, in 7 bits as the format asks.
fn comment(metadata: &Metadata) -> String {
    let mut text = "luxel".to_owned();
    for (i, (key, value)) in metadata.entries().enumerate() {
        let sign = if i == 0 { " " } else { "; " };
        text.extend([sign, key, "=", value]);
    }
    text.chars()
        .map(|c| if c.is_ascii() { c } else { '?' })
        .collect()
}

/// The index of each pixel, `same` where what is `shown` will do. Then that is what is shown.
fn indices(palette: &Palette, rgb: &[u8], same: u8, shown: &mut Vec<u8>) -> Vec<u8> {
    let pixels = rgb.chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
    if shown.is_empty() {
        shown.extend(pixels.map(|color| palette.index(color)));
        return shown.clone();
    }
    let draw = |(color, shown): ([u8; 3], &mut u8)| {
        let index = palette.index(color);
        if index == *shown || is_near(palette.colors[usize::from(*shown)], color) {
            return same;
        }
        *shown = index;
        index
    };
    pixels.zip(shown).map(draw).collect()
}

fn is_near(a: [u8; 3], b: [u8; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::gif::{ColorOutput, DecodeOptions};

    fn frame(rgb: &[[u8; 3]], ticks: u16) -> GifFrame {
        GifFrame {
            rgb: rgb.concat(),
            ticks,
        }
    }

    /// What a viewer shows: pixels of each frame over those before, its ticks.
    fn play(bytes: &[u8]) -> Vec<(Vec<[u8; 3]>, u16)> {
        let mut options = DecodeOptions::new();
        options.set_color_output(ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).expect("a GIF");
        assert_eq!(decoder.repeat(), Repeat::Infinite);
        let mut canvas = Vec::new();
        let mut played = Vec::new();
        while let Some(frame) = decoder.read_next_frame().expect("a frame") {
            let pixels = frame.buffer.chunks(4);
            canvas.resize(pixels.len(), [0; 3]);
            for (shown, pixel) in canvas.iter_mut().zip(pixels).filter(|(_, p)| p[3] == 255) {
                *shown = [pixel[0], pixel[1], pixel[2]];
            }
            played.push((canvas.clone(), frame.delay));
        }
        played
    }

    #[test]
    fn frames_play_as_they_were_given() {
        let [black, red, blue] = [[0, 0, 0], [255, 0, 0], [7, 30, 251]];
        let frames = [
            frame(&[black, red, blue, black], 5),
            frame(&[red, red, black, black], 7),
            frame(&[red, blue, black, black], 6),
        ];
        let mut metadata = Metadata::default();
        metadata.push("scene", "ab".repeat(200));
        let bytes = encode_gif((2, 2), &frames, &metadata).expect("small");
        let played = play(&bytes);
        let wanted: Vec<_> = frames
            .iter()
            .map(|f| {
                let pixels = f.rgb.chunks(3).map(|p| [p[0], p[1], p[2]]);
                (pixels.collect::<Vec<_>>(), f.ticks)
            })
            .collect();
        assert_eq!(played, wanted);
        let again = encode_gif((2, 2), &frames, &metadata).expect("small");
        assert_eq!(again, bytes, "equal frames are equal files");
    }

    #[test]
    fn a_full_palette_is_never_far_off() {
        let side = 64u8;
        let picture = |shift: u8| -> Vec<[u8; 3]> {
            let pixel = |i: u32| {
                let (x, y) = ((i % 64) as u8, (i / 64) as u8);
                [x * 4, y * 4, shift.wrapping_add(x).wrapping_mul(3)]
            };
            (0..u32::from(side) * u32::from(side)).map(pixel).collect()
        };
        let frames: Vec<GifFrame> = (0..3).map(|k| frame(&picture(k * 20), 4)).collect();
        let bytes = encode_gif((64, 64), &frames, &Metadata::default()).expect("small");
        let played = play(&bytes);
        assert_eq!(played.len(), 3);
        for ((shown, _), wanted) in played.iter().zip(&frames) {
            let error: u64 = shown
                .concat()
                .iter()
                .zip(&wanted.rgb)
                .map(|(a, b)| u64::from(a.abs_diff(*b)))
                .sum();
            assert!(error / 3 / 64 / 64 <= 12, "{error}");
        }
    }

    #[test]
    fn what_is_no_film_is_refused() {
        let picture = frame(&[[0; 3]], 1);
        let none = Metadata::default();
        for (size, frames) in [
            ((1, 1), vec![]),
            ((2, 1), vec![picture.clone()]),
            ((70_000, 1), vec![picture]),
        ] {
            assert!(encode_gif(size, &frames, &none).is_err(), "{size:?}");
        }
    }
}
