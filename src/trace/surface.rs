//! Surface: where a path is, from its hit and the cold arrays. Attributes are read once, for the closest hit only.
#![allow(
    clippy::needless_range_loop,
    reason = "lanes are numbers here: several arrays are indexed by one"
)]

use super::attributes::{Place, texture_color, vertex_color};
use super::chunk::{Chunk, WIDEST};
use super::groups::{Shape, group};
use super::vector::{V3, get, set};
use super::wave::{Surfaces, Wave};
use super::{Hits, Rays, cut, spawn};
use crate::flat::{ColorSource, FlatScene, Geometry, Scatter, Spheres};
use crate::math::lanes::BitLanes;
use crate::math::{Vec3, acos, atan2};

/// A point of a surface in each lane, but for what is looked up lane by lane.
struct Points<L> {
    position: V3<L>,
    ng: V3<L>,
    ns: V3<L>,
}

/// Fills `wave.surfaces` for every path that hit something, and groups the paths.
#[inline(always)]
pub(super) fn surface<L: BitLanes>(wave: &mut Wave, scene: &FlatScene) {
    group::<L>(wave, scene);
    let Wave {
        paths,
        hits,
        surfaces,
        groups,
        ..
    } = wave;
    for chunk in Chunk::all::<L>(&groups.by_shape[Shape::Sphere as usize]) {
        let points = on_spheres::<L>(&scene.spheres, &paths.rays, hits, &chunk);
        write(surfaces, &chunk, &points);
    }
    for chunk in Chunk::all::<L>(&groups.by_shape[Shape::Triangle as usize]) {
        let points = on_triangles::<L>(
            |_| &scene.world,
            cut::SMOOTH_NORMALS && scene.needs.smooth_normals,
            hits,
            &chunk,
        );
        write(surfaces, &chunk, &points);
    }
    if cut::INSTANCES {
        for chunk in Chunk::all::<L>(&groups.by_shape[Shape::Instance as usize]) {
            let points = on_instances::<L>(scene, hits, &chunk);
            write(surfaces, &chunk, &points);
        }
    }
}

/// Texture coordinates where a material reads a texture, and the colours of those. Returns of how many paths.
#[inline(never)]
pub(super) fn look_up(wave: &mut Wave, scene: &FlatScene) -> u64 {
    let Wave {
        hits,
        surfaces,
        groups,
        ..
    } = wave;
    let mut count = 0;
    for &i in groups.by_shape.iter().flatten() {
        let i = i as usize;
        let material = &scene.materials[surfaces.material[i] as usize];
        let textured = matches!(material.color, ColorSource::Texture { .. });
        if !textured && material.emission_source.is_none() {
            continue;
        }
        count += 1;
        let uv = coordinates(scene, hits, get(&surfaces.ng, i), i);
        surfaces.uv[0][i] = uv[0];
        surfaces.uv[1][i] = uv[1];
        if let ColorSource::Texture { texture, factor } = material.color
            && material.scatter != Scatter::Nothing
        {
            let place = Place::of_hit(hits, i, uv);
            let color = Vec3::from(factor) * texture_color(scene, texture, &place);
            set(&mut surfaces.color, i, color);
        }
    }
    count
}

#[inline(always)]
fn write<L: BitLanes>(surfaces: &mut Surfaces, chunk: &Chunk, points: &Points<L>) {
    chunk.put_vector(points.position, &mut surfaces.position);
    chunk.put_vector(points.ng, &mut surfaces.ng);
    chunk.put_vector(points.ns, &mut surfaces.ns);
}

/// Multiplies the colours of `wave.surfaces` by those of the corners, where materials want it.
#[inline(never)]
pub(super) fn color_by_vertices(wave: &mut Wave, scene: &FlatScene) {
    let Wave { hits, surfaces, .. } = wave;
    for i in 0..hits.prim.len() {
        let hit = hits.prim[i] != Hits::NONE;
        if hit && scene.materials[surfaces.material[i] as usize].vertex_colors {
            let place = Place::of_hit(hits, i, [0.0; 2]);
            let color = get(&surfaces.color, i) * vertex_color(scene, &place);
            set(&mut surfaces.color, i, color);
        }
    }
}

/// Where one ray hits what it hits.
pub(super) struct Point {
    pub(super) position: [f32; 3],
    pub(super) ng: [f32; 3],
    pub(super) uv: [f32; 2],
}

/// Where a ray hits what it hits, for stages that seldom ask.
#[inline(never)]
pub(super) fn place(scene: &FlatScene, rays: &Rays, hits: &Hits, i: usize) -> Point {
    let chunk = Chunk::new::<f32>(&[i as u32]);
    let points = match Shape::of(hits, i) {
        Shape::Sphere => on_spheres::<f32>(&scene.spheres, rays, hits, &chunk),
        Shape::Triangle => on_triangles::<f32>(|_| &scene.world, false, hits, &chunk),
        Shape::Instance => on_instances::<f32>(scene, hits, &chunk),
    };
    Point {
        position: points.position.0,
        ng: points.ng.0,
        uv: coordinates(scene, hits, points.ng.into(), i),
    }
}

/// Position and unit geometric normal (on the authored outside) of a hit, as the surface stage computes them: where rays
/// leave by [`Hits::err`]. For measuring.
#[must_use]
pub fn hit_place(scene: &FlatScene, rays: &Rays, hits: &Hits, i: usize) -> [[f32; 3]; 2] {
    let point = place(scene, rays, hits, i);
    [point.position, point.ng]
}

