//! Choices of traversal: rays through a tree.

use super::{PIECE, Row, in_turns, per_million};
use crate::build::bvh::{Accel, SphereItem, build};
use crate::flat::FlatScene;
use crate::math::{DVec3, Vec3};
use crate::measure::arms::{Arm, Rule, twins};
use crate::measure::bench::{Generator, Random, RayKind, RaySets, Subject, meshes};
use crate::trace::{Hits, Isa, Rays, closest_hit};
use std::sync::Arc;
use std::time::Instant;

/// Relative error of t that is one unit in the last place.
const ULP: f64 = 1.2e-7;

/// Radius of the walls of a room of spheres.
const WALL: f64 = 1e5;

/// Distance of those walls from the middle.
const ROOM: f64 = 20.0;

fn scene(subject: &Subject, accel: Accel) -> Arc<FlatScene> {
    Arc::new(subject.scene(build(&subject.primitives(), accel)))
}

/// Nanoseconds a ray of both twins, on rays in tile order.
fn time(
    twins: &[Box<dyn Arm>; 2],
    subject: &Subject,
    scene: &FlatScene,
    count: usize,
    until: Instant,
) -> [f64; 2] {
    let sets = RaySets::new(subject, scene, count);
    let rays = sets.of(RayKind::Diffuse);
    let starts = (0..rays.len()).step_by(PIECE);
    let batches: Vec<Rays> = starts
        .map(|at| rays.part(at..rays.len().min(at + PIECE)))
        .collect();
    let mut hits = Hits::default();
    let total = in_turns(batches.len(), until, |side, piece| {
        twins[side].closest_hit(Isa::best(), &batches[piece], &mut hits);
    });
    total.map(|ns| ns / rays.len().max(1) as f64)
}

/// Wrong answers of both twins, among a million.
fn judge(twins: &[Box<dyn Arm>; 2], rays: &Rays, wrong: impl Fn(usize, &Hits) -> bool) -> [f64; 2] {
    [0, 1].map(|side| {
        let mut hits = Hits::default();
        twins[side].closest_hit(Isa::best(), rays, &mut hits);
        let count = (0..rays.len()).filter(|&i| wrong(i, &hits)).count();
        per_million(count, rays.len())
    })
}

/// Rays from the middle of the object to its vertices and, as many, to points of its edges.
fn aimed(subject: &Subject, object: usize, count: usize) -> Rays {
    let mut random = Random::new(41);
    let middle = 0.5 * (subject.object.min + subject.object.max);
    // Not where symmetry makes everything exact.
    let origin = middle + Vec3::new(0.013, -0.007, 0.011);
    let mut rays = Rays::default();
    for i in 0..count {
        let triangle = subject.triangles[random.below(object)];
        let [a, b] = [triangle[0], triangle[1]];
        let at = if i.is_multiple_of(2) {
            a
        } else {
            a + random.unit() as f32 * (b - a)
        };
        let dir = (at - origin).as_dvec3().normalize().as_vec3();
        rays.push(origin.to_array(), dir.to_array(), f32::MAX);
    }
    rays
}

/// The watertight triangle.
pub(super) fn triangles(count: usize, until: Instant) -> Row {
    let ball = Generator::Ball70k.make();
    let scene = scene(&ball, Accel::Bvh);
    let twins = twins(Rule::Triangle, &scene);
    // The last twelve are the room's.
    let object = ball.triangles.len() - 12;
    let rays = aimed(&ball, object, count);
    Row {
        choice: "triangle test",
        exact: "watertight",
        cheap: "Möller–Trumbore",
        unit: "ray",
        ns: time(&twins, &ball, &scene, count, until),
        wrong: judge(&twins, &rays, |i, hits| hits.prim[i] as usize >= object),
        judged: rays.len(),
        counted: "rays at edges and vertices that leave a closed mesh",
    }
}

/// Widened boxes.
pub(super) fn boxes(count: usize, until: Instant) -> Row {
    let ball = Generator::Ball70k.make();
    let large = scene(&ball, Accel::Bvh);
    let timed = twins(Rule::Slab, &large);
    let small = Generator::Ball3k.make();
    let judged = twins(Rule::Slab, &scene(&small, Accel::Bvh));
    let rays = aimed(&small, small.triangles.len() - 12, count);
    let mut all = Hits::default();
    closest_hit(&scene(&small, Accel::Brute), Isa::best(), &rays, &mut all);
    let differs = |i: usize, hits: &Hits| {
        (hits.prim[i], hits.t[i].to_bits()) != (all.prim[i], all.t[i].to_bits())
    };
    Row {
        choice: "box test",
        exact: "widened",
        cheap: "as it comes",
        unit: "ray",
        ns: time(&timed, &ball, &large, count, until),
        wrong: judge(&judged, &rays, differs),
        judged: rays.len(),
        counted: "rays at edges and vertices whose hit is not that of testing all triangles",
    }
}

/// Roots in f64.
pub(super) fn spheres(count: usize, until: Instant) -> Row {
    let mut balls = meshes::spheres(1000);
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut center = [0.0; 3];
            center[axis] = side * (WALL + ROOM);
            let prim = balls.spheres.len() as u32;
            balls.spheres.push(SphereItem {
                center,
                radius: WALL,
                prim,
            });
        }
    }
    let scene = scene(&balls, Accel::Bvh);
    let twins = twins(Rule::Sphere, &scene);
    let rays = RaySets::new(&balls, &scene, count);
    let rays = rays.of(RayKind::Random);
    let right: Vec<f64> = (0..rays.len())
        .map(|i| nearest(&balls.spheres, rays, i))
        .collect();
    let off = |i: usize, hits: &Hits| {
        let t = f64::from(hits.t[i]);
        // Two infinities are no difference.
        t != right[i] && (t - right[i]).abs() > ULP * right[i]
    };
    Row {
        choice: "sphere roots",
        exact: "f64",
        cheap: "f32",
        unit: "ray",
        ns: time(&twins, &balls, &scene, count, until),
        wrong: judge(&twins, rays, off),
        judged: rays.len(),
        counted: "random rays among balls and walls of R = 1e5 whose t is more than an ulp off",
    }
}

/// The smallest positive root of all spheres, in f64 by the school's formula; infinity without one.
fn nearest(spheres: &[SphereItem], rays: &Rays, i: usize) -> f64 {
    let of = |v: &[Vec<f32>; 3]| DVec3::new(v[0][i].into(), v[1][i].into(), v[2][i].into());
    let [origin, dir] = [of(&rays.origin), of(&rays.dir)];
    let a = dir.length_squared();
    let mut nearest = f64::INFINITY;
    for sphere in spheres {
        let oc = origin - DVec3::from(sphere.center);
        let b = oc.dot(dir);
        let root = (b * b - a * (oc.length_squared() - sphere.radius * sphere.radius)).sqrt();
        for t in [(-b - root) / a, (-b + root) / a] {
            // Not a number is not above.
            if t > 0.0 && t < nearest {
                nearest = t;
            }
        }
    }
    nearest
}
