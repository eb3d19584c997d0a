//! Ray sets of a subject: what a path tracer asks of its tree, from orderly to hopeless.
//!
//! | set | rays | asks for |
//! |---|---|---|
//! | primary | from a pinhole through jittered pixels, in Morton order | the closest hit |
//! | diffuse | a cosine-distributed bounce off each hit of those, in their order: "tile order" | the closest hit |
//! | shuffled | the same, shuffled: nothing in common with its neighbours | the closest hit |
//! | shadow | from each of those hits that faces the lamp to a point of it | occlusion |
//! | random | from anywhere in the object's box in any direction | the closest hit |
//!
//! Rays leave surfaces as those of the renderer do: by the hit's error bound.

use super::random::Random;
use super::subject::{Subject, View};
use crate::flat::{FlatScene, Spheres};
use crate::math::{DVec3, Vec3};
use crate::trace::spawn::{
    offset_origin, sphere_point, triangle_normal, triangle_point, triangle_vertices,
};
use crate::trace::{Hits, Isa, Rays, closest_hit};
use std::fmt;

/// Which rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RayKind {
    /// Of a camera.
    Primary,
    /// Bounces in tile order.
    Diffuse,
    /// Bounces without order.
    Shuffled,
    /// To a lamp.
    Shadow,
    /// From anywhere to anywhere.
    Random,
}

impl RayKind {
    /// All, from orderly to hopeless.
    pub const ALL: [RayKind; 5] = [
        RayKind::Primary,
        RayKind::Diffuse,
        RayKind::Shuffled,
        RayKind::Shadow,
        RayKind::Random,
    ];

    /// Whether it asks for occlusion rather than the closest hit.
    #[must_use]
    pub fn occlusion(self) -> bool {
        self == RayKind::Shadow
    }

    /// Its name in tables and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            RayKind::Primary => "primary",
            RayKind::Diffuse => "diffuse",
            RayKind::Shuffled => "shuffled",
            RayKind::Shadow => "shadow",
            RayKind::Random => "random",
        }
    }
}

impl fmt::Display for RayKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The five sets.
#[derive(Clone, Debug, Default)]
pub struct RaySets {
    sets: [Rays; RayKind::ALL.len()],
}

impl RaySets {
    /// `count` primary and random rays of a subject, whose `scene` is [`Subject::scene`]; the others are as many as there
    /// are hits to start from.
    #[must_use]
    pub fn new(subject: &Subject, scene: &FlatScene, count: usize) -> RaySets {
        let primary = pinhole(&subject.view, count);
        let mut hits = Hits::default();
        closest_hit(scene, Isa::best(), &primary, &mut hits);
        let starts = starts(scene, &primary, &hits);
        let diffuse = bounces(&starts);
        let shuffled = shuffled(&diffuse);
        let shadow = to_lamp(&starts, &subject.view.lamp);
        let random = anywhere(subject, count);
        RaySets {
            sets: [primary, diffuse, shuffled, shadow, random],
        }
    }

    /// One of them.
    #[must_use]
    pub fn of(&self, kind: RayKind) -> &Rays {
        &self.sets[kind as usize]
    }
}

/// A point on a surface that a ray has hit.
struct Start {
    point: [f32; 3],
    /// Unit, on the side that the ray came from.
    normal: Vec3,
    err: f32,
}

impl Start {
    /// A ray from here.
    fn leave(&self, rays: &mut Rays, direction: DVec3, t_max: f32) {
        let dir = direction.as_vec3().to_array();
        let origin = offset_origin(self.point, self.normal.to_array(), self.err, dir);
        rays.push(origin, dir, t_max);
    }
}

