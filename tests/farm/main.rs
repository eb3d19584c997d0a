//! luxel among schedulers: the jobs that it prints, how many threads it takes, what it tells logs.

#[path = "../animate/folder.rs"]
#[allow(dead_code, reason = "animations use more of it")]
mod folder;
#[cfg(unix)]
mod jobs;
mod progress;
#[path = "../support/folder.rs"]
mod support;
mod threads;
