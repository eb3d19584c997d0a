//! Lamps through and by specular spheres: what next-event estimation cannot see, since a straight shadow ray ends at the
//! glass. From a diffuse vertex a chain of the scene is chosen, a point on a lamp, and the way between them is computed
//! ([`plane`]). Paths that find the same way by themselves share it by the power heuristic, with densities over the lamp's
//! area; ways that the search does not find are theirs alone. So nothing is counted twice, and nothing is left out.
//!
//! Deliberately absent: lamps that are triangles, and mirrors and glass that are no spheres.

mod plane;
mod record;
mod sample;
#[cfg(test)]
mod tests;

pub(super) use record::{Record, shared, wanted};
pub(super) use sample::{Reached, sample, trace};

use super::chunk::WIDEST;
use super::fresnel::{dielectrics, metal};
use super::vector::V3;
use crate::flat::{Bounces, FlatScene, Fresnel};
use crate::math::lanes::BitLanes;
use plane::{Ends, STARTS, Shape, Way};

/// Of the paths at which a chain might be sampled, so many are: what chains bring is even, hence few do.
const RATE: f32 = 0.125;

/// Ways that pass the centre no farther from each other, in radii, are one.
const SAME: f32 = 1.0 / 512.0;

/// A chain between a vertex and a lamp's point, in each lane.
struct Link<L: BitLanes> {
    shape: Shape<L>,
    tint: V3<L>,
    /// Of the sphere, scene units.
    center: [L::Wide; 3],
    radius: L,
    /// Axes of the plane.
    u: V3<L>,
    e: V3<L>,
    ends: Ends<L>,
    /// What each search finds, and where it finds any.
    ways: [(Way<L>, L::Mask); STARTS.len()],
}

/// One of the ways of a link.
struct Taken<L: BitLanes> {
    way: Way<L>,
    found: L::Mask,
    /// Probability that a search from a start that is chosen blindly finds it.
    share: L,
}

impl<L: BitLanes> Link<L> {
    /// From a point to one on a lamp.
    #[inline(always)]
    fn new(scene: &FlatScene, chains: &[u32; WIDEST], from: V3<L>, lamp: LampPoint<L>) -> Link<L> {
        let mut spheres = [0; WIDEST];
        for lane in 0..L::N {
            spheres[lane] = scene.chains.sphere(chains[lane] as usize);
        }
        let [x, y, z, radius] = L::rows(&scene.spheres.placed, &spheres);
        let center = [x, y, z];
        let [ior, ratio, inner, greatest] = L::rows(&scene.chains.shape, chains);
        let [r, g, b, bounces] = L::rows(&scene.chains.tint, chains);
        let shape = Shape {
            ior: L::narrow(ior),
            ratio: L::narrow(ratio),
            inner: L::narrow(inner),
            greatest: L::narrow(greatest),
            bounces: L::narrow(bounces),
        };
        let radius = L::narrow(radius);
        let per_radius = L::splat(1.0) / radius;
        let out = relative(from, center) * per_radius;
        let lamp = match lamp {
            LampPoint::Seen(from_center) => from_center,
            LampPoint::At(position) => relative(position, center),
        } * per_radius;
        let distance = out.dot(out).sqrt();
        let u = -(out / distance);
        let along = lamp.dot(u);
        let aside = lamp - u * along;
        let beside = aside.dot(aside).sqrt();
        let ends = Ends {
            distance,
            along,
            beside,
        };
        Link {
            shape,
            tint: V3::narrow([r, g, b]),
            center,
            radius,
            u,
            e: aside / beside,
            ends,
            ways: [
                Way::find(&shape, &ends, STARTS[0]),
                Way::find(&shape, &ends, STARTS[1]),
                Way::find(&shape, &ends, STARTS[2]),
            ],
        }
    }

    /// The way that each lane chooses.
    #[inline(always)]
    fn take(&self, chosen: [L::Mask; STARTS.len()]) -> Taken<L> {
        let (mut way, mut found) = self.ways[0];
        found = found & chosen[0];
        for ((other, also), &chosen) in self.ways.iter().zip(&chosen).skip(1) {
            way = Way::select(chosen, other, &way);
            found = found | (*also & chosen);
        }
        let mut share = L::splat(0.0);
        for (other, also) in &self.ways {
            let same = *also & (other.h - way.h).abs().lt(L::splat(SAME));
            let one = L::splat(1.0 / STARTS.len() as f32);
            share = share + L::select(same, one, L::splat(0.0));
        }
        Taken { way, found, share }
    }

    #[inline(always)]
    fn in_plane(&self, [along, beside]: [L; 2]) -> V3<L> {
        self.u * along + self.e * beside
    }

    /// The ends of the lines inside the sphere, in the scene.
    #[inline(always)]
    fn inside(&self, way: &Way<L>) -> [[V3<L>; 2]; 2] {
        let center = V3::narrow(self.center);
        let place = |point| center + self.in_plane(point) * self.radius;
        let [[a, b], [c, d]] = way.inside(&self.shape, &self.ends);
        [[place(a), place(b)], [place(c), place(d)]]
    }

    /// The first line's direction.
    #[inline(always)]
    fn first(&self, way: &Way<L>) -> V3<L> {
        self.in_plane(way.first(&self.ends))
    }

    /// Solid angle at the vertex over area of the lamp.
    #[inline(always)]
    fn density(&self, way: &Way<L>, lamp_normal: V3<L>) -> L {
        let cos = (-self.in_plane(way.last).dot(lamp_normal)).max(L::splat(0.0));
        cos * way.density(&self.ends) / (self.radius * self.radius)
    }

    /// Probability that a path that takes the first line takes all of the chain, and what the chain multiplies light by.
    #[inline(always)]
    fn carried(&self, way: &Way<L>, mode: Fresnel) -> (L, V3<L>) {
        let one = L::splat(1.0);
        let shape = &self.shape;
        let [outside, inside, over, under] = way.cosines(shape);
        let passes = |cos, ior| one - dielectrics(mode, cos, ior).0;
        let outer = passes(outside, shape.ior) * passes(inside, one / shape.ior);
        let inner = passes(over, shape.inner) * passes(under, one / shape.inner);
        let both = shape.is(Bounces::ThroughBoth);
        let through = L::select(both, outer * inner, outer);
        let reflected = outer * (one - passes(over, shape.inner));
        let through = L::select(shape.is(Bounces::Inside), reflected, through);
        let specular = shape.is(Bounces::Mirror) | shape.is(Bounces::Metal);
        let glass = L::select(
            shape.is(Bounces::Glass),
            one - passes(outside, shape.ior),
            through,
        );
        let chance = L::select(specular, one, glass);
        let metal = metal(self.tint, outside);
        let tint = V3::select(shape.is(Bounces::Metal), metal, self.tint);
        (chance, tint * chance)
    }
}

/// A point of a lamp.
enum LampPoint<L> {
    /// Relative to the sphere's centre.
    Seen(V3<L>),
    /// In the scene.
    At(V3<L>),
}

/// A point relative to a centre.
#[inline(always)]
fn relative<L: BitLanes>(point: V3<L>, center: [L::Wide; 3]) -> V3<L> {
    let p = point.widen();
    V3::narrow([p[0] - center[0], p[1] - center[1], p[2] - center[2]])
}
