//! Sphere lights: a direction in the cone that a sphere fills, and its density.
#![allow(
    clippy::needless_range_loop,
    reason = "lanes are numbers here: several arrays are indexed by one"
)]

use super::{LightSample, SHORT, choose, mean};
use crate::flat::FlatScene;
use crate::math::Vec3;
use crate::math::lanes::{BitLanes, WideLanes};
use crate::trace::chunk::WIDEST;
use crate::trace::vector::{V3, basis, concentric_disk};
use std::f64::consts::{PI, TAU};

/// The probability of a sphere's choice: area times mean radiance, as in the table, over its total.
#[inline(always)]
fn share(scene: &FlatScene, radius: f64, radiance: [f32; 3]) -> f32 {
    let weight = 4.0 * PI * radius * radius * mean(Vec3::from(radiance));
    (weight / scene.lights.total()) as f32
}

/// The directions from a point in which a sphere shows its emitting side, in each lane.
struct Cone<L: BitLanes> {
    /// From the point to the centre.
    to_center: [L::Wide; 3],
    radius: L::Wide,
    /// 1 − cos of the half angle; 2, the whole sphere of directions, inside an inverted sphere.
    one_minus_cos: L,
    /// −1 where the sphere is inverted, else 1.
    side: L::Wide,
    /// Bit i: lane i is on the side that emits. The other lanes are meaningless.
    valid: u32,
}

/// Sphere lights in lanes.
pub(super) struct Chosen<L: BitLanes> {
    center: [L::Wide; 3],
    radius: L::Wide,
    /// 2 where the sphere is inverted, else 0.
    inverted: L::Wide,
    /// Bit i: the sphere of lane i is inverted.
    inverted_bits: u32,
    radiance: V3<L>,
    /// As in the table, over the table's total: the probability of its choice.
    share: L,
}

impl<L: BitLanes> Chosen<L> {
    /// One sphere in all lanes.
    #[inline(always)]
    pub(super) fn one(scene: &FlatScene, sphere: u32) -> Chosen<L> {
        let (s, i, wide) = (&scene.spheres, sphere as usize, L::Wide::splat);
        let [x, y, z, radius] = s.placed[i];
        let radiance = scene.materials[s.material[i].0 as usize].emission;
        Chosen {
            center: [wide(x), wide(y), wide(z)],
            radius: wide(radius),
            inverted: wide(if s.inverted[i] { 2.0 } else { 0.0 }),
            inverted_bits: if s.inverted[i] { u32::MAX } else { 0 },
            radiance: V3::splat(radiance),
            share: L::splat(share(scene, s.radius(i), radiance)),
        }
    }

    /// A sphere in each lane.
    #[inline(always)]
    pub(super) fn each(scene: &FlatScene, spheres: &[u32; WIDEST]) -> Chosen<L> {
        let s = &scene.spheres;
        let (mut radiances, mut shares) = ([[0.0; WIDEST]; 3], [0.0; WIDEST]);
        let mut inverted_bits = 0;
        for lane in 0..L::N {
            let i = spheres[lane] as usize;
            inverted_bits |= u32::from(s.inverted[i]) << lane;
            let radiance = scene.materials[s.material[i].0 as usize].emission;
            shares[lane] = share(scene, s.radius(i), radiance);
            for (array, x) in radiances.iter_mut().zip(radiance) {
                array[lane] = x;
            }
        }
        let [x, y, z, radius] = L::rows(&s.placed, spheres);
        let inverted = L::select(L::mask(inverted_bits), L::splat(2.0), L::splat(0.0));
        Chosen {
            center: [x, y, z],
            radius,
            inverted: inverted.widen(),
            inverted_bits,
            radiance: V3::load(&radiances),
            share: L::load(&shares),
        }
    }
}

