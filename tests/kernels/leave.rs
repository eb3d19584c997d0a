//! Rays that leave a surface by its hit's error bound do not meet it again.

use crate::support::leave::returns;
use crate::support::{Parts, Rng};
use luxel::build::bvh::Accel;
use luxel::math::{DAffine3, DQuat, DVec3, Vec3};
use luxel::trace::Rays;

#[test]
fn rays_that_leave_a_triangle_do_not_meet_it_again() {
    let mut rng = Rng(7);
    let mut total = 0;
    for case in 0..2000 {
        let [span, offset] = [
            rng.log(-6.0, 6.0),
            if case % 2 == 0 {
                0.0
            } else {
                rng.log(-3.0, 7.0)
            },
        ];
        let at = DVec3::from([(); 3].map(|()| offset * rng.range(-1.0, 1.0)));
        let v = [(); 3]
            .map(|()| (at + DVec3::from([(); 3].map(|()| span * rng.range(-1.0, 1.0)))).as_vec3());
        let scene = Parts::of(vec![v]).scene(Accel::Bvh);
        let toward = |rng: &mut Rng| {
            let [a, b] = [rng.unit() as f32, rng.unit() as f32];
            let (a, b) = if a + b > 1.0 {
                (1.0 - a, 1.0 - b)
            } else {
                (a, b)
            };
            v[0] + (v[1] - v[0]) * a + (v[2] - v[0]) * b
        };
        let mut rays = Rays::default();
        for _ in 0..40 {
            let d = Vec3::from(rng.direction());
            let distance = (span.abs() * rng.range(0.1, 10.0)) as f32;
            rays.push(
                (toward(&mut rng) - d * distance).to_array(),
                d.to_array(),
                f32::MAX,
            );
        }
        let (back, sent) = returns(&scene, &rays, &mut rng, 10);
        assert_eq!(back, 0, "case {case}: {v:?}");
        total += sent;
    }
    println!("{total} rays sent");
    assert!(total > 100_000);
}

#[test]
fn rays_that_leave_a_sphere_do_not_meet_it_again() {
    let mut rng = Rng(8);
    let mut total = 0;
    for k in -4..=8 {
        for case in 0..24 {
            let r = 10f64.powi(k);
            let away = [0.0, 1.0, 1e3][case % 3] * r;
            let center = rng.direction().map(|d| f64::from(d) * away);
            // Half of them pass near the scene's origin, as walls do.
            let center = if case % 2 == 0 {
                center
            } else {
                DVec3::from(rng.direction().map(f64::from))
                    .normalize()
                    .to_array()
                    .map(|d| d * r * 1.001)
            };
            let parts = match case % 4 {
                0 | 1 => Parts {
                    looped: vec![(center, r)],
                    ..Parts::default()
                },
                _ => Parts {
                    tree_spheres: vec![(center, r)],
                    ..Parts::default()
                },
            };
            let mut rays = Rays::default();
            for _ in 0..100 {
                let target =
                    DVec3::from(center) + DVec3::from(rng.direction().map(f64::from)) * r * 0.9;
                let d = DVec3::from(rng.direction().map(f64::from));
                let o = target - d * r * rng.range(0.0, 5.0);
                rays.push(
                    o.as_vec3().to_array(),
                    (target - o).normalize_or(d).as_vec3().to_array(),
                    f32::MAX,
                );
            }
            let (back, sent) = returns(&parts.scene(Accel::Bvh), &rays, &mut rng, 10);
            assert_eq!(back, 0, "r = {r}, case {case}");
            total += sent;
        }
    }
    println!("{total} rays sent");
    assert!(total > 100_000);
}

#[test]
fn rays_that_leave_an_instance_do_not_meet_it_again() {
    let mut rng = Rng(9);
    let mut total = 0;
    for case in 0..300 {
        let q = DQuat::from_xyzw(
            rng.range(-1.0, 1.0),
            rng.range(-1.0, 1.0),
            rng.range(-1.0, 1.0),
            0.5,
        )
        .normalize();
        let scale = DVec3::new(rng.log(-3.0, 3.0), rng.log(-3.0, 3.0), rng.log(-3.0, 3.0));
        let move_by = DVec3::new(rng.log(-3.0, 5.0), rng.log(-3.0, 5.0), rng.log(-3.0, 5.0));
        let m = DAffine3::from_scale_rotation_translation(scale, q, move_by);
        let v = [(); 3].map(|()| Vec3::from(rng.in_cube(1.0)));
        let parts = Parts {
            meshes: vec![vec![v]],
            instances: vec![(0, m)],
            ..Parts::default()
        };
        let scene = parts.scene(Accel::Bvh);
        let mut rays = Rays::default();
        for _ in 0..40 {
            let target = m
                .transform_point3(((v[0] + v[1] + v[2]) / 3.0).as_dvec3())
                .as_vec3();
            let d = Vec3::from(rng.direction());
            rays.push(
                (target - d * scale.abs().max_element() as f32).to_array(),
                d.to_array(),
                f32::MAX,
            );
        }
        let (back, sent) = returns(&scene, &rays, &mut rng, 20);
        assert_eq!(back, 0, "case {case}: {m:?}");
        total += sent;
    }
    println!("{total} rays sent");
    assert!(total > 100_000);
}
