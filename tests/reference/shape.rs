//! Intersection in f64. A ray that leaves a surface knows which, so no epsilon is needed.

use super::{Random, Scene};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::PI;

pub(crate) enum Shape {
    Sphere {
        center: DVec3,
        radius: f64,
        inverted: bool,
        /// Its own axes in the scene: orthonormal, but for a common factor.
        axes: DMat3,
    },
    /// Counter-clockwise seen from the side of the geometric normal.
    Triangle {
        p: [DVec3; 3],
        /// Corner normals; flat if none.
        n: Option<[DVec3; 3]>,
        uv: [DVec2; 3],
        more: Option<Box<Corners>>,
    },
}

/// What few triangles have at their corners.
#[derive(Clone, Copy)]
pub(crate) struct Corners {
    pub(crate) uv1: [DVec2; 3],
    pub(crate) tint: [DVec3; 3],
    pub(crate) alpha: [f64; 3],
}

impl Corners {
    /// As if they were not there.
    pub(crate) const PLAIN: Corners = Corners {
        uv1: [DVec2::ZERO; 3],
        tint: [DVec3::ONE; 3],
        alpha: [1.0; 3],
    };
}

/// A ray; `dir` has unit length.
#[derive(Clone, Copy)]
pub(crate) struct Ray {
    pub(crate) origin: DVec3,
    pub(crate) dir: DVec3,
    /// The surface that it leaves.
    pub(crate) from: Option<usize>,
}

/// The closest hit.
#[derive(Clone, Copy)]
pub(crate) struct Hit {
    pub(crate) surface: usize,
    pub(crate) t: f64,
    pub(crate) position: DVec3,
    /// Unit, as authored.
    pub(crate) ng: DVec3,
    /// Unit, on the side of `ng`.
    pub(crate) ns: DVec3,
    pub(crate) uv: DVec2,
    /// The second texture coordinates.
    pub(crate) uv1: DVec2,
    /// Colour of the corners, 1 where they have none.
    pub(crate) tint: DVec3,
    /// Alpha of the corners, likewise.
    pub(crate) alpha: f64,
    /// Smallest of the three barycentric weights; 1 for spheres.
    pub(crate) margin: f64,
}

/// A point of a surface with its barycentric weights (0 for spheres).
type Crossing = (f64, [f64; 3]);

impl Shape {
    fn cross(&self, ray: &Ray, leaving: bool) -> Option<Crossing> {
        match self {
            Shape::Sphere { center, radius, .. } => {
                cross_sphere(ray, *center, *radius, leaving).map(|t| (t, [0.0; 3]))
            }
            Shape::Triangle { p, .. } if !leaving => cross_triangle(ray, p),
            Shape::Triangle { .. } => None,
        }
    }

    /// A point uniform by area among those that may face `from`, with the geometric normal there, and their area.
    pub(crate) fn sample_area(&self, from: DVec3, random: &mut Random) -> (DVec3, DVec3, f64) {
        match self {
            Shape::Sphere {
                center,
                radius,
                inverted,
                ..
            } => {
                // From outside, the cap up to the horizon at cos = r / d: its area is as its height (Archimedes).
                let to = from - *center;
                let horizon = (radius / to.length()).min(1.0);
                let (low, side) = if *inverted {
                    (-1.0, -1.0)
                } else {
                    (horizon, 1.0)
                };
                let n = random.cap(to.normalize_or(DVec3::Z), low);
                let area = 2.0 * PI * radius * radius * (1.0 - low);
                (*center + n * *radius, n * side, area)
            }
            Shape::Triangle { p, .. } => {
                let (mut a, mut b) = (random.unit(), random.unit());
                if a + b > 1.0 {
                    (a, b) = (1.0 - a, 1.0 - b);
                }
                let (e, f) = (p[1] - p[0], p[2] - p[0]);
                let normal = e.cross(f);
                let area = normal.length() / 2.0;
                (p[0] + e * a + f * b, normal.normalize(), area)
            }
        }
    }
}

