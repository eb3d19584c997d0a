//! The 8-bit picture: exposure, clamp, sRGB curve, round half up, no dither, once.

use super::srgb::Encoder;
use super::{EncodeError, Film, Metadata};

/// The film as the bytes of a PNG file.
///
/// `gain` is 2^EV and multiplies linear radiance. The metadata become `tEXt` chunks.
///
/// # Errors
/// If the image is larger than PNG allows.
pub fn encode_png(film: &Film, gain: f64, metadata: &Metadata) -> Result<Vec<u8>, EncodeError> {
    encode(film, gain, metadata).map_err(|e| EncodeError {
        format: "PNG",
        reason: e.to_string(),
    })
}

fn encode(film: &Film, gain: f64, metadata: &Metadata) -> Result<Vec<u8>, ::png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, film.width(), film.height());
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_source_srgb(::png::SrgbRenderingIntent::Perceptual);
    encoder.add_text_chunk("Software".to_owned(), "luxel".to_owned())?;
    for (key, value) in metadata.entries() {
        encoder.add_text_chunk(format!("luxel:{key}"), value.to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&develop(film, gain))?;
    writer.finish()?;
    Ok(bytes)
}

/// The 8-bit picture: three sRGB bytes per pixel, row by row from the top. `gain` as for [`encode_png`].
#[must_use]
pub fn develop(film: &Film, gain: f64) -> Vec<u8> {
    let curve = Encoder::new();
    film.radiance()
        .into_iter()
        .flatten()
        .map(|linear| curve.encode(f64::from(linear) * gain))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Planes, Window};
    use super::*;

    fn film() -> Film {
        let mut film = Film::new(2, 1);
        let window = Window {
            x: 0,
            y: 0,
            width: 2,
            height: 1,
        };
        let planes = Planes {
            rgb: vec![[0.0, 0.5, 2.0], [0.25, 0.5, 1.0]],
            count: vec![1, 2],
            ..Planes::default()
        };
        film.put(window, &planes);
        film
    }

    #[test]
    fn bytes_are_the_encoded_means() {
        // 0.5 encodes to 188, 0.25 to 137, 0.125 to 99, 0.0625 to 71.
        assert_eq!(develop(&film(), 1.0), [0, 188, 255, 99, 137, 188]);
        assert_eq!(develop(&film(), 0.5), [0, 137, 255, 71, 99, 137]);
    }

    #[test]
    fn the_file_reads_back_with_its_metadata() {
        let mut metadata = Metadata::default();
        metadata.push("seed", 7);
        let bytes = encode_png(&film(), 1.0, &metadata).expect("small");
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(&bytes))
            .read_info()
            .expect("a PNG");
        let mut pixels = vec![0; 6];
        reader.next_frame(&mut pixels).expect("one image");
        assert_eq!(pixels, develop(&film(), 1.0));
        let info = reader.info();
        assert!(info.srgb.is_some());
        let texts: Vec<_> = info
            .uncompressed_latin1_text
            .iter()
            .map(|t| (t.keyword.as_str(), t.text.as_str()))
            .collect();
        assert_eq!(texts, [("Software", "luxel"), ("luxel:seed", "7")]);
    }
}
