//! The kernels against each other (instruction sets, trees), against an f64 oracle, and against what geometry says must be hit.

mod agree;
mod count;
mod cracks;
mod exact;
mod leave;
mod packets;
#[path = "../support/mod.rs"]
mod support;
mod together;
mod trees;

use luxel::build::bvh::Accel;
use support::shoot::{best, bits, misses, ray, soup, trace};

pub(crate) const EVERY: [Accel; 3] = [Accel::Brute, Accel::Box, Accel::Bvh];
