//! `Srgb("#rrggbb")` to linear light by the exact curve of IEC 61966-2-1.

/// Linear R, G, B of `#rrggbb`; `None` if it is not that.
pub(super) fn decode_hex(hex: &str) -> Option<[f64; 3]> {
    let digits = hex.strip_prefix('#')?;
    if digits.len() != 6 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let channel = |i: usize| {
        u8::from_str_radix(&digits[2 * i..2 * i + 2], 16)
            .ok()
            .map(decode)
    };
    Some([channel(0)?, channel(1)?, channel(2)?])
}

/// `#rrggbb` of a linear colour that is exactly one; `None` for any other.
pub(super) fn encode_hex(linear: [f64; 3]) -> Option<String> {
    let channel = |x: f64| (0..=u8::MAX).find(|&value| decode(value) == x);
    let [r, g, b] = linear.map(channel);
    Some(format!("#{:02x}{:02x}{:02x}", r?, g?, b?))
}

/// Linear value of an 8-bit sRGB channel.
fn decode(value: u8) -> f64 {
    let encoded = f64::from(value) / 255.0;
    if encoded <= 0.040_45 {
        return encoded / 12.92;
    }
    let base = (encoded + 0.055) / 1.055;
    let square = base * base;
    square * fifth_root(square)
}

/// `x^(1/5)` for x in (0.001, 1], by Newton from above in plain arithmetic: the same bits on every machine.
fn fifth_root(x: f64) -> f64 {
    /// Seven steps from 1 come near the root of the smallest x, five more are quadratic.
    const STEPS: usize = 16;
    let mut y = 1.0_f64;
    for _ in 0..STEPS {
        let y4 = (y * y) * (y * y);
        y -= (y * y4 - x) / (5.0 * y4);
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_channel_value_is_the_curve_s() {
        for value in 0..=255_u8 {
            let x = f64::from(value) / 255.0;
            let wanted = if x <= 0.040_45 {
                x / 12.92
            } else {
                ((x + 0.055) / 1.055).powf(2.4)
            };
            assert!(
                (decode(value) - wanted).abs() <= 1e-15 * wanted,
                "{value}: {} {wanted}",
                decode(value)
            );
        }
    }

    #[test]
    fn ends_are_exact_and_order_is_kept() {
        assert_eq!(decode_hex("#000000"), Some([0.0; 3]));
        assert_eq!(decode_hex("#FFffFF"), Some([1.0; 3]));
        assert!((1..=255).all(|v| decode(v) > decode(v - 1)));
    }

    #[test]
    fn only_six_digits_are_a_colour() {
        for bad in [
            "c0ffee",
            "#c0ffe",
            "#c0ffeee",
            "#c0ffeg",
            "#+0ffee",
            "",
            "#é0ff€",
        ] {
            assert_eq!(decode_hex(bad), None, "{bad}");
        }
    }
}
