//! The colour spaces of FLIP, all from linear sRGB.

use crate::math::{self, DMat3, DVec3};

/// Chromaticities x, y of the primaries and of the white D65 (ITU-R BT.709, IEC 61966-2-1).
const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
const WHITE: [f64; 2] = [0.3127, 0.3290];

/// Where L* turns from a line into a cube root (CIE 15).
const LAB_KNEE: f64 = 6.0 / 29.0;

/// Linear R, G, B to X, Y, Z divided by those of white, and back.
#[derive(Clone, Debug)]
pub(super) struct Space {
    to_relative: DMat3,
    from_relative: DMat3,
}

/// CIE L*a*b* with its chroma scaled by L*/100, as colours fade in the dark: the Hunt effect.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lab {
    lightness: f32,
    a: f32,
    b: f32,
}

impl Space {
    pub(super) fn new() -> Space {
        let xyz = |[x, y]: [f64; 2]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
        let [r, g, b] = PRIMARIES.map(xyz);
        let white = xyz(WHITE);
        // Each primary is as strong as it must be for the three to add up to white.
        let unscaled = DMat3::from_cols(r, g, b);
        let strengths = DMat3::from_diagonal(unscaled.inverse() * white);
        let to_relative = DMat3::from_diagonal(white.recip()) * unscaled * strengths;
        Space {
            to_relative,
            from_relative: to_relative.inverse(),
        }
    }

    /// Opponent colours Y_y, C_x, C_z: L*a*b* without its cube root (Zhang and Wandell's linearised space), in which
    /// the contrast sensitivities were measured. Linear in light, so blurring is right here.
    pub(super) fn opponent(&self, rgb: [f64; 3]) -> [f64; 3] {
        let n = self.to_relative * DVec3::from(rgb);
        [116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z)]
    }

    /// Inverse of [`Space::opponent`], clamped to what a screen can show.
    pub(super) fn linear(&self, [yy, cx, cz]: [f64; 3]) -> [f64; 3] {
        let y = luminance(&[yy, cx, cz]);
        let n = DVec3::new(y + cx / 500.0, y, y - cz / 200.0);
        (self.from_relative * n)
            .clamp(DVec3::ZERO, DVec3::ONE)
            .to_array()
    }

    /// The Hunt-adjusted L*a*b* of a colour in [0, 1]³.
    pub(super) fn hunt_lab(&self, rgb: [f64; 3]) -> Lab {
        let n = self.to_relative * DVec3::from(rgb);
        let [x, y, z] = n.to_array().map(lab_curve);
        let lightness = 116.0 * y - 16.0;
        let hunt = 0.01 * lightness;
        Lab {
            lightness: lightness as f32,
            a: (hunt * 500.0 * (x - y)) as f32,
            b: (hunt * 200.0 * (y - z)) as f32,
        }
    }
}

/// Relative luminance in [0, 1] of an opponent colour.
pub(super) fn luminance(opponent: &[f64; 3]) -> f64 {
    (opponent[0] + 16.0) / 116.0
}

/// The cube root, replaced by its tangent's line near black.
fn lab_curve(t: f64) -> f64 {
    if t > LAB_KNEE * LAB_KNEE * LAB_KNEE {
        math::pow(t, 1.0 / 3.0)
    } else {
        t / (3.0 * LAB_KNEE * LAB_KNEE) + 4.0 / 29.0
    }
}

impl Lab {
    /// HyAB: city block in lightness, Euclidean in chroma (Abasi et al. 2020), better for large distances.
    pub(super) fn distance(self, other: Lab) -> f64 {
        let d = |a: f32, b: f32| f64::from(a) - f64::from(b);
        let (a, b) = (d(self.a, other.a), d(self.b, other.b));
        d(self.lightness, other.lightness).abs() + (a * a + b * b).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminances_are_the_standards() {
        let space = Space::new();
        // IEC 61966-2-1: 0.2126, 0.7152, 0.0722.
        let y = space.to_relative.row(1);
        assert!(
            y.abs_diff_eq(DVec3::new(0.2126, 0.7152, 0.0722), 5e-5),
            "{y}"
        );
        let white = space.to_relative * DVec3::ONE;
        assert!(white.abs_diff_eq(DVec3::ONE, 1e-14), "{white}");
    }

    #[test]
    fn opponent_colours_go_back() {
        let space = Space::new();
        for rgb in [[0.0; 3], [1.0; 3], [0.2, 0.5, 0.9], [1.0, 0.0, 0.3]] {
            let back = space.linear(space.opponent(rgb));
            assert!(DVec3::from(back).abs_diff_eq(rgb.into(), 1e-14), "{back:?}");
        }
    }

    #[test]
    fn lightness_runs_from_0_to_100() {
        let space = Space::new();
        let grey = |v: f64| space.hunt_lab([v; 3]);
        assert!(grey(0.0).lightness.abs() < 1e-5);
        assert!((grey(1.0).lightness - 100.0).abs() < 1e-4);
        // 18.4 % grey is the middle: L* = 116 · 0.184^⅓ − 16.
        assert!((grey(0.184).lightness - 49.977_7).abs() < 1e-3);
        assert!(grey(0.5).distance(grey(0.5)) == 0.0);
        assert!(grey(0.5).a.abs() < 1e-4 && grey(0.5).b.abs() < 1e-4);
    }
}
