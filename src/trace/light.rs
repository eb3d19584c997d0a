//! Lights: choosing a point on one, and the density with which a given point would have been chosen.
//!
//! A light is chosen by its share of the table's weights; then a point of a triangle uniformly by area, of a sphere
//! uniformly in the solid angle that it fills. A light without extent has one direction, which nothing else finds.

use super::attributes::light_radiance;
use super::punctual::sample_punctual;
use super::vector::{basis, unit};
use crate::flat::{FlatScene, LightTriangles, Spheres};
use crate::math::{DVec3, Vec3, sin_cos_turns};
use std::f64::consts::{PI, TAU};

/// Shadow rays stop short of the light by this factor, four units in the last place: the light's own hit, whose t is
/// rounded to half a unit, stays behind the end.
pub(super) const SHORT: f32 = 1.0 - 1.0 / 4_194_304.0;

/// γ(7) = 7ε / (1 − 7ε), ε = 2⁻²⁴: error factor of a point interpolated in a triangle (Pharr et al., §6.8).
const GAMMA_7: f32 = 7.0 / 16_777_216.0 * (1.0 + 7.0 / 16_777_216.0 * 2.0);

/// A direction towards a light.
pub(super) struct LightSample {
    /// Unit.
    pub(super) dir: Vec3,
    /// Where the shadow ray ends.
    pub(super) t_max: f32,
    /// What the light sends along it.
    pub(super) radiance: Vec3,
    /// Density over solid angle, the choice of the light included. Where the light has no extent, the probability of its
    /// choice: `radiance` is irradiance then, of what faces it.
    pub(super) pdf: f32,
    /// The light has no extent.
    pub(super) punctual: bool,
}

/// Samples the light table from a point; `None` where the chosen light sends nothing there.
#[inline(always)]
pub(super) fn sample_light(
    scene: &FlatScene,
    from: Vec3,
    choice: f32,
    u: [f32; 2],
) -> Option<LightSample> {
    let lights = &scene.lights;
    let total = lights.total();
    let target = f64::from(choice) * total;
    let chosen = lights
        .cumulative
        .partition_point(|&sum| sum <= target)
        .min(lights.len().checked_sub(1)?);
    if let Some(&sphere) = lights.spheres.get(chosen) {
        return sample_sphere(scene, from, sphere as usize, u, total);
    }
    let (i, triangles) = (chosen - lights.spheres.len(), &lights.triangles);
    if i >= triangles.area.len() {
        return sample_punctual(lights, from, chosen);
    }
    let mut sample = sample_triangle(triangles, from, i, u, total)?;
    if let Some(place) = triangles.place.get(i) {
        sample.radiance = light_radiance(scene, place, triangle_weights(u));
    }
    (sample.radiance != Vec3::ZERO).then_some(sample)
}

/// A normal of a surface that shines from both sides, on the side that a direction points to.
pub(super) fn towards(ng: Vec3, dir: Vec3) -> Vec3 {
    if ng.dot(dir) < 0.0 { -ng } else { ng }
}

/// Density, over solid angle from a point, of sampling the emitter that a ray in direction `dir` hit at distance `t`
/// with geometric normal `ng`; 0 where it could not have been sampled. `radiance` is what the table weighs per area: of
/// both sides together where both shine.
pub(super) fn light_pdf(
    scene: &FlatScene,
    from: Vec3,
    (dir, t): (Vec3, f32),
    (prim, ng): (u32, Vec3),
    radiance: Vec3,
) -> f32 {
    let total = scene.lights.total();
    if prim & Spheres::TAG != 0 {
        let cone = Cone::of(scene, from, (prim & !Spheres::TAG) as usize);
        return cone.map_or(0.0, |cone| {
            (cone.pdf() * sphere_weight(cone.radius, radiance) / total) as f32
        });
    }
    triangle_pdf(t, -dir.dot(ng), radiance, total)
}

/// Area times mean radiance, as in the table.
fn sphere_weight(radius: f64, radiance: Vec3) -> f64 {
    4.0 * PI * radius * radius * mean(radiance)
}

fn mean(c: Vec3) -> f64 {
    (f64::from(c.x) + f64::from(c.y) + f64::from(c.z)) / 3.0
}

/// A triangle is chosen with density mean / total per area, whatever its size.
fn triangle_pdf(distance: f32, cos: f32, radiance: Vec3, total: f64) -> f32 {
    if cos > 0.0 {
        (mean(radiance) / total) as f32 * (distance * distance / cos)
    } else {
        0.0
    }
}

