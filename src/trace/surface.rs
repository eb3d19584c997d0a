//! Surface: where a path is, from its hit and the cold arrays. Attributes are read once, for the closest hit only.

use super::attributes::{Place, texture_color, vertex_color};
use super::vector::{get, set, unit};
use super::wave::Wave;
use super::{Hits, Rays, spawn};
use crate::flat::{ColorSource, FlatScene, Geometry, Instance, Scatter, Spheres};
use crate::math::{Vec3, acos, atan2};

/// A point of a surface.
pub(super) struct Point {
    pub(super) position: Vec3,
    pub(super) ng: Vec3,
    ns: Vec3,
    pub(super) uv: [f32; 2],
    material: u32,
}

/// Fills `wave.surfaces` for every path that hit something.
pub(super) fn surface(wave: &mut Wave, scene: &FlatScene) {
    let Wave {
        paths,
        hits,
        surfaces,
        ..
    } = wave;
    surfaces.resize(paths.len());
    for i in 0..paths.len() {
        if hits.prim[i] == Hits::NONE {
            continue;
        }
        let point = point(scene, &paths.rays, hits, i);
        set(&mut surfaces.position, i, point.position);
        set(&mut surfaces.ng, i, point.ng);
        set(&mut surfaces.ns, i, point.ns);
        surfaces.uv[0][i] = point.uv[0];
        surfaces.uv[1][i] = point.uv[1];
        surfaces.material[i] = point.material;
        set(&mut surfaces.color, i, color(scene, &point, hits, i));
    }
}

/// Multiplies the colours of `wave.surfaces` by those of the corners, where materials want it.
#[inline(never)]
pub(super) fn color_by_vertices(wave: &mut Wave, scene: &FlatScene) {
    let Wave { hits, surfaces, .. } = wave;
    for i in 0..surfaces.material.len() {
        let hit = hits.prim[i] != Hits::NONE;
        if hit && scene.materials[surfaces.material[i] as usize].vertex_colors {
            let place = Place::of_hit(hits, i, [0.0; 2]);
            let color = get(&surfaces.color, i) * vertex_color(scene, &place);
            set(&mut surfaces.color, i, color);
        }
    }
}

/// Where a ray hits what it hits, for stages that seldom ask.
#[inline(never)]
pub(super) fn place(scene: &FlatScene, rays: &Rays, hits: &Hits, i: usize) -> Point {
    point(scene, rays, hits, i)
}

/// Position and unit geometric normal (on the authored outside) of a hit, as the surface stage computes them: where rays
/// leave by [`Hits::err`]. For measuring.
#[must_use]
pub fn hit_place(scene: &FlatScene, rays: &Rays, hits: &Hits, i: usize) -> [[f32; 3]; 2] {
    let point = place(scene, rays, hits, i);
    [point.position.to_array(), point.ng.to_array()]
}

/// By force: the rare caller must not take the inlining from the frequent one (measured: 8 % more instructions here).
#[inline(always)]
fn point(scene: &FlatScene, rays: &Rays, hits: &Hits, i: usize) -> Point {
    let (prim, instance) = (hits.prim[i], hits.instance[i]);
    if prim & Spheres::TAG != 0 {
        let ray = [
            get(&rays.origin, i).to_array(),
            get(&rays.dir, i).to_array(),
        ];
        return on_sphere(scene, ray, hits.t[i], (prim & !Spheres::TAG) as usize);
    }
    let weights = [hits.u[i], hits.v[i]];
    if instance == Hits::WORLD {
        return on_triangle(&scene.world, prim, weights);
    }
    let instance = &scene.instances[instance as usize];
    let local = on_triangle(&scene.local[instance.geometry as usize], prim, weights);
    to_world(scene, instance, local)
}