/// `count` rays through a square image, a pixel each.
fn pinhole(view: &View, count: usize) -> Rays {
    /// Width of the image on the plane at distance 1: about 53°.
    const IMAGE: f64 = 1.0;
    let mut random = Random::new(1);
    let forward = (view.target - view.eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let side = count.isqrt() + usize::from(count.isqrt().pow(2) < count);
    let mut rays = Rays::default();
    let pixels = (0u64..).map(morton).filter(|p| p.iter().all(|&c| c < side));
    for [x, y] in pixels.take(count) {
        let mut place = |pixel: usize| ((pixel as f64 + random.unit()) / side as f64 - 0.5) * IMAGE;
        let direction = forward + right * place(x) + up * place(y);
        let direction = direction.normalize().as_vec3();
        rays.push(
            view.eye.as_vec3().to_array(),
            direction.to_array(),
            f32::MAX,
        );
    }
    rays
}

/// The pixel at a place of the Morton curve: its even bits and its odd bits.
fn morton(code: u64) -> [usize; 2] {
    [code, code >> 1].map(|bits| (0..32).map(|i| (bits >> (2 * i) & 1) << i).sum::<u64>() as usize)
}

/// Where rays have hit.
fn starts(scene: &FlatScene, rays: &Rays, hits: &Hits) -> Vec<Start> {
    let hit = |i: &usize| hits.prim[*i] != Hits::NONE;
    let start = |i: usize| {
        let ray = [&rays.origin, &rays.dir].map(|a| [a[0][i], a[1][i], a[2][i]]);
        let prim = hits.prim[i];
        let (point, normal) = if prim & Spheres::TAG != 0 {
            let sphere = (prim & !Spheres::TAG) as usize;
            let (center, radius) = (scene.spheres.center(sphere), scene.spheres.radius(sphere));
            sphere_point(ray, hits.t[i], center, radius)
        } else {
            let vertices = triangle_vertices(&scene.world.triangles, prim);
            let point = triangle_point(vertices, hits.u[i], hits.v[i]);
            (point, triangle_normal(vertices))
        };
        let normal = Vec3::from(normal);
        let towards = normal.dot(Vec3::from(ray[1])) > 0.0;
        Start {
            point,
            normal: if towards { -normal } else { normal },
            err: hits.err[i],
        }
    };
    (0..rays.len()).filter(hit).map(start).collect()
}

/// A cosine-distributed ray from each: the normal plus a point of the unit sphere.
fn bounces(starts: &[Start]) -> Rays {
    let mut random = Random::new(2);
    let mut rays = Rays::default();
    for start in starts {
        let direction = loop {
            let sum = start.normal.as_dvec3() + random.direction();
            // Against the normal, their sum has no direction.
            if sum.length() > 1e-3 {
                break sum.normalize();
            }
        };
        start.leave(&mut rays, direction, f32::MAX);
    }
    rays
}

/// The same rays in another order (Fisher and Yates).
fn shuffled(rays: &Rays) -> Rays {
    let mut random = Random::new(3);
    let mut order: Vec<usize> = (0..rays.len()).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, random.below(i + 1));
    }
    let pick = |array: &Vec<f32>| order.iter().map(|&i| array[i]).collect::<Vec<f32>>();
    Rays {
        origin: [0, 1, 2].map(|axis| pick(&rays.origin[axis])),
        dir: [0, 1, 2].map(|axis| pick(&rays.dir[axis])),
        t_max: pick(&rays.t_max),
    }
}

/// A ray to a random point of the lamp from each start that faces it.
fn to_lamp(starts: &[Start], [corner, a, b]: &[DVec3; 3]) -> Rays {
    let mut random = Random::new(4);
    let mut rays = Rays::default();
    for start in starts {
        let to = *corner + *a * random.unit() + *b * random.unit();
        let way = to - Vec3::from(start.point).as_dvec3();
        if way.dot(start.normal.as_dvec3()) > 0.0 {
            start.leave(&mut rays, way.normalize(), way.length() as f32);
        }
    }
    rays
}

/// Rays from the object's box in all directions.
fn anywhere(subject: &Subject, count: usize) -> Rays {
    let mut random = Random::new(5);
    let [low, high] = [subject.object.min, subject.object.max].map(Vec3::as_dvec3);
    let mut rays = Rays::default();
    for _ in 0..count {
        let origin = random.point(low, high).as_vec3();
        let dir = random.direction().as_vec3();
        rays.push(origin.to_array(), dir.to_array(), f32::MAX);
    }
    rays
}
