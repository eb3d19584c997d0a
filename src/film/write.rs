//! Files appear whole or not at all.

use super::stream::Stream;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes `bytes` to a temporary name in the folder of `path`, then renames it. On an error the temporary is removed
/// and what stood at `path` before still does.
///
/// # Errors
/// Any of the file system.
pub fn write_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_by(&temporary_name(path)?, path, |file| file.write_all(bytes))
}

/// The same for a file of many that the same command writes again if it is killed: the temporary is `NAME.partial`
/// whatever the process, so that the next one leaves none behind.
///
/// # Errors
/// Any of the file system.
pub fn write_frame(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_by(&partial_name(path), path, |file| file.write_all(bytes))
}

/// The same for a large file that is written bit by bit.
///
/// # Errors
/// Any of the file system, and of `write`.
pub fn write_streamed(
    path: &Path,
    write: impl FnOnce(&mut Stream) -> io::Result<()>,
) -> io::Result<()> {
    let temporary = partial_name(path);
    let written = Stream::create(&temporary).and_then(|mut stream| {
        write(&mut stream)?;
        stream.finish()
    });
    rename(written, &temporary, path)
}

/// `NAME.partial` beside `path`.
#[must_use]
pub fn partial_name(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".partial");
    PathBuf::from(name)
}

fn write_by(
    temporary: &Path,
    path: &Path,
    write: impl FnOnce(&mut File) -> io::Result<()>,
) -> io::Result<()> {
    rename(write_all(temporary, write), temporary, path)
}

fn rename(written: io::Result<()>, temporary: &Path, path: &Path) -> io::Result<()> {
    let renamed = written.and_then(|()| fs::rename(temporary, path));
    if renamed.is_err() {
        // The first error is the one to tell; the temporary may not even exist.
        let _ = fs::remove_file(temporary);
    }
    renamed
}

/// Whether a file could be written at `path`: its folder exists and takes a file, and it is no folder itself. Asked
/// before rendering, so that minutes of work do not end in an error that was there from the start.
///
/// # Errors
/// The one that [`write_file`] would meet.
pub fn check_folder(path: &Path) -> io::Result<()> {
    let names_folder = path.as_os_str().as_encoded_bytes().ends_with(b"/");
    if names_folder || path.is_dir() {
        return Err(io::Error::new(
            io::ErrorKind::IsADirectory,
            "it is a folder",
        ));
    }
    // One name for every process: what one leaves that is killed here, the next removes.
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".probe");
    let probe = path.with_file_name(name);
    File::create(&probe)?;
    match fs::remove_file(&probe) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

fn write_all(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let mut file = File::create(path)?;
    write(&mut file)?;
    file.sync_all()
}

/// `.NAME.PID.partial` beside `path`: hidden, and another process's differs.
fn temporary_name(path: &Path) -> io::Result<PathBuf> {
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it names no file"))?;
    let mut temporary = OsString::from(".");
    temporary.push(name);
    temporary.push(format!(".{}.partial", std::process::id()));
    Ok(path.with_file_name(temporary))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("luxel-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a temporary folder");
        folder
    }

    #[test]
    fn replaces_the_file_and_leaves_no_other() {
        let folder = folder("write");
        let path = folder.join("a.png");
        check_folder(&path).expect("writable");
        write_file(&path, b"old").expect("writable");
        write_file(&path, b"new").expect("writable");
        assert_eq!(fs::read(&path).expect("there"), b"new");
        assert_eq!(fs::read_dir(&folder).expect("there").count(), 1);
        fs::remove_dir_all(&folder).expect("ours");
    }

    #[test]
    fn a_failed_rename_leaves_nothing() {
        let folder = folder("fail");
        let path = folder.join("taken");
        fs::create_dir(&path).expect("ours");
        assert!(check_folder(&path).is_err());
        assert!(write_file(&path, b"x").is_err());
        assert_eq!(fs::read_dir(&folder).expect("there").count(), 1);
        assert!(check_folder(&folder.join("no/such/a.png")).is_err());
        fs::remove_dir_all(&folder).expect("ours");
    }
}
