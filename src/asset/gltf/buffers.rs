//! The bytes of buffers: the binary chunk, embedded in the JSON, or a file, read when something needs them.
//!
//! Deliberately absent: what the bytes mean. Specification: section 3.6.1.

use super::container::Container;
use super::layout::{items, natural};
use super::uri::{self, Uri};
use crate::asset::limits::Budget;
use crate::asset::{Loader, codes};
use crate::diag::Diagnostic;
use serde_json::Value;
use std::path::Path;

/// Where the bytes of a buffer are.
#[derive(Debug)]
enum Bytes {
    /// Nothing has needed them yet.
    Unread,
    /// In the binary chunk of the file.
    Chunk,
    /// Read from a file or a data URI.
    Owned(Vec<u8>),
    /// Nowhere.
    Absent,
}

/// The buffers of a file.
#[derive(Debug)]
pub(super) struct Buffers {
    container: Container,
    /// Declared length of each.
    lengths: Vec<usize>,
    bytes: Vec<Bytes>,
    /// What was left when the file was opened.
    budget: Budget,
}

impl Buffers {
    /// The buffers that a file declares; nothing is read. What their elements decode to must fit the budget.
    pub(super) fn of(container: Container, json: &Value, budget: &Budget) -> Buffers {
        let declared = |buffer: &Value| buffer.get("byteLength").and_then(natural).unwrap_or(0);
        let lengths: Vec<usize> = items(json, "buffers").iter().map(declared).collect();
        let bytes = lengths.iter().map(|_| Bytes::Unread).collect();
        Buffers {
            container,
            lengths,
            bytes,
            budget: budget.clone(),
        }
    }

    /// Whether there is memory for what a part of the file decodes to; the error does not name the file.
    ///
    /// # Errors
    /// If there is not.
    pub(super) fn allow(&self, bytes: u64, what: &str) -> Result<(), Diagnostic> {
        let allowed = self.budget.allow(bytes, what, Path::new(""));
        allowed.map_err(|error| Diagnostic {
            file: None,
            ..error
        })
    }

    /// The bytes of a buffer, as many as it declares, if they were read.
    pub(super) fn bytes(&self, index: usize) -> Option<&[u8]> {
        let all = match self.bytes.get(index)? {
            Bytes::Unread | Bytes::Absent => None,
            Bytes::Chunk => self.container.binary(),
            Bytes::Owned(bytes) => Some(bytes.as_slice()),
        };
        all?.get(..*self.lengths.get(index)?)
    }

    /// Declared bytes of those that were read.
    pub(super) fn total(&self) -> usize {
        let read = (0..self.lengths.len()).filter_map(|i| self.bytes(i));
        read.map(<[u8]>::len).sum()
    }

    /// Reads the bytes of a buffer, unless that has been tried.
    ///
    /// # Errors
    /// A URI that leads to no bytes, or to fewer than the buffer declares.
    pub(super) fn load(
        &mut self,
        loader: &mut Loader,
        document: &Path,
        json: &Value,
        index: usize,
    ) -> Result<(), Diagnostic> {
        let Some(Bytes::Unread) = self.bytes.get(index) else {
            return Ok(());
        };
        self.bytes[index] = Bytes::Absent;
        let uri = items(json, "buffers").get(index).and_then(|b| b.get("uri"));
        let read = match uri.and_then(Value::as_str) {
            Some(uri) => read(loader, document, uri).map(Bytes::Owned),
            None => Ok(Bytes::Chunk),
        };
        let place = |d: Diagnostic, part| d.pointer(format!("/buffers/{index}{part}"));
        let bytes = read.map_err(|e| place(e, "/uri"))?;
        let there = match &bytes {
            Bytes::Owned(bytes) => Some(bytes.len()),
            _ => self
                .container
                .binary()
                .filter(|_| index == 0)
                .map(<[u8]>::len),
        };
        let declared = self.lengths[index];
        match there {
            Some(there) if there >= declared => {
                self.bytes[index] = bytes;
                Ok(())
            }
            Some(there) => {
                let says = format!("the buffer declares {declared} bytes, and {there} are there");
                let error = Diagnostic::error(codes::GLTF_BUFFER, says);
                Err(place(
                    error.hint("the file is cut off: copy or export it again"),
                    "",
                ))
            }
            None => {
                let says = "a buffer without a URI, and no binary chunk for it";
                let error = Diagnostic::error(codes::GLTF_BUFFER, says);
                Err(place(error.hint("export the file again"), ""))
            }
        }
    }
}

/// The bytes behind the URI of a buffer.
fn read(loader: &mut Loader, document: &Path, uri: &str) -> Result<Vec<u8>, Diagnostic> {
    let error = |says: String| Diagnostic::error(codes::GLTF_BUFFER, says);
    match uri::resolve(document, uri) {
        Ok(Uri::Embedded(_, bytes)) => Ok(bytes),
        Ok(Uri::File(path)) => loader.read(&path).map_err(|e| {
            let says = format!("{}: {}", path.display(), e.message);
            match e.hint {
                Some(hint) => error(says).hint(hint),
                None => error(says).hint("it belongs beside the glTF file"),
            }
        }),
        Err(bad) => Err(error(bad.says).hint(bad.hint)),
    }
}
