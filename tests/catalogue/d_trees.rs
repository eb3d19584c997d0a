//! D: trees. What they cull is what no ray meets, whatever the tree, the layout and the instruction set.

use crate::book::{Outcome, items};
use crate::scenes::{rays_at, twenty};
use crate::support::shoot::{best, misses, ray, trace};
use crate::support::{Parts, Rng, Solid};
use luxel::build::bvh::{Accel, Primitives, Quality};
use luxel::flat::FlatScene;
use luxel::math::Vec3;
use luxel::measure::arms::{self, Counter, Layout, Tree};
use luxel::measure::referee::{Found, Referee, Verdict};
use luxel::trace::{Hits, Isa, Rays, occluded};
use std::sync::Arc;
use std::time::Instant;

items! {
    d1_corners(1e5, 1e7): "D1", "rays at corners and edges that flat boxes share, every instruction set, sizes 1e±6, offsets to 1e6 sizes: misses";
    d2_zeros(1e5, 4e6): "D2", "directions of 0, -0 and subnormal components, origins in planes and corners of boxes: wrong by the f64 referee, or not as without a tree";
    d3_equality(2e4, 2e7): "D3", "twenty scenes, every tree and layout against no tree: another primitive or other bits of t, or another answer of occlusion";
    d4_order(4e4, 4e6): "D4", "twenty scenes, primitives shuffled: other bits of t";
    d6_bad_rays(2e4, 2e6): "D6", "rays that are not finite, have no direction or no positive end: a hit, or NaN";
}

const BATCH: usize = 4096;

