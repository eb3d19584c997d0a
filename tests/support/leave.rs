//! Rays that leave surfaces as those of paths do: from the point of a hit, moved by its error bound.

use super::Rng;
use super::shoot::{best, ray};
use luxel::flat::{FlatScene, Spheres};
use luxel::math::Vec3;
use luxel::trace::spawn::{
    instance_normal, instance_point, offset_origin, sphere_point, triangle_normal, triangle_point,
    triangle_vertices,
};
use luxel::trace::{Hits, Rays};

/// Traces, then sends `n` rays off every hit to each side; returns how many meet the same primitive again,
/// and how many were sent. Off a sphere, all go outward.
pub fn returns(scene: &FlatScene, rays: &Rays, rng: &mut Rng, n: usize) -> (usize, usize) {
    let hits = best(scene, rays);
    let mut away = Rays::default();
    let mut from = Vec::new();
    for i in 0..rays.len() {
        if hits.prim[i] == Hits::NONE {
            continue;
        }
        let (p, ng) = surface(scene, rays, &hits, i);
        for k in 0..n {
            let mut dir = Vec3::from(rng.direction());
            if k == 0 {
                // Nearly along the surface.
                dir = (dir.cross(Vec3::from(ng)) + 1e-3 * Vec3::from(ng)).normalize_or(dir);
            }
            let sphere = hits.prim[i] & Spheres::TAG != 0;
            if sphere && dir.as_dvec3().dot(Vec3::from(ng).as_dvec3()) < 0.0 {
                dir = -dir;
            }
            let dir = dir.to_array();
            away.push(offset_origin(p, ng, hits.err[i], dir), dir, f32::MAX);
            from.push((hits.instance[i], hits.prim[i]));
        }
    }
    let again = best(scene, &away);
    let pairs = again.instance.iter().zip(&again.prim);
    let back = from
        .iter()
        .zip(pairs)
        .filter(|(a, b)| (a.0, a.1) == (*b.0, *b.1))
        .count();
    (back, from.len())
}

/// Point and geometric normal of a hit, as the surface stage gets them.
pub fn surface(scene: &FlatScene, rays: &Rays, hits: &Hits, i: usize) -> ([f32; 3], [f32; 3]) {
    let [prim, instance] = [hits.prim[i], hits.instance[i]];
    let [u, v] = [hits.u[i], hits.v[i]];
    if prim & Spheres::TAG != 0 {
        let s = (prim & !Spheres::TAG) as usize;
        let (center, radius) = (scene.spheres.center(s), scene.spheres.radius(s));
        sphere_point(ray(rays, i), hits.t[i], center, radius)
    } else if instance == Hits::WORLD {
        let vertices = triangle_vertices(&scene.world.triangles, prim);
        (triangle_point(vertices, u, v), triangle_normal(vertices))
    } else {
        let instance = &scene.instances[instance as usize];
        let local = &scene.local[instance.geometry as usize];
        let vertices = triangle_vertices(&local.triangles, prim);
        (
            instance_point(instance, triangle_point(vertices, u, v)),
            instance_normal(instance, triangle_normal(vertices)),
        )
    }
}
