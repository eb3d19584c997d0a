//! The catalogue: what goes wrong at the extremes of numbers, tried on purpose.
//!
//! Every item is a construction with something that must hold: a ray that must hit, a bound, an equality to the bit. Quick
//! ones run at every commit; the same items, as often as their bars ask for, run by
//!
//! ```sh
//! cargo test --release --test catalogue deep -- --ignored --nocapture
//! ```
//!
//! which also writes the README's table, to `target/tmp/catalogue.md`. That takes hours; `CATALOGUE_TRIALS=1e7` before it
//! tries nothing more often than that. Seeds are fixed, so that a run can be repeated. 0 failures of N trials mean less
//! than one in N / 3 (with 95 % certainty).

mod a_bounds;
mod a_leaving;
mod a_triangles;
mod b_spheres;
mod book;
mod d_trees;
mod scenes;
#[path = "../support/mod.rs"]
mod support;