/// The directions from a point in which a sphere shows its emitting side.
struct Cone {
    /// From the point to the centre.
    to_center: DVec3,
    radius: f64,
    /// 1 − cos of the half angle; 2, the whole sphere of directions, inside an inverted sphere.
    one_minus_cos: f64,
}

impl Cone {
    /// `None` on the side that does not emit.
    ///
    /// 1 − cos θ = s² / (1 + √(1 − s²)), s = r / d, has no cancellation at any distance; d² − r² is (d − r)(d + r).
    fn new(from: Vec3, center: DVec3, radius: f64, inverted: bool) -> Option<Cone> {
        let to_center = center - from.as_dvec3();
        let d2 = to_center.length_squared();
        let d = d2.sqrt();
        let gap = (d - radius) * (d + radius);
        let one_minus_cos = match (gap > 0.0, inverted) {
            (true, false) => (radius * radius / d2) / (1.0 + (gap / d2).sqrt()),
            (false, true) => 2.0,
            _ => return None,
        };
        Some(Cone {
            to_center,
            radius,
            one_minus_cos,
        })
    }

    /// The cone of a sphere of the scene.
    fn of(scene: &FlatScene, from: Vec3, sphere: usize) -> Option<Cone> {
        let s = &scene.spheres;
        Cone::new(
            from,
            DVec3::from(s.center[sphere]),
            s.radius[sphere],
            s.inverted[sphere],
        )
    }

    fn pdf(&self) -> f64 {
        1.0 / (TAU * self.one_minus_cos)
    }

    /// A unit direction, uniform in the cone.
    fn sample(&self, u: [f32; 2]) -> Vec3 {
        let axis = unit(self.to_center.as_vec3());
        let axis = if axis.is_finite() { axis } else { Vec3::Z };
        let height = self.one_minus_cos * f64::from(u[0]);
        let (cos, sin) = (
            (1.0 - height) as f32,
            (height * (2.0 - height)).sqrt() as f32,
        );
        let (sin_phi, cos_phi) = sin_cos_turns(u[1]);
        let (s, t) = basis(axis);
        unit(s * (sin * cos_phi) + t * (sin * sin_phi) + axis * cos)
    }

    /// Distance to the emitting side along the rounded direction, as the kernel will find it; a direction that rounding
    /// puts beside the rim ends where it comes nearest.
    fn distance(&self, dir: Vec3) -> f32 {
        let d = dir.as_dvec3();
        let a = d.length_squared();
        let b = self.to_center.dot(d) / a;
        let beside = self.to_center - d * b;
        let half = ((self.radius * self.radius - beside.length_squared()).max(0.0) / a).sqrt();
        (if self.one_minus_cos < 2.0 {
            b - half
        } else {
            b + half
        }) as f32
    }
}

fn sample_sphere(
    scene: &FlatScene,
    from: Vec3,
    sphere: usize,
    u: [f32; 2],
    total: f64,
) -> Option<LightSample> {
    let cone = Cone::of(scene, from, sphere)?;
    let dir = cone.sample(u);
    let material = scene.spheres.material[sphere].0 as usize;
    let radiance = Vec3::from(scene.materials[material].emission);
    let pdf = (cone.pdf() * sphere_weight(cone.radius, radiance) / total) as f32;
    Some(LightSample {
        dir,
        t_max: cone.distance(dir) * SHORT,
        radiance,
        pdf,
        punctual: false,
    })
}

/// Weights of the second and third corner, uniform by area: the square folded along its diagonal by the square root
/// (Turk 1990).
fn triangle_weights(u: [f32; 2]) -> [f32; 2] {
    let root = u[0].sqrt();
    [root * (1.0 - u[1]), root * u[1]]
}

