//! In a tree too large for caches rays go together: they hit what each hits by itself.

use crate::agree::{hostile_rays, mixed};
use crate::support::Rng;
use crate::{bits, ray, soup, trace};
use luxel::build::bvh::Accel;
use luxel::flat::{FlatScene, Spheres};
use luxel::trace::{Hits, Isa, Rays, occluded};

/// The tree's bytes from which on rays go together.
const TOGETHER: usize = 8 << 20;

/// Everything of the other tests, and more small triangles than caches hold.
fn large() -> FlatScene {
    let mut parts = mixed();
    parts
        .triangles
        .extend(soup(&mut Rng(9), 400_000, 3.0, 0.03));
    parts.scene(Accel::Bvh)
}

fn rays() -> Rays {
    let mut rays = hostile_rays(20_003);
    let mut rng = Rng(10);
    for _ in 0..10_000 {
        rays.push(rng.in_cube(3.0), rng.direction(), f32::MAX);
    }
    rays
}

#[test]
fn rays_together_hit_what_each_hits() {
    let scene = large();
    let tree = size_of_val(&scene.world.bvh.nodes[..])
        + size_of_val(&scene.world.triangles.blocks[..])
        + size_of_val(&scene.spheres.blocks[..]);
    assert!(tree > TOGETHER, "{tree} bytes are too few");
    let mut rays = rays();
    let each = trace(&scene, Isa::SCALAR, &rays);
    let kinds = [
        each.prim.iter().filter(|&&p| p == Hits::NONE).count(),
        each.prim
            .iter()
            .filter(|&&p| p != Hits::NONE && p & Spheres::TAG != 0)
            .count(),
        each.instance.iter().filter(|&&i| i != Hits::WORLD).count(),
    ];
    assert!(kinds.iter().all(|&n| n > 300), "{kinds:?}");
    for isa in Isa::all() {
        let together = bits(&trace(&scene, isa, &rays));
        for (i, (a, b)) in bits(&each).iter().zip(&together).enumerate() {
            assert_eq!(a, b, "{isa:?} ray {i}: {:?}", ray(&rays, i));
        }
    }
    // Limits at, one step before and one step after the hits.
    for (i, &t) in each.t.iter().enumerate() {
        match i % 4 {
            0 => rays.t_max[i] = t,
            1 => rays.t_max[i] = t.next_up(),
            2 => rays.t_max[i] = t.next_down(),
            _ => {}
        }
    }
    let [mut expected, mut found] = [Vec::new(), Vec::new()];
    occluded(&scene, Isa::SCALAR, &rays, &mut expected);
    for isa in Isa::all() {
        occluded(&scene, isa, &rays, &mut found);
        assert_eq!(expected, found, "{isa:?}");
    }
}
