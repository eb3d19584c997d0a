//! What of the entities reaches the flat scene, and what is said of files that cannot.

use crate::stage::{build, file, options, scene, triangles, try_spawn};
use glam::Vec3;
use luxel::asset::AssetStore;
use luxel::build::{SceneBuilder, buffer_bytes};
use luxel::flat::Scatter;

#[test]
fn materials_lights_and_needs_follow_the_entities() {
    let scene = build(&scene(
        r#"(shape: Sphere(radius: 1), emissive: (radiance: (3, 0, 0))),
           (shape: Sphere(radius: 1), material: "coat"),
           (shape: Sphere(radius: 2), material: "coat", emissive: (radiance: (0, 3, 0))),
           (shape: Mesh("tetra.obj")),
           (shape: Sphere(radius: 1), material: "glass", transform: (scale: -2))"#,
    ));
    let scatters: Vec<Scatter> = scene.materials.iter().map(|m| m.scatter).collect();
    use Scatter::{Diffuse, Glass, Nothing, Plastic};
    assert_eq!(scatters, [Nothing, Plastic, Plastic, Glass, Diffuse]);
    assert!((scene.materials[1].internal_reflectance - 0.596_345_7).abs() < 1e-6);
    assert_eq!(scene.lights.spheres, [0, 2]);
    let [first, total] = scene.lights.cumulative[..] else {
        panic!()
    };
    assert_eq!(total, 5.0 * first);
    let r = scene.spheres.radius(0);
    assert!((first - 4.0 * std::f64::consts::PI * r * r).abs() < 1e-12);
    assert_eq!(scene.spheres.radius(3), 2.0 * r);
    let needs = scene.needs;
    assert!(
        needs.triangles && needs.looped_spheres && needs.lights && needs.plastic && needs.glass
    );
    assert!(
        !needs.tree_spheres && !needs.instances && !needs.mirror && !needs.metal && !needs.lens
    );
    let bytes: usize = buffer_bytes(&scene).iter().map(|b| b.bytes).sum();
    assert!(bytes > 4 * 3 * 3 * 4);
}

#[test]
fn many_spheres_enter_the_tree_and_walls_do_not() {
    let mut entities =
        r#"(shape: Sphere(radius: 1e4), transform: (translate: (0, -1e4, 0))),"#.to_owned();
    for i in 0..16 {
        entities +=
            &format!("(shape: Sphere(radius: 0.25), transform: (translate: ({i}, 0.25, 0))),");
    }
    let scene = build(&scene(&entities));
    let prims = |blocks: &[luxel::flat::SphereBlock]| {
        let mut prims: Vec<u32> = blocks
            .iter()
            .flat_map(|b| b.prim)
            .filter(|p| *p != u32::MAX)
            .collect();
        prims.sort();
        prims
    };
    assert_eq!(prims(&scene.spheres.looped), [0]);
    assert_eq!(prims(&scene.spheres.blocks), (1..17).collect::<Vec<_>>());
    assert!(scene.needs.tree_spheres && scene.needs.looped_spheres);
}

#[test]
fn a_mesh_scaled_to_almost_nothing_is_flattened_and_finite() {
    let scene = build(&scene(
        r#"(shape: Mesh("tetra.obj"), transform: (scale: (1e-90, 1, 1))),
           (shape: Mesh("tetra.obj"), transform: (scale: (1e-90, 1e-90, 1), translate: (1, 0, 0)))"#,
    ));
    assert!(scene.instances.is_empty());
    assert_eq!(scene.world.triangles.place.len(), 8);
    assert!(
        triangles(&scene)
            .iter()
            .flat_map(|t| t.1)
            .all(Vec3::is_finite)
    );
    let normals = &scene.world.shading.normals.corner;
    assert!(
        normals
            .iter()
            .all(|n| (Vec3::from_array(*n).length() - 1.0).abs() < 1e-5)
    );
}

#[test]
fn errors_of_files_come_at_once_with_their_places() {
    file("broken.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
    file("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    file("red.png", "this is not a png");
    let text = r#"Scene(version: 1, camera: (at: (0, 0, 8), look_at: (0, 0, 0)),
    materials: { "skin": Diffuse(color: Texture("red.png")) },
    entities: [
        (shape: Mesh("missing.obj")),
        (shape: Mesh("broken.obj")),
        (shape: Mesh("bare.obj"), material: "skin"),
        (parent: "far", shape: Sphere(radius: 1e150), transform: (scale: 1e150)),
        (name: "far", transform: (scale: 1e150)),
    ])"#;
    let errors = match try_spawn(text) {
        Err(errors) => errors,
        Ok(_) => panic!("spawned"),
    };
    let shown: Vec<String> = errors.iter().map(ToString::to_string).collect();
    let lines: Vec<u32> = errors
        .iter()
        .map(|e| e.span.as_ref().unwrap().line)
        .collect();
    assert_eq!(lines, [2, 4, 3, 6, 7], "{shown:#?}");
    assert!(
        shown[1].contains("scene.ron:4:22") && shown[1].contains("missing.obj"),
        "{shown:#?}"
    );
    assert!(
        shown[2].contains("broken.obj:3") && shown[2].contains("scene.ron:5:22"),
        "{shown:#?}"
    );
    assert!(shown[3].contains("no texture coordinates"));
}

#[test]
fn the_store_and_an_empty_world_build_something() {
    let (scene, _) = SceneBuilder::new(&hecs::World::new(), &AssetStore::default(), options())
        .build(&hecs::World::new(), 3);
    assert_eq!((scene.frame, scene.needs.triangles), (3, false));
    assert_eq!(scene.camera.forward, [0.0, 0.0, -1.0]);
}
