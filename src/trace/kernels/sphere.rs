//! Ray–sphere intersection: the root in f64 lanes.
//!
//! With coefficients `a = d·d`, `b = oc·d`, `c = oc·oc − r²` of a t² + 2 b t + c, the discriminant is `a (r² − |oc − (b/a) d|²)`
//! (Hearn and Baker; Haines, Günther and Akenine-Möller, *Precision Improvements for Ray/Sphere Intersection*, Ray Tracing
//! Gems, ch. 7), and the roots are c / q and q / a with `q = −(b + sign(b) √disc)`, which cancels nothing. In f64 t is right
//! to the last bit of f32 for radii from 10⁻⁴ to 10⁸; in f32 every known form loses three to six digits on walls.
//!
//! Tried: b, c and the discriminant alone in f64, t estimated in f32, and one root of the sphere that comes first (the same
//! bits): in a room of nine spheres, closest hits took 1.02 and occlusion 1.19 of the time.

use crate::math::lanes::{Lanes, WideLanes};

/// Rays in f64 lanes with what costs once per ray.
#[derive(Clone, Copy)]
pub(crate) struct WideRay<W> {
    origin: [W; 3],
    dir: [W; 3],
    a: W,
    inv_a: W,
}

impl<W: WideLanes> WideRay<W> {
    /// Any ray: one that is not finite or has no direction gives NaN, which hits nothing.
    #[inline(always)]
    pub(crate) fn new<L: Lanes<Wide = W>>(origin: [L; 3], dir: [L; 3]) -> WideRay<W> {
        let origin = [origin[0].widen(), origin[1].widen(), origin[2].widen()];
        let dir = [dir[0].widen(), dir[1].widen(), dir[2].widen()];
        let a = dot(dir, dir);
        WideRay {
            origin,
            dir,
            a,
            inv_a: W::splat(1.0) / a,
        }
    }

    /// The smallest root above 0 of each lane, rounded to f32; nothing if no lane has a root. Lanes without one hold a t
    /// that is NaN or not above 0. What rounds to 0 or to infinity is no hit: callers ask for `0 < t < limit`.
    #[inline(always)]
    pub(crate) fn root<L: Lanes<Wide = W>>(&self, center: [W; 3], radius: W) -> Option<L> {
        let oc = [
            self.origin[0] - center[0],
            self.origin[1] - center[1],
            self.origin[2] - center[2],
        ];
        let b = dot(oc, self.dir);
        let s = b * self.inv_a;
        let beside = [
            oc[0] - s * self.dir[0],
            oc[1] - s * self.dir[1],
            oc[2] - s * self.dir[2],
        ];
        let r2 = radius * radius;
        let quarter = r2 - dot(beside, beside);
        if !quarter.any_not_negative() {
            return None;
        }
        let c = dot(oc, oc) - r2;
        let q = -(b + (self.a * quarter).sqrt().copysign(b));
        let [t0, t1] = [c / q, q * self.inv_a];
        Some(L::narrow(t0.min(t1).positive_or(t0.max(t1))))
    }
}

#[inline(always)]
fn dot<W: WideLanes>(a: [W; 3], b: [W; 3]) -> W {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
