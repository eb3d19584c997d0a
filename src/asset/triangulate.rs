//! Polygons to triangles: a fan where it covers the polygon, else ear clipping in the polygon's best plane.

use crate::math::{DVec2, DVec3};

/// A polygon that needs ear clipping may have this many corners: clipping takes time in the square of their number.
pub(super) const MAX_CONCAVE_CORNERS: usize = 4_000;

/// Why a polygon was not triangulated as it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trouble {
    /// More than [`MAX_CONCAVE_CORNERS`] corners where a fan does not do.
    TooLarge,
    /// It crosses itself, as far as that shows; it was triangulated as well as it goes.
    Tangled,
}

/// Whether the fan around the first corner covers a polygon: every one of its triangles turns as the polygon does.
/// `flat` is left with the polygon in its best plane.
pub(super) fn fan_covers(points: &[DVec3], flat: &mut Vec<DVec2>) -> bool {
    project(points, flat);
    let rest = flat.get(1..).unwrap_or_default();
    rest.windows(2)
        .all(|pair| turn(flat[0], pair[0], pair[1]) > 0.0)
}

/// Appends the triangles of a polygon that no fan covers, as triples of indices into `flat`, in the winding of the
/// polygon.
///
/// A polygon of n corners gives n − 2 triangles, some perhaps without area. Equal input gives equal triangles.
pub(super) fn cut(flat: &[DVec2], out: &mut Vec<[usize; 3]>) -> Result<(), Trouble> {
    if flat.len() > MAX_CONCAVE_CORNERS {
        return Err(Trouble::TooLarge);
    }
    clip_ears(flat, out)
}

/// Drops the coordinate along which the polygon's normal (Newell's) is longest: coordinates stay exact, and the
/// polygon turns counter-clockwise.
fn project(points: &[DVec3], flat: &mut Vec<DVec2>) {
    let origin = points[0];
    // The edges at the origin span nothing.
    let normal: DVec3 = points
        .windows(2)
        .map(|edge| (edge[0] - origin).cross(edge[1] - origin))
        .sum();
    let size = normal.abs();
    let flatten = |p: DVec3| {
        if size.x >= size.y && size.x >= size.z {
            (p.y, p.z, normal.x)
        } else if size.y >= size.z {
            (p.z, p.x, normal.y)
        } else {
            (p.x, p.y, normal.z)
        }
    };
    flat.clear();
    flat.extend(points.iter().map(|&p| {
        let (u, v, along) = flatten(p - origin);
        DVec2::new(if along < 0.0 { -u } else { u }, v)
    }));
}

/// Twice the signed area of a triangle: above 0 counter-clockwise.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Cuts off ears, first to last, until a triangle is left.
fn clip_ears(flat: &[DVec2], out: &mut Vec<[usize; 3]>) -> Result<(), Trouble> {
    let n = flat.len();
    let mut ring = Ring::of(n);
    let mut left = n;
    let mut at = 0;
    let mut refused = 0;
    let mut clean = true;
    while left > 3 {
        let (before, after) = (ring.before[at], ring.after[at]);
        let stuck = refused >= left;
        if stuck || is_ear(flat, &ring, at) {
            let bend = turn(flat[before], flat[at], flat[after]);
            clean &= !stuck || bend == 0.0;
            out.push([before, at, after]);
            ring.remove(at);
            left -= 1;
            refused = 0;
        } else {
            refused += 1;
        }
        at = after;
    }
    let last = [ring.before[at], at, ring.after[at]];
    clean &= turn(flat[last[0]], flat[last[1]], flat[last[2]]) >= 0.0;
    out.push(last);
    if clean { Ok(()) } else { Err(Trouble::Tangled) }
}

/// The corners that are left, linked in a ring.
struct Ring {
    before: Vec<usize>,
    after: Vec<usize>,
}

impl Ring {
    fn of(n: usize) -> Ring {
        Ring {
            before: (0..n).map(|i| (i + n - 1) % n).collect(),
            after: (0..n).map(|i| (i + 1) % n).collect(),
        }
    }

    fn remove(&mut self, at: usize) {
        let (before, after) = (self.before[at], self.after[at]);
        self.after[before] = after;
        self.before[after] = before;
    }
}

