//! URIs of glTF files: embedded bytes, or a local file relative to the glTF (specification, section 2.9).
//!
//! Deliberately absent: reading files.

use std::path::{Path, PathBuf};

/// What a URI stands for.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Uri {
    /// `data:`: media type, without parameters, and bytes.
    Embedded(String, Vec<u8>),
    /// A file.
    File(PathBuf),
}

/// What is wrong with a URI, and what to do about it.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct BadUri {
    pub(super) says: String,
    pub(super) hint: &'static str,
}

/// The scheme of a URI, where it has one. A single letter before a colon is a Windows drive.
pub(super) fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let word = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    let starts = scheme.starts_with(|c: char| c.is_ascii_alphabetic());
    let is_scheme = scheme.is_empty() || scheme.len() > 1 && starts && scheme.chars().all(word);
    is_scheme.then_some(scheme)
}

/// Resolves a URI of the glTF file `document`.
///
/// A path may be percent-encoded or not, may lead through folders and out of them, and may be absolute.
///
/// # Errors
/// Remote and unknown schemes, broken base64, and what can name no file.
pub(super) fn resolve(document: &Path, uri: &str) -> Result<Uri, BadUri> {
    let bad = |says: String, hint| Err(BadUri { says, hint });
    match scheme(uri).map(str::to_ascii_lowercase).as_deref() {
        Some("data") => return embedded(&uri["data:".len()..]),
        Some("http" | "https" | "ftp") => {
            let says = format!("luxel does not fetch {:?}", clipped(uri));
            return bad(says, "download the file, and name it relative to the glTF");
        }
        Some("") => {
            return bad(
                format!("{:?} is not a URI", clipped(uri)),
                "name a file beside the glTF",
            );
        }
        Some(other) => {
            let says = format!("a URI of scheme {other:?} cannot be read");
            return bad(says, "name the file relative to the glTF");
        }
        None => {}
    }
    if uri.trim().is_empty() || uri.contains('\0') || uri.contains("%00") {
        return bad(
            format!("{:?} cannot name a file", clipped(uri)),
            "name a file beside the glTF",
        );
    }
    Ok(Uri::File(local(document, uri)))
}

/// The file that exists among the readings of a path; if none does, the first. Writers should encode spaces and other
/// letters, and often do not, so that a `%` or a `\` may also be meant as it stands.
fn local(document: &Path, uri: &str) -> PathBuf {
    let folder = document.parent().unwrap_or(Path::new(""));
    // Drops the `.` of `./name`.
    let join = |name: &str| -> PathBuf { folder.join(name).components().collect() };
    let decoded = String::from_utf8(percent_decoded(uri)).unwrap_or_else(|_| uri.to_owned());
    let meant = join(&decoded);
    let readings = [join(uri), join(&decoded.replace('\\', "/"))];
    if meant.is_file() {
        return meant;
    }
    readings
        .into_iter()
        .find(|path| path.is_file())
        .unwrap_or(meant)
}

/// The media type of a data URI, which is not decoded for it.
pub(super) fn media_type(uri: &str) -> Option<String> {
    scheme(uri).filter(|scheme| scheme.eq_ignore_ascii_case("data"))?;
    let (head, _) = uri.get("data:".len()..)?.split_once(',')?;
    Some(
        head.split(';')
            .next()
            .unwrap_or("")
            .trim()
            .to_ascii_lowercase(),
    )
}

/// Whether a data URI has a parameter of no letters, which RFC 2397 does not allow.
pub(super) fn has_empty_parameter(uri: &str) -> bool {
    let rest = scheme(uri).filter(|scheme| scheme.eq_ignore_ascii_case("data"));
    let rest = rest.and_then(|_| uri.get("data:".len()..));
    let head = rest.and_then(|rest| rest.split_once(','));
    head.is_some_and(|(head, _)| head.split(';').skip(1).any(|word| word.trim().is_empty()))
}

/// The media type and bytes of a data URI (RFC 2397) after its `data:`.
fn embedded(rest: &str) -> Result<Uri, BadUri> {
    let hint = "export the file again";
    let Some((head, body)) = rest.split_once(',') else {
        let says = "a data URI without a comma holds no data".into();
        return Err(BadUri { says, hint });
    };
    let mut parameters = head.split(';');
    let media = parameters.next().unwrap_or("").trim().to_ascii_lowercase();
    let is_base64 = parameters.any(|word| word.trim().eq_ignore_ascii_case("base64"));
    if !is_base64 {
        return Ok(Uri::Embedded(media, percent_decoded(body)));
    }
    let decoded = if body.contains('%') {
        base64(&percent_decoded(body))
    } else {
        base64(body.as_bytes())
    };
    match decoded {
        Ok(bytes) => Ok(Uri::Embedded(media, bytes)),
        Err(at) => {
            let says = format!("the data URI is not base64: character {at} of its data");
            Err(BadUri { says, hint })
        }
    }
}

