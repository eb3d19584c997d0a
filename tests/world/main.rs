//! Worlds and what is built of them: poses against independent matrices, invariances of the buffers to the bit.

#![allow(clippy::unwrap_used, reason = "a test may")]

mod buffers;
mod contents;
mod instances;
mod poses;
mod stage;
