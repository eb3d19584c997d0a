//! A5, A9, A10, A12 and A14: rays that leave triangles, and triangles that are far too small, too large or too many.

use crate::book::{Outcome, items};
use crate::rooms;
use crate::support::leave::{returns, surface};
use crate::support::shoot::{best, misses, ray};
use crate::support::{Parts, Rng, Solid};
use luxel::build::bvh::{Accel, Primitives};
use luxel::flat::FlatScene;
use luxel::math::Vec3;
use luxel::measure::referee::{Found, Referee, Verdict};
use luxel::trace::spawn::offset_origin;
use luxel::trace::{Hits, Rays};

items! {
    a5_scales(1e5, 1e7): "A5", "a ball and a star scaled by every power of two from 2^-32 to 2^40: other bits than at their own size";
    a9_self_hits(3e5, 1e8): "A9", "rays that leave triangles of coordinates 10^±8 by the hit's error bound, to both sides: they meet it again";
    a10_neighbours(4e5, 1e7): "A10", "rays that leave closed convex meshes from faces, edges and vertices, sizes 1e±6, offsets to 1e5 sizes: outward a hit, inward a miss";
    a12_gaps(1e5, 1e6): "A12", "parallel squares a gap of 12 ulp of the largest coordinate or more apart (24 if tilted), offsets to 1e4: the second is missed";
    a14_millions(2e3, 1e4): "A14", "a height field of ten million triangles (quick: 200,000): wrong by the f64 referee";
}

/// The exponents of A5: at smaller ones products of f32 underflow, at larger ones they overflow.
const TRIED: std::ops::RangeInclusive<i32> = -32..=40;

/// A triangle of coordinates of any size, and rays to it.
fn a9_self_hits(trials: u64) -> Outcome {
    let mut rng = Rng(21);
    let mut outcome = Outcome::default();
    for case in 0.. {
        if outcome.trials >= trials {
            break;
        }
        let span = rng.log(-8.0, 8.0).abs();
        let middle = match case % 3 {
            0 => Vec3::ZERO,
            1 => Vec3::from([(); 3].map(|()| rng.log(-8.0, 8.0) as f32)),
            _ => {
                let away = span * 10f64.powf(rng.range(0.0, 5.0));
                Vec3::from(rng.in_cube(away))
            }
        };
        let v = [(); 3]
            .map(|()| middle + Vec3::from([(); 3].map(|()| (span * rng.log(-2.0, 0.0)) as f32)));
        let scene = Parts::of(vec![v]).scene(Accel::Bvh);
        let mut rays = Rays::default();
        for i in 0..50 {
            let [a, b] = match i % 4 {
                0 => [0.0, 0.0],
                1 => [rng.unit() as f32, 0.0],
                _ => [rng.unit() as f32, rng.unit() as f32],
            };
            let target = v[0] + (v[1] - v[0]) * (a * (1.0 - b)) + (v[2] - v[0]) * b;
            let d = Vec3::from(rng.direction());
            let origin = target - d * (span * rng.range(0.1, 10.0)) as f32;
            rays.push(origin.to_array(), d.to_array(), f32::MAX);
        }
        let (back, sent) = returns(&scene, &rays, &mut rng, 40);
        outcome.add(Outcome::new(sent, back));
    }
    outcome
}

fn a10_neighbours(trials: u64) -> Outcome {
    let mut rng = Rng(22);
    let mut cases: Vec<(Solid, Vec3)> = Vec::new();
    for solid in [rooms::octahedron(), rooms::cube()] {
        for size in [2f32.powi(-20), 1.0, 2f32.powi(20)] {
            for away in [0.0, 1024.0, 131_072.0] {
                let offset = Vec3::new(away, -away, 0.5 * away) * size;
                cases.push((solid.placed(size, offset), offset));
            }
        }
    }
    for size in [1e-6, 1.0, 1e6] {
        cases.push((Solid::icosphere(2).placed(size, Vec3::ZERO), Vec3::ZERO));
    }
    let mut outcome = Outcome::default();
    let each = trials as usize / cases.len();
    for (solid, middle) in cases {
        let scene = Parts::of(solid.triangles()).scene(Accel::Bvh);
        for _ in 0..each.div_ceil(1000) {
            outcome.add(from_outside(&solid, middle, &scene, &mut rng));
        }
    }
    outcome
}

