//! Measuring: how wrong an image is. Two images enter, numbers and maps of their difference leave.
//!
//! [`Image`] reads a PNG or an EXR into linear light; [`Pair`] is an image and its reference, fit to be compared, with
//! the pixels that count; [`errors`] gives the statistics, [`flip`] what an eye would notice, [`heat`] a picture of
//! either. A value that is not finite is an error at the door ([`Pair::new`]), so none of the numbers can hide it.
//! [`fall`] follows an image's error while it is rendered.
//!
//! [`referee`] asks the same of what rays hit, [`exactness`] what being right costs, and [`stability`] what becomes of a
//! scene at other sizes and places. [`cost`] tells what a scene's own paths cost, [`tune`] what its dials cost and err.
//!
//! Deliberately absent: the arguments and words of `luxel compare`, the verdict on what error is too much, and any
//! alignment, scaling or exposure that would make images more alike than they are.

pub mod arms;
pub mod bench;
pub mod cost;
mod errors;
pub mod exactness;
pub mod fall;
pub mod flip;
pub mod heat;
mod image;
mod pair;
pub mod referee;
pub mod stability;
mod svg;
pub mod tune;

pub use self::errors::{Bias, Errors, Maximum, errors, relative_squared};
pub use self::image::{Image, ReadError};
pub use self::pair::{NonFinite, Pair, PairError, Selection};
