//! Instances and mirrored meshes against flattened ones.

use crate::stage::{build, scene, triangles};
use glam::Vec3;

const TWO: [&str; 2] = [
    r#"(shape: Mesh("tetra.obj"), material: "red", transform: (translate: (1, 2, 0), rotate: Euler(10, 20, 30), scale: (1, -2, 3)))"#,
    r#"(shape: Mesh("tetra.obj"), transform: (translate: (-2, 0, 1), rotate: Euler(-40, 0, 7)), emissive: (radiance: (1, 1, 1)))"#,
];

#[test]
fn instances_stand_where_flattened_meshes_would() {
    let instanced = build(&scene(&TWO.join(",")));
    // Other normals: another geometry, so that neither is used twice.
    let apart = TWO[1].replace("transform", "normals: Flat, transform");
    let flat = build(&scene(&format!("{}, {apart}", TWO[0])));
    assert_eq!((instanced.instances.len(), instanced.local.len()), (2, 1));
    assert_eq!(
        (flat.instances.len(), flat.world.shading.object.len()),
        (0, 8)
    );
    assert_eq!(
        instanced
            .instances
            .iter()
            .map(|i| i.mirrored)
            .collect::<Vec<_>>(),
        [true, false]
    );
    let pairs = triangles(&instanced).into_iter().zip(triangles(&flat));
    for ((object, a), (other, b)) in pairs {
        assert_eq!(object, other);
        let [min, max] = instanced.instances[object as usize]
            .bounds
            .map(Vec3::from_array);
        for (a, b) in a.iter().zip(b) {
            assert!(a.distance(b) < 4e-7, "{a} {b}");
            assert!(a.cmpge(min).all() && a.cmple(max).all());
            assert!(b.cmpge(min).all() && b.cmple(max).all());
        }
    }
    // The box is tight but for the rounding it allows for.
    let all = triangles(&instanced);
    let highest = all
        .iter()
        .filter(|t| t.0 == 1)
        .flat_map(|t| t.1)
        .fold(-9f32, |m, v| m.max(v.y));
    assert!(instanced.instances[1].bounds[1][1] - highest < 2e-5);
    // The lamp is listed alike, triangle by triangle.
    assert_eq!(instanced.lights.len(), 4);
    assert!((instanced.lights.total() / flat.lights.total() - 1.0).abs() < 1e-6);
    let back = instanced.instances[0];
    for i in 0..3 {
        for j in 0..3 {
            let sum: f32 = (0..3)
                .map(|k| back.to_world[i][k] * back.to_local[k][j])
                .sum();
            assert!((sum - if i == j { 1.0 } else { 0.0 }).abs() < 1e-5);
        }
    }
}

/// Volume enclosed by triangles that are counter-clockwise from outside.
fn volume(triangles: &[(u32, [Vec3; 3])]) -> f32 {
    triangles
        .iter()
        .map(|(_, [a, b, c])| a.dot(b.cross(*c)) / 6.0)
        .sum()
}

#[test]
fn mirrored_meshes_keep_their_outside_and_their_corners() {
    let entity = |scale: &str| {
        format!(
            r#"(shape: Mesh("tetra.obj"), normals: Smooth(angle_deg: 0), transform: (scale: {scale}))"#
        )
    };
    let straight = build(&scene(&entity("(1, 1, 1)")));
    let mirrored = build(&scene(&entity("(-1, 1, 1)")));
    let volumes =
        [&straight, &mirrored].map(|s| volume(&triangles(s)) / (s.rebase.scale as f32).powi(3));
    assert!(
        volumes.iter().all(|v| (v - 1.0).abs() < 1e-5),
        "{volumes:?}"
    );
    for prim in 0..4 {
        for (k, source) in [0, 2, 1].into_iter().enumerate() {
            let (a, b) = (3 * prim + k, 3 * prim + source);
            let (m, s) = (&mirrored.world.shading, &straight.world.shading);
            assert_eq!(m.uvs[a], s.uvs[b]);
            let [x, y, z] = s.normals.corner[b];
            let mirror = Vec3::from_array(m.normals.corner[a]);
            assert!(mirror.distance(Vec3::new(-x, y, z)) < 1e-6);
        }
        let (_, [a, b, c]) = triangles(&mirrored)[prim];
        let normal = (b - a).cross(c - a).normalize();
        assert!(
            normal.distance(Vec3::from_array(
                mirrored.world.shading.normals.corner[3 * prim]
            )) < 1e-5
        );
    }
}
