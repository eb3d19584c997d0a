//! Plain mathematics: vectors (glam), boxes, lanes, and the transcendental functions whose bits do not
//! depend on the machine.

pub mod aabb;
pub mod func;
pub(crate) mod lanes;
pub mod pages;
pub mod rotation;
pub mod srgb;

pub use aabb::Aabb;
pub use func::{acos, atan2, cos, exp, ln, pow, sin, sin_cos, sin_cos_turns, tan};
pub use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, Vec2, Vec3};
pub use rotation::{axis_angle_deg, euler_deg, quaternion, sin_cos_deg, unit};
pub use srgb::{SRGB_BYTES, srgb_to_linear};
