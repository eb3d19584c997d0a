//! Gigabytes to a file, past the system's cache where the system can: copying them there would cost a render more time than
//! everything else about saving, and would drive out what others keep in it.

use std::fs::File;
use std::io::{self, ErrorKind, Seek, SeekFrom, Write};
use std::path::Path;

/// What writes past the cache must begin and end at: the largest block of usual disks.
const ALIGNMENT: usize = 4096;

/// Bytes of a write: so many that their number does not matter.
const BLOCK: usize = 4 << 20;

/// A file on its way, for [`super::write_streamed`].
pub struct Stream {
    file: File,
    /// The same file, past the cache; `None` where that does not go.
    direct: Option<File>,
    /// A block that begins at `start`, of which `filled` bytes are used.
    buffer: Vec<u8>,
    start: usize,
    filled: usize,
    /// Bytes of the blocks before.
    written: u64,
}

impl Stream {
    /// Makes a file, or empties it.
    pub(super) fn create(path: &Path) -> io::Result<Stream> {
        let file = File::create(path)?;
        let buffer = vec![0; BLOCK + ALIGNMENT];
        Ok(Stream {
            file,
            direct: open_direct(path),
            start: buffer.as_ptr().align_offset(ALIGNMENT).min(ALIGNMENT),
            buffer,
            filled: 0,
            written: 0,
        })
    }

    /// Writes what is left, and waits for the disk.
    pub(super) fn finish(mut self) -> io::Result<()> {
        // Its end is nobody's block.
        self.direct = None;
        self.write_block()?;
        self.file.sync_all()
    }

    fn write_block(&mut self) -> io::Result<()> {
        let block = &self.buffer[self.start..self.start + self.filled];
        let put = |mut file: &File| {
            file.seek(SeekFrom::Start(self.written))?;
            file.write_all(block)
        };
        let done = match &self.direct {
            Some(file) => put(file),
            None => put(&self.file),
        };
        match done {
            // Some file systems say late that it does not go.
            Err(e) if e.kind() == ErrorKind::InvalidInput && self.direct.is_some() => {
                put(&self.file)?;
                self.direct = None;
            }
            done => done?,
        }
        self.written += self.filled as u64;
        self.filled = 0;
        Ok(())
    }
}

impl Write for Stream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.filled == BLOCK {
            self.write_block()?;
        }
        let length = bytes.len().min(BLOCK - self.filled);
        let at = self.start + self.filled;
        self.buffer[at..at + length].copy_from_slice(&bytes[..length]);
        self.filled += length;
        Ok(length)
    }

    fn flush(&mut self) -> io::Result<()> {
        // A block goes when it is full, and the rest at the end.
        Ok(())
    }
}

#[cfg(target_os = "linux")]
fn open_direct(path: &Path) -> Option<File> {
    use std::os::unix::fs::OpenOptionsExt;
    let mut options = File::options();
    options.write(true).custom_flags(libc::O_DIRECT);
    options.open(path).ok()
}

#[cfg(not(target_os = "linux"))]
fn open_direct(_: &Path) -> Option<File> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn bytes_arrive_in_their_order() {
        let path = std::env::temp_dir().join(format!("luxel-stream-{}", std::process::id()));
        let bytes: Vec<u8> = (0..3 * BLOCK as u32 / 2)
            .map(|i| (i >> 7) as u8 ^ i as u8)
            .collect();
        for length in [0, 1, ALIGNMENT, BLOCK - 1, BLOCK, BLOCK + 1, bytes.len()] {
            for step in [777_777, 2 * BLOCK] {
                let mut stream = Stream::create(&path).expect("a temporary file");
                for part in bytes[..length].chunks(step) {
                    stream.write_all(part).expect("room");
                }
                stream.finish().expect("room");
                assert!(
                    fs::read(&path).expect("there") == bytes[..length],
                    "{length}"
                );
            }
        }
        fs::remove_file(&path).expect("ours");
    }
}
