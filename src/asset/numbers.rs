//! The numbers of a vertex line that says nothing out of the ordinary: `-1.234567`, of up to fifteen digits.
//!
//! Most of what is not faces is such numbers, and a decimal that short needs no search for the nearest double: its digits
//! and its power of ten are exact, so that one division rounds once (Clinger, "How to read floating point numbers
//! accurately", 1990, section 3). The bits are those of `str::parse`. Whatever is longer, has an exponent or is no
//! number at all is left to the parser.

/// Numbers of a line that may be read here: a position and a colour.
pub(super) const MAX_NUMBERS: usize = 6;

/// Digits whose number is below 2⁵³.
const MAX_DIGITS: usize = 15;

/// Powers of ten, exact.
const TEN_TO: [f64; MAX_DIGITS + 1] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
];

/// Reads all the numbers of a line; `None` if one of them is not plain, or there are more than [`MAX_NUMBERS`].
pub(super) fn plain_numbers(text: &[u8]) -> Option<([f64; MAX_NUMBERS], usize)> {
    let mut numbers = [0.0; MAX_NUMBERS];
    let (mut count, mut rest) = (0, text);
    loop {
        while let [b' ' | b'\t', after @ ..] = rest {
            rest = after;
        }
        if rest.is_empty() {
            return Some((numbers, count));
        }
        let (number, after) = plain_number(rest)?;
        *numbers.get_mut(count)? = number;
        count += 1;
        rest = after;
    }
}

/// Reads one number, which a blank or the end follows; what is behind it.
fn plain_number(text: &[u8]) -> Option<(f64, &[u8])> {
    let (negative, text) = match text {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, text),
    };
    let (mut digits, mut value, mut point) = (0, 0u64, None);
    let mut rest = text;
    while let [byte, after @ ..] = rest {
        match byte {
            b'0'..=b'9' => {
                value = value.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                digits += 1;
            }
            b'.' if point.is_none() => point = Some(digits),
            b' ' | b'\t' => break,
            _ => return None,
        }
        rest = after;
    }
    if !(1..=MAX_DIGITS).contains(&digits) {
        return None;
    }
    let decimals = point.map_or(0, |before| digits - before);
    let number = value as f64 / TEN_TO[decimals];
    Some((if negative { -number } else { number }, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers of a line as the standard library reads them.
    fn exact(line: &str) -> Vec<u64> {
        let words = line.split_ascii_whitespace();
        words
            .map(|word| word.parse::<f64>().expect(word).to_bits())
            .collect()
    }

    fn plain(line: &str) -> Option<Vec<u64>> {
        let (numbers, count) = plain_numbers(line.as_bytes())?;
        Some(numbers[..count].iter().map(|n| n.to_bits()).collect())
    }

    #[test]
    fn plain_numbers_have_the_bits_of_the_standard_library() {
        for line in [
            "",
            "0 -0 -0.000000 00012 7.",
            " 1\t-2.5  .5 999999999999999 0.12345678901234 -.5 ",
        ] {
            assert_eq!(plain(line), Some(exact(line)), "{line}");
        }
        // Every length, with the point at every place, over digits without a pattern.
        let mut state = 1u64;
        for _ in 0..20_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let length = 1 + (state >> 60) as usize % MAX_DIGITS;
            let mut word = format!("{:015}", (state >> 8) % 1_000_000_000_000_000);
            word.truncate(length);
            word.insert((state >> 33) as usize % (length + 1), '.');
            assert_eq!(plain(&word), Some(exact(&word)), "{word}");
        }
    }

    #[test]
    fn all_else_is_left_to_the_parser() {
        for line in [
            "1e5",
            "+1",
            "nan",
            "1 2 x",
            ".",
            "-",
            "--1",
            "1.2.3",
            "1 # 2",
            "1/2",
            "1234567890123456",
            "0.0000000000000001",
            "1 2 3 4 5 6 7",
            "\u{a0}1",
        ] {
            assert_eq!(plain(line), None, "{line}");
        }
    }
}
