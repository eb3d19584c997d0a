//! Mirrors: a mesh under a negative scale is the mesh whose file says so, to the bit, and keeps its outside.

use crate::stage::{Stage, cube, obj, picture, points, trace, triple, turned};
use crate::support::{Rng, Solid};
use luxel::flat::FlatScene;
use luxel::math::{DVec3, Vec3};
use luxel::trace::{Hits, Rays, TraceOptions, hit_place, identity};

const MIRRORS: [[f64; 3]; 5] = [
    [-1.0, 1.0, 1.0],
    [1.0, -1.0, 1.0],
    [-1.0, -1.0, 1.0],
    [-1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
];

/// A glass mesh between a lamp and a wall; `more` belongs to its entity.
fn scene(file: &str, scale: [f64; 3], more: &str) -> String {
    format!(
        r#"camera: (at: (0.5, 1, 5), look_at: (0, 0, 0), vfov_deg: 40),
        materials: {{"glass": Glass(ior: 1.5), "wall": Diffuse(color: Linear(0.7, 0.6, 0.5))}},
        entities: [
            (shape: Mesh("{file}"), material: "glass", {more}
                transform: (rotate: Euler(10, 20, 30), scale: {})),
            (shape: Mesh("cube.obj"), normals: Flat, material: "wall",
                transform: (translate: (0.5, -2.5, -1), scale: (4, 1, 4))),
            (shape: Sphere(radius: 0.5), transform: (translate: (2, 3, 1)), emissive: (radiance: (20, 18, 16))),
        ]"#,
        triple(scale)
    )
}

/// A lopsided closed mesh, and the files of it and of what `scale` makes of it.
fn stage(name: &str, scale: [f64; 3]) -> Stage {
    let mut solid = Solid::icosphere(2);
    for (k, v) in (0..).zip(&mut solid.vertices) {
        *v *= 1.0 + 0.05 * ((k * 37 % 11) as f32 - 5.0) / 5.0;
        v.x += 0.25 * v.y;
    }
    let (corners, sides) = cube();
    let mirrored: Vec<DVec3> = points(&solid)
        .iter()
        .map(|v| *v * DVec3::from(scale))
        .collect();
    let faces = match scale.iter().product::<f64>() < 0.0 {
        true => turned(&solid.faces),
        false => solid.faces.clone(),
    };
    Stage::new(name)
        .file("mesh.obj", &obj(&points(&solid), &solid.faces))
        .file("twin.obj", &obj(&mirrored, &faces))
        .file("cube.obj", &obj(&corners, &sides))
}

#[test]
fn a_mirrored_mesh_is_its_twin_to_the_bit() {
    for (k, scale) in MIRRORS.into_iter().enumerate() {
        let stage = stage(&format!("mirrored_{k}"), scale);
        let options = TraceOptions::default();
        for more in ["normals: Flat,", "normals: Smooth(angle_deg: 80),"] {
            let of = |file, scale| {
                let flat = stage.flat(&scene(file, scale, more));
                assert!(flat.instances.is_empty());
                picture(&flat, 16, &options).rgb
            };
            let twin = of("twin.obj", [1.0; 3]);
            assert!(of("mesh.obj", scale) == twin, "{scale:?} {more}");
            if k == 0 {
                assert!(of("mesh.obj", [1.0; 3]) != twin, "the mesh is lopsided");
            }
        }
    }
}

/// A ball of glass is the same whichever way it is turned over.
#[test]
fn a_mirrored_sphere_is_itself() {
    let of = |scale: f64| {
        let body = format!(
            r#"camera: (at: (0, 0.5, 4), look_at: (0, 0, 0)), materials: {{"glass": Glass(ior: 1.5)}},
            entities: [(shape: Sphere(radius: 1), material: "glass", transform: (scale: {scale:?}))]"#
        );
        let flat = Stage::new("mirrored_sphere").flat(&body);
        picture(&flat, 16, &TraceOptions::default()).rgb
    };
    assert!(of(-1.0) == of(1.0));
}

/// What a mirrored instance is hit by: the triangles of its flattened twin, from the same side.
#[test]
fn a_mirrored_instance_keeps_its_outside() {
    let spin = "normals: Flat, spin: (axis: (0, 1, 0), deg_per_s: 90),";
    let mut rng = Rng(5);
    for (k, scale) in MIRRORS.into_iter().enumerate() {
        let stage = stage(&format!("mirrored_instance_{k}"), scale);
        let placed = stage.flat(&scene("mesh.obj", scale, spin));
        let flat = stage.flat(&scene("mesh.obj", scale, "normals: Flat,"));
        assert_eq!(placed.instances.len(), 1);
        assert_eq!(placed.rebase, flat.rebase);
        let (mut rays, size) = (Rays::default(), flat.rebase.scale);
        let middle = DVec3::from(flat.rebase.origin) * -size;
        for _ in 0..20_000 {
            let at = |half: f64, rng: &mut Rng| {
                middle + DVec3::from(rng.in_cube(1.0).map(f64::from)) * half * size
            };
            let (from, to) = (at(4.0, &mut rng), at(1.0, &mut rng));
            rays.push(
                from.as_vec3().to_array(),
                (to - from).as_vec3().to_array(),
                f32::MAX,
            );
        }
        let [a, b] = [&placed, &flat].map(|scene| sides(scene, &rays));
        let differ = a.iter().zip(&b).filter(|(a, b)| a != b).count();
        let hits = a.iter().flatten().count();
        assert!(hits > 5000, "{hits}");
        // Rays within rounding of an edge.
        assert!(differ <= 2, "{scale:?}: {differ} of {hits} hits differ");
    }
}

/// Entity, triangle and side of every hit.
fn sides(scene: &FlatScene, rays: &Rays) -> Vec<Option<(u32, u32, bool)>> {
    let hits = trace(scene, rays);
    let side = |i: usize| {
        let (prim, instance) = (hits.prim[i], hits.instance[i]);
        (prim != Hits::NONE).then(|| {
            let (triangle, entity) = identity(scene, prim, instance);
            let [_, ng] = hit_place(scene, rays, &hits, i);
            let d = Vec3::new(rays.dir[0][i], rays.dir[1][i], rays.dir[2][i]);
            (entity, triangle, d.dot(Vec3::from(ng)) < 0.0)
        })
    };
    (0..rays.len()).map(side).collect()
}
