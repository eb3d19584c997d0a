//! What is being read, told to people who have waited for a while.

use super::say;
use crate::asset::Reading;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// How long nobody minds.
const PATIENCE: Duration = Duration::from_secs(2);

/// Tells of reading until dropped.
pub(crate) struct Patience {
    running: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Patience {
    /// Starts a thread that says, after two seconds and then for every further file that takes as long, what is read.
    pub(crate) fn start(reading: Arc<Reading>) -> Patience {
        let (done, end) = channel::<()>();
        let thread = std::thread::spawn(move || {
            let mut told = None;
            while end.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                let file = reading.file();
                if file != told {
                    if let Some((path, bytes)) = &file {
                        say(&format!(
                            "reading {} ({})",
                            path.display(),
                            megabytes(*bytes)
                        ));
                    }
                    told = file;
                }
            }
        });
        Patience {
            running: Some((done, thread)),
        }
    }
}

impl Drop for Patience {
    fn drop(&mut self) {
        if let Some((done, thread)) = self.running.take() {
            drop(done);
            // A thread that died took only its words with it.
            let _ = thread.join();
        }
    }
}

/// `0.3 MB`, `90 MB`.
pub(crate) fn megabytes(bytes: u64) -> String {
    let megabytes = bytes as f64 / 1e6;
    if megabytes < 10.0 {
        format!("{megabytes:.1} MB")
    } else {
        format!("{megabytes:.0} MB")
    }
}
