//! The builder.

use crate::support::{Parts, Rng, Solid};
use crate::{EVERY, best, bits, soup};
use luxel::build::bvh::validate::validate;
use luxel::build::bvh::{
    Accel, Built, Primitives, Quality, SphereItem, build, build_with, sphere_bounds,
};
use luxel::flat::LinearNode;
use luxel::math::{Aabb, Vec3};
use luxel::trace::Rays;

const BOTH: [Quality; 2] = [Quality::Good, Quality::Fast];

/// Triangles that a builder could stumble over.
fn degenerate() -> Vec<(&'static str, Vec<[Vec3; 3]>)> {
    let mut rng = Rng(12);
    let at = |x: Vec3, size: f32| [x, x + size * Vec3::X, x + size * Vec3::Y];
    let numbered = |n: usize, f: &dyn Fn(f32) -> [Vec3; 3]| (0..n).map(|i| f(i as f32)).collect();
    vec![
        ("none", Vec::new()),
        ("one", vec![at(Vec3::ZERO, 1.0)]),
        ("two", numbered(2, &|i| at(Vec3::splat(i), 1.0))),
        ("a block", numbered(8, &|i| at(Vec3::splat(i), 0.5))),
        ("equal", vec![at(Vec3::ZERO, 1.0); 20_000]),
        // Centres of 0 in x and y, whatever the size.
        (
            "concentric",
            numbered(5000, &|i| {
                [[-i, -i, 0.0], [i, -i, 0.0], [0.0, i, 0.0]].map(Vec3::from)
            }),
        ),
        (
            "spaced exponentially",
            (-126..127)
                .map(|e| at(Vec3::splat(2f32.powi(e)), 2f32.powi(e - 3)))
                .collect(),
        ),
        (
            "not finite",
            numbered(999, &|i| {
                let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, i];
                [Vec3::splat(odd[i as usize % 4]), Vec3::X, Vec3::Y]
            }),
        ),
        (
            "huge",
            numbered(999, &|i| {
                [Vec3::splat(i), Vec3::X, Vec3::splat(f32::MAX - i * 1e35)]
            }),
        ),
        ("in a line", numbered(5000, &|i| [i * Vec3::X; 3])),
        (
            "in a plane",
            soup(&mut rng, 5000, 1.0, 0.1)
                .iter()
                .map(|t| t.map(|v| v.with_z(3.0)))
                .collect(),
        ),
        (
            "tiny",
            soup(&mut rng, 5000, 1.0, 0.1)
                .iter()
                .map(|t| t.map(|v| v * 1e-38))
                .collect(),
        ),
        ("soup", soup(&mut rng, 20_000, 1.0, 0.02)),
    ]
}

fn spheres() -> Vec<SphereItem> {
    let mut rng = Rng(13);
    let sphere = |i: u32| SphereItem {
        center: rng.in_cube(1.0).map(f64::from),
        radius: 10f64.powi(i as i32 % 5 - 4),
        prim: i,
    };
    (0..300).map(sphere).collect()
}

#[test]
fn trees_keep_their_promises() {
    let spheres = spheres();
    let boxes: Vec<Aabb> = spheres
        .iter()
        .map(|s| sphere_bounds(s.center, s.radius))
        .collect();
    for (name, triangles) in &degenerate() {
        for (s, i) in [(0, 0), (300, 0), (0, 100), (3, 2), (300, 100)] {
            let half = triangles.len() as u32 / 2;
            let groups = [0..half, half..triangles.len() as u32];
            let p = Primitives {
                triangles,
                groups: &groups,
                spheres: &spheres[..s],
                instances: &boxes[..i],
            };
            for accel in EVERY {
                for quality in BOTH {
                    let built = build_with(&p, accel, quality);
                    validate(&p, &built)
                        .unwrap_or_else(|e| panic!("{name} {accel:?} {quality:?} {s} {i}: {e}"));
                }
            }
        }
    }
}

#[test]
fn a_million_equal_triangles_are_no_deep_tree() {
    let triangles = vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 1_000_000];
    let p = Primitives {
        triangles: &triangles,
        ..Primitives::default()
    };
    for quality in BOTH {
        let built = build_with(&p, Accel::Bvh, quality);
        validate(&p, &built).unwrap_or_else(|e| panic!("{quality:?}: {e}"));
        assert!(built.bvh.depth <= 8, "{quality:?} {}", built.bvh.depth);
    }
}

/// Everything of a tree but boxes of nothing, as numbers that can be compared.
fn everything(built: &Built) -> Vec<u32> {
    let node = |n: &LinearNode| {
        let planes = n.planes.iter().flatten().map(|x| x.to_bits());
        planes.chain(n.child).collect::<Vec<u32>>()
    };
    let nodes = built.bvh.nodes.iter().flat_map(node);
    let prims = built.triangles.blocks.iter().flat_map(|b| b.prim);
    let places = built.triangles.place.iter().copied();
    nodes.chain(prims).chain(places).collect()
}

#[test]
fn threads_change_nothing() {
    // Large enough that ranges are shared and that subtrees are tasks.
    let triangles = soup(&mut Rng(14), 150_000, 1.0, 0.02);
    let p = Primitives {
        triangles: &triangles,
        ..Primitives::default()
    };
    for quality in BOTH {
        let by = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let pool = pool.expect("threads");
            everything(&pool.install(|| build_with(&p, Accel::Bvh, quality)))
        };
        let one = by(1);
        assert!(one == by(2) && one == by(5), "{quality:?}");
    }
}

#[test]
fn a_fast_tree_finds_the_same_bits() {
    let mut rng = Rng(15);
    let mut triangles = Solid::icosphere(5).triangles();
    triangles.extend(soup(&mut rng, 3000, 1.5, 0.3));
    // More in one place than a node holds.
    triangles.extend(vec![triangles[7]; 500]);
    let mut rays = Rays::default();
    for _ in 0..4096 {
        let origin = Vec3::from(rng.in_cube(2.0));
        rays.push(origin.to_array(), rng.direction(), f32::MAX);
    }
    let mut scene = Parts::of(triangles.clone()).scene(Accel::Bvh);
    let good = bits(&best(&scene, &rays));
    let p = Primitives {
        triangles: &triangles,
        ..Primitives::default()
    };
    let built = build_with(&p, Accel::Bvh, Quality::Fast);
    assert_ne!(built.bvh.nodes.len(), scene.world.bvh.nodes.len());
    scene.world.bvh = built.bvh;
    scene.world.triangles = built.triangles;
    assert!(bits(&best(&scene, &rays)) == good);
}

/// Boxes that a ray of the root meets are what the heuristic counts; the fast mode may cost a third more.
#[test]
fn trees_are_as_good_as_they_are_said_to_be() {
    let cost = |triangles: &[[Vec3; 3]], quality| {
        let p = Primitives {
            triangles,
            ..Primitives::default()
        };
        build_with(&p, Accel::Bvh, quality).cost
    };
    let ball = Solid::icosphere(6).triangles();
    let thin = soup(&mut Rng(16), 20_000, 1.0, 0.05);
    for (name, triangles, most) in [("ball", &ball, 8.0), ("soup", &thin, 30.0)] {
        let [good, fast] = BOTH.map(|quality| cost(triangles, quality));
        assert!(good < most, "{name}: {good}");
        assert!(good < fast && fast < 1.35 * good, "{name}: {good} {fast}");
    }
    let all = Primitives {
        triangles: &ball,
        ..Primitives::default()
    };
    assert!(build(&all, Accel::Brute).cost > 1000.0);
}
