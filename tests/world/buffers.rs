//! What changes no bit of the buffers: storage order, powers of two, steps of the grid, walls.

use crate::stage::{build, build_at, scene, spawn};
use luxel::flat::{FlatScene, Rebase};
use luxel::world::{AuthoringIndex, Name};

/// The same entities in a world whose archetypes and rows have another order.
fn shuffled(world: &hecs::World) -> hecs::World {
    use luxel::world::{Camera, Emissive, Material, Parent, Shape, Spin, Transform};
    let mut old: Vec<hecs::Entity> = world.iter().map(|e| e.entity()).collect();
    old.reverse();
    let mut other = hecs::World::new();
    // Ids are given from the other end, with a gap.
    let gone = other.spawn((Name("gone".into()),));
    let new: Vec<hecs::Entity> = old.iter().map(|_| other.spawn((0u8,))).collect();
    other.despawn(gone).unwrap();
    let renamed = |e: hecs::Entity| new[old.iter().position(|o| *o == e).unwrap()];
    for (from, to) in old.iter().zip(&new) {
        let from = world.entity(*from).unwrap();
        macro_rules! copy {
            ($($kind:ty),*) => {$(
                if let Some(c) = from.get::<&$kind>() { other.insert_one(*to, (*c).clone()).unwrap(); }
            )*};
        }
        copy!(
            Spin,
            Emissive,
            Material,
            Shape,
            Camera,
            Transform,
            AuthoringIndex
        );
        if let Some(parent) = from.get::<&Parent>() {
            other.insert_one(*to, Parent(renamed(parent.0))).unwrap();
        }
    }
    other
}

#[test]
fn storage_order_does_not_reach_the_buffers() {
    let text = scene(
        r#"(name: "hub", transform: (rotate: Euler(0, 30, 0)), spin: (axis: (0, 1, 0), deg_per_s: 10)),
           (parent: "hub", shape: Mesh("tetra.obj"), material: "red"),
           (parent: "hub", shape: Sphere(radius: 0.5), material: "coat", transform: (translate: (2, 0, 0))),
           (shape: Mesh("tetra.obj"), normals: Flat, transform: (translate: (-3, 0, 0)), emissive: (radiance: (1, 2, 3))),
           (shape: Sphere(radius: 0.25), emissive: (radiance: (9, 9, 9)), transform: (translate: (0, 3, 0)))"#,
    );
    let mut spawned = spawn(&text);
    let straight = format!("{:?}", build_at(&mut spawned, 0.4).0);
    spawned.world = shuffled(&spawned.world);
    assert_eq!(straight, format!("{:?}", build_at(&mut spawned, 0.4).0));
}

/// A scene of walls, instances, children and flattened meshes, scaled by `k` and then moved by `by`.
fn moved(k: f64, by: f64) -> String {
    let at =
        |x: f64, y: f64, z: f64| format!("({:?}, {:?}, {:?})", x * k + by, y * k - by, z * k + by);
    let of = |x: f64, y: f64, z: f64| format!("({:?}, {:?}, {:?})", x * k, y * k, z * k);
    let [camera, target, a, b, wall, lamp] = [
        at(0.0, 1.0, 8.0),
        at(0.25, 0.0, 0.0),
        at(1.5, -2.0, 0.5),
        at(-3.0, 1.0, 0.0),
        at(0.0, -512.0, 0.0),
        at(0.0, 6.0, 2.0),
    ];
    let (arm, pivot) = (of(0.7, 0.1, -0.3), of(0.3, 0.0, 0.0));
    let (eighth, size) = (0.125 * k, 0.3 * k);
    let entities = format!(
        r#"(name: "hub", transform: (translate: {a}, rotate: Euler(10, 20, 30)), spin: (axis: (1, 1, 0), deg_per_s: 77)),
           (parent: "hub", shape: Mesh("tetra.obj"), transform: (translate: {arm}, scale: {k:?}), spin: (axis: (0, 0, 1), deg_per_s: 5, pivot: {pivot})),
           (shape: Mesh("tetra.obj"), normals: Flat, transform: (translate: {b}, rotate: Euler(0, 45, 5), scale: ({k:?}, {size:?}, {k:?}))),
           (shape: Sphere(radius: {:?}), transform: (translate: {wall}), material: "red"),
           (shape: Sphere(radius: {eighth:?}), transform: (translate: {lamp}), emissive: (radiance: (4, 4, 4)))"#,
        500.0 * k
    );
    scene(&entities).replace(
        "camera: (at: (0, 0, 8), look_at: (0, 0, 0))",
        &format!("camera: (at: {camera}, look_at: {target}, lens: (aperture_radius: {eighth:?}, focus_distance: {k:?}))"),
    )
}

