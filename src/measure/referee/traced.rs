//! The verdicts on what was found for a ray.

use super::tree::Line;
use super::{Candidate, Certainty, Exact, Found, Ray, Referee, Verdict, sphere};
use crate::flat::Spheres;
use crate::trace::kernels::t_error_bound;

/// A ray and the truth about it.
pub struct Traced<'a> {
    pub(super) referee: &'a Referee<'a>,
    pub(super) ray: Ray,
    pub(super) line: Line,
    pub(super) t_max: f32,
    pub(super) exact: Option<Exact>,
}

/// Rays of [`Traced::closed_around`] are moved aside by so many times the reach, to be surely outside of doubt.
const ASIDE: f64 = 8.0;

/// Where they are moved to, in the plane across the ray.
const AROUND: [[i8; 2]; 16] = [
    [2, 0],
    [2, 1],
    [2, 2],
    [1, 2],
    [0, 2],
    [-1, 2],
    [-2, 2],
    [-2, 1],
    [-2, 0],
    [-2, -1],
    [-2, -2],
    [-1, -2],
    [0, -2],
    [1, -2],
    [2, -2],
    [2, -1],
];

/// Loose rule: t may differ by this share of 1 + t.
const LOOSE_T: f64 = 2e-4;

/// Loose rule: so close to an edge, in barycentric coordinates, hit and miss may differ.
const LOOSE_EDGE: f64 = 1e-3;

