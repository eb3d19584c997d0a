//! Where an image goes and in which format.

use super::failure::Failure;
use super::print_result;
use crate::film::{self, Aov, EncodeError, Film, Metadata};
use crate::math;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// File formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    /// 8-bit sRGB.
    Png,
    /// Linear f32.
    Exr,
}

/// A place for an image.
#[derive(Clone, Debug)]
pub(crate) struct Output {
    /// `None` is stdout.
    pub(crate) path: Option<PathBuf>,
    /// By the suffix.
    pub(crate) format: Format,
}

/// What an image is encoded with.
#[derive(Clone, Debug)]
pub(crate) struct Encoding<'a> {
    /// 2^EV, for PNG.
    pub(crate) gain: f64,
    /// For EXR.
    pub(crate) aovs: &'a [Aov],
    /// For both.
    pub(crate) metadata: Metadata,
}

impl<'a> Encoding<'a> {
    /// How an image is encoded that was rendered as `metadata` says.
    pub(crate) fn new(
        format: Format,
        mut metadata: Metadata,
        exposure: f64,
        aovs: &'a [Aov],
    ) -> Encoding<'a> {
        if format == Format::Png {
            metadata.push("exposure", exposure);
        }
        Encoding {
            gain: math::pow(2.0, exposure),
            aovs,
            metadata,
        }
    }
}

impl Output {
    /// The output that `-o` asks for, or `SCENE.png` in the current folder. Whatever would make writing fail later
    /// fails here, before minutes of rendering.
    pub(crate) fn choose(
        asked: Option<&Path>,
        scene: &Path,
        aovs: &[Aov],
    ) -> Result<Output, Failure> {
        let output = match asked {
            Some(path) if path == "-" => Output {
                path: None,
                format: Format::Png,
            },
            Some(path) => Output {
                path: Some(path.to_owned()),
                format: format_by_name(path)?,
            },
            None => Output {
                path: Some(default_name(scene)),
                format: Format::Png,
            },
        };
        check_aovs(output.format, aovs)?;
        if let Some(path) = &output.path {
            if same_file(path, scene) {
                let message = format!("\"{}\" is the scene itself", path.display());
                return Err(Failure::usage(message, "write elsewhere: -o FILE.png"));
            }
            check_writable(path)?;
        }
        Ok(output)
    }

    /// Encodes and writes.
    pub(crate) fn write(&self, film: &Film, encoding: &Encoding<'_>) -> Result<(), Failure> {
        self.write_by(film::write_file, film, encoding)
    }

    /// The same for what the same line writes again if it is killed.
    pub(crate) fn write_again(&self, film: &Film, encoding: &Encoding<'_>) -> Result<(), Failure> {
        self.write_by(film::write_frame, film, encoding)
    }

    fn write_by(
        &self,
        write: fn(&Path, &[u8]) -> std::io::Result<()>,
        film: &Film,
        encoding: &Encoding<'_>,
    ) -> Result<(), Failure> {
        let name = self.to_string();
        let bytes = encode(self.format, film, encoding).map_err(|e| Failure::io(&name, &e))?;
        match &self.path {
            Some(path) => write(path, &bytes).map_err(|e| Failure::io(&name, &e)),
            None => print_result(&bytes),
        }
    }

    /// `NAME.partial.png` beside `NAME.png`; none for stdout.
    pub(crate) fn partial(&self) -> Option<Output> {
        let path = self.path.as_ref()?;
        let mut name = path.file_stem()?.to_owned();
        name.push(".partial.");
        name.push(path.extension()?);
        Some(Output {
            path: Some(path.with_file_name(name)),
            format: self.format,
        })
    }
}

impl std::fmt::Display for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.path {
            Some(path) => write!(f, "{}", path.display()),
            None => f.write_str("stdout"),
        }
    }
}

/// The bytes of an image's file.
pub(crate) fn encode(
    format: Format,
    film: &Film,
    encoding: &Encoding<'_>,
) -> Result<Vec<u8>, EncodeError> {
    match format {
        Format::Png => film::encode_png(film, encoding.gain, &encoding.metadata),
        Format::Exr => film::encode_exr(film, encoding.aovs, &encoding.metadata),
    }
}

/// The format of a file by its suffix, which must hold the further images that are asked for.
pub(crate) fn format_of(path: &Path, aovs: &[Aov]) -> Result<Format, Failure> {
    let format = format_by_name(path)?;
    check_aovs(format, aovs)?;
    Ok(format)
}

fn check_aovs(format: Format, aovs: &[Aov]) -> Result<(), Failure> {
    if format == Format::Png && !aovs.is_empty() {
        let names: Vec<_> = aovs.iter().map(|aov| aov.name()).collect();
        return Err(Failure::usage(
            format!("a PNG cannot hold {}", names.join(", ")),
            "write an EXR: -o FILE.exr",
        ));
    }
    if let Some(twice) = (1..aovs.len()).find(|&i| aovs[..i].contains(&aovs[i])) {
        let message = format!("--aov names {} twice", aovs[twice].name());
        return Err(Failure::usage(message, "name it once"));
    }
    Ok(())
}

/// An output that cannot be written is an error now.
pub(crate) fn check_writable(path: &Path) -> Result<(), Failure> {
    film::check_folder(path).map_err(|e| Failure::io(format!("\"{}\"", path.display()), &e))
}

fn same_file(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| path.canonicalize().ok();
    place(a).is_some_and(|a| Some(a) == place(b))
}

fn format_by_name(path: &Path) -> Result<Format, Failure> {
    let suffix = path.extension().and_then(OsStr::to_str).unwrap_or("");
    match suffix.to_ascii_lowercase().as_str() {
        "png" => Ok(Format::Png),
        "exr" => Ok(Format::Exr),
        _ => Err(Failure::usage(
            format!(
                "the suffix of \"{}\" names no format that luxel writes",
                path.display()
            ),
            "end it in .png (8-bit picture) or .exr (linear, for measuring)",
        )),
    }
}

fn default_name(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or(OsStr::new("out")).to_owned();
    name.push(".png");
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn partial_keeps_the_suffix() {
        let output = Output {
            path: Some("a/b.c.exr".into()),
            format: Format::Exr,
        };
        let partial = output.partial().expect("a file");
        assert_eq!(partial.path, Some("a/b.c.partial.exr".into()));
    }

    #[test]
    fn the_default_is_in_this_folder() {
        let name = default_name(Path::new("scenes/deep/room.ron"));
        assert_eq!(name, Path::new("room.png"));
    }
}
