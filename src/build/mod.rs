//! build

pub mod bvh;
