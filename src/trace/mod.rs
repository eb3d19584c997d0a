//! Tracing: loops over SoA ray batches and path state. Takes a [`crate::flat::FlatScene`] and a lent slice, gives
//! radiance samples. Infallible.
//!
//! A wave of paths goes through stages that are loops: generate → closest hit → surface → emission → sort by material →
//! sample light → occluded → sample bsdf → roulette and compact → accumulate. Scenes that need it have two more: opacity
//! after closest hit (and in place of occluded), and vertex colours after surface.
//!
//! Deliberately absent: hecs, files, images, rayon, recursion, allocation per ray, locks.

mod attributes;
mod camera;
mod chunk;
pub mod fresnel;
mod groups;
pub mod isa;
pub mod kernels;
mod light;
mod opacity;
pub mod options;
mod path;
mod punctual;
pub mod rays;
pub mod replay;
mod roulette;
mod sampler;
mod scatter;
pub mod spawn;
mod stages;
mod surface;
#[cfg(test)]
mod test_support;
pub mod texture;
pub mod tile;
mod vector;
mod wave;

pub use isa::Isa;
pub use kernels::{closest_hit, occluded};
pub use options::{Fresnel, Sampler, TraceOptions};
pub use path::{Tracer, identity};
pub use rays::{Hits, Rays};
pub use replay::replay;
pub use surface::hit_place;
pub use tile::{LostSample, Rect, TileSums};
