//! The film: the last stage. Sums of samples enter, image files leave.
//!
//! A [`Patch`] gathers f64 sums and counts of the samples of some pixels, in an order that depends on the samples' indices alone
//! ([`Blocks`]); it may be kept in a file and taken up again ([`part`]). A [`Film`] is made of finished patches;
//! [`Film::radiance`] and its kin divide them, once, into linear f32.
//! A PNG is tone mapped here and nowhere else ([`srgb`]); an EXR stays linear, for measuring. Equal films with equal
//! [`Metadata`] are equal files: no time, host or path is written, and the bytes depend on neither machine nor threads.
//!
//! Deliberately absent: scenes, rays, tiles in flight, the choice of what to render, any clamp or filter of radiance
//! before the 8-bit picture.

mod allot;
pub mod aov;
mod blocks;
mod decay;
mod error;
mod exr;
mod gif;
mod metadata;
mod palette;
pub mod part;
mod patch;
mod pixels;
mod planes;
mod png;
mod resolve;
pub mod srgb;
mod stored;
mod stream;
mod sums;
mod write;
mod y4m;

pub use self::aov::Aov;
pub use self::blocks::Blocks;
pub use self::error::ErrorBar;
pub use self::exr::encode_exr;
pub use self::gif::{GifFrame, TICKS_PER_SECOND, encode_gif};
pub use self::metadata::Metadata;
pub use self::patch::Patch;
pub use self::planes::{Film, Planes, Window};
pub use self::png::{develop, encode_png};
pub use self::stored::{DecodeError, Stored, decode_exr, decode_png};
pub use self::stream::Stream;
pub use self::sums::Sums;
pub use self::write::{check_folder, partial_name, write_file, write_frame, write_streamed};
pub use self::y4m::{write_y4m_frame, write_y4m_header};

/// An image could not be encoded: its size is beyond what the format holds.
#[derive(Debug, thiserror::Error)]
#[error("cannot encode the {format} image: {reason}")]
pub struct EncodeError {
    /// `PNG`, `EXR` or `GIF`.
    pub format: &'static str,
    /// What the encoder says.
    pub reason: String,
}
