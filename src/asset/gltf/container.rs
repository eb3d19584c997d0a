//! The glTF container: the bytes of a `.gltf` or `.glb` file, told apart by content, to JSON text and a binary chunk.
//!
//! Deliberately absent: what the JSON says. The layout of GLB is that of the glTF 2.0 specification, section 4.4.

use crate::asset::codes;
use crate::diag::Diagnostic;
use std::ops::Range;

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// A file with the places of its parts. Nothing is copied.
#[derive(Debug)]
pub(super) struct Container {
    bytes: Vec<u8>,
    json: Range<usize>,
    binary: Option<Range<usize>>,
}

impl Container {
    /// Finds the parts of a file; what is odd but readable goes to `warnings`.
    ///
    /// # Errors
    /// A file that is neither GLB nor UTF-8 text, a GLB of another version, or one whose chunks are broken.
    pub(super) fn open(
        bytes: Vec<u8>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Container, Diagnostic> {
        let (json, binary) = if bytes.starts_with(MAGIC) {
            chunks(&bytes, warnings)?
        } else {
            (0..bytes.len(), None)
        };
        let json = without_mark(&bytes, json, warnings);
        if let Err(e) = std::str::from_utf8(&bytes[json.clone()]) {
            let at = json.start + e.valid_up_to();
            let error = broken(format!("neither GLB nor JSON: byte {at} is not UTF-8 text"));
            return Err(error.hint("export it again as glTF 2.0"));
        }
        Ok(Container {
            bytes,
            json,
            binary,
        })
    }

    /// The JSON text.
    pub(super) fn json(&self) -> &str {
        // Checked when it was opened.
        std::str::from_utf8(&self.bytes[self.json.clone()]).unwrap_or_default()
    }

    /// The binary chunk of a GLB, where there is one.
    pub(super) fn binary(&self) -> Option<&[u8]> {
        self.binary.clone().map(|range| &self.bytes[range])
    }

    /// Whether it is a GLB.
    pub(super) fn is_binary(&self) -> bool {
        self.bytes.starts_with(MAGIC)
    }
}

fn broken(says: String) -> Diagnostic {
    Diagnostic::error(codes::GLTF_CONTAINER, says)
}

fn odd(says: String) -> Diagnostic {
    Diagnostic::warning(codes::GLTF_ODD_CONTAINER, says)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}

/// The text without a byte order mark, which the format forbids (section 2.2) and many writers leave.
fn without_mark(bytes: &[u8], json: Range<usize>, warnings: &mut Vec<Diagnostic>) -> Range<usize> {
    if bytes[json.clone()].starts_with(BYTE_ORDER_MARK) {
        warnings.push(odd("the JSON starts with a byte order mark".into()));
        return json.start + BYTE_ORDER_MARK.len()..json.end;
    }
    json
}

/// The declared length of the file, checked against the bytes that exist.
fn declared_length(bytes: &[u8], warnings: &mut Vec<Diagnostic>) -> Result<usize, Diagnostic> {
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        let says = format!("the GLB header ends after {} of 12 bytes", bytes.len());
        return Err(broken(says).hint("the file is cut off: copy or export it again"));
    };
    if version != 2 {
        let says = format!("a GLB container of version {version}");
        let hint = "luxel reads glTF 2.0: export it again as 2.0";
        return Err(Diagnostic::error(codes::GLTF_VERSION, says).hint(hint));
    }
    let length = length as usize;
    if length < HEADER + CHUNK_HEADER {
        let says =
            format!("the GLB header declares a length of {length} bytes, too small for a chunk");
        return Err(broken(says).hint("export it again"));
    }
    if length != bytes.len() {
        let there = bytes.len();
        warnings.push(odd(format!(
            "the GLB header declares {length} bytes, the file has {there}"
        )));
    }
    Ok(length)
}

type Chunks = (Range<usize>, Option<Range<usize>>);

/// The JSON and the BIN chunk of a GLB.
fn chunks(bytes: &[u8], warnings: &mut Vec<Diagnostic>) -> Result<Chunks, Diagnostic> {
    let length = declared_length(bytes, warnings)?;
    let mut json = None;
    let mut binary = None;
    let mut at = HEADER;
    let mut index = 0;
    while at < length.min(bytes.len()) {
        let (kind, body) = chunk(bytes, at, length)?;
        let name = chunk_name(kind);
        if body.len() % 4 != 0 {
            let len = body.len();
            warnings.push(odd(format!(
                "the {name} chunk at byte {at} has {len} bytes, not a multiple of 4"
            )));
        }
        match kind {
            JSON if index == 0 => json = Some(body.clone()),
            _ if index == 0 => {
                let says = format!("the first GLB chunk is {name}, not JSON");
                return Err(broken(says).hint("export it again"));
            }
            JSON => {
                let says = format!("the GLB has a second JSON chunk at byte {at}");
                return Err(broken(says).hint("export it again"));
            }
            BIN if binary.is_some() => {
                let says = format!("the GLB has a second BIN chunk at byte {at}");
                return Err(broken(says).hint("export it again"));
            }
            BIN => {
                if index != 1 {
                    let says = format!("the BIN chunk at byte {at} is not the second chunk");
                    warnings.push(odd(says));
                }
                binary = Some(body.clone());
            }
            // Unknown chunks are for extensions, and ignored (section 4.4.3).
            _ => {}
        }
        at = body.end;
        index += 1;
    }
    match json {
        Some(json) if !json.is_empty() => Ok((json, binary)),
        Some(_) => Err(broken("the JSON chunk of the GLB is empty".into()).hint("export it again")),
        None => Err(broken("the GLB has no chunk".into()).hint("export it again")),
    }
}

