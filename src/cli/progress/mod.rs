//! How far a render is, told while it runs: as a bar to people, as lines to logs, schedulers and scripts.
//!
//! Takes what [`Control`] counts; gives lines on stderr. Deliberately absent: anything that a render waits for.

mod bar;
mod standing;
mod watcher;

use super::say;
use crate::film::Film;
use crate::render::Control;
use clap::ValueEnum;
use indicatif::ProgressBar;
use standing::Standing;
use std::io::IsTerminal;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

pub(crate) use standing::words;
pub(crate) use watcher::Watcher;

/// `--progress`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum How {
    /// A bar on a terminal, else nothing
    Auto,
    /// A bar
    Bar,
    /// A line every five seconds
    Plain,
    /// The same as JSON, and a line for every frame that is finished
    Json,
    /// Lines that OpenJD reads: `openjd_progress: 37.5`
    Openjd,
    /// Nothing
    None,
}

/// Often enough to look alive, rarely enough to cost nothing.
const REFRESH: Duration = Duration::from_millis(100);

/// The same for those who read logs.
const HEARTBEAT: Duration = Duration::from_secs(5);

/// What is counted.
pub(crate) struct Work {
    /// The counters.
    pub(crate) control: Arc<Control>,
    /// What `--time` allows.
    pub(crate) limit: Option<Duration>,
    /// The numbers of the frames, in their order; one or more.
    pub(crate) frames: Vec<u32>,
    /// Pixels of a frame.
    pub(crate) pixels: u64,
}

/// A frame that is finished.
pub(crate) struct Finished<'a> {
    pub(crate) frame: u32,
    pub(crate) path: &'a str,
    /// The relative error, if it was asked for.
    pub(crate) rel_err: Option<f64>,
    pub(crate) took: Duration,
}

/// Tells until dropped.
pub(crate) struct Progress {
    how: How,
    told: Arc<Mutex<Told>>,
    running: Option<Running>,
}

struct Running {
    done: Sender<()>,
    thread: JoinHandle<()>,
    bar: Option<ProgressBar>,
}

/// What the thread tells of.
#[derive(Default)]
struct Told {
    /// Nothing while the scene is read.
    work: Option<Work>,
    /// The relative error of the frame at hand, where somebody looked.
    rel_err: Option<f64>,
}

impl Progress {
    /// Starts telling, on a thread of its own; first that the scene is read.
    pub(crate) fn start(how: How) -> Progress {
        let how = match how {
            How::Auto if std::io::stderr().is_terminal() => How::Bar,
            How::Auto => How::None,
            how => how,
        };
        let told = Arc::default();
        let running = (how != How::None).then(|| Running::start(how, Arc::clone(&told)));
        Progress { how, told, running }
    }

    /// Reading is over, and this is what there is to do.
    pub(crate) fn begin(&self, work: Work) {
        self.told().work = Some(work);
    }

    /// The frame at hand is known to be so wrong; nothing, if it is another one.
    fn know(&self, rel_err: Option<f64>) {
        self.told().rel_err = rel_err;
    }

    /// The relative error of a film, if anybody reads of it.
    pub(crate) fn error_of(&self, film: &Film) -> Option<f64> {
        self.is_log()
            .then(|| film.error())
            .flatten()
            .map(|bar| bar.relative)
    }

    /// Whether lines are told.
    fn is_log(&self) -> bool {
        matches!(self.how, How::Plain | How::Json | How::Openjd)
    }

    /// Says a line, above the bar if there is one.
    pub(crate) fn say(&self, line: &str) {
        match self.running.as_ref().and_then(|it| it.bar.as_ref()) {
            Some(bar) => bar.suspend(|| say(line)),
            None => say(line),
        }
    }

    /// Says how things stand for the last time.
    pub(crate) fn end(&mut self) {
        if let Some(Running { done, thread, .. }) = self.running.take() {
            drop(done);
            // A thread that died took only its words with it.
            let _ = thread.join();
        }
    }

    /// Tells scripts of a frame that is finished.
    pub(crate) fn finished(&self, frame: &Finished<'_>) {
        if self.how == How::Json {
            say(&frame.json());
        }
    }

    fn told(&self) -> MutexGuard<'_, Told> {
        // Whoever died left it whole.
        self.told.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.end();
    }
}

impl Running {
    fn start(how: How, told: Arc<Mutex<Told>>) -> Running {
        let (done, end) = channel::<()>();
        let bar = (how == How::Bar).then(bar::bar);
        let drawn = bar.clone();
        let thread = std::thread::spawn(move || match drawn {
            Some(bar) => {
                watch(&told, &end, Duration::ZERO, |standing| {
                    bar::draw(&bar, standing)
                });
                bar.finish_and_clear();
            }
            None => watch(&told, &end, HEARTBEAT, |standing| {
                say(&standing.line(how));
            }),
        });
        Running { done, thread, bar }
    }
}

/// Tells how things stand, `every` so long and at the end.
fn watch(told: &Mutex<Told>, end: &Receiver<()>, every: Duration, mut tell: impl FnMut(&Standing)) {
    let launched = Instant::now();
    let (mut tracing_since, mut last) = (None, launched);
    let mut now = || {
        let told = told.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(work) = &told.work else {
            return Standing::Reading(launched.elapsed());
        };
        let counted = work.control.progress();
        if counted.1 == 0 {
            return Standing::Building(launched.elapsed());
        }
        // The build is over when tracing counts: its time says nothing about the samples to come.
        let since = *tracing_since.get_or_insert_with(Instant::now);
        let times = (launched.elapsed(), since.elapsed());
        Standing::of(work, counted, work.control.place(), times, told.rel_err)
    };
    while end.recv_timeout(REFRESH) == Err(RecvTimeoutError::Timeout) {
        let standing = now();
        if last.elapsed() >= every {
            tell(&standing);
            last = Instant::now();
        }
    }
    tell(&now());
}
