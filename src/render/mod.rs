//! Rendering: drives pose → build → trace → film, over tiles on rayon's threads. A world and [`Settings`] enter, a
//! [`crate::film::Film`] and [`Stats`] leave.
//!
//! Which thread traces which tile, and in how many passes, changes no bit: every tile carries its own f64 sums through
//! all of its samples in the order of their index, and tiles do not overlap.
//!
//! Deliberately absent: printing, files, clocks that a result depends on (but for [`Settings::time`], whose sample
//! count is recorded).

mod control;
mod frame;
mod lost;
mod metadata;
mod passes;
mod pilot;
mod settings;
mod stats;
mod tiles;

pub use control::Control;
pub use frame::{Renderer, Rendering};
pub use lost::NonFinite;
pub use settings::Settings;
pub use stats::{Ended, Stages, Stats};
