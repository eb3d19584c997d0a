//! What a ray makes of a triangle, in f64.

use luxel::math::{DVec3, Vec3};

/// t, u and v by Möller and Trumbore, no box, no tree. Of a ray in the triangle's plane, NaN.
pub fn triangle(v: [Vec3; 3], [o, d]: [[f32; 3]; 2]) -> [f64; 3] {
    let [v0, v1, v2] = v.map(|v| v.as_dvec3());
    let [o, d] = [o, d].map(|x| DVec3::from(x.map(f64::from)));
    let (e1, e2) = (v1 - v0, v2 - v0);
    let p = d.cross(e2);
    let det = e1.dot(p);
    let s = o - v0;
    let q = s.cross(e1);
    [e2.dot(q) / det, s.dot(p) / det, d.dot(q) / det]
}
