//! Transcendental functions whose bits do not depend on the machine.
//!
//! std's `sin`, `exp`, … call the platform's libm, so that two machines may differ in the last bit; these use only
//! IEEE operations (+, −, ×, ÷, √), which do not. Series are Taylor's on a reduced range, long enough that rounding,
//! not truncation, is the error: each function states its bound, and a test holds it to that against std.

use std::f64::consts::{FRAC_PI_2, LN_2, PI};

/// π/2 in three parts of 33 bits each (the last of 53): multiples up to 2²⁰ of the first two are exact.
const PIO2: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];
/// ln 2 in two parts; multiples of the first up to 2¹¹ are exact.
const LN2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
/// Arguments of sine and cosine beyond this are first reduced by the (exact) remainder of 2π rounded to f64.
const REDUCED: f64 = 1_048_576.0;

/// Horner's rule, highest power first.
#[inline(always)]
fn polynomial<const N: usize>(x: f64, coefficients: [f64; N]) -> f64 {
    coefficients.into_iter().fold(0.0, |sum, c| sum * x + c)
}

/// sin(r) for |r| ≤ π/4.
#[inline]
fn sin_reduced(r: f64) -> f64 {
    let x = r * r;
    let tail = polynomial(
        x,
        [
            1.0 / 355_687_428_096_000.0,
            -1.0 / 1_307_674_368_000.0,
            1.0 / 6_227_020_800.0,
            -1.0 / 39_916_800.0,
            1.0 / 362_880.0,
            -1.0 / 5_040.0,
            1.0 / 120.0,
            -1.0 / 6.0,
        ],
    );
    r + r * x * tail
}

/// cos(r) for |r| ≤ π/4.
#[inline]
fn cos_reduced(r: f64) -> f64 {
    let x = r * r;
    let tail = polynomial(
        x,
        [
            -1.0 / 6_402_373_705_728_000.0,
            1.0 / 20_922_789_888_000.0,
            -1.0 / 87_178_291_200.0,
            1.0 / 479_001_600.0,
            -1.0 / 3_628_800.0,
            1.0 / 40_320.0,
            -1.0 / 720.0,
            1.0 / 24.0,
        ],
    );
    1.0 - (0.5 * x - x * x * tail)
}

/// Quadrant (mod 4) and remainder in [−π/4, π/4] of an angle.
fn quadrant(x: f64) -> (u8, f64) {
    let x = if x.abs() > REDUCED { x % (2.0 * PI) } else { x };
    let k = (x / FRAC_PI_2).round();
    let r = ((x - k * PIO2[0]) - k * PIO2[1]) - k * PIO2[2];
    (k.rem_euclid(4.0) as u8, r)
}

