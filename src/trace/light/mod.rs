//! Lights: choosing a point on one, and the density with which a given point would have been chosen.
//!
//! A light is chosen by its share of the table's weights; then a point of a triangle uniformly by area, of a sphere
//! uniformly in the solid angle that it fills; a direction of the sky by its own table. A light without extent has one
//! direction, which nothing else finds.

mod environment;
mod sphere;

use super::attributes::light_radiance;
use super::chunk::WIDEST;
use super::cut;
use super::punctual::sample_punctual;
use super::vector::{V3, unit};
use crate::flat::{FlatScene, LightTriangles, Lights, Spheres};
use crate::math::Vec3;
use crate::math::lanes::BitLanes;
use environment::sample_environment;
pub(super) use environment::{Seen, see};
pub(super) use sphere::sample_lamp;
use sphere::{Chosen, sample_spheres, sphere_pdf};

/// Shadow rays stop short of the light by this factor, four units in the last place: the light's own hit, whose t is
/// rounded to half a unit, stays behind the end.
pub(super) const SHORT: f32 = 1.0 - 1.0 / 4_194_304.0;

/// γ(7) = 7ε / (1 − 7ε), ε = 2⁻²⁴: error factor of a point interpolated in a triangle (Pharr et al., §6.8).
const GAMMA_7: f32 = 7.0 / 16_777_216.0 * (1.0 + 7.0 / 16_777_216.0 * 2.0);

/// A direction towards a light, in each lane.
pub(super) struct LightSample<L> {
    /// Unit.
    pub(super) dir: V3<L>,
    /// Where the shadow ray ends.
    pub(super) t_max: L,
    /// What the light sends along it.
    pub(super) radiance: V3<L>,
    /// Density over solid angle, the choice of the light included. Where the light has no extent, the probability of its
    /// choice: `radiance` is irradiance then, of what faces it.
    pub(super) pdf: L,
    /// Bit i: the light of lane i has no extent.
    pub(super) punctual: u32,
    /// Bit i: the chosen light sends something there. What lane i holds is meaningless elsewhere.
    pub(super) valid: u32,
}

/// Samples the light table from a point of each lane. `choice` is needed where there are several lights.
#[inline(always)]
pub(super) fn sample_lights<L: BitLanes>(
    scene: &FlatScene,
    from: V3<L>,
    choice: impl FnOnce() -> L,
    u: [L; 2],
) -> LightSample<L> {
    let lights = &scene.lights;
    if let ([sphere], 1) = (lights.spheres.as_slice(), lights.len()) {
        return sample_spheres(from, &Chosen::one(scene, *sphere), u);
    }
    let mut chosen = [0; WIDEST];
    if lights.len() > 1 {
        let mut numbers = [0.0; WIDEST];
        choice().store(&mut numbers);
        for lane in 0..L::N {
            chosen[lane] = choose(lights, numbers[lane]);
        }
    }
    if lights.spheres.len() == lights.len() {
        for lane in &mut chosen {
            *lane = lights.spheres[*lane as usize];
        }
        return sample_spheres(from, &Chosen::each(scene, &chosen), u);
    }
    let mut numbers = [[0.0; WIDEST]; 5];
    for (lanes, array) in from.0.into_iter().chain(u).zip(&mut numbers) {
        lanes.store(array);
    }
    let mut samples = [[0.0; WIDEST]; 8];
    let (valid, punctual) = one_by_one(scene, &chosen[..L::N], &numbers, &mut samples);
    let [x, y, z, r, g, b, t_max, pdf] = &samples;
    let load = |array: &[f32; WIDEST]| L::load(array);
    LightSample {
        dir: V3([load(x), load(y), load(z)]),
        t_max: load(t_max),
        radiance: V3([load(r), load(g), load(b)]),
        pdf: load(pdf),
        punctual,
        valid,
    }
}

/// Which light a number in (0, 1) chooses.
#[inline(always)]
fn choose(lights: &Lights, number: f32) -> u32 {
    let target = f64::from(number) * lights.total();
    let chosen = lights.cumulative.partition_point(|&sum| sum <= target);
    chosen.min(lights.len() - 1) as u32
}

/// Lights of several kinds, lane by lane: from position and numbers to direction, radiance, end and density. Returns which
/// lanes are valid, and which are punctual.
#[inline(never)]
fn one_by_one(
    scene: &FlatScene,
    chosen: &[u32],
    numbers: &[[f32; WIDEST]; 5],
    samples: &mut [[f32; WIDEST]; 8],
) -> (u32, u32) {
    let [mut valid, mut punctual] = [0; 2];
    for (lane, &chosen) in chosen.iter().enumerate() {
        let [x, y, z, u0, u1] = numbers.map(|array| array[lane]);
        let from = Vec3::new(x, y, z);
        let Some(sample) = sample_light(scene, from, chosen as usize, [u0, u1]) else {
            continue;
        };
        let (V3([x, y, z]), V3([r, g, b])) = (sample.dir, sample.radiance);
        let all = [x, y, z, r, g, b, sample.t_max, sample.pdf];
        for (array, x) in samples.iter_mut().zip(all) {
            array[lane] = x;
        }
        valid |= 1 << lane;
        punctual |= sample.punctual << lane;
    }
    (valid, punctual)
}

/// Samples a light of the table; `None` where it sends nothing there.
fn sample_light(
    scene: &FlatScene,
    from: Vec3,
    chosen: usize,
    u: [f32; 2],
) -> Option<LightSample<f32>> {
    let lights = &scene.lights;
    let total = lights.total();
    if let Some(&sphere) = lights.spheres.get(chosen) {
        let sample = sample_spheres(V3::from(from), &Chosen::one(scene, sphere), u);
        return (sample.valid != 0).then_some(sample);
    }
    let (i, triangles) = (chosen - lights.spheres.len(), &lights.triangles);
    if i >= triangles.area.len() {
        return match &scene.environment {
            Some(sky) if cut::ENVIRONMENT && lights.environment && chosen + 1 == lights.len() => {
                sample_environment(sky, lights.share(chosen), u)
            }
            _ if cut::PUNCTUAL => sample_punctual(lights, from, chosen),
            _ => None,
        };
    }
    let mut sample = sample_triangle(triangles, from, i, u, total)?;
    if let Some(place) = triangles.place.get(i) {
        sample.radiance = V3::from(light_radiance(scene, place, triangle_weights(u)));
    }
    (Vec3::from(sample.radiance) != Vec3::ZERO).then_some(sample)
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
        let sphere = prim & !Spheres::TAG;
        return sphere_pdf(scene, V3::from(from), sphere, radiance);
    }
    triangle_pdf(t, -dir.dot(ng), radiance, total)
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
) -> Option<LightSample<f32>> {
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
        dir: V3::from(dir),
        t_max: distance * SHORT,
        radiance: V3::from(radiance),
        pdf,
        punctual: 0,
        valid: 1,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec3;
    use crate::trace::Sampler::Independent;
    use crate::trace::sampler::{Pair, sample_pair};

    fn numbers(n: u32) -> impl Iterator<Item = [f32; 2]> {
        (0..n).map(|i| sample_pair(Independent, 5, i, Pair::Pixel))
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
