//! The plane of a chain: a point, a sphere's centre and a point on a lamp lie in one, and so does all of the way between
//! them, since the normals of a sphere meet in its centre.
//!
//! Lengths are in radii of the sphere. `u` points from the first point to the centre, `e` is orthogonal to it, towards the
//! lamp's side. A line that passes the centre at the signed distance h (positive on the side of its left normal) passes it
//! at h after every bounce (Bouguer's law, and reflection keeps angles), so that one number describes the way and one
//! equation finds it: the line that leaves must meet the lamp. With its direction (cos ψ, sin ψ) that is
//! `y · (−sin ψ, cos ψ) = h`, solved by Newton's method. The idea is that of manifold next-event estimation (Hanika, Droske
//! and Fascione 2015), on a sphere with one unknown and without derivatives of normals.

use crate::flat::Bounces;
use crate::math::lanes::BitLanes;

/// Steps of Newton's method. What fewer do not find, paths must.
const STEPS: usize = 5;

/// How near the line must pass the lamp's point, relative to all lengths.
const NEAR: f32 = 1.0 / 16_384.0;

/// Where searches begin, over the greatest h. Of rays that a test sends through balls, they find 92 % again where there are
/// up to three ways, and all but one in a thousand elsewhere (`searches_find_what_arrives`).
pub(super) const STARTS: [f32; 3] = [-0.95, 0.3, 0.95];

/// A circle so wide that nothing is bent there.
const NEVER: f32 = (1u64 << 40) as f32;

/// h stays below the greatest by this factor, where the equation's derivative has a pole.
const BELOW: f32 = 1.0 - 1.0 / 1024.0;

/// The spheres of a chain, in each lane; see [`crate::flat::Chains::shape`].
#[derive(Clone, Copy)]
pub(super) struct Shape<L> {
    pub(super) ior: L,
    pub(super) ratio: L,
    pub(super) inner: L,
    pub(super) greatest: L,
    /// [`Bounces`] as a number.
    pub(super) bounces: L,
}

/// Both ends: how far the first is from the centre, and where the lamp's point lies, along `u` and along `e`.
#[derive(Clone, Copy)]
pub(super) struct Ends<L> {
    pub(super) distance: L,
    pub(super) along: L,
    pub(super) beside: L,
}

/// A way from one end to the other.
#[derive(Clone, Copy)]
pub(super) struct Way<L> {
    /// Distance at which its lines pass the centre.
    pub(super) h: L,
    /// Direction of the last line: cos ψ, sin ψ.
    pub(super) last: [L; 2],
    /// How fast the last line moves across the lamp's point: its distance from it, by h.
    spread: L,
}

impl<L: BitLanes> Shape<L> {
    #[inline(always)]
    pub(super) fn is(&self, bounces: Bounces) -> L::Mask {
        let number = L::splat(bounces as u32 as f32);
        self.bounces.le(number) & number.le(self.bounces)
    }

    #[inline(always)]
    fn at_most(&self, bounces: Bounces) -> L::Mask {
        self.bounces.le(L::splat(bounces as u32 as f32))
    }

    /// The circles as distances from the centre that h is compared with: outside and inside of either sphere. What is
    /// reflected in the middle does not enter there.
    #[inline(always)]
    fn circles(&self) -> [L; 4] {
        let (outer, middle) = (self.ior, self.ratio * self.ior);
        let under = L::select(
            self.is(Bounces::Inside),
            L::splat(NEVER),
            middle * self.inner,
        );
        [L::splat(1.0), outer, middle, under]
    }
}

/// Cosine at a circle that h meets at the sine h / c, and 1 / (c cosine).
#[inline(always)]
fn cosine<L: BitLanes>(h: L, c: L) -> [L; 2] {
    let root = (c * c - h * h).sqrt();
    [root / c, L::splat(1.0) / root]
}

