//! A thread that writes one frame while the next one is traced: disks are waited for by nobody else.

use super::failure::Failure;
use std::path::PathBuf;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// At most one frame on its way.
#[derive(Default)]
pub(crate) struct Writer {
    pending: Option<Pending>,
}

struct Pending {
    thread: JoinHandle<(Result<PathBuf, Failure>, Duration)>,
    line: String,
}

/// A frame that is written.
pub(crate) struct Written {
    pub(crate) path: PathBuf,
    /// What was to be said of it.
    pub(crate) line: String,
    /// What encoding and writing took.
    pub(crate) took: Duration,
}

impl Writer {
    /// Begins to write a frame; the one before must have been waited for.
    pub(crate) fn begin(
        &mut self,
        line: String,
        write: impl FnOnce() -> Result<PathBuf, Failure> + Send + 'static,
    ) {
        let thread = std::thread::spawn(move || {
            let start = Instant::now();
            (write(), start.elapsed())
        });
        self.pending = Some(Pending { thread, line });
    }

    /// Waits for the frame on its way, if there is one.
    pub(crate) fn wait(&mut self) -> Result<Option<Written>, Failure> {
        let Some(Pending { thread, line }) = self.pending.take() else {
            return Ok(None);
        };
        let (written, took) = thread
            .join()
            .map_err(|_| Failure::io("a frame", &"the thread that wrote it died"))?;
        Ok(Some(Written {
            path: written?,
            line,
            took,
        }))
    }
}