/// Every buffer as text, without the rebase; a float's text tells its bits.
fn buffers(mut scene: FlatScene) -> String {
    scene.rebase = Rebase {
        origin: [0.0; 3],
        scale: 1.0,
    };
    format!("{scene:?}")
}

#[test]
fn powers_of_two_and_grid_steps_change_no_bit() {
    let at = |k, by| build_at(&mut spawn(&moved(k, by)), 1.25).0;
    let here = at(1.0, 0.0);
    let step = 1.0 / here.rebase.scale / f64::from(1 << 20);
    let here = buffers(here);
    for k in [1.0 / 1024.0, 2.0, 1_073_741_824.0] {
        assert!(here == buffers(at(k, 0.0)), "scaled by {k}");
    }
    for steps in [1.0, 3.0, 12345.0, 1_048_577.0, -9_999_999.0] {
        assert!(
            here == buffers(at(1.0, steps * step)),
            "moved by {steps} steps"
        );
    }
    assert!(here != buffers(at(1.0, 0.1 * step)), "this test can fail");
}

#[test]
fn walls_do_not_widen_the_scene() {
    let ball = r#"(shape: Sphere(radius: 1))"#;
    let with = |wall: &str| build(&scene(&format!("{ball}{wall}"))).rebase;
    let alone = with("");
    // 9 from the eye to the far side of the ball: within 16 by the next power of two.
    assert_eq!(alone.scale, 1.0 / 16.0);
    for radius in ["1e3", "1e6", "1e8"] {
        let wall = format!(
            r#", (shape: Sphere(radius: {radius}), transform: (translate: (0, -{radius}, 0)))"#
        );
        assert_eq!(with(&wall), alone);
    }
    let room = r#", (shape: Sphere(radius: 60), transform: (translate: (0, -61, 0)))"#;
    assert_eq!(with(room).scale, 1.0 / 128.0);
    let only = build(
        "Scene(version: 1, camera: (at: (0, 0, 8), look_at: (0, 0, 0)), entities: [(shape: Sphere(radius: 1e8))])",
    );
    assert_eq!(only.rebase.scale, 1.0 / 268_435_456.0);
}

/// A wall is as large as its radius, and what stands on it feels the last bits of where its centre is.
#[test]
fn centres_of_walls_keep_the_bits_of_f64() {
    for center in [-1e3 / 3.0, -1e6 / 3.0, 1e8 / 7.0] {
        let built = build(&scene(&format!(
            "(shape: Sphere(radius: 1)), (shape: Sphere(radius: {center:?}), transform: (translate: (0.1, {center:?}, 0)))"
        ).replace("radius: -", "radius: ")));
        let Rebase { origin, scale } = built.rebase;
        for (axis, authored) in [0.1, center, 0.0].into_iter().enumerate() {
            let want = (authored - origin[axis]) * scale;
            let error = (built.spheres.center(1)[axis] - want).abs();
            assert!(
                error <= 4e-16 * want.abs(),
                "{center}: {error} on axis {axis}"
            );
        }
    }
}