/// Sine and cosine of an angle in radians, within 2 ulp of 1 for |x| ≤ 2²⁰; NaN for non-finite x.
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    let (quadrant, r) = quadrant(x);
    let (s, c) = (sin_reduced(r), cos_reduced(r));
    match quadrant {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// Sine of an angle in radians: see [`sin_cos`].
#[must_use]
pub fn sin(x: f64) -> f64 {
    sin_cos(x).0
}

/// Cosine of an angle in radians: see [`sin_cos`].
#[must_use]
pub fn cos(x: f64) -> f64 {
    sin_cos(x).1
}

/// Tangent of an angle in radians, relative error below 1e-15 away from its poles.
#[must_use]
pub fn tan(x: f64) -> f64 {
    let (s, c) = sin_cos(x);
    s / c
}

/// e^x, relative error below 4e-16.
#[must_use]
pub fn exp(x: f64) -> f64 {
    if x.is_nan() {
        return x;
    }
    let x = x.clamp(-746.0, 710.0);
    let k = (x / LN_2).round();
    let r = (x - k * LN2[0]) - k * LN2[1];
    let tail = polynomial(
        r,
        [
            1.0 / 6_227_020_800.0,
            1.0 / 479_001_600.0,
            1.0 / 39_916_800.0,
            1.0 / 3_628_800.0,
            1.0 / 362_880.0,
            1.0 / 40_320.0,
            1.0 / 5_040.0,
            1.0 / 720.0,
            1.0 / 120.0,
            1.0 / 24.0,
            1.0 / 6.0,
            0.5,
        ],
    );
    let half = (k / 2.0).floor();
    (1.0 + (r + r * r * tail)) * power_of_two(half) * power_of_two(k - half)
}

/// 2^k for an integer −1022 ≤ k ≤ 1023.
fn power_of_two(k: f64) -> f64 {
    f64::from_bits(((k as i64 + 1023) as u64) << 52)
}

/// Natural logarithm, error below 1 ulp of max(1, |ln x|); NaN below 0, −∞ at 0.
#[must_use]
pub fn ln(x: f64) -> f64 {
    if x.is_nan() || x < 0.0 {
        return f64::NAN;
    }
    if x == 0.0 {
        return f64::NEG_INFINITY;
    }
    if x == f64::INFINITY {
        return x;
    }
    const TWO_54: f64 = 18_014_398_509_481_984.0;
    let (x, bias) = if x < f64::MIN_POSITIVE {
        (x * TWO_54, -54.0)
    } else {
        (x, 0.0)
    };
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i64 - 1023;
    let m = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52));
    let (m, exponent) = if m > std::f64::consts::SQRT_2 {
        (m * 0.5, exponent + 1)
    } else {
        (m, exponent)
    };
    let k = exponent as f64 + bias;
    // ln m = 2 artanh(s), s = (m − 1) / (m + 1), |s| < 0.172.
    let f = m - 1.0;
    let s = f / (2.0 + f);
    let x = s * s;
    let tail = polynomial(
        x,
        [
            2.0 / 23.0,
            2.0 / 21.0,
            2.0 / 19.0,
            2.0 / 17.0,
            2.0 / 15.0,
            2.0 / 13.0,
            2.0 / 11.0,
            2.0 / 9.0,
            2.0 / 7.0,
            2.0 / 5.0,
            2.0 / 3.0,
        ],
    );
    k * LN2[0] + (2.0 * s + (s * x * tail + k * LN2[1]))
}

/// x^y for x ≥ 0, as e^(y ln x): relative error below 4e-16 · (1 + |y ln x|).
#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    if y == 0.0 || x == 1.0 {
        1.0
    } else {
        exp(y * ln(x))
    }
}

/// Arc tangent of y/x in (−π, π], with the quadrant of the point (x, y); 0 at the origin. Error below 4e-16 · π.
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    let (ax, ay) = (x.abs(), y.abs());
    let (small, large) = if ay > ax { (ax, ay) } else { (ay, ax) };
    let ratio = if large == 0.0 { 0.0 } else { small / large };
    let octant = atan_unit(ratio);
    let first = if ay > ax { FRAC_PI_2 - octant } else { octant };
    let half = if x < 0.0 { PI - first } else { first };
    half.copysign(y)
}

/// Arc tangent for 0 ≤ x ≤ 1: atan x = π/6 + atan((√3 x − 1) / (√3 + x)) brings it below tan(π/12).
fn atan_unit(x: f64) -> f64 {
    const SQRT_3: f64 = 1.732_050_807_568_877_2;
    const TAN_PI_12: f64 = 0.267_949_192_431_122_7;
    let (base, r) = if x > TAN_PI_12 {
        (PI / 6.0, (SQRT_3 * x - 1.0) / (SQRT_3 + x))
    } else {
        (0.0, x)
    };
    let q = r * r;
    let tail = polynomial(
        q,
        [
            1.0 / 29.0,
            -1.0 / 27.0,
            1.0 / 25.0,
            -1.0 / 23.0,
            1.0 / 21.0,
            -1.0 / 19.0,
            1.0 / 17.0,
            -1.0 / 15.0,
            1.0 / 13.0,
            -1.0 / 11.0,
            1.0 / 9.0,
            -1.0 / 7.0,
            1.0 / 5.0,
            -1.0 / 3.0,
        ],
    );
    base + (r + r * q * tail)
}

/// Arc cosine in [0, π] of x clamped to [−1, 1].
#[must_use]
pub fn acos(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    atan2(((1.0 - x) * (1.0 + x)).sqrt(), x)
}

