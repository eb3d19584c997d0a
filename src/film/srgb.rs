//! The sRGB curve (IEC 61966-2-1) to 8 bits, the same on every machine.
//!
//! A code k is the nearest to an encoded value e, halves going up, exactly when (k − ½)/255 ≤ e < (k + ½)/255. The curve
//! rises, so that comparison can be made before it instead of after: [`Encoder`] holds the 255 linear values at which
//! the code changes, and no power function is called per pixel.

use crate::math::srgb_to_linear;

/// Steps between codes.
const MAX_CODE: f64 = 255.0;

/// Linear light to sRGB bytes.
#[derive(Clone, Debug)]
pub struct Encoder {
    /// `thresholds[k - 1]` is the smallest linear value whose code is k.
    thresholds: [f64; 255],
}

impl Encoder {
    /// Finds the thresholds.
    #[must_use]
    pub fn new() -> Encoder {
        Encoder {
            thresholds: std::array::from_fn(|i| srgb_to_linear((i as f64 + 0.5) / MAX_CODE)),
        }
    }

    /// The code of a linear value: clamped to [0, 1], encoded, rounded half up. NaN is 0.
    #[must_use]
    pub fn encode(&self, linear: f64) -> u8 {
        // 255 thresholds: the point is at most 255.
        self.thresholds.partition_point(|&t| t <= linear) as u8
    }
}

impl Default for Encoder {
    fn default() -> Self {
        Encoder::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition, with the standard library's power function.
    fn reference(linear: f64) -> u8 {
        let x = linear.clamp(0.0, 1.0);
        let e = if x <= 0.003_130_8 {
            12.92 * x
        } else {
            1.055 * x.powf(1.0 / 2.4) - 0.055
        };
        (e * 255.0 + 0.5).floor() as u8
    }

    #[test]
    fn agrees_with_the_definition() {
        let encoder = Encoder::new();
        const STEPS: u32 = 200_000;
        let wrong = (0..=STEPS)
            .map(|i| f64::from(i) / f64::from(STEPS))
            .filter(|&x| encoder.encode(x) != reference(x))
            .count();
        assert_eq!(wrong, 0);
    }

    #[test]
    fn every_byte_survives_a_round_trip() {
        let encoder = Encoder::new();
        for k in 0..=255u8 {
            assert_eq!(encoder.encode(srgb_to_linear(f64::from(k) / 255.0)), k);
        }
    }

    #[test]
    fn halves_go_up_and_the_ends_are_clamped() {
        let encoder = Encoder::new();
        for k in 1..=255u8 {
            let edge = encoder.thresholds[usize::from(k) - 1];
            assert_eq!(encoder.encode(edge), k);
            assert_eq!(encoder.encode(edge.next_down()), k - 1);
        }
        for (x, code) in [
            (f64::NAN, 0),
            (-1.0, 0),
            (f64::NEG_INFINITY, 0),
            (1.0, 255),
            (7.0, 255),
            (f64::INFINITY, 255),
        ] {
            assert_eq!(encoder.encode(x), code);
        }
    }
}
