//! Images of the sky.

use super::super::*;
use super::{Folder, png};
use crate::diag::Diagnostic;
use ::exr::error::UnitResult;
use ::exr::prelude::*;
use std::sync::Arc;

fn load(
    bytes: &[u8],
) -> (
    std::result::Result<Arc<Panorama>, Diagnostic>,
    Vec<Diagnostic>,
) {
    // The content tells the format, not the name.
    let folder = Folder::of(&[("sky", bytes)]);
    let mut loader = Loader::new();
    let id = loader.panorama(&folder.0.join("sky"));
    let warnings = loader.warnings().to_vec();
    let store = loader.finish();
    (id.map(|id| store.panorama(id).clone()), warnings)
}

fn refused(bytes: &[u8]) -> Diagnostic {
    load(bytes).0.map(|_| ()).expect_err("an error")
}

/// Four columns, two rows.
const TEXELS: [[f32; 3]; 8] = [
    [0.0, 0.5, 1.0],
    [2.0, 4.0, 8.0],
    [0.25, 0.25, 0.25],
    [1.0, 1.0, 1.0],
    [1024.0, 512.0, 768.0],
    [0.0, 0.0, 0.0],
    [0.75, 0.5, 0.125],
    [3.0, 2.0, 1.0],
];

fn hdr(header: &str, texels: &[[f32; 3]]) -> Vec<u8> {
    let colors: Vec<_> = texels.iter().map(|t| image::Rgb(*t)).collect();
    let mut bytes = Vec::new();
    let encoder = image::codecs::hdr::HdrEncoder::new(&mut bytes);
    encoder
        .encode(&colors, 4, texels.len() / 4)
        .expect("an HDR image");
    let text = b"#?RADIANCE\n";
    assert!(bytes.starts_with(text));
    [header.as_bytes(), &bytes[text.len()..]].concat()
}

fn exr(texels: &[[f32; 3]]) -> Vec<u8> {
    let pixels = SpecificChannels::rgb(|at: Vec2<usize>| {
        let [r, g, b] = texels[at.y() * 4 + at.x()];
        (r, g, b)
    });
    let image = Image::from_channels((4, texels.len() / 4), pixels);
    bytes_of(|to| image.write().to_buffered(to))
}

/// What `written` puts into a buffer.
fn bytes_of(written: impl FnOnce(&mut std::io::Cursor<Vec<u8>>) -> UnitResult) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    written(&mut bytes).expect("an EXR image");
    bytes.into_inner()
}

#[test]
fn both_formats_give_their_texels() {
    let radiance = "#?RADIANCE\n";
    for bytes in [
        hdr(radiance, &TEXELS),
        hdr("#?RGBE\n", &TEXELS),
        exr(&TEXELS),
    ] {
        let (sky, warnings) = load(&bytes);
        let sky = sky.expect("a sky");
        assert_eq!(
            (sky.width, sky.height, &sky.texels[..]),
            (4, 2, &TEXELS[..])
        );
        assert_eq!((sky.brightest(), warnings), (1024.0, Vec::new()));
    }
}

#[test]
fn exposures_and_color_corrections_are_taken_out() {
    let header = "#?RADIANCE\nEXPOSURE=2\nEXPOSURE=4\nCOLORCORR=1 0.5 2\n";
    let sky = load(&hdr(header, &TEXELS)).0.expect("a sky");
    assert_eq!(sky.texels[1], [2.0 / 8.0, 4.0 / 4.0, 8.0 / 16.0]);
}

#[test]
fn a_stretched_sky_is_warned_of() {
    let (sky, warnings) = load(&hdr("#?RADIANCE\n", &TEXELS[..4]));
    assert_eq!(sky.expect("a sky").height, 1);
    let codes: Vec<_> = warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, [codes::NOT_A_PANORAMA]);
}

#[test]
fn what_is_no_radiance_is_refused_with_its_place() {
    for (wrong, says) in [
        (f32::NAN, "(NaN, 512, 768)"),
        (f32::INFINITY, "(inf, 512, 768)"),
        (-1e-3, "(-0.001, 512, 768)"),
        (1e19, "(10000000000000000000, 512, 768)"),
    ] {
        let mut texels = TEXELS;
        texels[4][0] = wrong;
        texels[7][2] = wrong;
        let error = refused(&exr(&texels));
        assert_eq!(error.code, codes::BAD_RADIANCE);
        let wanted = format!(
            "the pixel (0, 1) is {says}, but radiance is from 0 to 1e18, and 1 more are such"
        );
        assert_eq!(error.message, wanted);
        assert!(error.hint.is_some());
    }
}

#[test]
fn what_is_no_sky_is_refused() {
    let whole = hdr("#?RADIANCE\n", &TEXELS);
    let texels = SpecificChannels::build().with_channel("Y");
    let grey = Image::from_channels((4, 2), texels.with_pixel_fn(|_| (0.5f32,)));
    let grey = bytes_of(|to| grey.write().to_buffered(to));
    let color = SpecificChannels::rgb(|_: Vec2<usize>| (1.0f32, 1.0f32, 1.0f32));
    let layer = Layer::new(
        (4, 2),
        LayerAttributes::named("cropped").with_position(Vec2(1, 0)),
        Encoding::default(),
        color,
    );
    let mut cropped = Image::from_layer(layer);
    cropped.attributes.display_window = IntegerBounds::from_dimensions((8, 4));
    let cropped = bytes_of(|to| cropped.write().to_buffered(to));
    let exr = exr(&TEXELS);
    for (bytes, code, word) in [
        (&whole[..whole.len() - 2], codes::IMAGE_CORRUPT, "damaged"),
        (&whole[..30], codes::IMAGE_CORRUPT, "damaged"),
        (&exr[..exr.len() - 2], codes::IMAGE_CORRUPT, "damaged"),
        (&exr[..30], codes::IMAGE_CORRUPT, "damaged"),
        (&grey, codes::IMAGE_FORMAT, "R, G and B"),
        (&cropped, codes::IMAGE_FORMAT, "cropped"),
        (&[], codes::IMAGE_FORMAT, "neither"),
        (
            &png(png::ColorType::Rgb, png::BitDepth::Eight, 1, &[1, 2, 3]),
            codes::IMAGE_FORMAT,
            "neither",
        ),
        (
            b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 4\n",
            codes::IMAGE_CORRUPT,
            "4 x 0",
        ),
        (
            b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n",
            codes::OVER_BUDGET,
            "60000 x 60000",
        ),
    ] {
        let error = refused(bytes);
        assert_eq!(error.code, code, "{error:?}");
        assert!(error.message.contains(word), "{error:?}");
    }
}

#[test]
fn a_sky_that_fails_takes_no_memory() {
    let whole = hdr("#?RADIANCE\n", &TEXELS);
    let folder = Folder::of(&[("sky", &whole), ("cut", &whole[..whole.len() - 2])]);
    let mut loader = Loader::new();
    assert!(loader.panorama(&folder.0.join("cut")).is_err());
    assert!(loader.panorama(&folder.0.join("missing")).is_err());
    assert!(loader.panorama(&folder.0.join("sky")).is_ok());
    assert_eq!(loader.finish().memory(), 8 * 12);
}
