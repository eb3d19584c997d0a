//! Arrays of numpy: `.npy` (format 1.0, little-endian, C order) and members of `.npz`, a ZIP archive.

use miniz_oxide::inflate::decompress_to_vec;

fn number(bytes: &[u8], at: usize, length: usize) -> usize {
    bytes[at..at + length]
        .iter()
        .rev()
        .fold(0, |n, b| n << 8 | usize::from(*b))
}

/// A file of a ZIP archive (PKWARE APPNOTE §4.3): found by the central directory, stored or deflated.
pub(crate) fn member(archive: &[u8], name: &str) -> Vec<u8> {
    let end = archive
        .windows(4)
        .rposition(|w| w == b"PK\x05\x06")
        .expect("the end of a central directory");
    let mut at = number(archive, end + 16, 4);
    for _ in 0..number(archive, end + 10, 2) {
        let method = number(archive, at + 10, 2);
        let packed = number(archive, at + 20, 4);
        let [name_length, extra, comment] = [28, 30, 32].map(|k| number(archive, at + k, 2));
        let local = number(archive, at + 42, 4);
        if &archive[at + 46..at + 46 + name_length] == name.as_bytes() {
            let start =
                local + 30 + number(archive, local + 26, 2) + number(archive, local + 28, 2);
            let bytes = &archive[start..start + packed];
            return match method {
                0 => bytes.to_vec(),
                8 => decompress_to_vec(bytes).expect("deflated bytes"),
                other => panic!("compression method {other}"),
            };
        }
        at += 46 + name_length + extra + comment;
    }
    panic!("no {name} in the archive");
}

fn values<'a>(array: &'a [u8], kind: &str) -> impl Iterator<Item = [u8; 4]> + 'a {
    assert_eq!(&array[..8], b"\x93NUMPY\x01\x00");
    let header = number(array, 8, 2);
    let text = String::from_utf8_lossy(&array[10..10 + header]);
    assert!(
        text.contains(kind) && text.contains("'fortran_order': False"),
        "{text}"
    );
    array[10 + header..]
        .chunks_exact(4)
        .map(|b| [b[0], b[1], b[2], b[3]])
}

pub(crate) fn floats(array: &[u8]) -> Vec<f32> {
    values(array, "'<f4'").map(f32::from_le_bytes).collect()
}

pub(crate) fn ints(array: &[u8]) -> Vec<i32> {
    values(array, "'<i4'").map(i32::from_le_bytes).collect()
}
