//! The films of an animation, made of its frames' pictures: a GIF, and YUV4MPEG2 for an encoder.

use super::failure::Failure;
use super::frame_list::FrameList;
use super::frames::{Turn, check_gif, of_all_frames};
use super::output::check_writable;
use super::print_result;
use crate::film::{self, GifFrame, Metadata};
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// What is made of the pictures; nothing, if nothing is asked for.
pub(crate) struct Video {
    size: (u32, u32),
    turn: Turn,
    gif: Option<(PathBuf, Vec<GifFrame>)>,
    y4m: Option<Y4m>,
}

struct Y4m {
    /// `None` is stdout.
    path: Option<PathBuf>,
    to: Box<dyn Write>,
}

impl Video {
    /// What `--gif` and `--y4m` ask for, refused now if it cannot be written later.
    pub(crate) fn begin(
        gif: Option<&Path>,
        y4m: Option<&Path>,
        frames: &FrameList,
        size: (u32, u32),
        fps: f64,
    ) -> Result<Video, Failure> {
        let turn = Turn {
            frames: frames.len(),
            seconds: f64::from(frames.len()) * f64::from(frames.step()) / fps,
        };
        if let Some(path) = gif {
            check_suffix(path, "gif", "a GIF")?;
            check_gif(size, &turn)?;
            check_writable(path)?;
        }
        let fps = fps / f64::from(frames.step());
        Ok(Video {
            size,
            turn,
            gif: gif.map(|path| (path.to_owned(), Vec::new())),
            y4m: y4m.map(|path| Y4m::begin(path, size, fps)).transpose()?,
        })
    }

    /// Whether pictures are wanted.
    pub(crate) fn is_wanted(&self) -> bool {
        self.gif.is_some() || self.y4m.is_some()
    }

    /// Whether stdout is the film's.
    pub(crate) fn takes_stdout(&self) -> bool {
        self.y4m.as_ref().is_some_and(|y4m| y4m.path.is_none())
    }

    /// Shows the next frame: three sRGB bytes per pixel, row by row from the top.
    pub(crate) fn show(&mut self, rgb: Vec<u8>) -> Result<(), Failure> {
        if let Some(y4m) = &mut self.y4m {
            film::write_y4m_frame(&mut y4m.to, &rgb)
                .and_then(|()| y4m.to.flush())
                .map_err(|e| y4m.failure(&e))?;
        }
        if let Some((_, pictures)) = &mut self.gif {
            let ticks = self.turn.ticks(pictures.len() as u32);
            pictures.push(GifFrame { rgb, ticks });
        }
        Ok(())
    }

    /// Writes what is written at the end; `of_frame` are the metadata of a frame.
    pub(crate) fn finish(self, of_frame: &Metadata) -> Result<(), Failure> {
        let to_stdout = self.takes_stdout();
        let tell = |path: &Path| match to_stdout {
            true => Ok(()),
            false => print_result(format!("{}\n", path.display()).as_bytes()),
        };
        if let Some((path, pictures)) = &self.gif {
            let failed =
                |e: &dyn std::fmt::Display| Failure::io(format!("\"{}\"", path.display()), e);
            let metadata = of_all_frames(of_frame, self.turn.frames);
            let bytes = film::encode_gif(self.size, pictures, &metadata).map_err(|e| failed(&e))?;
            film::write_frame(path, &bytes).map_err(|e| failed(&e))?;
            tell(path)?;
        }
        match self.y4m.map(Y4m::finish).transpose()?.flatten() {
            Some(path) => tell(&path),
            None => Ok(()),
        }
    }
}

impl Y4m {
    fn begin(path: &Path, size: (u32, u32), fps: f64) -> Result<Y4m, Failure> {
        let mut y4m = if path == "-" {
            Y4m {
                path: None,
                to: Box::new(io::stdout()),
            }
        } else {
            check_suffix(path, "y4m", "a YUV4MPEG2 film")?;
            let file = File::create(film::partial_name(path))
                .map_err(|e| Failure::io(format!("\"{}\"", path.display()), &e))?;
            Y4m {
                path: Some(path.to_owned()),
                to: Box::new(BufWriter::new(file)),
            }
        };
        film::write_y4m_header(&mut y4m.to, size, fps).map_err(|e| y4m.failure(&e))?;
        Ok(y4m)
    }

    /// The file, if it is one, under its name.
    fn finish(mut self) -> Result<Option<PathBuf>, Failure> {
        self.to.flush().map_err(|e| self.failure(&e))?;
        if let Some(path) = &self.path {
            fs::rename(film::partial_name(path), path).map_err(|e| self.failure(&e))?;
        }
        Ok(self.path.take())
    }

    fn failure(&self, cause: &io::Error) -> Failure {
        match &self.path {
            Some(path) => Failure::io(format!("\"{}\"", path.display()), cause),
            None => Failure::io("the film to stdout", cause),
        }
    }
}

/// A film that did not come to its end is made anew, so nothing of it stays.
impl Drop for Y4m {
    fn drop(&mut self) {
        if let Some(path) = &self.path {
            // Renamed already, if it did.
            let _ = fs::remove_file(film::partial_name(path));
        }
    }
}

fn check_suffix(path: &Path, suffix: &str, what: &str) -> Result<(), Failure> {
    let is = path.extension().and_then(OsStr::to_str);
    if is.is_some_and(|is| is.eq_ignore_ascii_case(suffix)) {
        return Ok(());
    }
    Err(Failure::usage(
        format!("\"{}\" does not look like {what}", path.display()),
        &format!("end its name in .{suffix}"),
    ))
}
