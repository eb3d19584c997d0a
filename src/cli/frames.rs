//! The frames of a turn: how long each is shown, and where they go, a GIF or a sequence of PNG files.

use super::failure::Failure;
use super::output::check_writable;
use super::print_result;
use super::sequence::numbered;
use crate::film::{self, Film, GifFrame, Metadata, TICKS_PER_SECOND};
use crate::render::Rendering;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Frames a second, if neither frames nor seconds are asked for: eight ticks of a GIF each.
const FPS: f64 = 12.5;

/// How long a turn takes, if nobody says.
const SECONDS: f64 = 3.2;

/// Viewers slow down GIFs whose frames are shorter than this.
const MIN_TICKS: f64 = 2.0;

/// A GIF is made of all frames at once, which must fit in memory.
const MAX_GIF_BYTES: u64 = 1 << 30;

/// One turn in time.
#[derive(Clone, Copy)]
pub(crate) struct Turn {
    pub(crate) frames: u32,
    pub(crate) seconds: f64,
}

impl Turn {
    /// What is asked for, and the rest to fit it.
    pub(crate) fn of(frames: Option<u32>, seconds: Option<f64>) -> Turn {
        match (frames, seconds) {
            (Some(frames), Some(seconds)) => Turn { frames, seconds },
            // Few frames are shown longer; many make a longer turn.
            (Some(frames), None) => Turn {
                frames,
                seconds: SECONDS.max(f64::from(frames) / FPS),
            },
            (None, seconds) => {
                let seconds = seconds.unwrap_or(SECONDS);
                let frames = (seconds * FPS).round().max(1.0) as u32;
                Turn { frames, seconds }
            }
        }
    }

    /// How long a GIF shows a frame, in its ticks. Where they do not divide the turn, some frames last one longer, so
    /// that the whole takes its time.
    pub(super) fn ticks(self, frame: u32) -> u16 {
        let until = |frame: u32| {
            let share = f64::from(frame) / f64::from(self.frames);
            (TICKS_PER_SECOND * self.seconds * share).round()
        };
        (until(frame + 1) - until(frame)) as u16
    }
}

/// Where the frames go.
pub(crate) enum Output {
    Gif(PathBuf),
    /// With a run of # in its name.
    Sequence(PathBuf),
}

impl Output {
    /// What is asked for, or the default; refused now if it cannot be written later.
    pub(crate) fn choose(
        asked: Option<&Path>,
        default: PathBuf,
        size: (u32, u32),
        turn: &Turn,
    ) -> Result<Output, Failure> {
        let output = match asked {
            None => Output::Gif(default),
            Some(path) => Output::named(path)?,
        };
        match &output {
            Output::Gif(path) => {
                check_gif(size, turn)?;
                check_writable(path)?;
            }
            Output::Sequence(pattern) => check_writable(&numbered(pattern, 0))?,
        }
        Ok(output)
    }

    fn named(path: &Path) -> Result<Output, Failure> {
        let suffix = path.extension().and_then(OsStr::to_str).unwrap_or("");
        let name = path.file_name().and_then(OsStr::to_str).unwrap_or("");
        match suffix.to_ascii_lowercase().as_str() {
            "gif" => Ok(Output::Gif(path.to_owned())),
            "png" if name.contains('#') => Ok(Output::Sequence(path.to_owned())),
            "png" => Err(Failure::usage(
                format!("\"{}\" is one picture, and a turn has many", path.display()),
                "put # where their numbers go: -o frame_####.png",
            )),
            _ => Err(Failure::usage(
                format!(
                    "the suffix of \"{}\" names no film that luxel writes",
                    path.display()
                ),
                "end it in .gif, or write a sequence: -o frame_####.png",
            )),
        }
    }
}

/// Whether the turn can be a GIF.
pub(super) fn check_gif((width, height): (u32, u32), turn: &Turn) -> Result<(), Failure> {
    let ticks = TICKS_PER_SECOND * turn.seconds / f64::from(turn.frames);
    if ticks < MIN_TICKS {
        let most = (TICKS_PER_SECOND * turn.seconds / MIN_TICKS) as u32;
        let shortest = f64::from(turn.frames) * MIN_TICKS / TICKS_PER_SECOND;
        return Err(Failure::usage(
            "a GIF shows at most 50 frames a second",
            &format!(
                "--frames {most} or --seconds {shortest}, or write a sequence: -o frame_####.png"
            ),
        ));
    }
    let bytes = 3 * u64::from(width) * u64::from(height) * u64::from(turn.frames);
    if bytes > MAX_GIF_BYTES {
        return Err(Failure::usage(
            format!(
                "{} frames of {width}x{height} are too much for a GIF",
                turn.frames
            ),
            "make --size or --frames smaller, or write a sequence: -o frame_####.png",
        ));
    }
    Ok(())
}

