//! The sRGB transfer curve (IEC 61966-2-1).

use super::func::pow;
use std::sync::LazyLock;

/// Linear value of an sRGB-encoded one; both in [0, 1].
#[must_use]
pub fn srgb_to_linear(c: f64) -> f64 {
    if c <= 0.040_45 {
        c / 12.92
    } else {
        pow((c + 0.055) / 1.055, 2.4)
    }
}

/// Linear values of the 256 sRGB bytes.
pub static SRGB_BYTES: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| srgb_to_linear(i as f64 / 255.0) as f32));

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curve_is_the_standards() {
        assert_eq!(srgb_to_linear(0.0), 0.0);
        assert_eq!(srgb_to_linear(1.0), 1.0);
        assert!((srgb_to_linear(0.5) - 0.214_041_140_482_232_55).abs() < 1e-15);
        assert_eq!(SRGB_BYTES[255], 1.0);
        assert!(SRGB_BYTES.windows(2).all(|w| w[0] < w[1]));
    }
}