/// Five hundred rays from outside at faces, edges and vertices; from each hit, one on outward and one inward.
fn from_outside(solid: &Solid, middle: Vec3, scene: &FlatScene, rng: &mut Rng) -> Outcome {
    let mut rays = Rays::default();
    for i in 0..500 {
        let face = solid.faces[rng.below(solid.faces.len())].map(|i| solid.vertices[i]);
        let [a, b] = match i % 3 {
            0 => [0.0, 0.0],
            1 => [rng.unit() as f32, 0.0],
            _ => [rng.unit() as f32, rng.unit() as f32],
        };
        let target = face[0] + (face[1] - face[0]) * (a * (1.0 - b)) + (face[2] - face[0]) * b;
        let origin = middle + 4.0 * (target - middle);
        rays.push(origin.to_array(), (target - origin).to_array(), f32::MAX);
    }
    let hits = best(scene, &rays);
    let [mut out, mut inward] = [Rays::default(), Rays::default()];
    for i in 0..rays.len() {
        if hits.prim[i] == Hits::NONE {
            continue;
        }
        let (p, ng) = surface(scene, &rays, &hits, i);
        let outside = (Vec3::from(p) - middle).dot(Vec3::from(ng)) > 0.0;
        let n = Vec3::from(ng).as_dvec3() * if outside { 1.0 } else { -1.0 };
        let dir = Vec3::from(rng.direction());
        let dir = if dir.as_dvec3().dot(n) < 0.0 {
            -dir
        } else {
            dir
        };
        let dir = dir.to_array();
        out.push(offset_origin(p, ng, hits.err[i], dir), dir, f32::MAX);
        let corner = solid.vertices[rng.below(solid.vertices.len())];
        let target = middle + (corner - middle) * (0.5 * rng.unit() as f32);
        let dir = (target - Vec3::from(p)).normalize().to_array();
        inward.push(offset_origin(p, ng, hits.err[i], dir), dir, f32::MAX);
    }
    let sent = out.len() + inward.len();
    assert!(sent > 300, "only {sent} rays from 500 hits");
    let wrong = out.len() - misses(&best(scene, &out)) + misses(&best(scene, &inward));
    Outcome::new(sent, wrong)
}

/// Rays on through the first of two squares that a gap of so many units in the last place of the largest coordinate parts:
/// where they miss the second.
fn leaks(ulps: u32, tilted: bool, trials: u64, rng: &mut Rng) -> Outcome {
    let mut outcome = Outcome::default();
    while outcome.trials < trials {
        let offset = [1.0, 1e2, 1e4][rng.below(3)];
        let at = Vec3::from([(); 3].map(|()| rng.range(1.0, 2.0) as f32 * offset));
        let n = match tilted {
            true => Vec3::from(rng.direction()),
            false => Vec3::Z,
        };
        let (x, y) = n.any_orthonormal_pair();
        let most = at.max_element();
        let gap = ulps as f32 * (most.next_up() - most);
        // So wide that no ray leaves between them.
        let wide = 2.0 + 20.0 * gap;
        let square = |below: f32| {
            let p = |a: f32, b: f32| at + wide * (a * x + b * y) - below * n;
            let q = [p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)];
            [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]
        };
        let scene = Parts::of([square(0.0), square(gap)].concat()).scene(Accel::Bvh);
        let mut rays = Rays::default();
        for _ in 0..200 {
            let [a, b] = [(); 2].map(|()| rng.range(-1.0, 1.0) as f32);
            let up = Vec3::from(rng.direction());
            let up = if up.dot(n) < 0.0 { -up } else { up };
            let dir = -(up + 0.1 * n);
            let origin = at + a * x + b * y - dir;
            rays.push(origin.to_array(), dir.to_array(), f32::MAX);
        }
        let hits = best(&scene, &rays);
        let mut on = Rays::default();
        for i in 0..rays.len() {
            if hits.prim[i] < 2 {
                let (p, ng) = surface(&scene, &rays, &hits, i);
                let dir = ray(&rays, i)[1];
                on.push(offset_origin(p, ng, hits.err[i], dir), dir, f32::MAX);
            }
        }
        let second = best(&scene, &on);
        let leaked = second.prim.iter().filter(|&&p| p != 2 && p != 3).count();
        outcome.add(Outcome::new(on.len(), leaked));
    }
    outcome
}

fn a12_gaps(trials: u64) -> Outcome {
    let mut rng = Rng(23);
    let mut outcome = Outcome::default();
    let mut said = Vec::new();
    for (tilted, least, name) in [(false, 12, "square to an axis"), (true, 24, "tilted")] {
        for wider in [1, 2, 16, 1024] {
            outcome.add(leaks(wider * least, tilted, trials / 8, &mut rng));
        }
        let mut at = |ulps| leaks(ulps, tilted, trials / 32, &mut rng);
        let last = (1..least).rev().find(|&ulps| at(ulps).failures > 0);
        let eight = at(8);
        let share = 100.0 * eight.failures as f64 / eight.trials as f64;
        let from = last.map_or(1, |ulps| ulps + 1);
        said.push(format!("{name} none from {from} ulp on, {share:.1} % at 8"));
    }
    outcome.saying(said.join(", "))
}

