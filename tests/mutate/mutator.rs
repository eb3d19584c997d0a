//! Files to damaged files, by number: the same number gives the same damage.

use crate::support::Rng;

/// Numbers that break what was not thought of.
const EXTREMES: [&str; 20] = [
    "0",
    "-0",
    "1",
    "-1",
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e400",
    "5e-324",
    "1e-30",
    "1e30",
    "2147483648",
    "4294967295",
    "4294967296",
    "99999999999999999999",
    "1000000000",
    "0.5",
    "",
];

/// Words of the formats, to stand where they should not.
const WORDS: [&str; 20] = [
    "\nf ",
    "\nv ",
    "\nvt ",
    "\nusemtl ",
    "\nnewmtl ",
    "\nmap_Kd ",
    "\\\n",
    "#",
    "\r",
    "(",
    ")",
    "[",
    "\"",
    "..",
    "//",
    "Some(",
    "{",
    "null",
    "\"extensions\": {\"KHR_materials_transmission\": {}}, ",
    "\"mesh\": 0, ",
];

/// Largest piece that is moved, doubled or removed.
const MAX_PIECE: usize = 512;

/// Damages `seed` in one or two places; `other` is a file of the same kind to take pieces from.
pub(crate) fn mutate(rng: &mut Rng, seed: &[u8], other: &[u8]) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=rng.below(2) {
        if bytes.is_empty() {
            break;
        }
        match rng.below(10) {
            0 => flip(rng, &mut bytes),
            1..=3 => number(rng, &mut bytes),
            4 => drop(bytes.drain(piece(rng, bytes.len()))),
            5 => {
                let copy = bytes[piece(rng, bytes.len())].to_vec();
                let at = rng.below(bytes.len() + 1);
                drop(bytes.splice(at..at, copy));
            }
            6 => swap(rng, &mut bytes),
            7 => bytes.truncate(rng.below(bytes.len())),
            8 => splice(rng, &mut bytes, other),
            _ => {
                let word = WORDS[rng.below(WORDS.len())];
                let at = rng.below(bytes.len() + 1);
                drop(bytes.splice(at..at, word.bytes()));
            }
        }
    }
    if bytes.starts_with(b"\x89PNG") && rng.below(4) > 0 {
        mend_png(&mut bytes);
    }
    if bytes.starts_with(b"glTF") && rng.below(4) > 0 {
        mend_glb(&mut bytes);
    }
    bytes
}

fn piece(rng: &mut Rng, len: usize) -> std::ops::Range<usize> {
    let at = rng.below(len);
    at..len.min(at + 1 + rng.below(MAX_PIECE))
}

/// One bit, one byte, or four bytes at once.
fn flip(rng: &mut Rng, bytes: &mut [u8]) {
    let at = rng.below(bytes.len());
    match rng.below(3) {
        0 => bytes[at] ^= 1 << rng.below(8),
        1 => bytes[at] = rng.bits() as u8,
        _ => {
            let word = [u32::MAX, 0, 1 << 31, 1 << 24, rng.bits() as u32][rng.below(5)];
            let end = bytes.len().min(at + 4);
            bytes[at..end].copy_from_slice(&word.to_le_bytes()[..end - at]);
        }
    }
}

/// Replaces a number that is written in digits.
fn number(rng: &mut Rng, bytes: &mut Vec<u8>) {
    let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
    let from = rng.below(bytes.len());
    let Some(start) = bytes[from..].iter().position(u8::is_ascii_digit) else {
        return flip(rng, bytes);
    };
    let start = from + start;
    let len = bytes[start..]
        .iter()
        .take_while(|byte| is_part(byte))
        .count();
    let extreme = EXTREMES[rng.below(EXTREMES.len())];
    drop(bytes.splice(start..start + len, extreme.bytes()));
}

fn swap(rng: &mut Rng, bytes: &mut [u8]) {
    let len = bytes.len();
    let size = 1 + rng.below(MAX_PIECE.min(len));
    let (a, b) = (rng.below(len - size + 1), rng.below(len - size + 1));
    (0..size).for_each(|i| bytes.swap(a + i, b + i));
}

/// The beginning of one file and the end of another.
fn splice(rng: &mut Rng, bytes: &mut Vec<u8>, other: &[u8]) {
    bytes.truncate(rng.below(bytes.len() + 1));
    bytes.extend_from_slice(&other[rng.below(other.len() + 1)..]);
}

/// Corrects the checksums of a PNG's chunks, so that the damage reaches the decoder.
fn mend_png(bytes: &mut [u8]) {
    let mut at = 8;
    while let Some(length) = bytes.get(at..at + 4) {
        let length = u32::from_be_bytes([length[0], length[1], length[2], length[3]]) as usize;
        let end = at.saturating_add(8).saturating_add(length);
        if end.saturating_add(4) > bytes.len() {
            return;
        }
        let sum = crc32(&bytes[at + 4..end]).to_be_bytes();
        bytes[end..end + 4].copy_from_slice(&sum);
        at = end + 4;
    }
}

/// Corrects the lengths in a GLB, so that the damage reaches what its chunks say.
fn mend_glb(bytes: &mut [u8]) {
    const JSON: usize = 20;
    let whole = bytes.len();
    let binary = bytes.windows(4).position(|four| four == b"BIN\0");
    if whole < JSON {
        return;
    }
    let mut write = |at: usize, length: usize| {
        bytes[at..at + 4].copy_from_slice(&(length as u32).to_le_bytes());
    };
    write(8, whole);
    match binary.filter(|&kind| kind >= JSON + 4) {
        Some(kind) => {
            write(12, kind - 4 - JSON);
            write(kind - 4, whole - kind - 4);
        }
        None => write(12, whole - JSON),
    }
}

/// The checksum of PNG chunks (ISO 3309), bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| {
            if c & 1 == 1 {
                (c >> 1) ^ 0xEDB8_8320
            } else {
                c >> 1
            }
        })
    })
}
