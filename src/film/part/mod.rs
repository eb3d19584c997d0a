//! Part films: what a render has so far, or one of many machines' share of it, as a file. Patches enter, patches leave,
//! bit by bit the same.
//!
//! The file is a header of text, one `key: value` a line, the first of which is [`MAGIC`] and the last of which is empty; the number
//! of patches; the patches, each behind its length in bytes; and the CRC-32 of everything before it, so that a file that was
//! cut short or has flipped bits is told from a whole one. Numbers are little-endian. Patches are written and read one by one:
//! no file is ever held in memory.
//!
//! Deliberately absent: compression, since noise does not compress; which patches belong together, which is for who merges.

mod bytes;
mod read;
mod write;

pub use self::read::{Entry, PartError, PartFile};
pub use self::write::{PartWriter, encode_patch};

/// The first line of a part film, and the format's version.
pub const MAGIC: &str = "luxel part 1";

/// The same without the version.
const MAGIC_OF_ANY: &str = "luxel part ";
