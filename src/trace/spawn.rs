//! Where a hit is and where the next ray starts: positions, geometric normals, and the offset by the hit's error bound.
//!
//! [`super::Hits::err`] bounds what these functions compute, so surfaces and the next rays are made with them alone.
//! Deliberately absent: any absolute epsilon.
#![allow(
    clippy::needless_range_loop,
    reason = "axes are numbers here: several arrays are indexed by one"
)]

pub(super) mod lanes;

use crate::flat::{BLOCK, Instance, Triangles};

/// γ(n) = n ε / (1 − n ε), ε = 2⁻²⁴: bound on the relative error of n roundings (Higham, *Accuracy and Stability of
/// Numerical Algorithms*, lemma 3.1).
#[must_use]
pub const fn gamma(n: u32) -> f32 {
    let e = n as f32 * (f32::EPSILON / 2.0);
    e / (1.0 - e)
}

/// Vertices of a triangle in its geometry's space.
#[must_use]
#[inline(always)]
pub fn triangle_vertices(triangles: &Triangles, prim: u32) -> [[f32; 3]; 3] {
    let place = triangles.place[prim as usize] as usize;
    let (v, lane) = (&triangles.blocks[place / BLOCK].v, place % BLOCK);
    [
        [v[0][0][lane], v[0][1][lane], v[0][2][lane]],
        [v[1][0][lane], v[1][1][lane], v[1][2][lane]],
        [v[2][0][lane], v[2][1][lane], v[2][2][lane]],
    ]
}

/// The point of a triangle with weights (1 − b1 − b2, b1, b2).
#[must_use]
#[inline(always)]
pub fn triangle_point(v: [[f32; 3]; 3], b1: f32, b2: f32) -> [f32; 3] {
    lanes::triangle_point(v, b1, b2)
}

/// The unit normal of a triangle, towards the side from which its vertices run counter-clockwise; computed in f64, since a
/// sliver's cross product cancels. 0 for a triangle without area.
#[must_use]
#[inline(always)]
pub fn triangle_normal(v: [[f32; 3]; 3]) -> [f32; 3] {
    lanes::triangle_normal(v)
}

/// A local point in scene units; f64 inside, rounded once.
#[must_use]
#[inline(always)]
pub fn instance_point(instance: &Instance, p: [f32; 3]) -> [f32; 3] {
    lanes::instance_point(&one_lane(&instance.to_world), p)
}

/// A local normal in the scene, unit: by the transpose of `to_local`. A mirroring instance keeps its direction; whether that
/// is the outside is the caller's to say.
#[must_use]
#[inline(always)]
pub fn instance_normal(instance: &Instance, n: [f32; 3]) -> [f32; 3] {
    lanes::instance_normal(&one_lane(&instance.to_local), n)
}

#[inline(always)]
fn one_lane(matrix: &[[f32; 4]; 3]) -> [[[f32; 1]; 4]; 3] {
    // Not by `array::map`, which is not inlined.
    let mut lanes = [[[0.0]; 4]; 3];
    for row in 0..3 {
        for column in 0..4 {
            lanes[row][column] = [matrix[row][column]];
        }
    }
    lanes
}

/// The point of a sphere that a ray meets at `t`, with its outward unit normal: o + t d reprojected to C + r n in f64, then
/// rounded.
#[must_use]
#[inline(always)]
pub fn sphere_point(
    ray: [[f32; 3]; 2],
    t: f32,
    center: [f64; 3],
    radius: f64,
) -> ([f32; 3], [f32; 3]) {
    lanes::sphere_point(ray, t, center, radius)
}

/// The origin of a ray that leaves `p` in direction `dir`: `p` moved by `err` along the geometric normal to the side that
/// the ray goes to, then every component rounded away from the surface (pbrt's `OffsetRayOrigin`, 4th ed., §6.8.6).
#[must_use]
#[inline(always)]
pub fn offset_origin(p: [f32; 3], ng: [f32; 3], err: f32, dir: [f32; 3]) -> [f32; 3] {
    lanes::offset_origin(p, ng, err, dir)
}
