//! The traversal benchmark: its subjects and rays, its arms and its command.

use luxel::build::bvh::{Accel, build};
use luxel::flat::FlatScene;
use luxel::measure::bench::{LENGTH, RayKind, RaySets, Subject, meshes};
use luxel::trace::{Hits, Isa, Rays, closest_hit};
use std::collections::BTreeMap;

fn scene(subject: &Subject) -> FlatScene {
    subject.scene(build(&subject.primitives(), Accel::Bvh))
}

/// Triangles of every generator, sizes small.
fn subjects() -> [(&'static str, Subject, usize); 4] {
    [
        ("ball", meshes::ball(7), 20 * 49 + 12),
        ("terrain", meshes::terrain(21), 2 * 441),
        ("soup", meshes::soup(20_000), 20_000),
        ("spheres", meshes::spheres(300), 300),
    ]
}

#[test]
fn subjects_have_the_promised_size() {
    for (name, subject, count) in subjects() {
        let found = subject.triangles.len() + subject.spheres.len();
        assert_eq!(found, count, "{name}");
        let extent = f64::from((subject.object.max - subject.object.min).max_element());
        assert!(
            (0.8..1.25).contains(&(extent / LENGTH)),
            "{name} is {extent} long"
        );
    }
    let triangles = meshes::BALL_SIZES.map(|n| 20 * n.pow(2));
    assert_eq!(triangles, [2_880, 69_620, 1_310_720, 4_195_280]);
    assert_eq!(2 * meshes::TERRAIN_SIDE.pow(2), 4_193_408);
}

#[test]
fn a_ball_is_closed() {
    let ball = meshes::ball(9);
    let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    // Adding 0 makes −0 and 0 the same bits.
    let bits = |v: luxel::math::Vec3| v.to_array().map(|x| (x + 0.0).to_bits());
    for t in &ball.triangles {
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let [a, b] = [bits(t[a]), bits(t[b])];
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    assert_eq!(edges.len(), 3 * ball.triangles.len() / 2);
    // Once in either direction: neighbours agree which side is out.
    assert!(edges.values().all(|&n| n == 0));
}

#[test]
fn soup_is_thin() {
    for t in meshes::soup(100).triangles {
        let base = t[1] - t[0];
        let height = (t[2] - t[0]).cross(base).length() / base.length();
        let ratio = base.length() / height;
        assert!((39.0..41.0).contains(&ratio), "{ratio}");
    }
}

fn bits(rays: &Rays) -> Vec<[u32; 7]> {
    (0..rays.len())
        .map(|i| {
            let [o, d] = [&rays.origin, &rays.dir];
            let ray = [
                o[0][i],
                o[1][i],
                o[2][i],
                d[0][i],
                d[1][i],
                d[2][i],
                rays.t_max[i],
            ];
            ray.map(f32::to_bits)
        })
        .collect()
}

#[test]
fn rays_are_those_promised() {
    const COUNT: usize = 3000;
    for (name, subject, _) in subjects() {
        let scene = scene(&subject);
        let sets = RaySets::new(&subject, &scene, COUNT);
        let again = RaySets::new(&subject, &scene, COUNT);
        for kind in RayKind::ALL {
            let rays = bits(sets.of(kind));
            assert_eq!(rays, bits(again.of(kind)), "{name}, {kind}");
            assert!(rays.len() > COUNT / 16, "{name}, {kind}: {}", rays.len());
            for r in &rays {
                let length: f32 = r[3..6].iter().map(|&x| f32::from_bits(x).powi(2)).sum();
                assert!((length - 1.0).abs() < 1e-6, "{name}, {kind}");
            }
        }
        assert_eq!(sets.of(RayKind::Primary).len(), COUNT);
        assert_eq!(sets.of(RayKind::Random).len(), COUNT);
        let [mut diffuse, mut shuffled] =
            [RayKind::Diffuse, RayKind::Shuffled].map(|kind| bits(sets.of(kind)));
        assert_ne!(diffuse, shuffled, "{name}");
        diffuse.sort_unstable();
        shuffled.sort_unstable();
        assert_eq!(diffuse, shuffled, "{name}");
    }
}

#[test]
fn no_ray_leaves_the_room() {
    let ball = meshes::ball(7);
    let scene = scene(&ball);
    let sets = RaySets::new(&ball, &scene, 2000);
    // Shadow rays end at the lamp.
    for kind in RayKind::ALL.into_iter().filter(|kind| !kind.occlusion()) {
        let mut hits = Hits::default();
        closest_hit(&scene, Isa::best(), sets.of(kind), &mut hits);
        let misses = hits.prim.iter().filter(|&&prim| prim == Hits::NONE);
        assert_eq!(misses.count(), 0, "{kind}");
    }
}
