//! The files of an animation's frames: their names, which of them are finished, and how they are written.

use super::failure::Failure;
use super::output::{Encoding, Format, check_writable, encode, format_of};
use super::part::OWN;
use crate::film::{self, Aov, Film, Metadata, Stored};
use std::ffi::OsStr;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A file name with a run of # for the frame's number.
#[derive(Clone)]
pub(crate) struct Sequence {
    pattern: PathBuf,
    format: Format,
}

impl Sequence {
    /// What `-o` asks for, or `SCENE_####.png` in this folder.
    pub(crate) fn choose(
        asked: Option<&Path>,
        scene: &Path,
        aovs: &[Aov],
    ) -> Result<Sequence, Failure> {
        let pattern = match asked {
            Some(path) => path.to_owned(),
            None => default_name(scene),
        };
        let format = format_of(&pattern, aovs)?;
        let name = pattern.file_name().and_then(OsStr::to_str).unwrap_or("");
        if !name.contains('#') {
            return Err(Failure::usage(
                format!(
                    "\"{}\" is one picture, and there may be many",
                    pattern.display()
                ),
                "put # where their numbers go: -o frame_####.png",
            ));
        }
        Ok(Sequence { pattern, format })
    }

    /// Makes the folder if it is not there, and makes sure that it takes files.
    pub(crate) fn prepare(&self) -> Result<(), Failure> {
        if let Some(folder) = self.pattern.parent() {
            fs::create_dir_all(folder)
                .map_err(|e| Failure::io(format!("\"{}\"", folder.display()), &e))?;
        }
        check_writable(&self.pattern)
    }

    /// The file of a frame.
    pub(crate) fn path(&self, frame: u32) -> PathBuf {
        numbered(&self.pattern, frame)
    }

    /// How a frame is encoded.
    pub(crate) fn encoding<'a>(
        &self,
        metadata: Metadata,
        exposure: f64,
        aovs: &'a [Aov],
    ) -> Encoding<'a> {
        Encoding::new(self.format, metadata, exposure, aovs)
    }

    /// The picture of a frame that is there from before; `None` if it is not.
    ///
    /// One that is there and is not what this command would write is somebody's: an error.
    pub(crate) fn finished(
        &self,
        frame: u32,
        encoding: &Encoding<'_>,
    ) -> Result<Option<Stored>, Failure> {
        let path = self.path(frame);
        let refuse = |reason: &dyn std::fmt::Display| {
            Failure::usage(
                format!("\"{}\" is there already, and {reason}", path.display()),
                "write elsewhere with -o, or give --overwrite to render all frames anew",
            )
        };
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(refuse(&e)),
        };
        let stored = match self.format {
            Format::Png => film::decode_png(&bytes),
            Format::Exr => film::decode_exr(&bytes, encoding.gain),
        };
        let stored = stored.map_err(|e| refuse(&e))?;
        match difference(&stored, self.format, encoding) {
            Some(difference) => Err(refuse(&difference)),
            None => Ok(Some(stored)),
        }
    }

    /// Writes the file of a frame, whole or not at all.
    pub(crate) fn write(
        &self,
        frame: u32,
        film: &Film,
        encoding: &Encoding<'_>,
    ) -> Result<PathBuf, Failure> {
        let path = self.path(frame);
        let name = format!("\"{}\"", path.display());
        let bytes = encode(self.format, film, encoding).map_err(|e| Failure::io(&name, &e))?;
        film::write_frame(&path, &bytes).map_err(|e| Failure::io(&name, &e))?;
        Ok(path)
    }
}

/// What a file was made of that is not what is asked for now; `None` if all of it is.
fn difference(stored: &Stored, format: Format, encoding: &Encoding<'_>) -> Option<String> {
    // How many samples a wanted error takes, only rendering tells: all else being equal, so many.
    let free: &[&str] = match encoding.metadata.value("error") {
        Some(_) => &["spp"],
        None => &[],
    };
    let made = difference_of(&stored.metadata, &encoding.metadata, free);
    if made.is_some() {
        return made;
    }
    let mut channels = match format {
        Format::Png => Vec::new(),
        Format::Exr => ["R", "G", "B"].map(str::to_owned).to_vec(),
    };
    for aov in encoding.aovs {
        let parts = aov.channels().iter();
        channels.extend(parts.map(|part| format!("{}.{part}", aov.name())));
    }
    channels.sort_unstable();
    let mut there = stored.channels.clone();
    there.sort_unstable();
    (there != channels).then(|| "holds other images (--aov)".to_owned())
}

/// What `there` says that `wanted` does not, or otherwise, but for `free` keys; `None` if it is the same.
pub(super) fn difference_of(there: &Metadata, wanted: &Metadata, free: &[&str]) -> Option<String> {
    let counts = |key: &str| !free.contains(&key);
    for (key, value) in wanted.entries().filter(|(key, _)| counts(key)) {
        match (key, there.value(key)) {
            (_, Some(has)) if has == value => {}
            ("scene", Some(_)) => {
                return Some("was made of another scene, or of other files".to_owned());
            }
            ("version", Some(has)) => {
                return Some(format!("was made by luxel {has}, and this is {value}"));
            }
            (key, Some(has)) => {
                return Some(format!("was made with {} {has}, not {value}", name_of(key)));
            }
            (key, None) => return Some(format!("does not say its {}", name_of(key))),
        }
    }
    let mut surplus = there.entries().filter(|(key, _)| counts(key));
    let (key, value) = surplus.find(|(key, _)| wanted.value(key).is_none())?;
    Some(format!("was made with {} {value}", name_of(key)))
}

/// What a person calls a key: `part.samples` are samples.
fn name_of(key: &str) -> &str {
    key.strip_prefix(OWN).unwrap_or(key)
}

/// The path of a frame: the last run of # in the name becomes its number, with as many digits or more.
pub(super) fn numbered(pattern: &Path, frame: u32) -> PathBuf {
    let name = pattern.file_name().and_then(OsStr::to_str).unwrap_or("");
    let end = name.rfind('#').map_or(0, |at| at + 1);
    let start = name[..end].trim_end_matches('#').len();
    let digits = end - start;
    pattern.with_file_name(format!(
        "{}{frame:0digits$}{}",
        &name[..start],
        &name[end..]
    ))
}

fn default_name(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or(OsStr::new("frame")).to_owned();
    name.push("_####.png");
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_the_place_of_the_signs() {
        let of = |pattern: &str, frame| numbered(Path::new(pattern), frame);
        assert_eq!(of("a/f_####.png", 7), Path::new("a/f_0007.png"));
        assert_eq!(of("#.png", 12), Path::new("12.png"));
        assert_eq!(of("a#b/##-###x.png", 5), Path::new("a#b/##-005x.png"));
        assert_eq!(of("é##.png", 123), Path::new("é123.png"));
    }

    #[test]
    fn the_default_is_in_this_folder() {
        let name = default_name(Path::new("scenes/deep/room.ron"));
        assert_eq!(name, Path::new("room_####.png"));
    }
}
