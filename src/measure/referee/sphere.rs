//! A sphere against a line in f64.

use super::tree::Line;
use super::{Candidate, Certainty};
use crate::build::bvh::SphereItem;
use crate::math::DVec3;

/// The kernel decides in f64 as well, in another order: a line that passes the surface closer than this share of the
/// numbers involved may go either way.
const DOUBT: f64 = 1.0 / (1u64 << 44) as f64;

/// Roundings of t to f32: its own, and those of the box that it is clamped into.
const ROUNDINGS: f64 = 4.0 * f32::EPSILON as f64;

/// Where the line enters the sphere, or leaves it if it begins inside. Of a line that passes, the nearest point.
pub(super) fn meet(sphere: &SphereItem, line: &Line) -> Candidate {
    let to = DVec3::from(sphere.center) - line.origin;
    let a = line.dir.length_squared();
    let middle = to.dot(line.dir) / a;
    let beside = (to - middle * line.dir).length();
    let r = sphere.radius;
    let doubt = DOUBT * (to.length() + r);
    let half = ((r - beside) * (r + beside) / a).max(0.0).sqrt();
    // The product of the roots, without the cancellation of middle − half.
    let far = middle + half.copysign(middle);
    let near = (to.length() - r) * (to.length() + r) / a / far;
    let [first, second] = [near.min(far), near.max(far)];
    Candidate {
        t: if first > 0.0 { first } else { second },
        certainty: if beside < r - doubt {
            Certainty::Hit
        } else if beside <= r + doubt {
            Certainty::Doubtful
        } else {
            Certainty::Missed
        },
        inside: beside <= r,
        margin: 1.0 - beside / r,
        reach: doubt,
    }
}

/// t and margin, if the line meets the sphere.
pub(super) fn hit(sphere: &SphereItem, line: &Line) -> Option<(f64, f64)> {
    let met = meet(sphere, line);
    met.inside.then_some((met.t, met.margin))
}

/// Bound on |t − t64|: rounding, and how `DOUBT` moves the point where the line grazes.
pub(super) fn t_bound(sphere: &SphereItem, line: &Line, t: f64) -> f64 {
    let center = DVec3::from(sphere.center);
    let point = line.origin + t * line.dir;
    let normal = (point - center) / sphere.radius;
    let slope = normal.dot(line.dir).abs() / line.dir.length();
    let doubt = DOUBT * ((center - line.origin).length() + sphere.radius);
    let grazing = (2.0 * sphere.radius * doubt).sqrt();
    ROUNDINGS * t.abs() + (doubt / slope).min(grazing) / line.dir.length()
}