fn a5_scales(trials: u64) -> Outcome {
    let mut rng = Rng(24);
    let mut outcome = Outcome::default();
    let [mut low, mut high] = [-60, 80];
    for solid in [Solid::icosphere(3), Solid::star(2, &mut Rng(1))] {
        let n = trials as usize / 2 / TRIED.count();
        let mut rays = Rays::default();
        for _ in 0..n {
            rays.push(rng.in_cube(2.0), rng.direction(), f32::MAX);
        }
        let one = scaled(&solid, &rays, 0);
        for k in TRIED {
            let other = scaled(&solid, &rays, k);
            let differ = one.iter().zip(&other).filter(|(a, b)| a != b).count();
            outcome.add(Outcome::new(n, differ));
        }
        let holds = |k: i32| scaled(&solid, &rays, k) == one;
        low = (low..0).rev().find(|&k| !holds(k)).map_or(low, |k| k + 1);
        high = (1..=high).find(|&k| !holds(k)).map_or(high, |k| k - 1);
    }
    outcome.saying(format!("equal from 2^{low} to 2^{high}"))
}

/// Bits of the hits when all lengths but those of directions are scaled, scaled back.
fn scaled(solid: &Solid, rays: &Rays, k: i32) -> Vec<[u32; 5]> {
    let s = 2f32.powi(k);
    let mut rays = rays.clone();
    rays.origin.iter_mut().flatten().for_each(|x| *x *= s);
    let hits = best(
        &Parts::of(solid.placed(s, Vec3::ZERO).triangles()).scene(Accel::Bvh),
        &rays,
    );
    let back = |x: f32| (f64::from(x) / f64::from(s)) as f32;
    (0..rays.len())
        .map(|i| {
            let lengths = [back(hits.t[i]), back(hits.err[i])].map(f32::to_bits);
            let shares = [hits.u[i], hits.v[i]].map(f32::to_bits);
            [lengths[0], lengths[1], shares[0], shares[1], hits.prim[i]]
        })
        .collect()
}

/// Hills of `n` × `n` cells of two triangles over [−1, 1]².
fn hills(n: usize) -> Vec<[Vec3; 3]> {
    let height =
        |x: f32, z: f32| 0.2 * (5.0 * x).sin() * (7.0 * z).cos() + 0.002 * (91.0 * (x + z)).sin();
    let p = |i: usize, j: usize| {
        let [x, z] = [i, j].map(|k| 2.0 * k as f32 / n as f32 - 1.0);
        Vec3::new(x, height(x, z), z)
    };
    let mut triangles = Vec::with_capacity(2 * n * n);
    for i in 0..n {
        for j in 0..n {
            let [a, b, c, d] = [p(i, j), p(i, j + 1), p(i + 1, j + 1), p(i + 1, j)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

fn a14_millions(trials: u64) -> Outcome {
    let side = if trials < 10_000 { 320 } else { 2240 };
    let triangles = hills(side);
    let scene = Parts::of(triangles.clone()).scene(Accel::Bvh);
    let referee = Referee::new(Primitives {
        triangles: &triangles,
        ..Primitives::default()
    });
    let mut rng = Rng(25);
    let mut rays = Rays::default();
    for i in 0..trials {
        let origin = Vec3::new(
            rng.range(-1.0, 1.0) as f32,
            0.5,
            rng.range(-1.0, 1.0) as f32,
        );
        let mut target = Vec3::from(rng.in_cube(0.9)).with_y(0.0);
        if i % 2 == 0 {
            target = triangles[rng.below(triangles.len())][0];
        }
        rays.push(origin.to_array(), (target - origin).to_array(), f32::MAX);
    }
    let hits = best(&scene, &rays);
    let mut failures = 0;
    for i in 0..rays.len() {
        let hit = (hits.prim[i] != Hits::NONE).then(|| Found {
            t: hits.t[i],
            prim: hits.prim[i],
        });
        let verdict = referee.trace(ray(&rays, i), f32::MAX).judge(hit);
        failures += usize::from(verdict == Verdict::Wrong);
    }
    let bytes = size_of_val(&*scene.world.bvh.nodes) + size_of_val(&*scene.world.triangles.blocks);
    Outcome::new(rays.len(), failures).saying(format!(
        "{} triangles, {:.0} bytes each, {} levels",
        triangles.len(),
        bytes as f64 / triangles.len() as f64,
        scene.world.bvh.depth
    ))
}
