//! Texture look-up: decoded to linear texel by texel, so that filtering is linear.

use crate::flat::texture::{FilterMode, Texture, WrapMode};
use crate::math::{SRGB_BYTES, Vec3};

/// Linear colour at texture coordinates (u, v), v up: texel (0, 0) is the top left, its centre at
/// u = 0.5 / width, v = 1 − 0.5 / height.
#[must_use]
pub fn eval_texture(texture: &Texture, uv: [f32; 2]) -> Vec3 {
    let x = wrap(texture.wrap, uv[0]) * texture.width as f32;
    let y = (1.0 - wrap(texture.wrap, uv[1])) * texture.height as f32;
    match texture.filter {
        FilterMode::Nearest => texel(texture, x.floor() as i64, y.floor() as i64),
        FilterMode::Bilinear => {
            let (x, y) = (x - 0.5, y - 0.5);
            let (x0, y0) = (x.floor(), y.floor());
            let (fx, fy) = (x - x0, y - y0);
            let (x0, y0) = (x0 as i64, y0 as i64);
            let top = texel(texture, x0, y0).lerp(texel(texture, x0 + 1, y0), fx);
            let bottom = texel(texture, x0, y0 + 1).lerp(texel(texture, x0 + 1, y0 + 1), fx);
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

/// A texel; indices one beyond the border wrap as coordinates do.
fn texel(texture: &Texture, x: i64, y: i64) -> Vec3 {
    let index = |i: i64, n: u32| {
        let n = i64::from(n);
        let i = match texture.wrap {
            WrapMode::Repeat => i.rem_euclid(n),
            WrapMode::Mirror | WrapMode::Clamp => i.clamp(0, n - 1),
        };
        i as usize
    };
    let at = 3 * (index(y, texture.height) * texture.width as usize + index(x, texture.width));
    match texture.texels.get(at..at + 3) {
        Some(&[r, g, b]) => {
            let linear = &*SRGB_BYTES;
            Vec3::new(linear[r as usize], linear[g as usize], linear[b as usize])
        }
        _ => Vec3::ZERO,
    }
}
