//! Rays that go one way walk as one: each hits what it hits by itself.

use crate::agree::{hostile_rays, mixed};
use crate::support::Rng;
use crate::{bits, ray, soup, trace};
use luxel::build::bvh::Accel;
use luxel::flat::{FlatScene, Spheres};
use luxel::trace::{Hits, Isa, Rays, occluded};

/// Fans of rays from points inside and outside, beams of parallel ones, and what leaves a place every way, in order; some of
/// them with a limit, some broken, and as many as fill no packet.
fn bundles(fans: usize) -> Rays {
    let mut rng = Rng(21);
    let mut rays = Rays::default();
    for fan in 0..fans {
        let (from, to) = (rng.in_cube(5.0), rng.in_cube(2.0));
        let axis = [0, 1, 2].map(|a| to[a] - from[a]);
        let spread = [0.0, 1e-3, 0.05, 0.3][fan % 4];
        let beam = fan % 3 == 0;
        for i in 0..61 {
            let off = rng.in_cube(spread).map(|x| x * 4.0);
            let [mut origin, mut dir] = [from, axis];
            for a in 0..3 {
                *(if beam { &mut origin[a] } else { &mut dir[a] }) += off[a];
            }
            if fan % 7 == 0 {
                dir = rng.direction();
            }
            match (fan % 11, i % 17) {
                (1, 3) => dir[i % 3] = 0.0,
                (2, 3) => dir[i % 3] = -0.0,
                (3, 3) => dir = [0.0; 3],
                (4, 3) => dir[i % 3] = f32::NAN,
                (5, 3) => origin[i % 3] = f32::INFINITY,
                _ => (),
            }
            let limit = match (fan % 5, i % 13) {
                (1, 2) => 0.0,
                (1, 3) => -1.0,
                (1, 4) => f32::NAN,
                (2, _) => rng.range(0.0, 3.0) as f32,
                _ => f32::MAX,
            };
            rays.push(origin, dir, limit);
        }
    }
    rays
}

/// Asserts that every instruction set gives the bits of one ray after the other, and that hits are of all kinds.
fn agree(scene: &FlatScene, rays: &mut Rays) {
    let alone = trace(scene, Isa::SCALAR, rays);
    let hit = |prim: &&u32| **prim != Hits::NONE;
    let kinds = [
        alone.prim.iter().filter(|p| !hit(p)).count(),
        alone
            .prim
            .iter()
            .filter(hit)
            .filter(|&&p| p & Spheres::TAG != 0)
            .count(),
        alone.instance.iter().filter(|&&i| i != Hits::WORLD).count(),
        alone
            .prim
            .iter()
            .filter(hit)
            .filter(|&&p| p & Spheres::TAG == 0)
            .count(),
    ];
    assert!(kinds.iter().all(|&n| n > 100), "{kinds:?}");
    for isa in Isa::all() {
        let together = bits(&trace(scene, isa, rays));
        for (i, (a, b)) in bits(&alone).iter().zip(&together).enumerate() {
            assert_eq!(a, b, "{isa:?} ray {i}: {:?}", ray(rays, i));
        }
    }
    for (i, &t) in alone.t.iter().enumerate() {
        match i % 4 {
            0 => rays.t_max[i] = t,
            1 => rays.t_max[i] = t.next_up(),
            2 => rays.t_max[i] = t.next_down(),
            _ => (),
        }
    }
    let [mut expected, mut blocked] = [Vec::new(), Vec::new()];
    occluded(scene, Isa::SCALAR, rays, &mut expected);
    let number = expected.iter().filter(|&&b| b).count();
    assert!(
        number > 100 && rays.len() - number > 100,
        "{number} blocked"
    );
    for isa in Isa::all() {
        occluded(scene, isa, rays, &mut blocked);
        for (i, (a, b)) in expected.iter().zip(&blocked).enumerate() {
            assert_eq!(a, b, "{isa:?} shadow ray {i}: {:?}", ray(rays, i));
        }
    }
}

#[test]
fn packets_hit_what_their_rays_hit() {
    let scene = mixed().scene(Accel::Bvh);
    agree(&scene, &mut bundles(400));
    // One packet's worth of broken rays among sound ones, and a batch that is one ray too long.
    agree(&scene, &mut {
        let mut rays = bundles(150);
        let hostile = hostile_rays(1001);
        for i in 0..hostile.len() {
            let [origin, dir] = ray(&hostile, i);
            rays.push(origin, dir, hostile.t_max[i]);
        }
        rays
    });
}

#[test]
fn packets_in_a_large_tree_hit_what_their_rays_hit() {
    let mut parts = mixed();
    parts
        .triangles
        .extend(soup(&mut Rng(22), 200_000, 3.0, 0.03));
    agree(&parts.scene(Accel::Bvh), &mut bundles(300));
}

#[test]
fn a_tree_of_one_kind_gives_the_same_bits() {
    let only = |keep: fn(&mut crate::support::Parts)| {
        let mut parts = mixed();
        keep(&mut parts);
        parts.scene(Accel::Bvh)
    };
    let scenes = [
        only(|p| {
            p.tree_spheres.clear();
            p.instances.clear();
        }),
        only(|p| {
            p.triangles.clear();
            p.groups.clear();
            p.instances.clear();
        }),
        only(|p| {
            p.triangles.clear();
            p.groups.clear();
            p.tree_spheres.clear();
        }),
    ];
    let rays = bundles(200);
    for scene in &scenes {
        let alone = bits(&trace(scene, Isa::SCALAR, &rays));
        for isa in Isa::all() {
            assert_eq!(alone, bits(&trace(scene, isa, &rays)), "{isa:?}");
        }
    }
}
