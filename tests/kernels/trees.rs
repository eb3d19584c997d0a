//! The builder.

use crate::support::Rng;
use crate::{EVERY, soup};
use luxel::build::bvh::validate::validate;
use luxel::build::bvh::{Primitives, SphereItem, build, sphere_bounds};
use luxel::math::{Aabb, Vec3};

#[test]
fn trees_keep_their_promises() {
    let mut rng = Rng(12);
    let equal = vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 100_000];
    let spaced: Vec<[Vec3; 3]> = (0..240)
        .map(|i| 2f32.powi(i - 120))
        .map(|x| {
            [
                Vec3::splat(x),
                Vec3::splat(x * 1.1),
                Vec3::new(x, x, 1.1 * x),
            ]
        })
        .collect();
    let broken: Vec<[Vec3; 3]> = (0..99)
        .map(|i| {
            [
                Vec3::splat(if i % 3 == 0 { f32::NAN } else { i as f32 }),
                Vec3::X,
                Vec3::splat(f32::MAX),
            ]
        })
        .collect();
    let sets = [
        Vec::new(),
        equal[..1].to_vec(),
        equal,
        spaced,
        broken,
        soup(&mut rng, 30_000, 1.0, 0.02),
    ];
    let spheres: Vec<SphereItem> = (0..300)
        .map(|i| SphereItem {
            center: rng.in_cube(1.0).map(f64::from),
            radius: 10f64.powi(i as i32 % 5 - 4),
            prim: i,
        })
        .collect();
    let boxes: Vec<Aabb> = spheres
        .iter()
        .map(|s| sphere_bounds(s.center, s.radius))
        .collect();
    for triangles in &sets {
        for (s, i) in [(0, 0), (300, 0), (0, 100), (3, 2), (300, 100)] {
            for accel in EVERY {
                let half = triangles.len() as u32 / 2;
                let groups = [0..half, half..triangles.len() as u32];
                let p = Primitives {
                    triangles,
                    groups: &groups,
                    spheres: &spheres[..s],
                    instances: &boxes[..i],
                };
                let built = build(&p, accel);
                validate(&p, &built)
                    .unwrap_or_else(|e| panic!("{accel:?} {} {s} {i}: {e}", triangles.len()));
            }
        }
    }
}
