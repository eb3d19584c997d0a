//! What a running render shares with the one who waits for it.

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

/// A request to stop, and counters. Relaxed throughout: nothing else is published by them.
#[derive(Debug)]
pub struct Control {
    stop: AtomicBool,
    samples: AtomicU64,
    /// Samples of the frames that are finished.
    before: AtomicU64,
    /// Samples that the frame will have; 0 while that is not known.
    expected: AtomicU64,
    /// Frames that were begun.
    begun: AtomicU32,
    /// How many there will be.
    frames: u32,
}

impl Default for Control {
    fn default() -> Self {
        Control::of_frames(1)
    }
}

impl Control {
    /// For so many renderings, one after the other, whose progress is counted together.
    #[must_use]
    pub fn of_frames(frames: u32) -> Control {
        Control {
            stop: AtomicBool::new(false),
            samples: AtomicU64::new(0),
            before: AtomicU64::new(0),
            expected: AtomicU64::new(0),
            begun: AtomicU32::new(0),
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

    /// Samples traced so far, and how many there will be if the frames to come take as many as this one. (0, 0) before
    /// tracing begins.
    #[must_use]
    pub fn progress(&self) -> (u64, u64) {
        let samples = self.samples.load(Ordering::Relaxed);
        let before = self.before.load(Ordering::Relaxed);
        let expected = self.expected.load(Ordering::Relaxed);
        let finished = self.begun.load(Ordering::Relaxed).saturating_sub(1);
        let left = self.frames.saturating_sub(finished);
        (samples, before + expected * u64::from(left))
    }

    /// Which of the frames is being rendered, counted from 0, its samples so far, and how many it will have.
    #[must_use]
    pub fn place(&self) -> (u32, u64, u64) {
        let samples = self.samples.load(Ordering::Relaxed);
        let traced = samples.saturating_sub(self.before.load(Ordering::Relaxed));
        let expected = self.expected.load(Ordering::Relaxed);
        let begun = self.begun.load(Ordering::Relaxed);
        (begun.saturating_sub(1), traced.min(expected), expected)
    }

    /// Begins a frame: what was traced so far is that of others.
    pub(super) fn begin(&self) {
        let samples = self.samples.load(Ordering::Relaxed);
        self.before.store(samples, Ordering::Relaxed);
        self.begun.fetch_add(1, Ordering::Relaxed);
    }

    /// How many samples the frame will have, as far as is known.
    pub(super) fn expect(&self, samples: u64) {
        self.expected.store(samples, Ordering::Relaxed);
    }

    pub(super) fn add(&self, samples: u64) {
        self.samples.fetch_add(samples, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_of_different_cost_are_told_apart() {
        let control = Control::of_frames(4);
        assert_eq!((control.progress(), control.place()), ((0, 0), (0, 0, 0)));
        control.begin();
        control.expect(100);
        assert_eq!(control.progress(), (0, 400));
        control.add(25);
        assert_eq!(
            (control.progress(), control.place()),
            ((25, 400), (0, 25, 100))
        );
        control.add(75);
        control.begin();
        assert_eq!(control.place(), (1, 0, 100));
        control.expect(50);
        control.add(20);
        assert_eq!(
            (control.progress(), control.place()),
            ((120, 250), (1, 20, 50))
        );
    }
}
