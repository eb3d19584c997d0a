//! Instruction sets, trees, batch lengths and scales give the same bits; `occluded` is `closest_hit`.

use crate::support::{Parts, Rng, Solid, empty_scene};
use crate::{EVERY, best, bits, misses, ray, soup, trace};
use luxel::build::bvh::Accel;
use luxel::flat::{FlatScene, Spheres};
use luxel::math::{DAffine3, DQuat, DVec3, Vec3};
use luxel::trace::spawn::triangle_vertices;
use luxel::trace::{Hits, Isa, Rays, occluded};

/// Everything at once: two meshes, a soup with degenerate and broken triangles, equal triangles, spheres in the tree and
/// out of it, and instances that turn, stretch and mirror.
pub(crate) fn mixed() -> Parts {
    let mut rng = Rng(1);
    let mut triangles = Solid::uv_sphere(12, 16).triangles();
    let first = triangles.len() as u32;
    triangles.extend(soup(&mut rng, 300, 3.0, 0.5));
    triangles.extend([triangles[0]; 20]);
    triangles.push([Vec3::ONE; 3]);
    triangles.push([Vec3::ZERO, Vec3::splat(f32::NAN), Vec3::X]);
    triangles.push([Vec3::ZERO, Vec3::splat(f32::INFINITY), Vec3::X]);
    let groups = vec![0..first, first..triangles.len() as u32];
    let spheres = (0..40)
        .map(|_| {
            let c = rng.in_cube(3.0).map(f64::from);
            (c, 10f64.powf(rng.range(-2.0, -0.3)))
        })
        .collect();
    let turn = DQuat::from_xyzw(0.1, 0.5, -0.3, 0.8).normalize();
    let place = |x: f64, s: DVec3| {
        DAffine3::from_scale_rotation_translation(s, turn, DVec3::new(x, 0.3, -0.2))
    };
    Parts {
        triangles,
        groups,
        tree_spheres: spheres,
        looped: vec![([0.0, -1000.0, 0.0], 997.0), ([0.0, 1e5, 0.0], 1e5 - 4.0)],
        meshes: vec![
            Solid::icosphere(2).triangles(),
            soup(&mut rng, 50, 1.0, 0.7),
        ],
        instances: vec![
            (0, place(1.5, DVec3::ONE)),
            (0, place(-1.5, DVec3::new(2.0, 0.1, 0.5))),
            (1, place(0.0, DVec3::new(-1.0, 1.0, 1.0))),
            (1, place(0.5, DVec3::splat(1e-2))),
        ],
    }
}

/// Rays of all kinds, the hostile included.
pub(crate) fn hostile_rays(n: usize) -> Rays {
    let mut rng = Rng(2);
    let mut rays = Rays::default();
    let odd = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        1e-40,
        f32::MAX,
        1e-20,
    ];
    for i in 0..n {
        let mut origin = rng.in_cube(4.0);
        let mut dir = rng.direction();
        let mut t_max = f32::MAX;
        match i % 8 {
            0 => dir = [0, 1, 2].map(|_| odd[rng.below(4)]),
            1 => origin = origin.map(|x| x.round()),
            2 => dir = dir.map(|x| x * 1e3),
            3 => t_max = rng.range(0.0, 6.0) as f32,
            4 if i % 16 == 4 => origin[rng.below(3)] = odd[rng.below(odd.len())],
            5 if i % 16 == 5 => dir[rng.below(3)] = odd[rng.below(odd.len())],
            6 if i % 16 == 6 => t_max = odd[rng.below(odd.len())],
            _ => {}
        }
        rays.push(origin, dir, t_max);
    }
    rays
}

#[test]
fn every_instruction_set_and_every_tree_gives_the_same_bits() {
    let rays = hostile_rays(20_003);
    let parts = mixed();
    let reference = bits(&trace(&parts.scene(Accel::Bvh), Isa::SCALAR, &rays));
    let kinds = [
        |h: &[u32; 6]| h[3] == Hits::NONE,
        |h: &[u32; 6]| h[3] != Hits::NONE && h[3] & Spheres::TAG != 0,
        |h: &[u32; 6]| h[3] & Spheres::TAG == 0 && h[4] == Hits::WORLD,
        |h: &[u32; 6]| h[4] != Hits::WORLD,
    ];
    for kind in kinds {
        let count = reference.iter().filter(|h| kind(h)).count();
        assert!(
            count > 500,
            "only {count} rays of a kind: {rays:?}",
            rays = rays.len()
        );
    }
    for accel in EVERY {
        let scene = parts.scene(accel);
        for isa in Isa::all() {
            let found = bits(&trace(&scene, isa, &rays));
            for (i, (a, b)) in reference.iter().zip(&found).enumerate() {
                assert_eq!(a, b, "{accel:?} {isa:?} ray {i}: {:?}", ray(&rays, i));
            }
        }
    }
    for (i, h) in reference.iter().enumerate() {
        let [t, u, v, .., err] = h.map(f32::from_bits);
        assert!(
            t > 0.0 && u >= 0.0 && v >= 0.0 && (0.0..1.0).contains(&err),
            "ray {i}: {h:?}"
        );
        let limit = rays.t_max[i];
        assert!(
            h[3] == Hits::NONE || t <= limit,
            "ray {i} at {t} beyond {limit}"
        );
    }
}

