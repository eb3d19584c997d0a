//! What rays visit, counted: by a walk that finds what the kernels find, and as many as others count.

use crate::agree::{hostile_rays, mixed};
use crate::support::{Parts, Solid};
use crate::{EVERY, best, soup};
use luxel::build::bvh::Accel;
use luxel::measure::arms::{Counter, Tree};
use luxel::trace::{Hits, Isa, Rays, Visits, count_closest, count_occluded, occluded};
use std::sync::Arc;

const RAYS: usize = 4_001;

#[test]
fn the_counted_walk_finds_what_the_kernels_find() {
    let rays = hostile_rays(RAYS);
    for accel in EVERY {
        let scene = mixed().scene(accel);
        let mut hits = Hits::default();
        let visits = count_closest(&scene, &rays, &mut hits);
        let truth = best(&scene, &rays);
        for i in 0..rays.len() {
            let [found, truth] = [&hits, &truth].map(|h| (h.prim[i], h.instance[i]));
            assert_eq!(found, truth, "{accel:?}, ray {i}");
            if truth.0 != Hits::NONE {
                assert_eq!(
                    hits.t[i].to_bits(),
                    best(&scene, &rays.part(i..i + 1)).t[0].to_bits()
                );
            }
        }
        let (mut found, mut truth) = (Vec::new(), Vec::new());
        let shadows = count_occluded(&scene, &rays, &mut found);
        occluded(&scene, Isa::best(), &rays, &mut truth);
        assert_eq!(found, truth, "{accel:?}");
        assert!(shadows.nodes <= visits.nodes && shadows.primitives < visits.primitives);
        assert!(visits.instances > 0);
    }
}

/// Without a tree, a ray that meets the box of everything is tested against everything.
#[test]
fn without_a_tree_everything_is_visited() {
    let triangles = Solid::icosphere(2).triangles();
    let count = triangles.len() as u64;
    let scene = Parts::of(triangles).scene(Accel::Brute);
    let mut rays = Rays::default();
    let mut rng = crate::support::Rng(3);
    for _ in 0..100 {
        rays.push(rng.in_cube(0.1), rng.direction(), f32::MAX);
    }
    let visits = count_closest(&scene, &rays, &mut Hits::default());
    let all = Visits {
        rays: 100,
        nodes: 100,
        primitives: 100 * count,
        instances: 0,
    };
    assert_eq!(visits, all);
}

/// The rivals of `luxel bench` walk the same tree, but for which of two children comes first that a ray enters at once.
#[test]
fn rivals_count_the_same() {
    let mut rng = crate::support::Rng(4);
    let triangles = soup(&mut rng, 3000, 3.0, 0.3);
    let scene = Arc::new(Parts::of(triangles).scene(Accel::Bvh));
    let mut rays = Rays::default();
    for _ in 0..2000 {
        rays.push(rng.in_cube(4.0), rng.direction(), f32::MAX);
    }
    let counter = Counter::new(Tree::Bvh8, &scene);
    let near = |own: u64, other: u64| own.abs_diff(other) * 1000 <= own;
    let closest = count_closest(&scene, &rays, &mut Hits::default());
    let theirs = counter.count(&rays, false);
    assert!(closest.nodes > 2 * 2000, "{closest:?}");
    assert!(near(closest.nodes, theirs.nodes), "{closest:?} {theirs:?}");
    assert!(
        near(closest.primitives, theirs.primitives),
        "{closest:?} {theirs:?}"
    );
    let shadows = count_occluded(&scene, &rays, &mut Vec::new());
    let theirs = counter.count(&rays, true);
    assert!(shadows.nodes < closest.nodes);
    assert!(near(shadows.nodes, theirs.nodes), "{shadows:?} {theirs:?}");
    assert!(
        near(shadows.primitives, theirs.primitives),
        "{shadows:?} {theirs:?}"
    );
}
