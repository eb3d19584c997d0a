//! The clock that rays are timed by.

use std::time::Duration;

/// CPU time of this thread: what others do on the machine does not count, beyond what they take from the caches.
#[cfg(any(target_os = "linux", target_os = "macos"))]
pub(in crate::measure) fn now() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map_or_else(|_| since_start(), Duration::from)
}

/// Time since the first call.
#[cfg(not(any(target_os = "linux", target_os = "macos")))]
pub(in crate::measure) fn now() -> Duration {
    since_start()
}

fn since_start() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}