/// Rays from points of surfaces, as rounded and not moved away: every t of the surface itself is smaller than its error.
/// Some start exactly on a vertex.
fn rays_from_surfaces(scene: &FlatScene, n: usize) -> Rays {
    let mut rng = Rng(4);
    let seeing = hostile_rays(n);
    let hits = best(scene, &seeing);
    let vertices: Vec<[f32; 3]> = (0..scene.world.triangles.place.len() as u32)
        .flat_map(|prim| triangle_vertices(&scene.world.triangles, prim))
        .collect();
    let mut rays = Rays::default();
    for i in 0..n {
        let [o, d] = ray(&seeing, i);
        let start = match i % 4 {
            0 => vertices[rng.below(vertices.len())],
            _ => [0, 1, 2].map(|k| o[k] + hits.t[i] * d[k]),
        };
        rays.push(start, rng.direction(), f32::MAX);
    }
    rays
}

#[test]
fn rays_that_start_on_surfaces_agree() {
    let parts = mixed();
    let rays = rays_from_surfaces(&parts.scene(Accel::Bvh), 8_001);
    let truth = trace(&parts.scene(Accel::Bvh), Isa::SCALAR, &rays);
    let near = truth.t.iter().filter(|t| **t < 1e-6).count();
    assert!(
        near > 300,
        "only {near} rays meet the surface where they start"
    );
    for accel in EVERY {
        let scene = parts.scene(accel);
        for isa in Isa::all() {
            let found = trace(&scene, isa, &rays);
            assert!(bits(&found) == bits(&truth), "{accel:?} {isa:?}");
            let mut blocked = Vec::new();
            occluded(&scene, isa, &rays, &mut blocked);
            let hit: Vec<bool> = truth.prim.iter().map(|p| *p != Hits::NONE).collect();
            assert!(blocked == hit, "{accel:?} {isa:?} occluded");
        }
    }
}

#[test]
fn occluded_is_a_hit_below_the_limit() {
    let parts = mixed();
    let mut rays = hostile_rays(4_001);
    let free = best(&parts.scene(Accel::Bvh), &rays);
    for (i, &t) in free.t.iter().enumerate() {
        // Exactly at the hit, one step before, one step after.
        match i % 6 {
            0 => rays.t_max[i] = t,
            1 => rays.t_max[i] = t.next_up(),
            2 => rays.t_max[i] = t.next_down(),
            _ => {}
        }
    }
    for accel in EVERY {
        let scene = parts.scene(accel);
        for isa in Isa::all() {
            let hits = trace(&scene, isa, &rays);
            let mut out = vec![true; 3];
            occluded(&scene, isa, &rays, &mut out);
            for (i, &out) in out.iter().enumerate() {
                let expected = hits.t[i] < rays.t_max[i];
                assert_eq!(out, expected, "{accel:?} {isa:?} ray {i}");
            }
        }
    }
}

#[test]
fn batches_of_any_length_agree() {
    let scene = mixed().scene(Accel::Bvh);
    let all = hostile_rays(50);
    let whole = bits(&best(&scene, &all));
    for n in (0..35).chain([47, 48, 49]) {
        for isa in Isa::all() {
            let mut rays = Rays::default();
            (0..n).for_each(|i| rays.push(ray(&all, i)[0], ray(&all, i)[1], all.t_max[i]));
            assert_eq!(bits(&trace(&scene, isa, &rays)), whole[..n]);
        }
    }
    let nothing = empty_scene();
    for isa in Isa::all() {
        assert_eq!(misses(&trace(&nothing, isa, &all)), 50);
    }
}

#[test]
fn powers_of_two_scale_bits() {
    let rays = {
        let mut rng = Rng(11);
        let mut rays = Rays::default();
        (0..4000).for_each(|_| rays.push(rng.in_cube(4.0), rng.direction(), f32::MAX));
        rays
    };
    let mut parts = mixed();
    parts.instances.clear();
    parts.triangles.truncate(parts.triangles.len() - 2);
    let one = best(&parts.scene(Accel::Bvh), &rays);
    for k in [-20, -1, 1, 20] {
        let s = 2f64.powi(k);
        let mut scaled = parts.clone();
        scaled
            .triangles
            .iter_mut()
            .flatten()
            .for_each(|v| *v *= s as f32);
        for sphere in scaled.tree_spheres.iter_mut().chain(&mut scaled.looped) {
            sphere.0.iter_mut().for_each(|c| *c *= s);
            sphere.1 *= s;
        }
        let mut moved = rays.clone();
        moved
            .origin
            .iter_mut()
            .flatten()
            .for_each(|x| *x *= s as f32);
        let other = best(&scaled.scene(Accel::Bvh), &moved);
        for i in 0..rays.len() {
            let [t, err] = [other.t[i] / s as f32, other.err[i] / s as f32];
            let same = (
                t.to_bits(),
                other.u[i].to_bits(),
                other.prim[i],
                err.to_bits(),
            );
            assert_eq!(
                same,
                (
                    one.t[i].to_bits(),
                    one.u[i].to_bits(),
                    one.prim[i],
                    one.err[i].to_bits()
                ),
                "2^{k} ray {i}"
            );
        }
    }
}
