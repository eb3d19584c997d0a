//! Textures of materials: from a `textureInfo` to a [`TextureUse`].
//!
//! glTF's v points down and luxel's up, so that coordinates enter as (u, 1 − v), and a KHR_texture_transform is turned
//! upside down on both sides. Wrap modes need no change: each of them mirrors into itself.

use super::exact::{exact, exact_one};
use super::images::Images;
use super::materials::Look;
use super::source::Source;
use crate::asset::{Filter, Loader, TextureUse, Wrap};
use crate::math::{SRGB_BYTES, sin_cos};
use gltf::texture::{Info, MagFilter, WrappingMode};

/// What a material gets of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sampled {
    /// The image is missing, or the texture has none.
    Nothing,
    /// The primitive has the coordinates.
    Texture(TextureUse),
    /// The primitive has no such coordinates, and all of it the colour of the first texel: linear RGB.
    Texel([f64; 3]),
}

/// The set of coordinates that a texture is read by: that of its transform, if it says.
pub(super) fn uv_set(info: &Info<'_>) -> u32 {
    let transform = info.texture_transform();
    let own = transform.and_then(|transform| transform.tex_coord());
    own.unwrap_or(info.tex_coord())
}

/// What a primitive's material gets of a texture; `pointer` is that of the `textureInfo`.
pub(super) fn sampled(
    loader: &Loader,
    source: &Source,
    images: &Images,
    (info, pointer): (&Info<'_>, &str),
    look: &Look,
) -> Sampled {
    let image = info.texture().source().map(|image| image.index());
    let Some(texture) = image.and_then(|image| images.texture(image)) else {
        return Sampled::Nothing;
    };
    let set = uv_set(info);
    if !look.has_uv_set(set) {
        let texels = &loader.loaded_texture(texture).texels;
        let linear = |k: usize| {
            let byte = texels.get(k).copied().unwrap_or(u8::MAX);
            f64::from(SRGB_BYTES[usize::from(byte)])
        };
        return Sampled::Texel([0, 1, 2].map(linear));
    }
    let sampler = info.texture().sampler();
    Sampled::Texture(TextureUse {
        texture,
        uv_set: set as u8,
        transform: transform(source, info, pointer),
        wrap: [sampler.wrap_s(), sampler.wrap_t()].map(|mode| match mode {
            WrappingMode::ClampToEdge => Wrap::Clamp,
            WrappingMode::MirroredRepeat => Wrap::Mirror,
            WrappingMode::Repeat => Wrap::Repeat,
        }),
        filter: match sampler.mag_filter() {
            Some(MagFilter::Nearest) => Filter::Nearest,
            Some(MagFilter::Linear) | None => Filter::Bilinear,
        },
    })
}

fn transform(source: &Source, info: &Info<'_>, pointer: &str) -> Option<[f64; 6]> {
    let transform = info.texture_transform()?;
    let at = |part: &str| format!("{pointer}/extensions/KHR_texture_transform/{part}");
    let json = &source.json;
    let map = upright(
        exact(json, &at("offset"), transform.offset()),
        exact_one(json, &at("rotation"), transform.rotation()),
        exact(json, &at("scale"), transform.scale()),
    );
    let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    (map != identity).then_some(map)
}

/// The map of KHR_texture_transform, scale then rotation then offset, between coordinates whose v points up.
///
/// Rotation is counter-clockwise as seen with v down: (1, 0) goes to (cos, −sin). The GLSL in early versions of the
/// extension's text has it the other way round; its example, which says what part of the image is seen, has not.
fn upright([x, y]: [f64; 2], rotation: f64, [across, down]: [f64; 2]) -> [f64; 6] {
    let (sin, cos) = sin_cos(rotation);
    // u' = a u + b v + x, v' = c u + d v + y with v down.
    let [a, b, c, d] = [cos * across, sin * down, -sin * across, cos * down];
    [a, 0.0 - b, b + x, 0.0 - c, d, 1.0 - d - y]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// Applies a map to coordinates with v down, through v up.
    fn through(map: [f64; 6], [u, v]: [f64; 2]) -> [f64; 2] {
        let [a, b, x, c, d, y] = map;
        let up = 1.0 - v;
        [a * u + b * up + x, 1.0 - (c * u + d * up + y)]
    }

    fn assert_close(found: [f64; 2], expected: [f64; 2]) {
        let off = |k: usize| (found[k] - expected[k]).abs();
        assert!(off(0) < 1e-12 && off(1) < 1e-12, "{found:?} {expected:?}");
    }

    #[test]
    fn a_transform_shows_what_the_text_of_the_extension_says() {
        // "only the lower left quadrant of the source image, rotated clockwise 90°": the top left of the surface shows
        // the bottom left of the image, its top right what was above that.
        let map = upright([0.0, 1.0], FRAC_PI_2, [0.5, 0.5]);
        assert_close(through(map, [0.0, 0.0]), [0.0, 1.0]);
        assert_close(through(map, [1.0, 0.0]), [0.0, 0.5]);
        assert_close(through(map, [0.0, 1.0]), [0.5, 1.0]);
        // "inverts the T axis".
        let map = upright([0.0, 1.0], 0.0, [1.0, -1.0]);
        assert_close(through(map, [0.25, 0.125]), [0.25, 0.875]);
    }

    #[test]
    fn scale_comes_first_then_rotation_then_offset() {
        let map = upright([0.1, 0.2], 0.3, [4.0, 5.0]);
        let (sin, cos) = sin_cos(0.3);
        let [u, v] = [4.0 * 0.6, 5.0 * 0.7];
        let expected = [cos * u + sin * v + 0.1, -sin * u + cos * v + 0.2];
        assert_close(through(map, [0.6, 0.7]), expected);
    }
}
