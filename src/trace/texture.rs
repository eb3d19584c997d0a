//! Texture look-up: decoded to linear texel by texel, so that filtering is linear.

use crate::flat::texture::{FilterMode, Texture, WrapMode};
use crate::math::{SRGB_BYTES, Vec3};

/// Linear colour at texture coordinates (u, v), v up: texel (0, 0) is the top left, its centre at
/// u = 0.5 / width, v = 1 − 0.5 / height.
#[inline]
#[must_use]
pub fn eval_texture(texture: &Texture, uv: [f32; 2]) -> Vec3 {
    filtered(texture, uv, |i| {
        match texture.texels.get(3 * i..3 * i + 3) {
            Some(&[r, g, b]) => {
                let linear = &*SRGB_BYTES;
                Vec3::new(linear[r as usize], linear[g as usize], linear[b as usize])
            }
            _ => Vec3::ZERO,
        }
    })
}

/// Alpha at texture coordinates, as [`eval_texture`]; 1 where the image has none.
#[must_use]
pub fn eval_alpha(texture: &Texture, uv: [f32; 2]) -> f32 {
    let Some(alpha) = &texture.alpha else {
        return 1.0;
    };
    let at = |i: usize| Vec3::splat(alpha.get(i).map_or(0.0, |a| f32::from(*a) / 255.0));
    filtered(texture, uv, at).x
}

/// Filters what `at` gives for the indices of texels.
#[inline(always)]
fn filtered(texture: &Texture, uv: [f32; 2], at: impl Fn(usize) -> Vec3) -> Vec3 {
    let x = wrap(texture.wrap[0], uv[0]) * texture.width as f32;
    let y = (1.0 - wrap(texture.wrap[1], uv[1])) * texture.height as f32;
    let texel = |x: i64, y: i64| at(index(texture, x, y));
    match texture.filter {
        FilterMode::Nearest => texel(x.floor() as i64, y.floor() as i64),
        FilterMode::Bilinear => {
            let (x, y) = (x - 0.5, y - 0.5);
            let (x0, y0) = (x.floor(), y.floor());
            let (fx, fy) = (x - x0, y - y0);
            let (x0, y0) = (x0 as i64, y0 as i64);
            let top = texel(x0, y0).lerp(texel(x0 + 1, y0), fx);
            let bottom = texel(x0, y0 + 1).lerp(texel(x0 + 1, y0 + 1), fx);
            top.lerp(bottom, fy)
        }
    }
}

/// A coordinate brought into [0, 1].
fn wrap(mode: WrapMode, x: f32) -> f32 {
    match mode {
        WrapMode::Repeat => x - x.floor(),
        WrapMode::Mirror => {
            let period = x - 2.0 * (x * 0.5).floor();
            if period > 1.0 { 2.0 - period } else { period }
        }
        WrapMode::Clamp => x.clamp(0.0, 1.0),
    }
}

/// The index of a texel; columns and rows one beyond the border wrap as coordinates do.
fn index(texture: &Texture, x: i64, y: i64) -> usize {
    let along = |mode: WrapMode, i: i64, n: u32| {
        let n = i64::from(n);
        let i = match mode {
            WrapMode::Repeat => i.rem_euclid(n),
            WrapMode::Mirror | WrapMode::Clamp => i.clamp(0, n - 1),
        };
        i as usize
    };
    let [u, v] = texture.wrap;
    along(v, y, texture.height) * texture.width as usize + along(u, x, texture.width)
}
