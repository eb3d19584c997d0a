//! A triangle against a line in f64, and how far the f32 kernel may be off.

use super::tree::Line;
use super::{Candidate, Certainty};
use crate::math::{DVec3, Vec3};

/// Unit roundoff of f32.
const U: f64 = 1.0 / (1u64 << 24) as f64;

/// What f32 rounds to where numbers end: a product or a quotient that underflows is off by so much at most.
const LEAST: f64 = f32::MIN_POSITIVE as f64 * f32::EPSILON as f64;

/// Bound on the relative error of `n` f32 roundings (Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, §3.1).
const fn gamma(n: u32) -> f64 {
    n as f64 * U / (1.0 - n as f64 * U)
}

/// t and the smallest barycentric coordinate, if the line meets the triangle.
///
/// Edge functions are signed volumes, d · (b × c) with the vertices relative to the origin: of the neighbour across an edge it
/// is the exact negative, so that f64 has no cracks either.
pub(super) fn hit(vertices: &[Vec3; 3], line: &Line) -> Option<(f64, f64)> {
    let way = vertices.map(|v| v.as_dvec3() - line.origin);
    let edges = volumes(way, line.dir);
    inside(edges).then(|| (plane(way, line.dir), margin(edges)))
}

/// What the line meets of the triangle's plane, and what the kernel may make of that.
///
/// The kernel's edge functions are those of sheared vertices (Woop, Benthin and Wald 2013), the volumes over d[kz]; their
/// rounding is bounded here step by step.
pub(super) fn meet(vertices: &[Vec3; 3], line: &Line) -> Candidate {
    let way = vertices.map(|v| v.as_dvec3() - line.origin);
    let edges = volumes(way, line.dir);
    let kz = line.dir.abs().max_position();
    let seen = way.map(|v| Sheared::new(v, line.dir, kz));
    let doubt =
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| line.dir[kz].abs() * edge_doubt(&seen[i], &seen[j]));
    Candidate {
        t: plane(way, line.dir),
        certainty: certainty(edges, doubt),
        inside: inside(edges),
        margin: margin(edges),
        reach: seen.iter().map(Sheared::reach).fold(0.0, f64::max),
    }
}

fn volumes([a, b, c]: [DVec3; 3], d: DVec3) -> [f64; 3] {
    [d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b))]
}

fn inside(edges: [f64; 3]) -> bool {
    let one_side = edges.iter().all(|&e| e >= 0.0) || edges.iter().all(|&e| e <= 0.0);
    one_side && edges.iter().sum::<f64>() != 0.0
}

/// The smallest barycentric coordinate.
fn margin(edges: [f64; 3]) -> f64 {
    let sum: f64 = edges.iter().sum();
    let share = edges.map(|e| e / sum);
    share[0].min(share[1]).min(share[2])
}

/// Where the line meets the plane; but not nearer or farther than all vertices, which a line that misses the triangle by
/// rounding alone would be if it ran almost in the plane.
fn plane([a, b, c]: [DVec3; 3], d: DVec3) -> f64 {
    let normal = (b - a).cross(c - a);
    let kz = d.abs().max_position();
    let depths = [a, b, c].map(|v| v[kz] / d[kz]);
    let low = depths[0].min(depths[1]).min(depths[2]);
    let high = depths[0].max(depths[1]).max(depths[2]);
    // Of a line in the plane, NaN, `max` and `min` make a depth.
    (normal.dot(a) / normal.dot(d)).max(low).min(high)
}

/// What the kernel must make of edge functions that it knows up to `doubt`.
fn certainty(edges: [f64; 3], doubt: [f64; 3]) -> Certainty {
    let all = |test: fn(f64, f64) -> bool| edges.iter().zip(doubt).all(|(&e, d)| test(e, d));
    if all(|e, d| e > d) || all(|e, d| e < -d) {
        Certainty::Hit
    } else if all(|e, d| e >= -d) || all(|e, d| e <= d) {
        Certainty::Doubtful
    } else {
        Certainty::Missed
    }
}

/// A vertex sheared along the line, and the bound on the rounding of either coordinate in f32.
struct Sheared {
    p: [f64; 2],
    error: [f64; 2],
}

impl Sheared {
    /// `fl(fl(v − o) + fl(fl(−d / d[kz]) · fl(v[kz] − o[kz])))`: two roundings of the first term, four of the second,
    /// and the quotient and the product may underflow.
    fn new(v: DVec3, d: DVec3, kz: usize) -> Sheared {
        let sheared = |axis: usize| {
            let along = -d[axis] / d[kz] * v[kz];
            let rounding = gamma(2) * v[axis].abs() + gamma(4) * along.abs();
            let error = rounding + LEAST * (1.0 + v[kz].abs());
            (v[axis] + along, error)
        };
        let [x, y] = [sheared((kz + 1) % 3), sheared((kz + 2) % 3)];
        Sheared {
            p: [x.0, y.0],
            error: [x.1, y.1],
        }
    }

    fn reach(&self) -> f64 {
        self.error[0].max(self.error[1])
    }
}

/// Bound on the error of `fl(fl(b₀ c₁) − fl(b₁ c₀))`.
fn edge_doubt(b: &Sheared, c: &Sheared) -> f64 {
    let product = |i: usize, j: usize| {
        let exact = (b.p[i] * c.p[j]).abs();
        let most = (b.p[i].abs() + b.error[i]) * (c.p[j].abs() + c.error[j]);
        most - exact + gamma(2) * most + LEAST
    };
    product(0, 1) + product(1, 0)
}
