//! What a running render shares with the one who waits for it.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// A request to stop, and counters that only ever grow. Relaxed throughout: nothing else is published by them.
#[derive(Debug, Default)]
pub struct Control {
    stop: AtomicBool,
    samples: AtomicU64,
    total: AtomicU64,
}

impl Control {
    /// Asks the render to come to its end; it returns what it has.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    #[must_use]
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Samples traced so far, and how many there will be: pixels × samples per pixel. (0, 0) before tracing begins.
    #[must_use]
    pub fn progress(&self) -> (u64, u64) {
        (
            self.samples.load(Ordering::Relaxed),
            self.total.load(Ordering::Relaxed),
        )
    }

    pub(super) fn expect(&self, total: u64) {
        self.total.store(total, Ordering::Relaxed);
    }

    pub(super) fn add(&self, samples: u64) {
        self.samples.fetch_add(samples, Ordering::Relaxed);
    }
}
