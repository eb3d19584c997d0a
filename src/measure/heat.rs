//! A picture of errors: dark where there is none, bright where it is largest.

use super::Pair;

/// The colour of pixels that do not count: grey, which the ramp never is.
const UNCOUNTED: [u8; 3] = [96; 3];

/// The bytes of an 8-bit PNG: the ramp at each value, clamped to [0, 1]. `values` has one per pixel of the pair.
///
/// # Errors
/// What the encoder says, if the image is larger than PNG allows.
pub fn encode_png(pair: &Pair<'_>, values: &[f32]) -> Result<Vec<u8>, String> {
    let image = pair.reference();
    let pixels: Vec<u8> = (values.iter().zip(pair.counts()))
        .flat_map(|(&value, &counts)| if counts { ramp(value) } else { UNCOUNTED })
        .collect();
    encode(image.width() as u32, image.height() as u32, &pixels).map_err(|e| e.to_string())
}

fn encode(width: u32, height: u32, pixels: &[u8]) -> Result<Vec<u8>, ::png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_source_srgb(::png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}

/// Black, plum, orange, pale yellow in sRGB bytes. Lightness rises all the way, so that the order of errors shows in
/// grey as well; the hump of blue keeps small errors apart from none.
fn ramp(value: f32) -> [u8; 3] {
    let t = value.clamp(0.0, 1.0);
    let rest = 1.0 - t;
    let red = 1.0 - rest * rest;
    let green = t * t;
    let blue = 2.4 * t * rest * rest + 0.85 * t * t * t * t;
    [red, green, blue].map(|c| (c * 255.0 + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::super::{Image, Selection};
    use super::*;
    use crate::math::SRGB_BYTES;

    #[test]
    fn the_ramp_gets_lighter_all_the_way() {
        let luminance = |i: u16| {
            let [r, g, b] = ramp(f32::from(i) / 255.0).map(|c| SRGB_BYTES[usize::from(c)]);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        for i in 0..255 {
            assert!(luminance(i) < luminance(i + 1), "{i}");
        }
        assert_eq!(ramp(-1.0), [0; 3]);
        assert_eq!(ramp(f32::INFINITY), ramp(1.0));
    }

    #[test]
    fn pixels_that_do_not_count_are_grey() {
        let mut pixels = vec![[0.0; 3]; 9];
        pixels[8] = [3.0; 3];
        let image = Image::new(9, pixels).expect("whole");
        let pair = Pair::new(&image, &image, Selection::Peers).expect("comparable");
        let bytes = encode_png(&pair, &[1.0; 9]).expect("small");
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(&bytes))
            .read_info()
            .expect("a PNG");
        let mut got = vec![0; 27];
        reader.next_frame(&mut got).expect("one image");
        assert_eq!(got[21..], [255, 255, 217, 96, 96, 96]);
    }
}