impl<L: BitLanes> Cone<L> {
    /// 1 − cos θ = s² / (1 + √(1 − s²)) with s = r / d has no cancellation at any distance, if 1 − s² is (d² − r²) / d²
    /// in f64. What follows of it is a number of f32's precision.
    #[inline(always)]
    fn new(from: V3<L>, sphere: &Chosen<L>) -> Cone<L> {
        let [zero, one] = [L::Wide::splat(0.0), L::Wide::splat(1.0)];
        let (c, radius) = (sphere.center, sphere.radius);
        let from = from.widen();
        let to_center = [c[0] - from[0], c[1] - from[1], c[2] - from[2]];
        let (d2, r2) = (dot(to_center, to_center), radius * radius);
        let gap = d2 - r2;
        let outside = L::bits(L::wide_lt(zero, gap));
        let per_d2 = one / d2;
        let (sin2, cos2) = (L::narrow(r2 * per_d2), L::narrow(gap * per_d2));
        let cap = sin2 / (L::splat(1.0) + cos2.sqrt());
        let inverted = L::narrow(sphere.inverted);
        Cone {
            to_center,
            radius,
            one_minus_cos: L::select(L::splat(0.0).lt(inverted), inverted, cap),
            side: one - sphere.inverted,
            valid: (outside ^ sphere.inverted_bits) & ((1 << L::N) - 1),
        }
    }

    #[inline(always)]
    fn pdf(&self) -> L {
        L::splat(1.0) / (L::splat(TAU as f32) * self.one_minus_cos)
    }

    /// A unit direction, uniform in the cone: a point of the disk at the distance √q of its middle is as high as q says.
    /// The disk's map is continuous, which keeps evenly spread numbers evenly spread.
    #[inline(always)]
    fn sample(&self, u: [L; 2]) -> V3<L> {
        let axis = V3::<L>::narrow(self.to_center).unit();
        let axis = V3::select(axis.finite(), axis, V3::splat([0.0, 0.0, 1.0]));
        let [x, y] = concentric_disk(u);
        let (one, two) = (L::splat(1.0), L::splat(2.0));
        let height = self.one_minus_cos * (x * x + y * y);
        // sin θ / √q, where rounding may put a point of the rim beyond it.
        let sin = (self.one_minus_cos * (two - height).max(L::splat(0.0))).sqrt();
        let (s, t) = basis(axis);
        (s * (sin * x) + t * (sin * y) + axis * (one - height)).unit()
    }

    /// Distance to the emitting side along the rounded direction, as the kernel will find it; a direction that rounding
    /// puts beside the rim ends where it comes nearest.
    #[inline(always)]
    fn distance(&self, dir: V3<L>) -> L {
        let d = dir.widen();
        // Of a unit vector: 1 / (1 + δ) is 1 − δ but for δ², which is below 10⁻¹³.
        let per_a = L::Wide::splat(2.0) - dot(d, d);
        let to = self.to_center;
        let b = dot(to, d) * per_a;
        let beside = [to[0] - d[0] * b, to[1] - d[1] * b, to[2] - d[2] * b];
        let inside = self.radius * self.radius - dot(beside, beside);
        let half = (inside.max(L::Wide::splat(0.0)) * per_a).sqrt();
        L::narrow(b - half * self.side)
    }
}

/// Samples sphere lights of the scene, one in each lane.
#[inline(always)]
pub(super) fn sample_spheres<L: BitLanes>(
    from: V3<L>,
    spheres: &Chosen<L>,
    u: [L; 2],
) -> LightSample<L> {
    let cone = Cone::new(from, spheres);
    let dir = cone.sample(u);
    LightSample {
        dir,
        t_max: cone.distance(dir) * L::splat(SHORT),
        radiance: spheres.radiance,
        pdf: cone.pdf() * spheres.share,
        punctual: 0,
        valid: cone.valid,
    }
}

/// A point of a sphere light, in each lane.
pub(in crate::trace) struct Lamp<L: BitLanes> {
    /// Index of the sphere.
    pub(in crate::trace) sphere: [u32; WIDEST],
    /// To the point, unit, and how far it is.
    pub(in crate::trace) dir: V3<L>,
    pub(in crate::trace) distance: L,
    /// There, outward; and its cosine with the way back.
    pub(in crate::trace) normal: V3<L>,
    pub(in crate::trace) cos: L,
    pub(in crate::trace) radiance: V3<L>,
    /// Over solid angle, the choice of the light included.
    pub(in crate::trace) pdf: L,
    /// Bit i: lane i has a point. The other lanes are meaningless.
    pub(in crate::trace) valid: u32,
}

