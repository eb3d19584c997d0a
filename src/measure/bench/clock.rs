//! The clocks that rays and pictures are timed by.

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

/// CPU time of all threads of this process together.
#[cfg(any(target_os = "linux", target_os = "macos"))]
pub(in crate::measure) fn of_all_threads(_threads: usize) -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID).map_or_else(|_| since_start(), Duration::from)
}

/// Time since the first call, as if all threads had worked all of it.
#[cfg(not(any(target_os = "linux", target_os = "macos")))]
pub(in crate::measure) fn of_all_threads(threads: usize) -> Duration {
    since_start() * u32::try_from(threads).unwrap_or(1)
}

fn since_start() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}
