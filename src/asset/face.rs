//! The words of a face line to indices.

use super::corner::NONE;
use super::records::KINDS;

/// Which vertex, uv and normal a corner names; [`NONE`] for what it does not.
pub(super) type Corner = [u32; 3];

/// Reads the corners of a face that says nothing out of the ordinary: numbers of up to nine digits, slashes, blanks. In
/// one pass over the bytes, since most of a file is faces. Returns whether that was all; [`corner`] knows the rest.
pub(super) fn plain_corners(text: &[u8], out: &mut Vec<Corner>) -> bool {
    out.clear();
    let is_blank = |byte: &u8| matches!(byte, b' ' | b'\t');
    let mut at = 0;
    loop {
        while text.get(at).is_some_and(is_blank) {
            at += 1;
        }
        if at == text.len() {
            return true;
        }
        let mut corner = [NONE; 3];
        for (kind, index) in corner.iter_mut().enumerate() {
            let (first, mut number) = (at, 0u32);
            while let Some(digit @ b'0'..=b'9') = text.get(at) {
                number = number
                    .wrapping_mul(10)
                    .wrapping_add(u32::from(digit - b'0'));
                at += 1;
            }
            match (at - first, number) {
                (0, _) => {}
                (1..=9, 1..) => *index = number - 1,
                _ => return false,
            }
            if text.get(at) != Some(&b'/') {
                break;
            }
            if kind + 1 == KINDS.len() {
                return false;
            }
            at += 1;
        }
        let ends = text.get(at).is_none_or(is_blank);
        if corner[0] == NONE || !ends {
            return false;
        }
        out.push(corner);
    }
}

/// Reads a corner of a face: `1`, `1/2`, `1//3` or `1/2/3`. `counts` is how many lines of each kind stand above.
pub(super) fn corner(token: &str, counts: &[usize; 3]) -> Result<Corner, String> {
    let mut corner = [NONE; 3];
    let mut rest = token;
    for kind in 0.. {
        let slash = rest.bytes().position(|byte| byte == b'/');
        let digits = &rest[..slash.unwrap_or(rest.len())];
        if kind == KINDS.len() {
            return Err(format!("`{token}` has more than three indices"));
        }
        if !digits.is_empty() {
            corner[kind] = index(digits, kind, counts[kind])?;
        }
        let Some(slash) = slash else {
            break;
        };
        rest = &rest[slash + 1..];
    }
    if corner[0] == NONE {
        return Err(format!("`{token}` names no vertex"));
    }
    Ok(corner)
}

/// The absolute index, from 0, that an index of a face means; negative ones count from the last line so far. What is
/// too large for any file is the largest index.
fn index(digits: &str, kind: usize, count: usize) -> Result<u32, String> {
    let name = KINDS[kind];
    let index: i64 = digits
        .parse()
        .map_err(|_| format!("`{digits}` is not a `{name}` index"))?;
    let index = match index {
        0 => return Err(format!("`{name}` indices start at 1, and this face uses 0")),
        1.. => index as u64 - 1,
        _ => (count as u64).checked_sub(index.unsigned_abs()).ok_or_else(|| {
            format!("`{name}` index {index} reaches before the first: only {count} stand above this face")
        })?,
    };
    Ok(index.min(u64::from(NONE - 1)) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_short_way_and_the_long_way_read_alike() {
        for line in [
            "1 2 3",
            " 1/2\t3/4/5  6//7 ",
            "999999999/1/1",
            "8/ 9// 7/3/",
            "",
        ] {
            let mut short = Vec::new();
            assert!(plain_corners(line.as_bytes(), &mut short), "{line}");
            let long = line
                .split_ascii_whitespace()
                .map(|token| corner(token, &[9; 3]));
            assert_eq!(Ok(short), long.collect(), "{line}");
        }
        for line in [
            "-1",
            "0",
            "1/0",
            "+1",
            "1 2 # 3",
            "1/2/3/",
            "1/2/3/4",
            "/1",
            "1000000000",
            "1 x",
        ] {
            assert!(!plain_corners(line.as_bytes(), &mut Vec::new()), "{line}");
        }
    }
}