fn sample_triangle(
    lights: &LightTriangles,
    from: Vec3,
    i: usize,
    u: [f32; 2],
    total: f64,
) -> Option<LightSample> {
    let (v0, e1, e2) = (
        Vec3::from(lights.v0[i]),
        Vec3::from(lights.e1[i]),
        Vec3::from(lights.e2[i]),
    );
    let [b1, b2] = triangle_weights(u);
    let ng = unit(e1.cross(e2));
    let radiance = Vec3::from(lights.radiance[i]);
    let (ng, weight) = match lights.two_sided.get(i) {
        Some(true) => (towards(ng, from - v0), radiance * 2.0),
        _ => (ng, radiance),
    };
    let point = v0 + e1 * b1 + e2 * b2;
    let size = v0.abs() + (e1 * b1).abs() + (e2 * b2).abs();
    let point = point + ng * (GAMMA_7 * size.dot(ng.abs()));
    let to = point - from;
    let distance = to.length();
    let dir = to * (1.0 / distance);
    let pdf = triangle_pdf(distance, -dir.dot(ng), weight, total);
    (pdf > 0.0 && pdf.is_finite()).then_some(LightSample {
        dir,
        t_max: distance * SHORT,
        radiance,
        pdf,
        punctual: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Sampler::Independent;
    use crate::trace::sampler::{Pair, sample_pair};
    use crate::trace::test_support::chi_squared;

    fn numbers(n: u32) -> impl Iterator<Item = [f32; 2]> {
        (0..n).map(|i| sample_pair(Independent, 5, i, Pair::Pixel))
    }

    /// The relative error of 1 − cos against f64 without cancellation, from nearly touching to very far.
    #[test]
    fn cone_is_exact_at_every_distance() {
        for k in 0..30 {
            let distance = 1.0 + f64::powi(10.0, k - 6);
            let from = Vec3::new(0.0, 0.0, distance as f32);
            let cone = Cone::new(from, DVec3::ZERO, 1.0, false).expect("outside");
            let s = 1.0 / f64::from(from.z);
            let want = 2.0 * (0.5 * s.asin()).sin().powi(2);
            assert!(
                (cone.one_minus_cos - want).abs() <= 1e-9 * want,
                "d = {distance}"
            );
        }
        assert!(Cone::new(Vec3::ZERO, DVec3::ZERO, 1.0, false).is_none());
        assert!(Cone::new(Vec3::splat(2.0), DVec3::ZERO, 1.0, true).is_none());
    }

    #[test]
    fn sphere_directions_are_uniform_in_the_cone() {
        let cases = [
            (Vec3::new(0.3, -2.0, 0.7), false),
            (Vec3::new(900.0, 5.0, -70.0), false),
            (Vec3::new(0.1, 0.2, 0.3), true),
        ];
        for (from, inverted) in cases {
            let cone = Cone::new(from, DVec3::ZERO, 1.0, inverted).expect("emits");
            let axis = unit(cone.to_center.as_vec3());
            let (s, t) = basis(axis);
            let z = chi_squared(
                20,
                32,
                200_000,
                numbers(200_000).map(|u| {
                    let dir = cone.sample(u);
                    assert!((dir.length() - 1.0).abs() < 3e-7);
                    // 1 − cos as half the squared chord: exact for narrow cones.
                    let height =
                        f64::from((dir - axis).length_squared()) / 2.0 / cone.one_minus_cos;
                    let phi = f64::from(dir.dot(t)).atan2(f64::from(dir.dot(s))) / TAU;
                    [height, phi.rem_euclid(1.0)]
                }),
            );
            assert!(z.abs() < 4.0, "z = {z}");
        }
    }

    /// Mean of 1 / pdf over samples is the solid angle, against van Oosterom and Strackee's formula.
    #[test]
    fn triangle_density_integrates_to_its_solid_angle() {
        let (a, b, c) = (
            Vec3::new(-0.4, 0.3, 1.0),
            Vec3::new(0.9, 0.5, 1.3),
            Vec3::new(0.2, -0.8, 0.7),
        );
        let lights = LightTriangles {
            v0: vec![a.to_array()],
            e1: vec![(b - a).to_array()],
            e2: vec![(c - a).to_array()],
            area: vec![(c - a).cross(b - a).length() / 2.0],
            radiance: vec![[2.0; 3]],
            two_sided: Vec::new(),
            place: Vec::new(),
        };
        let total = f64::from(lights.area[0]) * 2.0;
        let [x, y, z] = [a, b, c].map(Vec3::as_dvec3);
        let [lx, ly, lz] = [x, y, z].map(DVec3::length);
        let omega = 2.0
            * (x.dot(y.cross(z)).abs())
                .atan2(lx * ly * lz + x.dot(y) * lz + x.dot(z) * ly + y.dot(z) * lx);
        let n = 200_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for u in numbers(n) {
            let sample =
                sample_triangle(&lights, Vec3::ZERO, 0, u, total).expect("faces the point");
            let weight = 1.0 / f64::from(sample.pdf);
            sum += weight;
            squares += weight * weight;
        }
        let mean = sum / f64::from(n);
        let error = ((squares / f64::from(n) - mean * mean) / f64::from(n)).sqrt();
        assert!(
            (mean - omega).abs() < 4.0 * error && error < 2e-3 * omega,
            "{mean} ± {error}, {omega}"
        );
    }
}
