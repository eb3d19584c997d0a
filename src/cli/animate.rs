//! `luxel animate`: frames of one scene, each a file of its own, and films made of them.

use super::animate_args::AnimateArgs;
use super::failure::Failure;
use super::frame_list::FrameList;
use super::load::Loaded;
use super::progress::{Finished, Progress, Watcher, Work, words};
use super::sequence::Sequence;
use super::stats::{lost, samples, spp_of_all};
use super::video::Video;
use super::writer::{Account, Writer};
use super::{diagnostics, interrupt, load, print_result, say};
use crate::film::{self, Film};
use crate::render::{Control, Renderer, Rendering};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Renders the frames that are not there yet.
pub(crate) fn run(args: &AnimateArgs) -> Result<(), Failure> {
    let dials = &args.dials;
    let files = Sequence::choose(args.output.as_deref(), &args.scene, &dials.aov)?;
    let progress = Progress::start(args.progress);
    let loaded = load(args)?;
    let animation = &loaded.desc.animation;
    let scenes = || FrameList::of_range(animation.frames.clone());
    let frames = args.frames.clone().unwrap_or_else(scenes);
    let frames = match args.shard {
        None => frames,
        Some(shard) => {
            let (index, count) = shard.here()?;
            let Some(own) = frames.share(index, count) else {
                say(&format!(
                    "{frames}; none of them is in share {index} of {count}"
                ));
                return Ok(());
            };
            own
        }
    };
    let settings = dials.settings_to(&loaded.desc, args.spp, args.noise);
    let (gif, y4m) = (args.gif.as_deref(), args.y4m.as_deref());
    let (size, fps) = (settings.size, animation.fps);
    files.prepare()?;
    let video = Video::begin(gif, y4m, &frames, size, fps)?;
    let run = Run {
        args,
        files,
        video,
        renderer: loaded.renderer(settings)?,
        writer: Writer::default(),
        progress,
        rendered: 0,
        spp: Vec::new(),
        beside_tracing: Duration::ZERO,
    };
    let todo = run.unfinished(&frames)?;
    say(&match frames.len() - todo.len() as u32 {
        0 => frames.to_string(),
        finished => format!("{frames}; {finished} of them are finished"),
    });
    let control = Arc::new(Control::of_frames(todo.len() as u32));
    interrupt::listen(&control);
    run.progress.begin(Work {
        control: Arc::clone(&control),
        limit: None,
        frames: todo.clone(),
        pixels: u64::from(size.0) * u64::from(size.1),
    });
    run.frames(&frames, &todo, &control)
}

/// Reads the scene and tells what there is to say about it.
fn load(args: &AnimateArgs) -> Result<Loaded, Failure> {
    let dials = &args.dials;
    let (loaded, warnings) = load::scene(&args.scene, dials.max_memory)?;
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(&warnings);
    if dials.strict {
        Failure::if_any(&warnings)?;
    }
    if !dials.nee.is_on() && loaded.has_punctual_lights() {
        say("warning: with --nee off, lights without extent (`light: ..`) do not shine");
    }
    Ok(loaded)
}

/// An animation while it is rendered.
struct Run<'a> {
    args: &'a AnimateArgs,
    files: Sequence,
    video: Video,
    renderer: Renderer,
    writer: Writer,
    progress: Progress,
    /// Frames that were rendered and written.
    rendered: u32,
    /// Samples per pixel of each frame that was rendered.
    spp: Vec<u32>,
    /// What tracing waited for, in all frames together.
    beside_tracing: Duration,
}

