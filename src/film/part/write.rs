//! Writing a part film, patch by patch.

use super::super::{Metadata, Patch};
use super::{MAGIC, bytes};
use crc32fast::Hasher;
use std::io::{self, Write};

/// The bytes of a patch, in the place of what `into` held; for [`PartWriter::patch`].
pub fn encode_patch(patch: &Patch, into: &mut Vec<u8>) {
    into.clear();
    bytes::put_patch(into, patch);
}

/// A part film on its way.
pub struct PartWriter<W> {
    out: W,
    checksum: Hasher,
}

impl<W: Write> PartWriter<W> {
    /// Begins with the header; `patches` will follow.
    ///
    /// # Errors
    /// Any of `out`.
    pub fn begin(out: W, header: &Metadata, patches: u32) -> io::Result<PartWriter<W>> {
        let mut part = PartWriter {
            out,
            checksum: Hasher::new(),
        };
        part.write(format!("{MAGIC}\n{}\n", header.to_lines()).as_bytes())?;
        part.write(&patches.to_le_bytes())?;
        Ok(part)
    }

    /// Writes what [`encode_patch`] made.
    ///
    /// # Errors
    /// Any of `out`.
    pub fn patch(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write(&(bytes.len() as u64).to_le_bytes())?;
        self.write(bytes)
    }

    /// Writes the checksum; gives back what it was written to.
    ///
    /// # Errors
    /// Any of `out`.
    pub fn finish(mut self) -> io::Result<W> {
        let checksum = self.checksum.finalize();
        self.out.write_all(&checksum.to_le_bytes())?;
        Ok(self.out)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.checksum.update(bytes);
        self.out.write_all(bytes)
    }
}