/// A cube's surface in `n` × `n` squares a side, corners at integers, closed.
fn boxes(n: i32) -> Solid {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [0, n] {
            let mut p = |i: i32, j: i32| {
                let mut v = [0; 3];
                [v[axis], v[(axis + 1) % 3], v[(axis + 2) % 3]] = [side, i, j];
                vertices.push(Vec3::from(v.map(|x| (2 * x - n) as f32)));
                vertices.len() - 1
            };
            for i in 0..n {
                for j in 0..n {
                    let [a, b, c, d] = [p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1)];
                    faces.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
    }
    Solid { vertices, faces }
}

fn d1_corners(trials: u64) -> Outcome {
    let mut rng = Rng(41);
    let solid = boxes(12);
    let mut outcome = Outcome::default();
    let places = [
        (1.0, 0.0),
        (1e-6, 0.0),
        (1e6, 0.0),
        (1.0, 1e3),
        (1e-3, 1e5),
        (1.0, 1e6),
        (1e6, 1e6),
    ];
    let isas: Vec<Isa> = Isa::all().collect();
    let each = trials as usize / places.len();
    for (size, offset) in places {
        let offset = Vec3::new(offset, -offset, 0.5 * offset) * size;
        let placed = solid.placed(size, offset);
        let scene = Parts::of(placed.triangles()).scene(Accel::Bvh);
        for start in (0..each).step_by(BATCH) {
            let mut rays = Rays::default();
            for i in 0..BATCH.min(each - start) {
                let face = placed.faces[rng.below(placed.faces.len())].map(|i| placed.vertices[i]);
                let along = if i % 2 == 0 { 0.0 } else { rng.unit() as f32 };
                let target = face[0] + (face[1] - face[0]) * along;
                let mut origin = offset + Vec3::from(rng.in_cube(8.0)).round() * size;
                if i % 3 == 0 {
                    origin = offset + Vec3::from(rng.in_cube(8.0)) * size;
                }
                rays.push(origin.to_array(), (target - origin).to_array(), f32::MAX);
            }
            let isa = isas[start / BATCH % isas.len()];
            outcome.add(Outcome::new(rays.len(), misses(&trace(&scene, isa, &rays))));
        }
    }
    outcome
}

fn d2_zeros(trials: u64) -> Outcome {
    let mut rng = Rng(42);
    let mut triangles = boxes(4).triangles();
    // Corners at whole numbers, for which f64 is exact, or at none: a ray that starts in a corner must not meet it.
    let aside = Vec3::new(0.11, 0.23, -0.37);
    triangles.extend(Solid::icosphere(1).placed(2.0, aside).triangles());
    for _ in 0..40 {
        triangles.push([(); 3].map(|()| Vec3::from(rng.in_cube(6.0)).round()));
    }
    let scenes = [Accel::Bvh, Accel::Brute].map(|accel| Parts::of(triangles.clone()).scene(accel));
    let referee = Referee::new(Primitives {
        triangles: &triangles,
        ..Primitives::default()
    });
    let components = [
        0.0, -0.0, 1e-45, -1e-45, 1e-38, -1e-38, 1.0, -1.0, 1.0, -0.5,
    ];
    let mut outcome = Outcome::default();
    while outcome.trials < trials {
        let mut rays = Rays::default();
        for i in 0..BATCH {
            let mut origin = Vec3::from(rng.in_cube(7.0));
            if i % 4 != 0 {
                origin = origin.round();
            }
            let mut dir = [(); 3].map(|()| components[rng.below(components.len())]);
            if dir.iter().all(|d| f32::abs(*d) < 0.1) {
                dir[rng.below(3)] = 1.0;
            }
            rays.push(origin.to_array(), dir, f32::MAX);
        }
        let [hits, brute] = [&scenes[0], &scenes[1]].map(|scene| best(scene, &rays));
        for i in 0..rays.len() {
            let found = (hits.prim[i] != Hits::NONE).then(|| Found {
                t: hits.t[i],
                prim: hits.prim[i],
            });
            let verdict = referee.trace(ray(&rays, i), f32::MAX).judge(found);
            let same = (hits.prim[i], hits.t[i].to_bits()) == (brute.prim[i], brute.t[i].to_bits());
            let failed = !same || verdict == Verdict::Wrong;
            if failed {
                let hit = (hits.t[i], triangles.get(hits.prim[i] as usize));
                println!("{verdict:?}, {same}: {:?} {hit:?}", ray(&rays, i));
            }
            outcome.add(Outcome::new(1, usize::from(failed)));
        }
    }
    outcome
}

/// What a tree and a layout make of rays: (primitive, bits of t), and what is in the way.
type Answers = (Vec<(u32, u32)>, Vec<bool>);

fn answers(scene: &FlatScene, isa: Isa, rays: &Rays) -> Answers {
    let hits = trace(scene, isa, rays);
    let mut blocked = Vec::new();
    occluded(scene, isa, rays, &mut blocked);
    (of(&hits), blocked)
}

fn of(hits: &Hits) -> Vec<(u32, u32)> {
    let t = hits.t.iter().map(|t| t.to_bits());
    hits.prim.iter().copied().zip(t).collect()
}

fn differences(a: &Answers, b: &Answers) -> usize {
    let hits = a.0.iter().zip(&b.0).filter(|(a, b)| a != b).count();
    hits + a.1.iter().zip(&b.1).filter(|(a, b)| a != b).count()
}

fn d3_equality(trials: u64) -> Outcome {
    let mut rng = Rng(43);
    let mut outcome = Outcome::default();
    let mut compared = 0;
    for (name, parts) in twenty() {
        let brute = parts.scene(Accel::Brute);
        let trees = [
            parts.scene(Accel::Box),
            parts.scene(Accel::Bvh),
            parts.scene_by(Accel::Bvh, Quality::Fast),
        ];
        let plain = parts.instances.is_empty() && parts.looped.is_empty();
        let one_kind = parts.triangles.is_empty() || parts.tree_spheres.is_empty();
        let rivals: Vec<Box<dyn arms::Arm>> = Tree::ALL
            .into_iter()
            .filter(|_| plain && one_kind)
            .flat_map(|tree| {
                let scene = Arc::new(parts.scene(tree.accel()));
                Layout::ALL.map(|layout| arms::make(tree, layout, &scene))
            })
            .flatten()
            .collect();
        let each = trials as usize / 20;
        for start in (0..each).step_by(BATCH) {
            let rays = rays_at(&parts, BATCH.min(each - start), &mut rng);
            let truth = answers(&brute, Isa::best(), &rays);
            let mut wrong = 0;
            for tree in &trees {
                wrong += differences(&truth, &answers(tree, Isa::best(), &rays));
            }
            // The others a batch in four, since they are many.
            if (start / BATCH).is_multiple_of(4) {
                for rival in &rivals {
                    let mut hits = best(&brute, &rays);
                    let mut blocked = Vec::new();
                    let isa = arm_isa();
                    rival.closest_hit(isa, &rays, &mut hits);
                    rival.occluded(isa, &rays, &mut blocked);
                    wrong += differences(&truth, &(of(&hits), blocked));
                }
                compared = compared.max(trees.len() + rivals.len());
            }
            if wrong > 0 {
                println!("{name}: {wrong} differences");
            }
            outcome.add(Outcome::new(rays.len(), wrong));
        }
    }
    outcome.saying(format!("up to {compared} trees and layouts a scene"))
}

/// The best that the rivals have kernels for.
fn arm_isa() -> Isa {
    use luxel::trace::isa::Level;
    [Level::Avx2, Level::Sse2]
        .into_iter()
        .find_map(Isa::available)
        .unwrap_or(Isa::SCALAR)
}

fn d4_order(trials: u64) -> Outcome {
    let mut rng = Rng(44);
    let mut outcome = Outcome::default();
    for (_, parts) in twenty() {
        let each = trials as usize / 20;
        let rays = rays_at(&parts, each, &mut rng);
        let t = |parts: &Parts| -> Vec<u32> {
            let hits = best(&parts.scene(Accel::Bvh), &rays);
            hits.t.iter().map(|t| t.to_bits()).collect()
        };
        let truth = t(&parts);
        let mut shuffled = parts.clone();
        shuffled.groups.clear();
        for i in (1..shuffled.triangles.len()).rev() {
            shuffled.triangles.swap(i, rng.below(i + 1));
        }
        for i in (1..shuffled.tree_spheres.len()).rev() {
            shuffled.tree_spheres.swap(i, rng.below(i + 1));
        }
        shuffled.instances.reverse();
        let other = t(&shuffled);
        let differ = truth.iter().zip(&other).filter(|(a, b)| a != b).count();
        outcome.add(Outcome::new(each, differ));
    }
    outcome
}

fn d6_bad_rays(trials: u64) -> Outcome {
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let mut rng = Rng(45);
    let parts = Parts {
        triangles: Solid::icosphere(4).triangles(),
        tree_spheres: vec![([0.0; 3], 0.5), ([0.3, 0.1, 0.2], 0.25)],
        looped: vec![([0.0; 3], 1e3)],
        ..Parts::default()
    };
    let scene = parts.scene(Accel::Bvh);
    let (mut good, mut bad) = (Rays::default(), Rays::default());
    for i in 0..trials as usize {
        let (mut origin, mut dir, mut t_max) = (rng.in_cube(0.9), rng.direction(), f32::MAX);
        good.push(origin, dir, t_max);
        match i % 4 {
            0 => origin[rng.below(3)] = odd[rng.below(3)],
            1 => dir[rng.below(3)] = odd[rng.below(3)],
            2 => dir = [0.0, -0.0, 0.0],
            _ => t_max = [f32::NAN, 0.0, -0.0, -1.0, f32::NEG_INFINITY][rng.below(5)],
        }
        bad.push(origin, dir, t_max);
    }
    let mut failures = 0;
    let mut time = |rays: &Rays, expect: bool| {
        let mut least = f64::INFINITY;
        for _ in 0..5 {
            let start = Instant::now();
            let hits = best(&scene, rays);
            least = least.min(start.elapsed().as_secs_f64());
            let numbers = [&hits.t, &hits.u, &hits.v, &hits.err];
            failures += numbers
                .iter()
                .flat_map(|a| a.iter())
                .filter(|x| x.is_nan())
                .count();
            let wrong = |&&p: &&u32| (p != Hits::NONE) != expect;
            failures += hits.prim.iter().filter(wrong).count();
        }
        least
    };
    let (ordinary, took) = (time(&good, true), time(&bad, false));
    let mut blocked = Vec::new();
    occluded(&scene, Isa::best(), &bad, &mut blocked);
    failures += blocked.iter().filter(|b| **b).count();
    Outcome::new(bad.len(), failures).saying(format!(
        "in {:.2} of the time of good rays",
        took / ordinary
    ))
}

/// D7. Work is a whole number: what changes it changes the tree, and should be meant to.
#[test]
fn work_is_what_it_was() {
    let mut found = String::new();
    for (name, parts) in twenty() {
        if !["soup", "ball", "lattice", "slivers", "balls"].contains(&name) {
            continue;
        }
        let rays = rays_at(&parts, 1000, &mut Rng(46));
        let scene = Arc::new(parts.scene(Accel::Bvh));
        for tree in [Tree::Bvh8, Tree::Bvh2] {
            let work = Counter::new(tree, &scene).count(&rays, false);
            found += &format!(
                "{name} {tree}: {} nodes, {} primitives\n",
                work.nodes, work.primitives
            );
        }
    }
    assert_eq!(found, include_str!("work.txt"), "\n{found}");
}
