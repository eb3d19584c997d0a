//! What a running render shares with the one who waits for it.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// A request to stop, and counters that only ever grow. Relaxed throughout: nothing else is published by them.
#[derive(Debug)]
pub struct Control {
    stop: AtomicBool,
    samples: AtomicU64,
    total: AtomicU64,
    /// How many times as much as one rendering expects there will be.
    frames: u32,
}

impl Default for Control {
    fn default() -> Self {
        Control::of_frames(1)
    }
}

impl Control {
    /// For renderings of equal size, one after the other, whose progress is counted together.
    #[must_use]
    pub fn of_frames(frames: u32) -> Control {
        Control {
            stop: AtomicBool::new(false),
            samples: AtomicU64::new(0),
            total: AtomicU64::new(0),
            frames,
        }
    }

    /// Asks the render to come to its end; it returns what it has.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    #[must_use]
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Samples traced so far, and how many there will be: pixels × samples per pixel × frames. (0, 0) before tracing begins.
    #[must_use]
    pub fn progress(&self) -> (u64, u64) {
        (
            self.samples.load(Ordering::Relaxed),
            self.total.load(Ordering::Relaxed),
        )
    }

    pub(super) fn expect(&self, total: u64) {
        let total = total * u64::from(self.frames);
        self.total.store(total, Ordering::Relaxed);
    }

    pub(super) fn add(&self, samples: u64) {
        self.samples.fetch_add(samples, Ordering::Relaxed);
    }
}
