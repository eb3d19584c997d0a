//! Surface: where a path is, from its hit and the cold arrays. Attributes are read once, for the closest hit only.

use super::vector::{get, set, unit};
use super::wave::{Paths, Wave};
use super::{Hits, texture::eval_texture};
use crate::flat::{ColorSource, FlatScene, Geometry, Instance, Scatter, Spheres};
use crate::math::{DVec3, Vec3, acos, atan2};

/// A point of a surface.
struct Point {
    position: Vec3,
    ng: Vec3,
    ns: Vec3,
    uv: [f32; 2],
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
        let point = point(scene, paths, hits, i);
        set(&mut surfaces.position, i, point.position);
        set(&mut surfaces.ng, i, point.ng);
        set(&mut surfaces.ns, i, point.ns);
        surfaces.uv[0][i] = point.uv[0];
        surfaces.uv[1][i] = point.uv[1];
        surfaces.material[i] = point.material;
        set(&mut surfaces.color, i, color(scene, &point));
    }
}

fn point(scene: &FlatScene, paths: &Paths, hits: &Hits, i: usize) -> Point {
    let (prim, instance) = (hits.prim[i], hits.instance[i]);
    if prim & Spheres::TAG != 0 {
        return sphere_point(
            scene,
            get(&paths.rays.origin, i),
            get(&paths.rays.dir, i),
            hits.t[i],
            prim & !Spheres::TAG,
        );
    }
    let (u, v) = (hits.u[i], hits.v[i]);
    if instance == Hits::WORLD {
        let local = triangle_point(&scene.world, prim, u, v);
        return Point {
            ng: unit(local.ng),
            ..local
        };
    }
    let instance = &scene.instances[instance as usize];
    let local = triangle_point(&scene.local[instance.geometry as usize], prim, u, v);
    to_world(scene, instance, local)
}

/// Interpolates in the geometry's own space; `ng` is not yet of unit length.
fn triangle_point(geometry: &Geometry, prim: u32, u: f32, v: f32) -> Point {
    let place = geometry.triangles.place[prim as usize] as usize;
    let block = &geometry.triangles.blocks[place / crate::flat::BLOCK];
    let lane = place % crate::flat::BLOCK;
    let vertex = |k: usize| {
        Vec3::new(
            block.v[k][0][lane],
            block.v[k][1][lane],
            block.v[k][2][lane],
        )
    };
    let (a, b, c) = (vertex(0), vertex(1), vertex(2));
    let w = 1.0 - u - v;
    let shading = &geometry.shading;
    let corner = 3 * prim as usize;
    let ng = (b - a).cross(c - a);
    let ns = match shading.normals.corner.get(corner..corner + 3) {
        Some(n) => Vec3::from(n[0]) * w + Vec3::from(n[1]) * u + Vec3::from(n[2]) * v,
        None => ng,
    };
    let uv = match shading.uvs.get(corner..corner + 3) {
        Some(t) => [0, 1].map(|k| t[0][k] * w + t[1][k] * u + t[2][k] * v),
        None => [0.0; 2],
    };
    Point {
        position: a * w + b * u + c * v,
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
        unit(ng)
    };
    if ns.dot(ng) < 0.0 { -ns } else { ns }
}

/// Positions by the matrix, normals by the transpose of its inverse.
fn to_world(scene: &FlatScene, instance: &Instance, local: Point) -> Point {
    let m = &instance.to_world;
    let p = local.position;
    let row = |r: &[f32; 4]| r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
    let position = Vec3::new(row(&m[0]), row(&m[1]), row(&m[2]));
    let w = &instance.to_local;
    let normal = |n: Vec3| {
        let axis = |k: usize| w[0][k] * n.x + w[1][k] * n.y + w[2][k] * n.z;
        Vec3::new(axis(0), axis(1), axis(2))
    };
    let sign = if instance.mirrored { -1.0 } else { 1.0 };
    let ng = unit(normal(unit(local.ng))) * sign;
    let ns = facing(normal(local.ns), ng);
    let material =
        scene.instance_materials[instance.materials as usize + local.material as usize].0;
    Point {
        position,
        ng,
        ns,
        uv: local.uv,
        material,
    }
}

/// The hit of a sphere, put back onto it: p = C + r n in f64, rounded once.
fn sphere_point(scene: &FlatScene, origin: Vec3, dir: Vec3, t: f32, sphere: u32) -> Point {
    let s = sphere as usize;
    let spheres = &scene.spheres;
    let center = DVec3::from(spheres.center[s]);
    let p = origin.as_dvec3() + dir.as_dvec3() * f64::from(t);
    let d = p - center;
    let outward = d * (1.0 / d.length_squared().sqrt());
    let position = (center + outward * spheres.radius[s]).as_vec3();
    let n = unit(outward.as_vec3());
    let ng = if spheres.inverted[s] { -n } else { n };
    Point {
        position,
        ng,
        ns: ng,
        uv: sphere_uv(spheres, s, n),
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

fn color(scene: &FlatScene, point: &Point) -> Vec3 {
    let material = &scene.materials[point.material as usize];
    if material.scatter == Scatter::Nothing {
        return Vec3::ZERO;
    }
    match material.color {
        ColorSource::Constant(c) => Vec3::from(c),
        ColorSource::Texture { texture, factor } => {
            Vec3::from(factor) * eval_texture(&scene.textures[texture as usize], point.uv)
        }
    }
}
