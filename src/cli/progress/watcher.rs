//! Looks at a film now and then while it is traced, so that logs can say how wrong it is by now.

use super::{HEARTBEAT, Progress};
use crate::film::Film;
use std::time::Instant;

/// A look is a copy of the film: larger ones are not looked at before they are finished.
const MAX_PIXELS: u64 = 1 << 22;

/// A look takes at most one part in so many of the time.
const SELDOM: u32 = 50;

/// Watches one frame.
pub(crate) struct Watcher<'a> {
    progress: &'a Progress,
    next: Option<Instant>,
}

impl<'a> Watcher<'a> {
    /// Watches a frame of so many pixels, if anybody reads about it.
    pub(crate) fn of(progress: &'a Progress, pixels: u64) -> Watcher<'a> {
        let wanted = progress.is_log() && pixels <= MAX_PIXELS;
        Watcher {
            progress,
            next: wanted.then(|| Instant::now() + HEARTBEAT),
        }
    }

    /// Takes its chance between two passes.
    pub(crate) fn look(&mut self, film: &dyn Fn() -> Film) {
        let now = Instant::now();
        if self.next.is_some_and(|next| next <= now) {
            self.progress.know(self.progress.error_of(&film()));
            let pause = HEARTBEAT.max(now.elapsed() * SELDOM);
            self.next = Some(Instant::now() + pause);
        }
    }
}

/// What was known of this frame is not known of the next one.
impl Drop for Watcher<'_> {
    fn drop(&mut self) {
        self.progress.know(None);
    }
}
