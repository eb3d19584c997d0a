//! luxel among schedulers: how many threads it takes, what it tells logs.

#[path = "../animate/folder.rs"]
#[allow(dead_code, reason = "animations use more of it")]
mod folder;
mod progress;
mod threads;