/// Sine and cosine of `turns` · 2π in f32, for sampling: error below 2e-7. `turns` in [−1, 1].
#[inline(always)]
#[must_use]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    // Exact: a multiple of a quarter, and what is left in [−1/8, 1/8].
    let quarter = (turns * 4.0 + 8.5) as i32 - 8;
    let r = (turns - quarter as f32 * 0.25) * std::f32::consts::TAU;
    let x = r * r;
    let s =
        r + r * x * (-1.0 / 6.0 + x * (1.0 / 120.0 + x * (-1.0 / 5_040.0 + x * (1.0 / 362_880.0))));
    let c = 1.0 + x * (-0.5 + x * (1.0 / 24.0 + x * (-1.0 / 720.0 + x * (1.0 / 40_320.0))));
    let (sin, cos) = if quarter & 1 == 0 { (s, c) } else { (c, s) };
    let sin = if quarter & 2 == 0 { sin } else { -sin };
    let cos = if (quarter + 1) & 2 == 0 { cos } else { -cos };
    (sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evenly spread arguments in [a, b].
    fn grid(a: f64, b: f64) -> impl Iterator<Item = f64> {
        (0..=40_000).map(move |i| a + (b - a) * f64::from(i) / 40_000.0)
    }

    #[test]
    fn circle_functions_agree_with_std() {
        for x in grid(-20.0, 20.0).chain(grid(-1e6, 1e6)) {
            let (s, c) = sin_cos(x);
            assert!((s - x.sin()).abs() <= 4.5e-16, "sin {x}");
            assert!((c - x.cos()).abs() <= 4.5e-16, "cos {x}");
        }
        for x in grid(-1.5, 1.5) {
            assert!((tan(x) - x.tan()).abs() <= 1e-15 * x.tan().abs(), "tan {x}");
        }
        assert!(sin(f64::INFINITY).is_nan() && cos(f64::NAN).is_nan());
    }

    #[test]
    fn exponential_and_logarithm_agree_with_std() {
        for x in grid(-700.0, 700.0).chain(grid(-1.0, 1.0)) {
            assert!((exp(x) - x.exp()).abs() <= 4e-16 * x.exp(), "exp {x}");
        }
        for x in grid(1e-9, 3.0).chain(grid(1.0, 1e9)) {
            assert!(
                (ln(x) - x.ln()).abs() <= 2.3e-16 * x.ln().abs().max(1.0),
                "ln {x}"
            );
        }
        assert_eq!(exp(-1000.0), 0.0);
        assert_eq!(exp(1000.0), f64::INFINITY);
        assert_eq!(ln(0.0), f64::NEG_INFINITY);
        assert!((ln(5e-324) - 5e-324f64.ln()).abs() < 1e-12);
        for x in grid(0.0, 4.0) {
            for y in [0.0, 1.0 / 2.4, 1.0, 2.4, 5.0] {
                let bound = 4e-16 * (1.0 + (y * x.max(1e-300).ln()).abs());
                assert!(
                    (pow(x, y) - x.powf(y)).abs() <= bound * x.powf(y),
                    "{x}^{y}"
                );
            }
        }
    }

    #[test]
    fn inverse_functions_agree_with_std() {
        for a in grid(-PI, PI) {
            let (y, x) = (a.sin(), a.cos());
            assert!((atan2(y, x) - y.atan2(x)).abs() <= 1.3e-15, "atan2 {a}");
        }
        for x in grid(-1.0, 1.0) {
            assert!((acos(x) - x.acos()).abs() <= 1.3e-15, "acos {x}");
        }
        assert_eq!(atan2(0.0, 0.0), 0.0);
    }

    #[test]
    fn turns_agree_with_std() {
        for x in grid(-1.0, 1.0) {
            let t = x as f32;
            let (s, c) = sin_cos_turns(t);
            let exact = f64::from(t) * 2.0 * PI;
            assert!((f64::from(s) - exact.sin()).abs() < 2e-7, "sin {t}");
            assert!((f64::from(c) - exact.cos()).abs() < 2e-7, "cos {t}");
        }
    }
}