/// Interpolates in the geometry's own space.
#[inline(always)]
fn on_triangle(geometry: &Geometry, prim: u32, [u, v]: [f32; 2]) -> Point {
    let vertices = spawn::triangle_vertices(&geometry.triangles, prim);
    let ng = Vec3::from(spawn::triangle_normal(vertices));
    let w = 1.0 - u - v;
    let shading = &geometry.shading;
    let corner = 3 * prim as usize;
    let ns = match shading.normals.corner.get(corner..corner + 3) {
        Some(n) => Vec3::from(n[0]) * w + Vec3::from(n[1]) * u + Vec3::from(n[2]) * v,
        None => ng,
    };
    let uv = match shading.uvs.get(corner..corner + 3) {
        Some(t) => [0, 1].map(|k| t[0][k] * w + t[1][k] * u + t[2][k] * v),
        None => [0.0; 2],
    };
    Point {
        position: Vec3::from(spawn::triangle_point(vertices, u, v)),
        ng,
        ns: facing(ns, ng),
        uv,
        material: shading.material[prim as usize],
    }
}

/// A shading normal as a unit vector on the side of the geometric normal; that one where it has no direction.
fn facing(ns: Vec3, ng: Vec3) -> Vec3 {
    let length = ns.length_squared();
    let ns = if length > 0.0 && length.is_finite() {
        unit(ns)
    } else {
        ng
    };
    if ns.dot(ng) < 0.0 { -ns } else { ns }
}

/// Positions by the matrix, normals by the transpose of its inverse: an outward normal stays outward, mirrored or not.
#[inline(always)]
fn to_world(scene: &FlatScene, instance: &Instance, local: Point) -> Point {
    let ng = Vec3::from(spawn::instance_normal(instance, local.ng.to_array()));
    let ns = Vec3::from(spawn::instance_normal(instance, local.ns.to_array()));
    let slot = instance.materials as usize + local.material as usize;
    Point {
        position: Vec3::from(spawn::instance_point(instance, local.position.to_array())),
        ng,
        ns: facing(ns, ng),
        uv: local.uv,
        material: scene.instance_materials[slot].0,
    }
}

/// The hit of a sphere, put back onto it.
#[inline(always)]
fn on_sphere(scene: &FlatScene, ray: [[f32; 3]; 2], t: f32, s: usize) -> Point {
    let spheres = &scene.spheres;
    let (position, outward) = spawn::sphere_point(ray, t, spheres.center[s], spheres.radius[s]);
    let outward = Vec3::from(outward);
    let ng = if spheres.inverted[s] {
        -outward
    } else {
        outward
    };
    Point {
        position: Vec3::from(position),
        ng,
        ns: ng,
        uv: sphere_uv(spheres, s, outward),
        material: spheres.material[s].0,
    }
}

/// Longitude and latitude: u = 1/2 + atan2(x, z) / 2π, v = 1 − acos(y) / π in the sphere's own axes, so that an image
/// stands upright and unmirrored with its middle towards +Z.
fn sphere_uv(spheres: &Spheres, s: usize, n: Vec3) -> [f32; 2] {
    use std::f64::consts::{PI, TAU};
    let Some(m) = spheres.to_local.get(s) else {
        return [0.0; 2];
    };
    let axis = |r: usize| f64::from(m[3 * r] * n.x + m[3 * r + 1] * n.y + m[3 * r + 2] * n.z);
    let (x, y, z) = (axis(0), axis(1), axis(2));
    [
        (0.5 + atan2(x, z) / TAU) as f32,
        (1.0 - acos(y) / PI) as f32,
    ]
}

#[inline(always)]
fn color(scene: &FlatScene, point: &Point, hits: &Hits, i: usize) -> Vec3 {
    let material = &scene.materials[point.material as usize];
    if material.scatter == Scatter::Nothing {
        return Vec3::ZERO;
    }
    match material.color {
        ColorSource::Constant(c) => Vec3::from(c),
        ColorSource::Texture { texture, factor } => {
            let place = Place::of_hit(hits, i, point.uv);
            Vec3::from(factor) * texture_color(scene, texture, &place)
        }
    }
}
