//! Tracing: loops over SoA ray batches and path state. Takes a [`crate::flat::FlatScene`] and a lent slice, gives
//! radiance samples. Infallible.
//!
//! A wave of paths goes through stages that are loops: generate → closest hit → group and surface → emission → sample
//! light → occluded → sample bsdf → roulette and compact → accumulate. Scenes that need it have more: opacity after
//! closest hit (and in place of occluded), textures and vertex colours after surface.
//!
//! Stages run over lanes of paths, as kernels over lanes of boxes: each is written once, generic over
//! `math::lanes::BitLanes`, and one lane is the scalar stage; `stages` has their entries. Lights of several kinds, textures,
//! emission and opacity go path by path.
//!
//! Deliberately absent: hecs, files, images, rayon, recursion, allocation per ray, locks.

mod attributes;
mod camera;
mod chain;
mod chunk;
mod cut;
pub mod fresnel;
mod groups;
pub mod isa;
pub mod kernels;
mod light;
mod opacity;
pub mod options;
mod own;
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
mod tally;
#[cfg(test)]
mod test_support;
pub mod texture;
pub mod tile;
mod vector;
mod wave;

pub use isa::Isa;
pub use kernels::{Visits, closest_hit, count_closest, count_occluded, occluded};
pub use options::{Fresnel, Sampler, TraceOptions};
pub use own::own_rays;
pub use path::{Tracer, identity};
pub use rays::{Hits, Rays};
pub use replay::replay;
pub use surface::hit_place;
pub use tally::{Stage, Tallies, Tally};
pub use tile::{LostSample, Rect, TileSums};
