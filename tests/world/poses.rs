//! Poses against products of independent matrices, and against those of other frames.

use crate::stage::{build_at, options, scene, spawn};
use glam::DVec3;
use luxel::build::SceneBuilder;
use luxel::world::{self, Name, Pose};

fn pose_of(world: &hecs::World, name: &str) -> Pose {
    let mut query = world.query::<(&Name, &Pose)>();
    let found = query.iter().find(|(n, _)| n.0 == name).unwrap();
    *found.1
}

/// Row-major 4 × 4 matrices, written for this test alone.
type Matrix = [[f64; 4]; 4];

fn product(factors: &[Matrix]) -> Matrix {
    let mut all = shift([0.0; 3]);
    for factor in factors {
        let mut next = [[0.0; 4]; 4];
        for (i, row) in next.iter_mut().enumerate() {
            for (j, cell) in row.iter_mut().enumerate() {
                *cell = (0..4).map(|k| all[i][k] * factor[k][j]).sum();
            }
        }
        all = next;
    }
    all
}

fn shift([x, y, z]: [f64; 3]) -> Matrix {
    [
        [1.0, 0.0, 0.0, x],
        [0.0, 1.0, 0.0, y],
        [0.0, 0.0, 1.0, z],
        [0.0, 0.0, 0.0, 1.0],
    ]
}

fn stretch([x, y, z]: [f64; 3]) -> Matrix {
    let mut m = shift([0.0; 3]);
    (m[0][0], m[1][1], m[2][2]) = (x, y, z);
    m
}

/// Turns from axis `a` towards axis `b`.
fn turn(a: usize, b: usize, deg: f64) -> Matrix {
    let (s, c) = deg.to_radians().sin_cos();
    let mut m = shift([0.0; 3]);
    (m[a][a], m[a][b], m[b][a], m[b][b]) = (c, -s, s, c);
    m
}

fn assert_maps(pose: &Pose, expected: &Matrix) {
    for p in [[0.0; 3], [1.0, 0.0, 0.0], [0.3, -2.0, 5.0]] {
        let got = pose.affine().transform_point3(DVec3::from_array(p));
        for i in 0..3 {
            let want: f64 = (0..3).map(|k| expected[i][k] * p[k]).sum::<f64>() + expected[i][3];
            assert!(
                (got[i] - want).abs() < 1e-11,
                "{p:?}: {got:?}, {expected:?}"
            );
        }
    }
}

#[test]
fn poses_are_the_product_of_the_matrices_of_the_chain() {
    let mut spawned = spawn(&scene(
        r#"(name: "hub", transform: (translate: (1, 2, 3), rotate: Euler(10, 20, 30), scale: 2),
            spin: (axis: (0, 5, 0), deg_per_s: 36)),
           (name: "arm", parent: "hub", transform: (translate: (0.5, 0, -1), rotate: AxisAngle(axis: (0, 0, 0.1), deg: -75), scale: (1, 2, -3)),
            spin: (axis: (-2, 0, 0), deg_per_s: 12.5, pivot: (4, -1, 0.25))),
           (name: "leaf", parent: "arm", transform: (translate: (7, 8, 9), rotate: Quat(0, 0, 3e20, 3e20)))"#,
    ));
    for t in [0.0, 0.7, 13.25, 1e4] {
        world::pose(&mut spawned.world, t);
        let euler = product(&[turn(0, 1, 30.0), turn(2, 0, 20.0), turn(1, 2, 10.0)]);
        let hub = product(&[
            shift([1.0, 2.0, 3.0]),
            turn(2, 0, (36.0 * t) % 360.0),
            euler,
            stretch([2.0; 3]),
        ]);
        let arm = product(&[
            hub,
            shift([4.0, -1.0, 0.25]),
            turn(1, 2, -((12.5 * t) % 360.0)),
            shift([-4.0, 1.0, -0.25]),
            shift([0.5, 0.0, -1.0]),
            turn(0, 1, -75.0),
            stretch([1.0, 2.0, -3.0]),
        ]);
        let leaf = product(&[arm, shift([7.0, 8.0, 9.0]), turn(0, 1, 90.0)]);
        assert_maps(&pose_of(&spawned.world, "hub"), &hub);
        assert_maps(&pose_of(&spawned.world, "arm"), &arm);
        assert_maps(&pose_of(&spawned.world, "leaf"), &leaf);
    }
}

#[test]
fn a_full_turn_is_the_rest_pose_to_the_bit() {
    let text = scene(
        r#"(name: "hub", transform: (translate: (0.1, 0.2, 0.3)), spin: (axis: (1, 2, -3), deg_per_s: -90, pivot: (0.7, 0, 0))),
           (name: "cat", parent: "hub", shape: Mesh("tetra.obj"), transform: (translate: (3, 0, 0), rotate: Euler(1, 2, 3)),
            spin: (axis: (0.3, 0, 1), deg_per_s: 45))"#,
    );
    let mut spawned = spawn(&text);
    let rest = format!("{:?}", build_at(&mut spawned, 0.0).0);
    for t in [8.0, 80.0, 8e7, -16.0] {
        assert_eq!(
            rest,
            format!("{:?}", build_at(&mut spawned, t).0),
            "t = {t}"
        );
    }
    let turned = format!("{:?}", build_at(&mut spawned, 2.0).0);
    assert_ne!(rest, turned);
}

#[test]
fn frames_do_not_depend_on_the_frames_before() {
    let text = scene(
        r#"(shape: Mesh("tetra.obj"), spin: (axis: (1, 2, 3), deg_per_s: 50)),
           (shape: Mesh("tetra.obj"), transform: (translate: (4, 0, 0)), normals: Flat),
           (shape: Sphere(radius: 1), emissive: (radiance: (1, 1, 1)))"#,
    );
    let mut spawned = spawn(&text);
    let mut builder = SceneBuilder::new(&spawned.world, &spawned.assets, options());
    let mut at = |t: f64| {
        world::pose(&mut spawned.world, t);
        format!("{:?}", builder.build(&spawned.world, 0).0)
    };
    let (first, _, again) = (at(0.5), at(1.7), at(0.5));
    assert_eq!(first, again);
    assert_eq!(first, format!("{:?}", build_at(&mut spawn(&text), 0.5).0));
}