/// What comes of the frames.
pub(crate) struct Frames {
    output: Output,
    turn: Turn,
    size: (u32, u32),
    count: u32,
    /// Those of a GIF, until all are there.
    pictures: Vec<GifFrame>,
    metadata: Metadata,
}

/// What was written.
pub(crate) struct Finished {
    pub(crate) count: u32,
    /// `None` if it is nothing.
    pub(crate) path: Option<String>,
}

impl Frames {
    pub(crate) fn new(output: Output, turn: &Turn) -> Frames {
        Frames {
            output,
            turn: *turn,
            size: (0, 0),
            count: 0,
            pictures: Vec::new(),
            metadata: Metadata::default(),
        }
    }

    /// Writes a frame of a sequence; keeps one of a GIF.
    pub(crate) fn add(&mut self, frame: u32, rendering: &Rendering) -> Result<(), Failure> {
        let film = &rendering.film;
        match &self.output {
            Output::Gif(_) => {
                if self.count == 0 {
                    self.size = (film.width(), film.height());
                    self.metadata = of_all_frames(&rendering.metadata, self.turn.frames);
                }
                self.pictures.push(GifFrame {
                    rgb: film::develop(film, 1.0),
                    ticks: self.turn.ticks(frame),
                });
            }
            Output::Sequence(pattern) => {
                let path = numbered(pattern, frame);
                write_png(&path, film, &rendering.metadata)?;
                print_result(format!("{}\n", path.display()).as_bytes())?;
            }
        }
        self.count += 1;
        Ok(())
    }

    /// Writes the GIF; one that lacks frames as `NAME.partial.gif`.
    pub(crate) fn finish(self) -> Result<Finished, Failure> {
        let finished = |path: &Path| Finished {
            count: self.count,
            path: (self.count > 0).then(|| path.display().to_string()),
        };
        let path = match &self.output {
            Output::Sequence(pattern) => return Ok(finished(pattern)),
            Output::Gif(path) if self.count < self.turn.frames => {
                path.with_extension("partial.gif")
            }
            Output::Gif(path) => path.clone(),
        };
        if self.count > 0 {
            let bytes = film::encode_gif(self.size, &self.pictures, &self.metadata)
                .map_err(|e| Failure::io(path.display(), &e))?;
            film::write_file(&path, &bytes).map_err(|e| Failure::io(path.display(), &e))?;
            print_result(format!("{}\n", path.display()).as_bytes())?;
        }
        Ok(finished(&path))
    }
}

/// The metadata of a frame, with the number of frames in the place of its own number, and without what is its own.
pub(super) fn of_all_frames(one: &Metadata, frames: u32) -> Metadata {
    let mut all = Metadata::default();
    let by_error = one.entries().any(|(key, _)| key == "error");
    for (key, value) in one.entries() {
        match key {
            "frame" => all.push("frames", frames),
            "spp" if by_error => {}
            _ => all.push(key, value),
        }
    }
    all
}

/// The same bytes as `luxel render` writes.
fn write_png(path: &Path, film: &Film, metadata: &Metadata) -> Result<(), Failure> {
    let mut metadata = metadata.clone();
    metadata.push("exposure", 0);
    let bytes =
        film::encode_png(film, 1.0, &metadata).map_err(|e| Failure::io(path.display(), &e))?;
    film::write_file(path, &bytes).map_err(|e| Failure::io(path.display(), &e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_add_up_to_the_turn() {
        for (frames, seconds) in [
            (60, 3.0),
            (48, 2.0),
            (7, 1.0),
            (1, 600.0),
            (150, 3.0),
            (24, 1.618),
        ] {
            let turn = Turn { frames, seconds };
            let ticks: Vec<u16> = (0..frames).map(|frame| turn.ticks(frame)).collect();
            let total: u32 = ticks.iter().map(|&t| u32::from(t)).sum();
            assert_eq!(
                f64::from(total),
                (100.0 * seconds).round(),
                "{frames} {seconds}"
            );
            let (least, most) = (ticks.iter().min(), ticks.iter().max());
            assert!(
                most.zip(least)
                    .is_some_and(|(most, least)| most - least <= 1)
            );
        }
        let turn = Turn::of(None, None);
        assert_eq!(turn.frames, 40);
        assert!(
            (0..40).all(|frame| turn.ticks(frame) == 8),
            "the default divides"
        );
    }
}
