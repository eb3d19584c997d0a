//! Numbers as people write them.

use crate::math::DVec3;

/// Three numbers as one writes them.
pub(super) fn place(p: DVec3) -> String {
    format!("({}, {}, {})", short(p.x), short(p.y), short(p.z))
}

/// A number to three digits.
pub(crate) fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{x:.2e}");
    }
    let digits = if size >= 100.0 {
        0
    } else if size >= 10.0 {
        1
    } else if size >= 1.0 {
        2
    } else {
        4
    };
    let text = format!("{x:.digits$}");
    if text.contains('.') {
        let text = text.trim_end_matches('0').trim_end_matches('.');
        return if text == "-0" {
            "0".to_owned()
        } else {
            text.to_owned()
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 1.0, -2.5, 1234.5, 12.345, 0.012, 1e-9, 3e8, -0.00001].map(short);
        let wanted = [
            "0", "1", "-2.5", "1234", "12.3", "0.012", "1.00e-9", "3.00e8", "-1.00e-5",
        ];
        assert_eq!(texts, wanted);
    }
}
