//! Rendering: drives pose → build → trace → film, over tiles on rayon's threads. A world and [`Settings`] enter, a
//! [`crate::film::Film`] and [`Stats`] leave.
//!
//! Which thread traces which tile, and in how many passes, changes no bit: every tile carries its own f64 sums through
//! all of its samples, in an order that depends on their indices alone, and tiles do not overlap. Nor does it matter how often
//! a render is stopped and taken up again ([`Canvas`]), or by how many machines it is shared ([`Share`]).
//!
//! Deliberately absent: printing, files, clocks that a result depends on (but for [`Settings::time`], whose sample
//! count is recorded).

mod canvas;
mod control;
mod frame;
mod lost;
mod metadata;
mod passes;
mod pilot;
mod settings;
mod stats;
mod tiles;

pub use canvas::{Canvas, PatchGuard, Share};
pub use control::Control;
pub use frame::{Renderer, Rendering, Traced};
pub use lost::NonFinite;
pub use pilot::Verdict;
pub use settings::Settings;
pub use stats::{Ended, Stages, Stats};