impl Traced<'_> {
    /// The closest hit in f64.
    #[must_use]
    pub fn exact(&self) -> Option<Exact> {
        self.exact
    }

    /// Whether what luxel found is right, see [the module](super): the closest hit with t ≤ `t_max`, or none.
    #[must_use]
    pub fn judge(&self, found: Option<Found>) -> Verdict {
        let mut edge = false;
        let limit = match (found, self.exact) {
            (None, None) => return Verdict::Agrees,
            (None, Some(_)) => f64::from(self.t_max),
            (Some(hit), _) => {
                let own = self.referee.meet(hit.prim, &self.line);
                let t = f64::from(hit.t);
                let bound = self.t_bound(hit.prim, own.t);
                // Of a doubtful one, which the line may pass, the plane may be met behind the origin.
                let doubtful = own.certainty == Certainty::Doubtful;
                let counts = own.certainty != Certainty::Missed && (own.t > 0.0 || doubtful);
                if !counts || hit.t > self.t_max || (t - own.t).abs() > bound {
                    return Verdict::Wrong;
                }
                if self.exact.is_some_and(|e| e.prim == hit.prim) {
                    return Verdict::Agrees;
                }
                edge |= !own.inside;
                t - bound
            }
        };
        for (prim, candidate) in self.referee.candidates(&self.line, limit) {
            if candidate.t + self.t_bound(prim, candidate.t) >= limit {
                continue;
            }
            let sure = candidate.certainty == Certainty::Hit;
            if sure || self.closed_around(prim, &candidate, limit) {
                return Verdict::Wrong;
            }
            edge = true;
        }
        if edge { Verdict::Edge } else { Verdict::Tie }
    }

    /// Whether what luxel found is right: something with 0 < t < `t_max`, or nothing.
    #[must_use]
    pub fn judge_occlusion(&self, occluded: bool) -> Verdict {
        if !occluded {
            return self.judge(None);
        }
        if self.exact.is_some() {
            return Verdict::Agrees;
        }
        let mut verdict = Verdict::Wrong;
        for (prim, candidate) in self.referee.candidates(&self.line, f64::INFINITY) {
            if candidate.t - self.t_bound(prim, candidate.t) < f64::from(self.t_max) {
                verdict = if candidate.inside {
                    Verdict::Tie
                } else {
                    Verdict::Edge
                };
            }
        }
        verdict
    }

    /// The rule for peers, whose bounds are not known: t within 2·10⁻⁴ (1 + t) agrees, whatever was hit; hit and miss may
    /// differ, as [`Verdict::Edge`], within 10⁻³ of an edge in barycentric coordinates.
    #[must_use]
    pub fn judge_loosely(&self, found: Option<Found>) -> Verdict {
        let missed = |exact: Exact| exact.margin < LOOSE_EDGE;
        let explained = match (found, self.exact) {
            (None, None) => return Verdict::Agrees,
            (None, Some(exact)) => missed(exact),
            (Some(hit), Some(exact)) if near(hit, exact.t) => return Verdict::Agrees,
            (Some(hit), Some(exact)) if f64::from(hit.t) > exact.t => missed(exact),
            (Some(hit), _) => {
                let own = self.referee.meet(hit.prim, &self.line);
                own.margin > -LOOSE_EDGE && near(hit, own.t)
            }
        };
        if explained {
            Verdict::Edge
        } else {
            Verdict::Wrong
        }
    }

    /// The loose rule for occlusion.
    #[must_use]
    pub fn judge_occlusion_loosely(&self, occluded: bool) -> Verdict {
        if !occluded {
            return self.judge_loosely(None);
        }
        if self.exact.is_some() {
            return Verdict::Agrees;
        }
        let reach = f64::from(self.t_max) + LOOSE_T * (1.0 + f64::from(self.t_max));
        let candidates = self.referee.candidates(&self.line, reach);
        if candidates.iter().any(|(_, c)| c.margin > -LOOSE_EDGE) {
            Verdict::Edge
        } else {
            Verdict::Wrong
        }
    }

    /// Whether the surface goes on around a doubtful candidate, so that a ray that got past it went through a crack: lines moved
    /// aside all meet it, or what has a corner in common with it, an odd number of times before the limit.
    ///
    /// Rounding moves vertices, and how often a surface lies over a point does not change by that, modulo 2, as long as its
    /// rim stays away from the point (its degree, Milnor, *Topology from the Differentiable Viewpoint*, 1965, §4). Where it is
    /// even, the surface turns back near the ray, whatever is met around: through the notch of a saddle that is seen almost
    /// along its surface, rays pass that no line aside falls into. What has no corner in common is another surface.
    fn closed_around(&self, prim: u32, candidate: &Candidate, limit: f64) -> bool {
        let aside = ASIDE * candidate.reach;
        let x = self.line.dir.any_orthogonal_vector().normalize();
        let y = self.line.dir.cross(x).normalize();
        let far = limit >= f64::from(f32::MAX);
        let near = if far {
            limit
        } else {
            0.5 * (candidate.t + limit)
        };
        AROUND.iter().all(|&[i, j]| {
            let origin = self.line.origin + aside * (f64::from(i) * x + f64::from(j) * y);
            let moved = Line {
                origin,
                ..self.line
            };
            let met = self.referee.candidates(&moved, near);
            let over = met
                .iter()
                .filter(|(of, c)| c.inside && self.touch(prim, *of));
            over.count() % 2 == 1
        })
    }

    /// Whether two primitives are one, or triangles with a corner in common.
    fn touch(&self, a: u32, b: u32) -> bool {
        let triangle = |prim: u32| self.referee.primitives.triangles.get(prim as usize);
        match (triangle(a), triangle(b)) {
            (Some(of_a), Some(of_b)) => of_a.iter().any(|corner| of_b.contains(corner)),
            _ => a == b,
        }
    }

    /// Bound on |t − t64| of a hit at about `t`.
    fn t_bound(&self, prim: u32, t: f64) -> f64 {
        /// Roundings of t itself, when it is clamped.
        const CLAMPED: f64 = 4.0 * f32::EPSILON as f64;
        let index = (prim & !Spheres::TAG) as usize;
        if prim & Spheres::TAG == 0 {
            let vertices = self.referee.primitives.triangles[index].map(|v| v.to_array());
            f64::from(t_error_bound(vertices, self.ray[0], self.ray[1])) + CLAMPED * t
        } else {
            sphere::t_bound(&self.referee.primitives.spheres[index], &self.line, t)
        }
    }
}

fn near(hit: Found, t: f64) -> bool {
    (f64::from(hit.t) - t).abs() <= LOOSE_T * (1.0 + t)
}
