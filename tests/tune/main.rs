//! `luxel tune` from outside, and whether what it finds is best.

#![allow(clippy::unwrap_used, reason = "a test may")]

mod cli;
mod grid;
