//! Numbers in few digits, as a person would write them.

use crate::math::DVec3;

/// The number to so many significant digits.
pub(super) fn significant(x: f64, digits: usize) -> f64 {
    // Formatting rounds correctly, in decimal, at any magnitude; what it gives always reads back.
    format!("{x:.0$e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(x)
}

/// The number to five decimals.
pub(super) fn decimals(x: f64) -> f64 {
    const STEPS: f64 = 1e5;
    // 0 + x: no negative zero.
    0.0 + (x * STEPS).round() / STEPS
}

/// A place to a hundred-thousandth of `reach`.
pub(super) fn place(p: DVec3, reach: f64) -> [f64; 3] {
    /// Digits of a number as large as `reach`, and of any double.
    const DIGITS: usize = 5;
    const ALL: usize = 17;
    let short = |x: f64| {
        let (mut digits, mut size) = (DIGITS, x.abs() / reach);
        while size >= 1.0 && digits < ALL {
            (digits, size) = (digits + 1, size / 10.0);
        }
        0.0 + significant(x, digits)
    };
    p.to_array().map(short)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_in_decimal() {
        assert_eq!(significant(1234.5678, 5), 1234.6);
        assert_eq!(significant(-9.99996e-7, 5), -1e-6);
        assert_eq!(decimals(0.123_456_7), 0.123_46);
        assert!(decimals(-1e-9).is_sign_positive());
        let far = place(DVec3::new(1_234_567.123_456, -0.000_012_345_678, 0.0), 1.0);
        assert_eq!(far, [1_234_567.123_46, -0.000_012_346, 0.0]);
    }
}