impl Run<'_> {
    /// Those of the frames whose files are not there. All are looked at before anything is rendered.
    fn unfinished(&self, frames: &FrameList) -> Result<Vec<u32>, Failure> {
        let mut unfinished = Vec::new();
        for frame in frames.iter() {
            if self.args.overwrite || self.finished(frame)?.is_none() {
                unfinished.push(frame);
            }
        }
        Ok(unfinished)
    }

    fn finished(&self, frame: u32) -> Result<Option<film::Stored>, Failure> {
        self.files.finished(frame, &self.encoding(frame))
    }

    fn encoding(&self, frame: u32) -> super::output::Encoding<'_> {
        let dials = &self.args.dials;
        let metadata = self.renderer.metadata(frame);
        self.files.encoding(metadata, dials.exposure, &dials.aov)
    }

    /// Renders the frames of `todo` and shows all of `frames`.
    fn frames(
        mut self,
        frames: &FrameList,
        todo: &[u32],
        control: &Arc<Control>,
    ) -> Result<(), Failure> {
        let launched = Instant::now();
        let (mut done, mut shown) = (Ok(()), 0);
        for frame in frames.iter() {
            done = if todo.binary_search(&frame).is_ok() {
                self.frame(frame, control)
            } else {
                self.show_finished(frame)
            };
            if done.is_err() || control.stopped() {
                break;
            }
            shown += 1;
        }
        // Whatever ended it, what is on its way to the disk is finished.
        let last = self.settle();
        let (rendered, all) = (self.rendered, todo.len());
        if let Err(failure) = done.and(last) {
            self.progress
                .say(&format!("{rendered} of {all} frames are finished and stay"));
            return Err(failure);
        }
        if shown < frames.len() {
            self.progress.say(&format!(
                "stopped; {rendered} of {all} frames are finished, and the same line goes on with the rest"
            ));
            return Err(Failure::resumable());
        }
        self.finish(frames, launched.elapsed())
    }

    /// Writes the films, and says what all of it cost.
    fn finish(self, frames: &FrameList, took: Duration) -> Result<(), Failure> {
        let rendered = self.rendered;
        let metadata = match frames.iter().next() {
            Some(frame) => self.encoding(frame).metadata,
            None => film::Metadata::default(),
        };
        drop(self.progress);
        let start = Instant::now();
        self.video.finish(&metadata)?;
        let beside = self.beside_tracing + start.elapsed();
        let beside = beside.checked_div(rendered).unwrap_or_default();
        let samples = match self.args.noise {
            Some(_) => format!(", {}", spp_of_all(&self.spp)),
            None => String::new(),
        };
        say(&match rendered {
            0 => "nothing was left to render".to_owned(),
            1 => format!("1 frame in {}", words(took)),
            _ => format!(
                "{rendered} frames in {}{samples}; beside tracing, {} a frame",
                words(took),
                words(beside)
            ),
        });
        Ok(())
    }

    /// Renders a frame and sends it on its way to the disk; one that is stopped is dropped.
    fn frame(&mut self, frame: u32, control: &Control) -> Result<(), Failure> {
        let dials = &self.args.dials;
        let launched = Instant::now();
        let (width, height) = self.renderer.settings().size;
        let mut watcher = Watcher::of(&self.progress, u64::from(width) * u64::from(height));
        let look = |film: &dyn Fn() -> Film, _, _| watcher.look(film);
        let rendering = self.renderer.render_watched(frame, control, look);
        drop(watcher);
        if rendering.stats.stopped {
            return Ok(());
        }
        let told = lost(rendering.film.total_non_finite(), &rendering.non_finite);
        if let Some(lost) = told.filter(|_| dials.strict) {
            // Not written, or the next run would take the frame as finished.
            return Err(Failure::lost_samples(lost, LOST_HINT));
        }
        let traced = Instant::now();
        self.settle()?;
        if self.video.is_wanted() {
            let gain = self.encoding(frame).gain;
            self.video.show(film::develop(&rendering.film, gain))?;
        }
        let files = self.files.clone();
        let (exposure, aovs) = (dials.exposure, dials.aov.clone());
        self.beside_tracing += rendering.stats.stages.beside_tracing();
        self.spp.push(rendering.stats.spp);
        let account = Account {
            frame,
            line: line(frame, &rendering, self.args.noise),
            rel_err: self.progress.error_of(&rendering.film),
            took: traced - launched,
        };
        self.writer.begin(account, move || {
            let encoding = files.encoding(rendering.metadata, exposure, &aovs);
            files.write(frame, &rendering.film, &encoding)
        });
        self.beside_tracing += traced.elapsed();
        Ok(())
    }

    /// Waits until the frame on its way is written, and tells of it.
    fn settle(&mut self) -> Result<(), Failure> {
        let Some(written) = self.writer.wait()? else {
            return Ok(());
        };
        self.rendered += 1;
        if !self.video.takes_stdout() {
            print_result(format!("{}\n", written.path.display()).as_bytes())?;
        }
        let Account {
            frame,
            line,
            rel_err,
            took,
        } = written.account;
        self.progress
            .say(&format!("{line}, write {}", words(written.took)));
        self.progress.finished(&Finished {
            frame,
            path: &written.path.display().to_string(),
            rel_err,
            took,
        });
        Ok(())
    }

    fn show_finished(&mut self, frame: u32) -> Result<(), Failure> {
        if !self.video.is_wanted() {
            return Ok(());
        }
        match self.finished(frame)? {
            Some(stored) => self.video.show(stored.rgb),
            None => {
                let path = self.files.path(frame);
                Err(Failure::io(
                    path.display(),
                    &"it was there a moment ago, and is gone",
                ))
            }
        }
    }
}

/// What to do about samples that are not finite.
const LOST_HINT: &str =
    "`luxel render --replay FRAME,X,Y,SAMPLE` with the same options shows how one came about";

/// What a frame cost but for its writing, and before that what it lost. `goal` is how wrong it was to be.
fn line(frame: u32, rendering: &Rendering, goal: Option<f64>) -> String {
    let stages = &rendering.stats.stages;
    let samples = match goal {
        Some(_) => samples(&rendering.stats, goal) + ", ",
        None => String::new(),
    };
    let lost = match lost(rendering.film.total_non_finite(), &rendering.non_finite) {
        Some(lost) => format!("warning: {lost}\n  = help: {LOST_HINT}\n"),
        None => String::new(),
    };
    format!(
        "{lost}frame {frame}: {samples}pose {}, extract {}, flatten {}, tree {}, trace {}",
        words(stages.pose),
        words(stages.extract),
        words(stages.flatten),
        words(stages.bvh),
        words(stages.pilot + stages.trace),
    )
}