/// Samples a point on a sphere light that shines outward; where the table chooses another light, there is none.
#[inline(always)]
pub(in crate::trace) fn sample_lamp<L: BitLanes>(
    scene: &FlatScene,
    from: V3<L>,
    choice: L,
    u: [L; 2],
) -> Lamp<L> {
    let lights = &scene.lights;
    let mut numbers = [0.0; WIDEST];
    choice.store(&mut numbers);
    let (mut sphere, mut valid) = ([lights.spheres[0]; WIDEST], 0);
    for lane in 0..L::N {
        if let Some(&chosen) = lights.spheres.get(choose(lights, numbers[lane]) as usize) {
            sphere[lane] = chosen;
            valid |= 1 << lane;
        }
    }
    let chosen = Chosen::each(scene, &sphere);
    let cone = Cone::new(from, &chosen);
    let dir = cone.sample(u);
    let distance = cone.distance(dir);
    let back = V3::narrow(cone.to_center) - dir * distance;
    let normal = -(back * (L::splat(1.0) / L::narrow(cone.radius)));
    Lamp {
        sphere,
        dir,
        distance,
        normal,
        cos: -normal.dot(dir),
        radiance: chosen.radiance,
        pdf: cone.pdf() * chosen.share,
        valid: valid & cone.valid & !chosen.inverted_bits,
    }
}

/// Density of sampling a sphere from a point; 0 on the side that does not emit.
pub(super) fn sphere_pdf(scene: &FlatScene, from: V3<f32>, sphere: u32, radiance: Vec3) -> f32 {
    let cone = Cone::new(from, &Chosen::<f32>::one(scene, sphere));
    if cone.valid == 0 {
        return 0.0;
    }
    cone.pdf() * share(scene, cone.radius, radiance.to_array())
}

#[inline(always)]
fn dot<W: WideLanes>(a: [W; 3], b: [W; 3]) -> W {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec3;
    use crate::trace::Sampler::Independent;
    use crate::trace::sampler::{Pair, sample_pair};
    use crate::trace::test_support::chi_squared;

    fn numbers(n: u32) -> impl Iterator<Item = [f32; 2]> {
        (0..n).map(|i| sample_pair(Independent, 5, i, Pair::Pixel))
    }

    /// The cone of a sphere of radius 1 about the origin.
    fn cone(from: Vec3, inverted: bool) -> Option<Cone<f32>> {
        let sphere = Chosen {
            center: [0.0; 3],
            radius: 1.0,
            inverted: if inverted { 2.0 } else { 0.0 },
            inverted_bits: u32::from(inverted),
            radiance: V3([1.0; 3]),
            share: 1.0,
        };
        let cone = Cone::new(V3::from(from), &sphere);
        (cone.valid == 1).then_some(cone)
    }

    /// The relative error of 1 − cos against f64 without cancellation, from nearly touching to very far: that of an f32 after
    /// four roundings.
    #[test]
    fn cone_is_exact_at_every_distance() {
        // Beyond 10¹⁸ radii, the cone itself is no number of f32.
        for k in 0..25 {
            let distance = 1.0 + f64::powi(10.0, k - 6);
            let from = Vec3::new(0.0, 0.0, distance as f32);
            let cone = cone(from, false).expect("outside");
            let s = 1.0 / f64::from(from.z);
            let want = 2.0 * (0.5 * s.asin()).sin().powi(2);
            assert!(
                (f64::from(cone.one_minus_cos) - want).abs() <= 2.4e-7 * want,
                "d = {distance}"
            );
        }
        assert!(cone(Vec3::ZERO, false).is_none());
        assert!(cone(Vec3::splat(2.0), true).is_none());
    }

    #[test]
    fn sphere_directions_are_uniform_in_the_cone() {
        let cases = [
            (Vec3::new(0.3, -2.0, 0.7), false),
            (Vec3::new(900.0, 5.0, -70.0), false),
            (Vec3::new(0.1, 0.2, 0.3), true),
        ];
        for (from, inverted) in cases {
            let cone = cone(from, inverted).expect("emits");
            let axis = V3::from(DVec3::from(cone.to_center).as_vec3()).unit();
            let (s, t) = basis(axis);
            let [axis, s, t] = [axis, s, t].map(Vec3::from);
            let z = chi_squared(
                20,
                32,
                200_000,
                numbers(200_000).map(|u| {
                    let dir = Vec3::from(cone.sample(u));
                    assert!((dir.length() - 1.0).abs() < 3e-7);
                    // 1 − cos as half the squared chord: exact for narrow cones.
                    let height = f64::from((dir - axis).length_squared())
                        / 2.0
                        / f64::from(cone.one_minus_cos);
                    let phi = f64::from(dir.dot(t)).atan2(f64::from(dir.dot(s))) / TAU;
                    [height, phi.rem_euclid(1.0)]
                }),
            );
            assert!(z.abs() < 4.0, "z = {z}");
        }
    }
}