/// Bytes with `%hh` decoded; a `%` that starts no such thing stands for itself.
fn percent_decoded(text: &str) -> Vec<u8> {
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).and_then(|&b| char::from(b).to_digit(16));
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        match (byte, digit(at + 1), digit(at + 2)) {
            (b'%', Some(high), Some(low)) => {
                decoded.push((high * 16 + low) as u8);
                at += 3;
            }
            _ => {
                decoded.push(byte);
                at += 1;
            }
        }
    }
    decoded
}

/// Decodes base64 (RFC 4648, section 4), padded or not; the place of the first wrong character from 0 otherwise.
fn base64(text: &[u8]) -> Result<Vec<u8>, usize> {
    let padding = text
        .iter()
        .rev()
        .take(2)
        .take_while(|&&c| c == b'=')
        .count();
    let digits = &text[..text.len() - padding];
    if digits.len() % 4 == 1 {
        return Err(digits.len());
    }
    let mut decoded = Vec::with_capacity(digits.len() / 4 * 3 + 2);
    for (group, chunk) in digits.chunks(4).enumerate() {
        let mut bits = 0;
        for (k, &c) in chunk.iter().enumerate() {
            bits = bits << 6 | sextet(c).ok_or(group * 4 + k)?;
        }
        bits <<= 6 * (4 - chunk.len());
        decoded.extend_from_slice(&bits.to_be_bytes()[1..chunk.len()]);
    }
    Ok(decoded)
}

fn sextet(c: u8) -> Option<u32> {
    let value = match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    };
    Some(u32::from(value))
}

/// The start of a URI, for a message.
pub(super) fn clipped(uri: &str) -> String {
    const KEPT: usize = 80;
    match uri.char_indices().nth(KEPT) {
        Some((at, _)) => format!("{}...", &uri[..at]),
        None => uri.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(uri: &str) -> PathBuf {
        match resolve(Path::new("models/box.gltf"), uri) {
            Ok(Uri::File(path)) => path,
            other => panic!("{uri}: {other:?}"),
        }
    }

    fn bytes(uri: &str) -> Vec<u8> {
        match resolve(Path::new("a.gltf"), uri) {
            Ok(Uri::Embedded(_, bytes)) => bytes,
            other => panic!("{uri}: {other:?}"),
        }
    }

    #[test]
    fn base64_follows_the_vectors_of_its_rfc() {
        let vectors = [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
        ];
        for (text, meant) in vectors {
            assert_eq!(base64(text.as_bytes()), Ok(meant.into()), "{text}");
            assert_eq!(
                base64(text.trim_end_matches('=').as_bytes()),
                Ok(meant.into())
            );
        }
        assert_eq!(base64(b"+/+/"), Ok(vec![0xFB, 0xFF, 0xBF]));
        assert_eq!(base64(b"Zm9v*m8="), Err(4));
        assert_eq!(base64(b"Zm9vY"), Err(5));
        assert_eq!(base64(b"Z==="), Err(1));
    }

    #[test]
    fn data_uris_hold_bytes() {
        assert_eq!(
            bytes("data:application/octet-stream;base64,AAEC"),
            [0, 1, 2]
        );
        assert_eq!(bytes("DATA:;base64,%41AEC"), [0, 1, 2]);
        assert_eq!(bytes("data:,a%20b"), b"a b");
        let media = resolve(Path::new(""), "data:Image/PNG;charset=x;base64,");
        assert_eq!(media, Ok(Uri::Embedded("image/png".into(), vec![])));
        assert_eq!(
            media_type("data:Image/PNG;base64,*"),
            Some("image/png".into())
        );
        assert_eq!(media_type("data.bin"), None);
        assert!(resolve(Path::new(""), "data:nothing").is_err());
        assert!(resolve(Path::new(""), "data:;base64,&").is_err());
    }

    #[test]
    fn paths_are_relative_to_the_document() {
        assert_eq!(file("a%20b.bin"), Path::new("models/a b.bin"));
        assert_eq!(file("a b.bin"), Path::new("models/a b.bin"));
        assert_eq!(file("./x/../y.bin"), Path::new("models/x/../y.bin"));
        assert_eq!(file("100%.png"), Path::new("models/100%.png"));
        assert_eq!(file("/abs.png"), Path::new("/abs.png"));
    }

    #[test]
    fn what_is_no_local_file_is_refused() {
        let refused = [
            "http://x/y.png",
            "HTTPS://x",
            "file:///x",
            ":",
            "",
            " ",
            "a%00b",
            "urn:x",
        ];
        for uri in refused {
            assert!(resolve(Path::new("a.gltf"), uri).is_err(), "{uri}");
        }
        assert_eq!(scheme("C:\\x.png"), None);
        assert_eq!(scheme("a/b:c"), None);
    }
}
