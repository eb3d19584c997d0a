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
    account: Account,
}

/// What is to be said of a frame once it is written.
pub(crate) struct Account {
    pub(crate) frame: u32,
    /// To people: what it cost but for its writing, and before that what it lost.
    pub(crate) line: String,
    /// The relative error, if it was asked for.
    pub(crate) rel_err: Option<f64>,
    /// From its first stage to its last sample.
    pub(crate) took: Duration,
}

/// A frame that is written.
pub(crate) struct Written {
    pub(crate) path: PathBuf,
    pub(crate) account: Account,
    /// What encoding and writing took.
    pub(crate) took: Duration,
}

impl Writer {
    /// Begins to write a frame; the one before must have been waited for.
    pub(crate) fn begin(
        &mut self,
        account: Account,
        write: impl FnOnce() -> Result<PathBuf, Failure> + Send + 'static,
    ) {
        let thread = std::thread::spawn(move || {
            let start = Instant::now();
            (write(), start.elapsed())
        });
        self.pending = Some(Pending { thread, account });
    }

    /// Waits for the frame on its way, if there is one.
    pub(crate) fn wait(&mut self) -> Result<Option<Written>, Failure> {
        let Some(Pending { thread, account }) = self.pending.take() else {
            return Ok(None);
        };
        let (written, took) = thread
            .join()
            .map_err(|_| Failure::io("a frame", &"the thread that wrote it died"))?;
        Ok(Some(Written {
            path: written?,
            account,
            took,
        }))
    }
}