/// Product of complex numbers.
#[inline(always)]
fn times<L: BitLanes>(a: [L; 2], b: [L; 2]) -> [L; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// The direction of the last line, and the derivative of its angle by h.
#[inline(always)]
fn leave<L: BitLanes>(shape: &Shape<L>, distance: L, h: L) -> ([L; 2], L) {
    let [one, two] = [L::splat(1.0), L::splat(2.0)];
    let [cos, first] = cosine(h, distance);
    let at = [cos, h / distance];
    let circles = shape.circles();
    let [cos, outside] = cosine(h, circles[0]);
    let out = [cos, -(h / circles[0])];
    let out = times(out, out);
    let mirrored = [-out[0], -out[1]];
    let mut bent = out;
    let mut rate = outside;
    for (circle, into) in [(1, true), (2, false), (3, true)] {
        let [cos, slope] = cosine(h, circles[circle]);
        let sin = h / circles[circle];
        let turn = [cos, if into { sin } else { -sin }];
        bent = times(bent, times(turn, turn));
        rate = if into { rate - slope } else { rate + slope };
    }
    let reflects = shape.at_most(Bounces::Glass);
    let sign = L::select(shape.is(Bounces::Inside), -one, one);
    let turn = [
        L::select(reflects, mirrored[0], sign * bent[0]),
        L::select(reflects, mirrored[1], sign * bent[1]),
    ];
    let rate = L::select(reflects, outside, rate);
    (times(at, turn), first - two * rate)
}

impl<L: BitLanes> Way<L> {
    /// The way that the search finds from one of [`STARTS`] between two points outside the sphere, and in which lanes it
    /// finds one.
    #[inline(always)]
    pub(super) fn find(shape: &Shape<L>, ends: &Ends<L>, start: f32) -> (Way<L>, L::Mask) {
        let [zero, one] = [L::splat(0.0), L::splat(1.0)];
        let reflects = shape.at_most(Bounces::Inside);
        let far = (ends.along * ends.along + ends.beside * ends.beside).sqrt();
        let most = shape.greatest.min(ends.distance) * L::splat(BELOW);
        // Reflected rays pass the centre on the lamp's side.
        let mut h = most * L::select(reflects, L::splat(start.abs()), L::splat(start));
        let mut way = Way::at(shape, ends, h);
        for _ in 0..STEPS {
            h = (h - way.miss(ends) / way.spread).min(most).max(-most);
            way = Way::at(shape, ends, h);
        }
        let scale = L::splat(NEAR) * (one + far);
        let [cos, sin] = way.last;
        let ahead = cos * ends.along + sin * ends.beside;
        let meets = way.miss(ends).abs().le(scale) & one.lt(ahead * ahead + h * h) & zero.lt(ahead);
        let outside = one.lt(ends.distance) & one.lt(far) & zero.lt(ends.beside);
        let side = L::select(reflects, h, one);
        (way, meets & outside & zero.lt(side) & zero.lt(h.abs()))
    }

    #[inline(always)]
    pub(super) fn select(mask: L::Mask, yes: &Way<L>, no: &Way<L>) -> Way<L> {
        Way {
            h: L::select(mask, yes.h, no.h),
            last: [
                L::select(mask, yes.last[0], no.last[0]),
                L::select(mask, yes.last[1], no.last[1]),
            ],
            spread: L::select(mask, yes.spread, no.spread),
        }
    }

    #[inline(always)]
    fn at(shape: &Shape<L>, ends: &Ends<L>, h: L) -> Way<L> {
        let (last, rate) = leave(shape, ends.distance, h);
        let ahead = last[0] * ends.along + last[1] * ends.beside;
        Way {
            h,
            last,
            spread: -(ahead * rate) - L::splat(1.0),
        }
    }

    /// How far beside the lamp's point the last line passes.
    #[inline(always)]
    fn miss(&self, ends: &Ends<L>) -> L {
        let [cos, sin] = self.last;
        cos * ends.beside - sin * ends.along - self.h
    }

    /// Cosine and sine of the first line's angle with the axis.
    #[inline(always)]
    pub(super) fn first(&self, ends: &Ends<L>) -> [L; 2] {
        let [cos, _] = cosine(self.h, ends.distance);
        [cos, self.h / ends.distance]
    }

    /// Where the last line leaves the sphere, along `u` and `e`.
    #[inline(always)]
    pub(super) fn exit(&self) -> [L; 2] {
        let one = L::splat(1.0);
        let [cos, sin] = self.last;
        let on = (one - self.h * self.h).max(L::splat(0.0)).sqrt();
        [on * cos - self.h * sin, on * sin + self.h * cos]
    }

    /// Of the lines inside the sphere, the first and the last: where they touch the sphere and where they come nearest to
    /// its centre, along `u` and `e`.
    #[inline(always)]
    pub(super) fn inside(&self, shape: &Shape<L>, ends: &Ends<L>) -> [[[L; 2]; 2]; 2] {
        let circles = shape.circles();
        let [out, into] = [
            [cosine(self.h, circles[0])[0], self.h / circles[0]],
            [cosine(self.h, circles[1])[0], self.h / circles[1]],
        ];
        let conjugate = |z: [L; 2]| [z[0], -z[1]];
        let bend = times(conjugate(out), into);
        let nearest = |line: [L; 2]| [-(line[1] * into[1]), line[0] * into[1]];
        let first = self.first(ends);
        let on = out[0];
        let entry = [
            -(on * first[0]) - self.h * first[1],
            self.h * first[0] - on * first[1],
        ];
        [
            [entry, nearest(times(first, bend))],
            [self.exit(), nearest(times(self.last, conjugate(bend)))],
        ]
    }

    /// Solid angle at the first end over area at the lamp's, orthogonal to the last line, in radii: the directions
    /// h / d · dα dφ, with dα = dh / (d cos α), fall on `beside` dφ · |spread| dh.
    #[inline(always)]
    pub(super) fn density(&self, ends: &Ends<L>) -> L {
        let [cos, sin] = self.first(ends);
        sin.abs() / (ends.distance * cos * ends.beside * self.spread.abs())
    }

    /// Cosines at the outside and the inside of the sphere, and of the one in its middle.
    #[inline(always)]
    pub(super) fn cosines(&self, shape: &Shape<L>) -> [L; 4] {
        let mut cosines = shape.circles();
        for c in &mut cosines {
            *c = cosine(self.h, *c)[0];
        }
        cosines
    }
}
