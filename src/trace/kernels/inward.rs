//! Hits beside an edge step inward: by so much that the next ray starts on the right side of both triangles that meet there.
//!
//! Rounding moves a position not only off its triangle, which [`super::bound`] makes up for along the normal, but in its plane,
//! too: beside an edge, it may come into the plane of the neighbour or behind it, and what starts there and goes that way
//! meets nothing. In: a triangle, the weights of a hit, how far rounding may move it. Out: weights whose point is so far
//! inside that no rounding takes it past the edge.
//!
//! Deliberately absent: neighbours. What happens at an edge is decided by the triangle that was hit.

use crate::math::DVec3;

/// How far inside, in sums of the position's error bounds by component.
///
/// Once takes up rounding, that of the next ray's origin included: γ₇ is three roundings more than the position has. What
/// is left, twice, is at least how far that origin is off the plane; so it stands before each neighbour that meets the
/// triangle at 45° or more.
pub(super) const MARGIN: f32 = 3.0;

/// Triangles less high than so many margins stay as they are: rounding blurs all of them.
const HEIGHT: f64 = 4.0;

/// Units in the last place by which the first weight, 1 − b1 − b2, may be short of what it should be.
const LAST_PLACES: u32 = 8;

/// The weights of a hit at least `margin` from every edge, or the given ones.
///
/// The point goes straight away from each edge that is nearer. Everything in f64; a function of the hit alone.
#[inline(never)]
pub(super) fn step(v: [[f32; 3]; 3], [b1, b2]: [f32; 2], margin: f32) -> [f32; 2] {
    let margin = f64::from(margin);
    let [p, q, r] = v.map(|v| DVec3::from(v.map(f64::from)));
    let edges = [r - q, p - r, q - p];
    let normal = edges[1].cross(edges[2]);
    let weights = [1.0 - b1 - b2, b1, b2].map(f64::from);
    let least = weights[0].min(weights[1]).min(weights[2]).max(0.0);
    let squares = edges.map(DVec3::length_squared);
    let longest = squares[0].max(squares[1]).max(squares[2]);
    if least * least * normal.length_squared() >= margin * margin * longest {
        return [b1, b2];
    }
    let (area, lengths) = (normal.length(), squares.map(f64::sqrt));
    if HEIGHT * margin * longest.sqrt() > area {
        return [b1, b2];
    }
    let mut moved = weights;
    for k in 0..3 {
        let short = margin - weights[k] * area / lengths[k];
        if short > 0.0 {
            // The gradient of weight j is the normal cross edge j, over the area.
            for j in 0..3 {
                moved[j] += short * edges[k].dot(edges[j]) / (area * lengths[k]);
            }
        }
    }
    let mut rounded = [moved[1] as f32, moved[2] as f32];
    for _ in 0..LAST_PLACES {
        let [b1, b2] = rounded;
        if weights[0] >= moved[0] || f64::from(1.0 - b1 - b2) >= moved[0] {
            break;
        }
        let larger = usize::from(b2 > b1);
        rounded[larger] = rounded[larger].next_down();
    }
    rounded
}