/// The distance along the ray to the centre, minus and plus half a chord. From the sphere itself one root is 0 and the
/// other is known without cancellation.
fn cross_sphere(ray: &Ray, center: DVec3, radius: f64, leaving: bool) -> Option<f64> {
    let to_center = center - ray.origin;
    let along = to_center.dot(ray.dir);
    if leaving {
        return (along > 0.0).then_some(2.0 * along);
    }
    let across = (to_center - ray.dir * along).length_squared();
    let half = radius * radius - across;
    if half < 0.0 {
        return None;
    }
    let half = half.sqrt();
    [along - half, along + half].into_iter().find(|t| *t > 0.0)
}

/// Möller and Trumbore 1997.
fn cross_triangle(ray: &Ray, p: &[DVec3; 3]) -> Option<Crossing> {
    let (e, f) = (p[1] - p[0], p[2] - p[0]);
    let q = ray.dir.cross(f);
    let det = e.dot(q);
    if det == 0.0 {
        return None;
    }
    let s = ray.origin - p[0];
    let u = s.dot(q) / det;
    let r = s.cross(e);
    let v = ray.dir.dot(r) / det;
    let t = f.dot(r) / det;
    let w = 1.0 - u - v;
    (u >= 0.0 && v >= 0.0 && w >= 0.0 && t > 0.0).then_some((t, [w, u, v]))
}

/// The closest of all surfaces.
pub(crate) fn closest(scene: &Scene, ray: &Ray) -> Option<Hit> {
    let mut best: Option<(usize, Crossing)> = None;
    for (i, surface) in scene.surfaces.iter().enumerate() {
        if let Some(crossing) = surface.shape.cross(ray, ray.from == Some(i))
            && best.is_none_or(|(_, b)| crossing.0 < b.0)
        {
            best = Some((i, crossing));
        }
    }
    best.map(|(i, crossing)| hit(scene, ray, i, crossing))
}

/// An image around a ball as it is read from outside: the middle column faces +Z, columns to the right of it +X, the top
/// row the north pole, +Y.
fn sphere_uv(p: DVec3) -> DVec2 {
    let east = p.x.atan2(p.z).to_degrees();
    let north = p.y.atan2(p.x.hypot(p.z)).to_degrees();
    DVec2::new((east + 180.0) / 360.0, (north + 90.0) / 180.0)
}

fn hit(scene: &Scene, ray: &Ray, surface: usize, (t, w): Crossing) -> Hit {
    let there = ray.origin + ray.dir * t;
    match &scene.surfaces[surface].shape {
        Shape::Sphere {
            center,
            radius,
            inverted,
            axes,
        } => {
            let out = (there - *center).normalize();
            let ng = if *inverted { -out } else { out };
            Hit {
                surface,
                t,
                position: *center + out * *radius,
                ng,
                ns: ng,
                uv: sphere_uv(axes.transpose() * out),
                uv1: DVec2::ZERO,
                tint: DVec3::ONE,
                alpha: 1.0,
                margin: 1.0,
            }
        }
        Shape::Triangle { p, n, uv, more } => {
            let ng = (p[1] - p[0]).cross(p[2] - p[0]).normalize();
            let ns = n.map_or(ng, |n| {
                (n[0] * w[0] + n[1] * w[1] + n[2] * w[2]).normalize()
            });
            Hit {
                surface,
                t,
                position: p[0] * w[0] + p[1] * w[1] + p[2] * w[2],
                ng,
                ns: if ns.dot(ng) < 0.0 { -ns } else { ns },
                uv: uv[0] * w[0] + uv[1] * w[1] + uv[2] * w[2],
                uv1: more.as_ref().map_or(DVec2::ZERO, |m| {
                    m.uv1[0] * w[0] + m.uv1[1] * w[1] + m.uv1[2] * w[2]
                }),
                tint: more.as_ref().map_or(DVec3::ONE, |m| {
                    m.tint[0] * w[0] + m.tint[1] * w[1] + m.tint[2] * w[2]
                }),
                alpha: more.as_ref().map_or(1.0, |m| {
                    m.alpha[0] * w[0] + m.alpha[1] * w[1] + m.alpha[2] * w[2]
                }),
                margin: w[0].min(w[1]).min(w[2]),
            }
        }
    }
}
