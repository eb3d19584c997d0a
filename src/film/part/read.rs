//! Reading a part film: first all of it, to know that it is whole, then patch by patch as asked.

use super::super::{Metadata, Patch, Window};
use super::{MAGIC, MAGIC_OF_ANY, bytes};
use crc32fast::Hasher;
use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

/// Longest header: a few hundred bytes are usual.
const LONGEST_HEADER: u64 = 1 << 16;

/// Bytes of a patch before its arrays: window and samples.
const PEEKED: u64 = 24;

/// A file is no whole part film of this luxel's.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// It cannot be read.
    #[error("it cannot be read: {0}")]
    Io(#[from] io::Error),
    /// It is something else.
    #[error("it is no part film of luxel")]
    Other,
    /// Of another version of the format.
    #[error("it is a part film of another format (`{0}`; this luxel reads `{MAGIC}`)")]
    Format(String),
    /// It ends too early.
    #[error("it is cut short")]
    Short,
    /// Its bytes are not those that were written.
    #[error("it is damaged: its bytes do not have its checksum")]
    Damaged,
}

/// Where a patch is, and what it holds.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its pixels.
    pub window: Window,
    /// Its first sample.
    pub first: u32,
    /// One after its last sample.
    pub done: u32,
    at: u64,
    length: u64,
}

/// A whole part film.
#[derive(Debug)]
pub struct PartFile {
    file: File,
    /// What it says about itself.
    pub header: Metadata,
    /// Its patches.
    pub entries: Vec<Entry>,
}

impl PartFile {
    /// Reads all of a file and looks whether it is whole.
    ///
    /// # Errors
    /// If it is not.
    pub fn open(path: &Path) -> Result<PartFile, PartError> {
        let mut source = Source {
            reader: BufReader::with_capacity(1 << 18, File::open(path)?),
            checksum: Hasher::new(),
            at: 0,
        };
        let header = source.header()?;
        let count = u32::from_le_bytes(source.array()?);
        let mut entries = Vec::new();
        for _ in 0..count {
            entries.push(source.entry()?);
        }
        let found = source.checksum.clone().finalize();
        let mut rest = Vec::new();
        source.reader.take(5).read_to_end(&mut rest)?;
        match <[u8; 4]>::try_from(rest) {
            Ok(written) if u32::from_le_bytes(written) == found => {}
            Err(rest) if rest.len() < 4 => return Err(PartError::Short),
            _ => return Err(PartError::Damaged),
        }
        let file = File::open(path)?;
        Ok(PartFile {
            file,
            header,
            entries,
        })
    }

    /// Reads a patch.
    ///
    /// # Errors
    /// If the file has changed since it was opened.
    pub fn patch(&mut self, entry: &Entry) -> Result<Patch, PartError> {
        self.file.seek(SeekFrom::Start(entry.at))?;
        let mut bytes = Vec::new();
        (&self.file).take(entry.length).read_to_end(&mut bytes)?;
        bytes::patch(&bytes).ok_or(PartError::Damaged)
    }
}

/// A file as far as it has been read.
struct Source {
    reader: BufReader<File>,
    checksum: Hasher,
    at: u64,
}

impl Source {
    /// The lines up to the empty one.
    fn header(&mut self) -> Result<Metadata, PartError> {
        let mut text = Vec::new();
        let mut reader = (&mut self.reader).take(LONGEST_HEADER);
        loop {
            let before = text.len();
            let length = reader.read_until(b'\n', &mut text)?;
            if before == 0 {
                check_magic(&text)?;
            }
            match length {
                0 => return Err(PartError::Short),
                1 if before > 0 => break,
                _ => {}
            }
        }
        self.checksum.update(&text);
        self.at = text.len() as u64;
        let text = String::from_utf8(text).map_err(|_| PartError::Damaged)?;
        Ok(Metadata::from_lines(&text))
    }

    fn entry(&mut self) -> Result<Entry, PartError> {
        let length = u64::from_le_bytes(self.array()?);
        let at = self.at;
        let head: [u8; PEEKED as usize] = self.array()?;
        let (window, first, done) = bytes::peek(&head).ok_or(PartError::Damaged)?;
        self.skip(length.checked_sub(PEEKED).ok_or(PartError::Damaged)?)?;
        Ok(Entry {
            window,
            first,
            done,
            at,
            length,
        })
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], PartError> {
        let mut bytes = [0; N];
        self.reader.read_exact(&mut bytes).map_err(short)?;
        self.checksum.update(&bytes);
        self.at += N as u64;
        Ok(bytes)
    }

    /// Reads on, for the checksum alone.
    fn skip(&mut self, mut length: u64) -> Result<(), PartError> {
        while length > 0 {
            let there = self.reader.fill_buf()?;
            let part = length.min(there.len() as u64) as usize;
            if part == 0 {
                return Err(PartError::Short);
            }
            self.checksum.update(&there[..part]);
            self.reader.consume(part);
            self.at += part as u64;
            length -= part as u64;
        }
        Ok(())
    }
}

fn check_magic(first_line: &[u8]) -> Result<(), PartError> {
    let line = String::from_utf8_lossy(first_line);
    match line.trim_end_matches('\n') {
        MAGIC => Ok(()),
        other if !other.is_empty() && MAGIC.starts_with(other) => Err(PartError::Short),
        other if other.starts_with(MAGIC_OF_ANY) && other.len() < 32 => {
            Err(PartError::Format(other.to_owned()))
        }
        _ => Err(PartError::Other),
    }
}

fn short(error: io::Error) -> PartError {
    match error.kind() {
        ErrorKind::UnexpectedEof => PartError::Short,
        _ => PartError::Io(error),
    }
}

#[cfg(test)]
mod tests;
