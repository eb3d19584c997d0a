//! stub
use crate::math::Vec3;
/// stub
pub fn offset_origin(p: Vec3, ng: Vec3, err: f32, dir: Vec3) -> Vec3 {
    p + ng * err.copysign(dir.dot(ng))
}