/// Interpolates in the own space of each lane's geometry; normals, if some are smooth.
#[inline(always)]
fn on_triangles<'a, L: BitLanes>(
    geometry: impl Fn(usize) -> &'a Geometry,
    smooth_normals: bool,
    hits: &Hits,
    chunk: &Chunk,
) -> Points<L> {
    let [mut corners, mut normals] = [[[[0.0; WIDEST]; 3]; 3]; 2];
    let mut smooth = [0.0; WIDEST];
    for lane in 0..L::N {
        let (geometry, prim) = (geometry(lane), chunk.at(&hits.prim, lane));
        let vertices = spawn::triangle_vertices(&geometry.triangles, prim);
        put_lane(&mut corners, lane, vertices.as_flattened());
        let corner = 3 * prim as usize;
        if smooth_normals
            && let Some(three) = geometry.shading.normals.corner.get(corner..corner + 3)
        {
            put_lane(&mut normals, lane, three.as_flattened());
            smooth[lane] = 1.0;
        }
    }
    let [a, b, c] = &corners;
    let vertices = [V3::load(a).0, V3::load(b).0, V3::load(c).0];
    let (u, v): (L, L) = (chunk.lanes(&hits.u), chunk.lanes(&hits.v));
    let ng = V3(spawn::lanes::triangle_normal(vertices));
    let [n0, n1, n2] = &normals;
    let w = L::splat(1.0) - u - v;
    let ns = V3::load(n0) * w + V3::load(n1) * u + V3::load(n2) * v;
    let smooth = L::splat(0.0).lt(L::load(&smooth));
    Points {
        position: V3(spawn::lanes::triangle_point(vertices, u, v)),
        ng,
        ns: facing(V3::select(smooth, ns, ng), ng),
    }
}

/// Spreads nine numbers over a lane of as many arrays.
#[inline(always)]
fn put_lane(arrays: &mut [[[f32; WIDEST]; 3]; 3], lane: usize, numbers: &[f32]) {
    for (array, x) in arrays.as_flattened_mut().iter_mut().zip(numbers) {
        array[lane] = *x;
    }
}

/// A shading normal as a unit vector on the side of the geometric normal; that one where it has no direction.
#[inline(always)]
fn facing<L: BitLanes>(ns: V3<L>, ng: V3<L>) -> V3<L> {
    let (zero, length) = (L::splat(0.0), ns.dot(ns));
    let directed = zero.lt(length) & length.lt(L::splat(f32::INFINITY));
    let ns = V3::select(directed, ns.unit(), ng);
    V3::select(ns.dot(ng).lt(zero), -ns, ns)
}

/// Positions by the matrix, normals by the transpose of its inverse: an outward normal stays outward, mirrored or not.
#[inline(always)]
fn on_instances<L: BitLanes>(scene: &FlatScene, hits: &Hits, chunk: &Chunk) -> Points<L> {
    let instance = |lane| &scene.instances[chunk.at(&hits.instance, lane) as usize];
    let local = on_triangles::<L>(
        |lane| &scene.local[instance(lane).geometry as usize],
        cut::SMOOTH_NORMALS && scene.needs.smooth_normals,
        hits,
        chunk,
    );
    let [mut to_world, mut to_local] = [[[[0.0; WIDEST]; 4]; 3]; 2];
    for lane in 0..L::N {
        let instance = instance(lane);
        for row in 0..3 {
            for column in 0..4 {
                to_world[row][column][lane] = instance.to_world[row][column];
                to_local[row][column][lane] = instance.to_local[row][column];
            }
        }
    }
    let ng = V3(spawn::lanes::instance_normal(&to_local, local.ng.0));
    let ns = V3(spawn::lanes::instance_normal(&to_local, local.ns.0));
    let position = spawn::lanes::instance_point(&to_world, local.position.0);
    Points {
        position: V3(position),
        ng,
        ns: facing(ns, ng),
    }
}

/// Hits of spheres, put back onto them.
#[inline(always)]
fn on_spheres<L: BitLanes>(
    spheres: &Spheres,
    rays: &Rays,
    hits: &Hits,
    chunk: &Chunk,
) -> Points<L> {
    let (mut index, mut inverted) = ([0; WIDEST], 0);
    for lane in 0..L::N {
        index[lane] = chunk.at(&hits.prim, lane) & !Spheres::TAG;
        inverted |= u32::from(spheres.inverted[index[lane] as usize]) << lane;
    }
    let [x, y, z, radius] = L::rows(&spheres.placed, &index);
    let center = [x, y, z];
    let ray = [chunk.vector(&rays.origin).0, chunk.vector(&rays.dir).0];
    let (position, outward) = spawn::lanes::sphere_point(ray, chunk.lanes(&hits.t), center, radius);
    let outward = V3(outward);
    let ng = V3::select(L::mask(inverted), -outward, outward);
    Points {
        position: V3(position),
        ng,
        ns: ng,
    }
}

/// Texture coordinates of a hit with geometric normal `ng`; 0 where nothing asks for them.
#[inline(always)]
fn coordinates(scene: &FlatScene, hits: &Hits, ng: Vec3, i: usize) -> [f32; 2] {
    let prim = hits.prim[i];
    let shading = match Shape::of(hits, i) {
        Shape::Sphere => {
            let s = (prim & !Spheres::TAG) as usize;
            let outward = if scene.spheres.inverted[s] { -ng } else { ng };
            return sphere_uv(&scene.spheres, s, outward);
        }
        Shape::Triangle => &scene.world.shading,
        Shape::Instance => {
            let geometry = scene.instances[hits.instance[i] as usize].geometry;
            &scene.local[geometry as usize].shading
        }
    };
    let corner = 3 * prim as usize;
    let (u, v) = (hits.u[i], hits.v[i]);
    match shading.uvs.get(corner..corner + 3) {
        Some(t) => [0, 1].map(|k| t[0][k] * (1.0 - u - v) + t[1][k] * u + t[2][k] * v),
        None => [0.0; 2],
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
