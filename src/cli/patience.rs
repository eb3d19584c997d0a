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
        let wait = move || end.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout);
        let thread = std::thread::spawn(move || tell(&reading, wait, say));
        Patience {
            running: Some((done, thread)),
        }
    }
}

/// Says what is read whenever `wait` has lasted and there is news, until `wait` returns false.
fn tell(reading: &Reading, mut wait: impl FnMut() -> bool, mut say: impl FnMut(&str)) {
    let mut told = None;
    while wait() {
        let file = reading.file();
        if file != told {
            if let Some((path, bytes)) = &file {
                let size = megabytes(*bytes);
                say(&format!("reading {} ({size})", path.display()));
            }
            told = file;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::Loader;

    #[test]
    fn a_file_that_takes_long_is_told_once_and_the_next_one_too() {
        let folder = std::env::temp_dir().join(format!("luxel-patience-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let files = ["slow.obj", "slower.obj"].map(|name| folder.join(name));
        for file in &files {
            std::fs::write(file, text).expect("a file");
        }
        let mut loader = Loader::new();
        let reading = loader.reading();
        // Two seconds each, of which nobody waits: nothing is read yet; one file for two waits; another; the end.
        let mut waits = [None, Some(0), None, Some(1)].into_iter();
        let wait = || match waits.next() {
            Some(next) => {
                if let Some(file) = next {
                    loader.mesh(&files[file]).expect("a mesh");
                }
                true
            }
            None => false,
        };
        let mut said = Vec::new();
        tell(&reading, wait, |line| said.push(line.to_owned()));
        std::fs::remove_dir_all(&folder).expect("gone");
        let expect = files.map(|file| format!("reading {} (0.0 MB)", file.display()));
        assert_eq!(said, expect);
    }
}
