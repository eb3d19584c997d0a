//! Renders that are killed, stopped, shared and put together again: always the bits of one run on one machine, or a clear word.

mod cost;
mod folder;
mod refused;
mod shares;
mod stopped;
mod told;
