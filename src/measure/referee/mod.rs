//! The referee: what rays hit in f64, and whether what a kernel found is wrong. Hits enter, verdicts leave.
//!
//! [`Referee::trace`] is the truth: edge functions as signed volumes and t as a quotient of volumes, in f64, over a tree
//! of its own. Against the errors of f32, those of f64 do not count.
//!
//! [`Traced::judge`] holds luxel to what its kernels promise. Of a hit at t on a primitive that the exact ray meets at t64:
//!
//! - *agrees*: it is the closest one in f64 too, and t is **inside** its bound: |t − t64| is at most
//!   [`t_error_bound`](crate::trace::kernels::t_error_bound) and a rounding of t. A miss agrees with a miss.
//! - *tie*: another primitive than in f64, and their t lie inside the sum of their bounds.
//! - *edge*: hit and miss differ, and an f64 edge function of the triangle in question lies **inside** the bound on the
//!   rounding of the f32 one around 0: whether the ray passes is not for f32 to know. But neighbours decide alike: where
//!   the surface goes on around the ray and does not turn back there, it must have been hit.
//! - *wrong*: anything else. A miss on a closed mesh is always wrong.
//!
//! Spheres are held to f64, in which their kernel computes: a rounding of t, and grazing to 2⁻⁴⁴ of the numbers involved.
//!
//! [`Traced::judge_loosely`] is the rule for libraries that promise nothing: see there.
//!
//! Deliberately absent: instances, and speed.

mod sphere;
#[cfg(test)]
mod tests;
mod traced;
mod tree;
mod triangle;

pub use traced::Traced;

use crate::build::bvh::{Primitives, sphere_bounds};
use crate::flat::Spheres;
use crate::math::{Aabb, DVec3};
use tree::{Line, Tree};

/// What to make of a hit or a miss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It is that of f64, t inside its bound.
    Agrees,
    /// Two primitives closer to each other than f32 can tell.
    Tie,
    /// The ray passes an edge closer than f32 can tell.
    Edge,
    /// Not explained by any bound.
    Wrong,
}

/// A hit in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exact {
    /// Ray parameter.
    pub t: f64,
    /// Primitive, as in [`Hits::prim`](crate::trace::Hits::prim).
    pub prim: u32,
    /// How far inside the ray is: the smallest barycentric coordinate, or the share of a sphere's radius.
    pub margin: f64,
}

/// What was found for a ray, in a form that every library can give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Ray parameter.
    pub t: f32,
    /// Primitive, as in [`Hits::prim`](crate::trace::Hits::prim).
    pub prim: u32,
}

/// A primitive, and what a line makes of it.
struct Candidate {
    /// Where the line meets its surface, extended beyond the edges.
    t: f64,
    /// What f32 must make of it.
    certainty: Certainty,
    /// What f64 makes of it.
    inside: bool,
    /// See [`Exact::margin`]; negative outside.
    margin: f64,
    /// How far aside f32 may see it, scene units.
    reach: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Certainty {
    Hit,
    Doubtful,
    Missed,
}

/// Triangles and spheres with a tree over them.
pub struct Referee<'a> {
    primitives: Primitives<'a>,
    tree: Tree,
}

/// A ray as it is given: origin and direction.
type Ray = [[f32; 3]; 2];

impl<'a> Referee<'a> {
    /// Over the triangles and the spheres of `primitives`; of a sphere, `prim` is its place among them.
    #[must_use]
    pub fn new(primitives: Primitives<'a>) -> Referee<'a> {
        let triangle = |v: &[_; 3]| Aabb::point(v[0]).with(v[1]).with(v[2]);
        let triangles = primitives.triangles.iter().map(triangle);
        let spheres = primitives.spheres.iter();
        let boxes: Vec<Aabb> = triangles
            .chain(spheres.map(|s| sphere_bounds(s.center, s.radius)))
            .collect();
        Referee {
            primitives,
            tree: Tree::new(&boxes),
        }
    }

    /// The truth about a ray: its closest hit with 0 < t < `t_max` in f64.
    #[must_use]
    pub fn trace(&self, [origin, dir]: Ray, t_max: f32) -> Traced<'_> {
        let wide = |x: [f32; 3]| DVec3::from(x.map(f64::from));
        let line = Line {
            origin: wide(origin),
            dir: wide(dir),
        };
        Traced {
            referee: self,
            ray: [origin, dir],
            line,
            t_max,
            exact: self.closest(&line, f64::from(t_max)),
        }
    }

    fn closest(&self, line: &Line, t_max: f64) -> Option<Exact> {
        let mut best: Option<Exact> = None;
        self.tree.visit(line, t_max, |item| {
            let prim = self.prim(item);
            let limit = best.map_or(t_max, |b| b.t);
            let hit = self.hit(prim, line);
            if let Some((t, margin)) = hit.filter(|&(t, _)| t > 0.0 && t < limit) {
                best = Some(Exact { t, prim, margin });
            }
            best.map_or(t_max, |b| b.t)
        });
        best
    }

    /// Everything that f32 may hit with 0 < t < `limit`.
    fn candidates(&self, line: &Line, limit: f64) -> Vec<(u32, Candidate)> {
        let mut found = Vec::new();
        self.tree.visit(line, limit, |item| {
            let prim = self.prim(item);
            let met = self.meet(prim, line);
            if met.certainty != Certainty::Missed && met.t > 0.0 && met.t < limit {
                found.push((prim, met));
            }
            limit
        });
        found
    }

    fn prim(&self, item: u32) -> u32 {
        let triangles = self.primitives.triangles.len() as u32;
        item.checked_sub(triangles)
            .map_or(item, |sphere| Spheres::TAG | sphere)
    }

    fn hit(&self, prim: u32, line: &Line) -> Option<(f64, f64)> {
        let index = (prim & !Spheres::TAG) as usize;
        if prim & Spheres::TAG == 0 {
            triangle::hit(&self.primitives.triangles[index], line)
        } else {
            sphere::hit(&self.primitives.spheres[index], line)
        }
    }

    fn meet(&self, prim: u32, line: &Line) -> Candidate {
        let index = (prim & !Spheres::TAG) as usize;
        if prim & Spheres::TAG == 0 {
            triangle::meet(&self.primitives.triangles[index], line)
        } else {
            sphere::meet(&self.primitives.spheres[index], line)
        }
    }
}
