//! Plain mathematics: vectors (glam), boxes, lanes, and the transcendental functions whose bits do not
//! depend on the machine.

pub mod aabb;

pub use aabb::Aabb;
pub use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, Vec2, Vec3};
