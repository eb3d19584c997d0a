//! What must be hit is hit: edges, vertices, lattices, planes and corners of boxes.

use crate::support::{Parts, Rng, Solid};
use crate::{EVERY, best, misses};
use luxel::build::bvh::Accel;
use luxel::math::{DAffine3, DQuat, DVec3, Vec3};
use luxel::trace::Rays;

/// Rays from inside a closed mesh to points of its edges and to its vertices.
fn aimed(solid: &Solid, n: usize, rng: &mut Rng) -> Rays {
    let mut rays = Rays::default();
    for i in 0..n {
        let face = solid.faces[rng.below(solid.faces.len())];
        let k = rng.below(3);
        let [a, b] = [face[k], face[(k + 1) % 3]].map(|i| solid.vertices[i]);
        let s = if i % 2 == 0 { 0.0 } else { rng.unit() as f32 };
        let target = a + (b - a) * s;
        let origin = if i % 16 == 0 {
            Vec3::ZERO
        } else {
            Vec3::from(rng.in_cube(0.4))
        };
        let mut dir = target - origin;
        if i % 3 == 0 {
            dir = dir.normalize();
        }
        rays.push(origin.to_array(), dir.to_array(), f32::MAX);
    }
    rays
}

#[test]
fn closed_meshes_have_no_cracks() {
    let mut rng = Rng(3);
    let mut star = Solid::icosphere(3);
    for v in &mut star.vertices {
        *v *= rng.range(1.0, 6.0) as f32;
    }
    let solids = [Solid::uv_sphere(24, 48), Solid::icosphere(4), star];
    for (k, solid) in solids.iter().enumerate() {
        let scene = Parts::of(solid.triangles()).scene(Accel::Bvh);
        let hits = best(&scene, &aimed(solid, 250_000, &mut rng));
        assert_eq!(misses(&hits), 0, "mesh {k}");
    }
    let solid = &solids[0];
    let turn = DQuat::from_xyzw(0.3, -0.2, 0.5, 0.7).normalize();
    let m = DAffine3::from_scale_rotation_translation(DVec3::ONE, turn, DVec3::ZERO);
    let parts = Parts {
        meshes: vec![solid.triangles()],
        instances: vec![(0, m)],
        ..Parts::default()
    };
    let mut turned = solid.clone();
    for v in &mut turned.vertices {
        *v = m.transform_point3(v.as_dvec3()).as_vec3();
    }
    let hits = best(&parts.scene(Accel::Bvh), &aimed(&turned, 250_000, &mut rng));
    assert_eq!(misses(&hits), 0, "instance");
}

#[test]
fn an_integer_grid_has_no_cracks() {
    let n = 32;
    let mut rng = Rng(4);
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let p = |x: i32, y: i32| Vec3::new((i + x) as f32, (j + y) as f32, 0.0);
            triangles.push([p(0, 0), p(1, 0), p(1, 1)]);
            triangles.push([p(0, 0), p(1, 1), p(0, 1)]);
        }
    }
    let mut rays = Rays::default();
    for i in 0..200_000 {
        let line = |rng: &mut Rng| rng.below(n as usize + 1) as f32;
        let free = |rng: &mut Rng| (rng.unit() * f64::from(n)) as f32;
        let x = if i % 2 == 0 {
            line(&mut rng)
        } else {
            free(&mut rng)
        };
        let y = if i % 4 < 2 {
            line(&mut rng)
        } else {
            free(&mut rng)
        };
        let zero = if i % 8 < 4 { 0.0 } else { -0.0 };
        rays.push([x, y, 10.0], [zero, zero, -1.0], f32::MAX);
    }
    // The quad whose diagonal a published test runs along.
    let s = 5.0;
    let quad = [[-s, -s], [s, -s], [s, s], [-s, s]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let diagonal = vec![[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]];
    let mut along = Rays::default();
    along.push(
        [0.0, 0.0, 10.0],
        [0.304_584_47, 0.304_584_47, -0.902_472_5],
        f32::MAX,
    );
    for accel in EVERY {
        assert_eq!(
            misses(&best(&Parts::of(triangles.clone()).scene(accel), &rays)),
            0
        );
        assert_eq!(
            misses(&best(&Parts::of(diagonal.clone()).scene(accel), &along)),
            0
        );
    }
}

#[test]
fn corners_and_planes_of_boxes_are_inside() {
    // Two triangles that fill the box's faces x = 0 and x = 1, met by rays that run in its planes, along its edges and
    // through its corners.
    let quad = |x: f32| {
        let p = |y: f32, z: f32| Vec3::new(x, y, z);
        [
            [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0)],
            [p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)],
        ]
    };
    let scene = Parts::of([quad(0.0), quad(1.0)].concat()).scene(Accel::Bvh);
    let mut rays = Rays::default();
    for y in [0.0, 0.5, 1.0] {
        for z in [0.0, 0.25, 1.0] {
            for zero in [0.0f32, -0.0] {
                rays.push([-1.0, y, z], [1.0, zero, -zero], f32::MAX);
                rays.push([2.0, y, z], [-1.0, zero, zero], f32::MAX);
                rays.push([-2.0, y, z], [1e-3, zero, zero], f32::MAX);
            }
        }
    }
    assert_eq!(misses(&best(&scene, &rays)), 0);
    // Corner rays: from anywhere to a vertex of a box that is a triangle's vertex too.
    let mut rng = Rng(10);
    for offset in [0.0, 1e2, 1e4] {
        let solid = {
            let mut s = Solid::icosphere(1);
            s.vertices
                .iter_mut()
                .for_each(|v| *v += Vec3::splat(offset));
            s
        };
        let scene = Parts::of(solid.triangles()).scene(Accel::Bvh);
        let mut rays = Rays::default();
        for _ in 0..20_000 {
            let target = solid.vertices[rng.below(solid.vertices.len())];
            let origin = Vec3::splat(offset) + Vec3::from(rng.in_cube(0.3));
            rays.push(origin.to_array(), (target - origin).to_array(), f32::MAX);
        }
        assert_eq!(misses(&best(&scene, &rays)), 0, "offset {offset}");
    }
}