/// Whether the corner is convex and no other corner that is left lies in its triangle. Corners at the very place of
/// one of the three do not count: bridges to holes repeat them.
fn is_ear(flat: &[DVec2], ring: &Ring, at: usize) -> bool {
    let (before, after) = (ring.before[at], ring.after[at]);
    let (a, b, c) = (flat[before], flat[at], flat[after]);
    if turn(a, b, c) <= 0.0 {
        return false;
    }
    let mut other = ring.after[after];
    while other != before {
        let p = flat[other];
        let apart = p != a && p != b && p != c;
        if apart && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0 {
            return false;
        }
        other = ring.after[other];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<DVec3> {
        // A tilted plane, so that no coordinate is spare.
        points
            .iter()
            .map(|&(x, y)| DVec3::new(x, y, 0.5 * x - 2.0 * y))
            .collect()
    }

    fn triangulate(points: &[DVec3], out: &mut Vec<[usize; 3]>) -> Result<(), Trouble> {
        let mut flat = Vec::new();
        if fan_covers(points, &mut flat) {
            out.extend((1..points.len() - 1).map(|i| [0, i, i + 1]));
            return Ok(());
        }
        cut(&flat, out)
    }

    /// Triangles, and the sum of their areas as seen along z, each counted as positive.
    fn covered(points: &[DVec3]) -> (Vec<[usize; 3]>, f64) {
        let mut triangles = Vec::new();
        assert_eq!(triangulate(points, &mut triangles), Ok(()));
        let flat = |i: usize| points[i].truncate();
        let area = triangles
            .iter()
            .map(|t| turn(flat(t[0]), flat(t[1]), flat(t[2])).abs() / 2.0)
            .sum();
        (triangles, area)
    }

    #[test]
    fn convex_polygons_are_fans() {
        let square = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert_eq!(covered(&square).0, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn concave_polygons_are_covered_once_from_any_start_in_either_winding() {
        let shapes: [(&[(f64, f64)], f64); 4] = [
            (&[(0.0, 0.0), (4.0, 0.0), (1.0, 1.0), (0.0, 4.0)], 4.0),
            (
                &[
                    (0.0, 0.0),
                    (3.0, 0.0),
                    (3.0, 3.0),
                    (2.0, 3.0),
                    (2.0, 1.0),
                    (1.0, 1.0),
                    (1.0, 3.0),
                    (0.0, 3.0),
                ],
                7.0,
            ),
            (
                &[
                    (0.0, 0.0),
                    (2.0, 0.0),
                    (4.0, 0.0),
                    (4.0, 2.0),
                    (2.0, 1.0),
                    (0.0, 2.0),
                ],
                6.0,
            ),
            // A square with a square hole, joined by a bridge that is walked twice.
            (
                &[
                    (0.0, 0.0),
                    (3.0, 0.0),
                    (3.0, 3.0),
                    (0.0, 3.0),
                    (0.0, 0.0),
                    (1.0, 1.0),
                    (1.0, 2.0),
                    (2.0, 2.0),
                    (2.0, 1.0),
                    (1.0, 1.0),
                ],
                8.0,
            ),
        ];
        for (shape, area) in shapes {
            for start in 0..shape.len() {
                let mut turned = shape.to_vec();
                turned.rotate_left(start);
                for _ in 0..2 {
                    let points = polygon(&turned);
                    let (triangles, found) = covered(&points);
                    assert_eq!(
                        (triangles.len(), found),
                        (shape.len() - 2, area),
                        "{turned:?}"
                    );
                    turned.reverse();
                }
            }
        }
    }

    #[test]
    fn degenerate_and_tangled_polygons_end() {
        let mut triangles = Vec::new();
        let bow = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 1.0)];
        let found = triangulate(&polygon(&bow), &mut triangles);
        assert_eq!((found, triangles.len()), (Err(Trouble::Tangled), 2));
        for shape in [
            vec![(1.0, 1.0); 7],
            vec![(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)],
        ] {
            triangles.clear();
            assert_eq!(triangulate(&polygon(&shape), &mut triangles), Ok(()));
            assert_eq!(triangles.len(), shape.len() - 2);
        }
    }
}