/// Kind and bytes of the chunk at a place.
fn chunk(bytes: &[u8], at: usize, length: usize) -> Result<(u32, Range<usize>), Diagnostic> {
    let cut = "the file is cut off: copy or export it again";
    let (Some(len), Some(kind)) = (word(bytes, at), word(bytes, at + 4)) else {
        let says = format!("the GLB ends inside the header of the chunk at byte {at}");
        return Err(broken(says).hint(cut));
    };
    let start = at + CHUNK_HEADER;
    let end = start.saturating_add(len as usize);
    let name = chunk_name(kind);
    if end > length {
        let says = format!(
            "the {name} chunk at byte {at} declares {len} bytes and does not fit the {length} bytes of the GLB"
        );
        return Err(broken(says).hint("export it again"));
    }
    if end > bytes.len() {
        let there = bytes.len() - start;
        let says = format!("the {name} chunk at byte {at} has {there} of its {len} bytes");
        return Err(broken(says).hint(cut));
    }
    Ok((kind, start..end))
}

fn chunk_name(kind: u32) -> String {
    match kind {
        JSON => "JSON".into(),
        BIN => "BIN".into(),
        other => format!("unknown (0x{other:08X})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A GLB of chunks, with a declared length that is right.
    fn glb(chunks: &[(u32, &[u8])]) -> Vec<u8> {
        let mut bytes = [MAGIC, &2_u32.to_le_bytes(), &[0; 4]].concat();
        for (kind, body) in chunks {
            bytes.extend((body.len() as u32).to_le_bytes());
            bytes.extend(kind.to_le_bytes());
            bytes.extend_from_slice(body);
        }
        let length = bytes.len() as u32;
        bytes[8..12].copy_from_slice(&length.to_le_bytes());
        bytes
    }

    fn open(bytes: &[u8]) -> Result<(Container, Vec<Diagnostic>), Diagnostic> {
        let mut warnings = Vec::new();
        Container::open(bytes.to_vec(), &mut warnings).map(|container| (container, warnings))
    }

    fn code(bytes: &[u8]) -> &'static str {
        open(bytes).expect_err("a broken container").code
    }

    fn warnings(bytes: &[u8]) -> usize {
        open(bytes).expect("a readable container").1.len()
    }

    #[test]
    fn parts_are_found() {
        let (container, warnings) = open(&glb(&[(JSON, b"{}  "), (BIN, b"abcd")])).expect("a GLB");
        assert_eq!(
            (container.json(), container.binary()),
            ("{}  ", Some(&b"abcd"[..]))
        );
        assert!(warnings.is_empty() && container.is_binary());
        let (container, warnings) = open(b"{}").expect("text");
        assert_eq!((container.json(), container.binary()), ("{}", None));
        assert!(warnings.is_empty() && !container.is_binary());
        // Unknown chunks are ignored.
        assert_eq!(warnings_of_unknown(), 0);
    }

    fn warnings_of_unknown() -> usize {
        warnings(&glb(&[(JSON, b"{}  "), (BIN, b"abcd"), (7, b"....")]))
    }

    #[test]
    fn what_is_odd_is_read_with_a_warning() {
        assert_eq!(warnings(b"\xEF\xBB\xBF{}"), 1);
        assert_eq!(warnings(&glb(&[(JSON, b"{}")])), 1);
        assert_eq!(
            warnings(&glb(&[(JSON, b"{}  "), (7, b"...."), (BIN, b"abcd")])),
            1
        );
        let trailing = [&glb(&[(JSON, b"{}  ")])[..], b"junk"].concat();
        assert_eq!(warnings(&trailing), 1);
    }

    #[test]
    fn what_is_broken_is_refused() {
        let whole = glb(&[(JSON, b"{}  "), (BIN, b"abcd")]);
        for end in 4..whole.len() {
            // Cut between the chunks only the declared length is wrong.
            if end != whole.len() - 12 {
                assert_eq!(code(&whole[..end]), "E120", "cut at {end}");
            }
        }
        assert_eq!(code(&glb(&[])), "E120");
        assert_eq!(code(&glb(&[(JSON, b"")])), "E120");
        assert_eq!(code(&glb(&[(BIN, b"abcd"), (JSON, b"{}  ")])), "E120");
        assert_eq!(code(&glb(&[(JSON, b"{}  "), (JSON, b"{}  ")])), "E120");
        assert_eq!(
            code(&glb(&[(JSON, b"{}  "), (BIN, b"abcd"), (BIN, b"abcd")])),
            "E120"
        );
        let mut huge = whole.clone();
        huge[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
        assert_eq!(code(&huge), "E120");
        let mut old = whole;
        old[4] = 1;
        assert_eq!(code(&old), "E121");
        assert_eq!(code(b"\xFF\xFE"), "E120");
    }
}
