//! Worlds and what is built of them: poses against independent matrices, invariances of the buffers to the bit.

#![allow(clippy::unwrap_used, reason = "a test may")]

use glam::{DVec3, Vec3};
use luxel::asset::AssetStore;
use luxel::build::{Accel, BuildOptions, BuildTimes, Quality, SceneBuilder, buffer_bytes};
use luxel::flat::{FlatScene, Fresnel, PixelFilter, Rebase, Scatter};
use luxel::world::{self, AuthoringIndex, Name, Pose, Spawned};
use std::path::{Path, PathBuf};

/// A lopsided tetrahedron with a seam: every corner has its own uv.
const TETRA: &str = "\
v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 3\n\
vt 0 0\nvt 1 0\nvt 0 1\nvt 0.25 0.75\n\
f 1/1 3/2 2/3\nf 1/4 2/2 4/3\nf 1/1 4/4 3/2\nf 2/3 3/1 4/4\n";

fn options() -> BuildOptions {
    BuildOptions {
        accel: Accel::Bvh,
        quality: Quality::Good,
        size: (64, 48),
        filter: PixelFilter::Box,
        background: [0.0; 3],
        uv_aov: true,
        fresnel: Fresnel::Exact,
        caustics: false,
    }
}

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("world");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Writes a file once, whole, whatever other tests do at the same time.
fn file(name: &str, text: &str) {
    let whole = folder().join(format!("{name}.{:?}", std::thread::current().id()));
    std::fs::write(&whole, text).unwrap();
    std::fs::rename(whole, folder().join(name)).unwrap();
}

fn try_spawn(text: &str) -> Result<Spawned, Vec<luxel::diag::Diagnostic>> {
    file("tetra.obj", TETRA);
    let (desc, _) = luxel::scene::parse(text, &folder().join("scene.ron")).unwrap();
    world::spawn(&desc, luxel::asset::Loader::new())
}

fn spawn(text: &str) -> Spawned {
    try_spawn(text).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// A scene around `entities`.
fn scene(entities: &str) -> String {
    format!(
        "Scene(version: 1, camera: (at: (0, 0, 8), look_at: (0, 0, 0)), materials: {{
            \"red\": Diffuse(color: Linear(0.8, 0.1, 0.1)), \"coat\": Plastic(), \"glass\": Glass(ior: 1.5) }},
        entities: [{entities}])"
    )
}

fn build_at(spawned: &mut Spawned, t: f64) -> (FlatScene, BuildTimes) {
    world::pose(&mut spawned.world, t);
    SceneBuilder::new(&spawned.world, &spawned.assets, options()).build(&spawned.world, 0)
}

fn build(text: &str) -> FlatScene {
    build_at(&mut spawn(text), 0.0).0
}

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

/// Triangles of the scene in scene units, from wherever they are stored, with the object they belong to.
fn triangles(scene: &FlatScene) -> Vec<(u32, [Vec3; 3])> {
    let vertices = |g: &luxel::flat::Geometry, prim: usize| {
        let place = g.triangles.place[prim] as usize;
        let block = &g.triangles.blocks[place / 8];
        assert_eq!(block.prim[place % 8] as usize, prim);
        block
            .v
            .map(|v| Vec3::from_array(v.map(|lanes| lanes[place % 8])))
    };
    let mut all = Vec::new();
    for (prim, object) in scene.world.shading.object.iter().enumerate() {
        all.push((object.0, vertices(&scene.world, prim)));
    }
    for instance in &scene.instances {
        let local = &scene.local[instance.geometry as usize];
        for prim in 0..local.triangles.place.len() {
            let v = vertices(local, prim).map(|p| {
                Vec3::from_array(
                    instance
                        .to_world
                        .map(|r| r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]),
                )
            });
            let v = if instance.mirrored {
                [v[0], v[2], v[1]]
            } else {
                v
            };
            all.push((instance.object.0, v));
        }
    }
    all.sort_by_key(|t| t.0);
    all
}

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
