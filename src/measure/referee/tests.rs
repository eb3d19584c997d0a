//! The referee against brute force; that it lets pass what is right, and that it sees what is planted.

use super::{Exact, Found, Referee, Verdict};
use crate::build::bvh::{Accel, Primitives, build};
use crate::math::{DVec3, Vec3};
use crate::measure::bench::{Random, RayKind, RaySets, Subject, meshes};
use crate::trace::{Hits, Isa, Rays, closest_hit, occluded};

/// Rays of a set.
const RAYS: usize = 2048;

fn ray(rays: &Rays, i: usize) -> [[f32; 3]; 2] {
    [&rays.origin, &rays.dir].map(|a| [a[0][i], a[1][i], a[2][i]])
}

fn found(hits: &Hits, i: usize) -> Option<Found> {
    (hits.prim[i] != Hits::NONE).then_some(Found {
        t: hits.t[i],
        prim: hits.prim[i],
    })
}

/// Möller and Trumbore (*Fast, Minimum Storage Ray/Triangle Intersection*, 1997) in f64: another formula than the
/// referee's.
fn moller_trumbore(v: &[Vec3; 3], [origin, dir]: [[f32; 3]; 2]) -> Option<f64> {
    let [v0, v1, v2] = v.map(|v| v.as_dvec3());
    let [o, d] = [origin, dir].map(|x| DVec3::from(x.map(f64::from)));
    let (e1, e2) = (v1 - v0, v2 - v0);
    let p = d.cross(e2);
    let det = e1.dot(p);
    let s = o - v0;
    let q = s.cross(e1);
    let [t, u, v] = [e2.dot(q) / det, s.dot(p) / det, d.dot(q) / det];
    (t > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some(t)
}

#[test]
fn it_agrees_with_brute_force() {
    let subject = meshes::ball(8);
    let referee = Referee::new(subject.primitives());
    let mut random = Random::new(1);
    let mut hits = 0;
    for _ in 0..2000 {
        let origin = random.point(DVec3::splat(-4.0), DVec3::splat(4.0));
        let ray = [origin, random.direction()].map(|x| x.as_vec3().to_array());
        let brute = (0u32..)
            .zip(&subject.triangles)
            .filter_map(|(prim, v)| Some((moller_trumbore(v, ray)?, prim)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let found = referee.trace(ray, f32::MAX).exact();
        assert_eq!(found.map(|e| e.prim), brute.map(|b| b.1), "{ray:?}");
        if let (Some(Exact { t, .. }), Some((brute, _))) = (found, brute) {
            assert!((t - brute).abs() < 1e-9, "{ray:?}: {t} {brute}");
            hits += 1;
        }
    }
    assert_eq!(hits, 2000, "the room is closed");
}

/// Verdicts on the kernels, in the order of [`Verdict`].
fn judged(subject: &Subject) -> [usize; 4] {
    let scene = subject.scene(build(&subject.primitives(), Accel::Bvh));
    let referee = Referee::new(subject.primitives());
    let sets = RaySets::new(subject, &scene, RAYS);
    let mut verdicts = [0; 4];
    for kind in RayKind::ALL {
        let rays = sets.of(kind);
        let (mut hits, mut blocked) = (Hits::default(), Vec::new());
        closest_hit(&scene, Isa::best(), rays, &mut hits);
        occluded(&scene, Isa::best(), rays, &mut blocked);
        for (i, &blocked) in blocked.iter().enumerate() {
            let traced = referee.trace(ray(rays, i), rays.t_max[i]);
            let closest = traced.judge(found(&hits, i));
            for verdict in [closest, traced.judge_occlusion(blocked)] {
                verdicts[verdict as usize] += 1;
            }
        }
    }
    verdicts
}

#[test]
fn the_kernels_are_never_wrong() {
    for subject in [
        meshes::ball(12),
        meshes::terrain(60),
        meshes::soup(5000),
        meshes::spheres(3000),
    ] {
        let [agree, ties, edges, wrong] = judged(&subject);
        println!("{agree} agree, {ties} ties, {edges} at edges, {wrong} wrong");
        assert_eq!(wrong, 0);
        assert!(agree > 4 * RAYS && ties + edges < RAYS / 100);
    }
}

/// Rays from inside the ball to points of its edges.
fn at_edges(subject: &Subject, count: usize) -> Rays {
    let mut random = Random::new(7);
    let mut rays = Rays::default();
    for _ in 0..count {
        // The last twelve triangles are the room's.
        let triangle = subject.triangles[random.below(subject.triangles.len() - 12)];
        let k = random.below(3);
        let [a, b] = [triangle[k], triangle[(k + 1) % 3]].map(Vec3::as_dvec3);
        let origin = random
            .point(DVec3::splat(-0.5), DVec3::splat(0.5))
            .as_vec3();
        let to = a + (b - a) * random.unit() - origin.as_dvec3();
        rays.push(
            origin.to_array(),
            to.normalize().as_vec3().to_array(),
            f32::MAX,
        );
    }
    rays
}

#[test]
fn planted_errors_are_seen() {
    let subject = meshes::ball(12);
    let scene = subject.scene(build(&subject.primitives(), Accel::Bvh));
    let referee = Referee::new(subject.primitives());
    let rays = at_edges(&subject, RAYS);
    let mut hits = Hits::default();
    closest_hit(&scene, Isa::best(), &rays, &mut hits);
    let mut edges = 0;
    for i in 0..rays.len() {
        let ray = ray(&rays, i);
        let traced = referee.trace(ray, f32::MAX);
        let judge = |found| traced.judge(found);
        let hit = found(&hits, i).expect("the ball is closed");
        let verdict = judge(Some(hit));
        assert_ne!(verdict, Verdict::Wrong, "{ray:?}");
        edges += usize::from(verdict == Verdict::Edge);
        // A crack, whatever lies behind it.
        assert_eq!(judge(None), Verdict::Wrong, "{ray:?}");
        let behind = [ray[0], ray[1]].map(Vec3::from);
        let beyond = behind[0] + (hit.t + 0.01) * behind[1];
        let next = referee
            .trace([beyond.to_array(), ray[1]], f32::MAX)
            .exact()
            .expect("the room is closed");
        let through = Found {
            t: (next.t + f64::from(hit.t) + 0.01) as f32,
            prim: next.prim,
        };
        assert_eq!(judge(Some(through)), Verdict::Wrong, "{ray:?}");
        // A t that is off, and a triangle that the ray does not meet.
        let off = Found {
            t: hit.t * 1.001,
            ..hit
        };
        assert_eq!(judge(Some(off)), Verdict::Wrong, "{ray:?}");
        let beside = Found {
            prim: subject.triangles.len() as u32 - 1 - hit.prim,
            ..hit
        };
        assert_eq!(judge(Some(beside)), Verdict::Wrong, "{ray:?}");
    }
    println!("{edges} at edges");
}

#[test]
fn rays_at_the_rim_of_a_surface_may_miss() {
    // A lone triangle: all its edges are rims.
    let triangles = [[
        Vec3::new(0.1, 0.2, 3.0),
        Vec3::new(1.3, 0.1, 3.5),
        Vec3::new(0.4, 0.9, 2.8),
    ]];
    let primitives = Primitives {
        triangles: &triangles,
        ..Primitives::default()
    };
    let referee = Referee::new(primitives);
    let mut random = Random::new(3);
    let mut edges = 0;
    for _ in 0..1000 {
        let [a, b] = [triangles[0][0], triangles[0][1]].map(Vec3::as_dvec3);
        let to = (a + (b - a) * random.range(0.1, 0.9))
            .normalize()
            .as_vec3()
            .to_array();
        let ray = [[0.0; 3], to];
        let verdict = referee.trace(ray, f32::MAX).judge(None);
        assert!(
            verdict == Verdict::Edge || verdict == Verdict::Agrees,
            "{verdict:?}"
        );
        edges += usize::from(verdict == Verdict::Edge);
        assert_ne!(
            referee.trace(ray, f32::MAX).judge_loosely(None),
            Verdict::Wrong
        );
    }
    assert!(edges > 300, "{edges}");
    let middle = (triangles[0][0] + triangles[0][1] + triangles[0][2])
        .normalize()
        .to_array();
    let ray = [[0.0; 3], middle];
    assert_eq!(referee.trace(ray, f32::MAX).judge(None), Verdict::Wrong);
    assert_eq!(
        referee.trace(ray, f32::MAX).judge_loosely(None),
        Verdict::Wrong
    );
    assert_eq!(
        referee.trace(ray, f32::MAX).judge_occlusion(true),
        Verdict::Agrees
    );
    assert_eq!(
        referee.trace(ray, 1.0).judge_occlusion(true),
        Verdict::Wrong
    );
    assert_eq!(
        referee.trace(ray, 1.0).judge_occlusion_loosely(true),
        Verdict::Wrong
    );
}

/// A miss at the middle of a fan of triangles, its rim given beside the ray and in depth.
fn missed_middle(rim: &[[f32; 3]]) -> Verdict {
    let middle = Vec3::new(0.1, 0.2, 3.0);
    let corner = |k: usize| middle + Vec3::from(rim[k % rim.len()]);
    let triangles: Vec<_> = (0..rim.len())
        .map(|k| [middle, corner(k), corner(k + 1)])
        .collect();
    let referee = Referee::new(Primitives {
        triangles: &triangles,
        ..Primitives::default()
    });
    let ray = [[0.0; 3], middle.normalize().to_array()];
    referee.trace(ray, f32::MAX).judge(None)
}

#[test]
fn rays_into_the_notch_of_a_saddle_may_miss() {
    // Left and right of the ray two triangles each, below it the narrow rest; between second and fifth, above, nothing: a
    // notch of 7 degrees, which lines aside pass by.
    let saddle = [
        [0.16, -1.0, 0.1],
        [-0.28, 1.0, 0.3],
        [0.21, -1.0, -0.2],
        [0.26, -1.0, 0.2],
        [-0.15, 1.0, -0.1],
        [0.22, -1.0, 0.3],
    ];
    assert_eq!(missed_middle(&saddle), Verdict::Edge);
    // Once around is a crack.
    let around = [0, 1, 4, 3].map(|k| saddle[k]);
    assert_eq!(missed_middle(&around), Verdict::Wrong);
}

#[test]
fn what_underflow_hides_is_doubtful() {
    // The upper edge lies at z = 2, and the ray passes it by 1.4e-45, which no product in f32 tells from nothing.
    let triangles = [[
        Vec3::new(3.0, 5.0, 2.0),
        Vec3::new(3.0, 4.0, 2.0),
        Vec3::new(3.0, 2.0, -1.0),
    ]];
    let referee = Referee::new(Primitives {
        triangles: &triangles,
        ..Primitives::default()
    });
    let ray = [[4.0, 5.0, 2.0], [-1.0, -0.5, 1e-45]];
    let traced = referee.trace(ray, f32::MAX);
    assert_eq!(traced.exact(), None);
    assert_eq!(traced.judge(None), Verdict::Agrees);
    let hit = Found { t: 1.0, prim: 0 };
    assert_eq!(traced.judge(Some(hit)), Verdict::Edge);
}

#[test]
fn a_plane_behind_a_doubtful_triangle_in_front_is_an_edge() {
    // The ray runs almost in the plane of a sliver whose box begins at t = 0.39, past one of its edges by less than
    // rounding; the plane itself it meets at t = -0.38.
    let triangles = [[
        Vec3::new(-0.565_630_85, -0.031_785_64, -0.291_039_02),
        Vec3::new(-0.427_824_14, 0.927_742_96, -0.536_628_37),
        Vec3::new(-0.549_600_3, 0.079_328_38, -0.319_664_57),
    ]];
    let primitives = Primitives {
        triangles: &triangles,
        ..Primitives::default()
    };
    let referee = Referee::new(primitives);
    let ray = [
        [-0.341_192_25, 0.208_238_2, -0.840_586_9],
        [-0.221_288_8, 0.726_348_3, 0.650_729_9],
    ];
    let traced = referee.trace(ray, f32::MAX);
    assert_eq!(traced.exact(), None);
    let hit = Found {
        t: 0.601_226_57,
        prim: 0,
    };
    assert_eq!(traced.judge(Some(hit)), Verdict::Edge);
    // Beyond its bound it stays wrong.
    let beyond = Found { t: 2.0, ..hit };
    assert_eq!(traced.judge(Some(beyond)), Verdict::Wrong);
}
