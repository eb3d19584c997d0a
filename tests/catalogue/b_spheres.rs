//! B: spheres. Walls of any radius, far and small ones, grazed ones, nested ones.

use crate::book::{Outcome, items};
use crate::support::leave::{returns, surface};
use crate::support::shoot::{best, ray};
use crate::support::{Parts, Rng};
use luxel::build::bvh::{Accel, Primitives, SphereItem};
use luxel::flat::{FlatScene, Spheres};
use luxel::math::{DVec3, Vec3};
use luxel::measure::referee::{Found, Referee, Verdict};
use luxel::trace::spawn::{offset_origin, sphere_point};
use luxel::trace::{Hits, Rays};

items! {
    b1_walls(2e5, 4.8e7): "B1", "the six walls of a room as spheres of R = 10 to 1e8: missed, t off by more than 1.2e-7 of it against f64, or the normal by more than 2e-7";
    b3_far_and_small(2e5, 1e7): "B3", "spheres of r = 1e-1 to 1e-8 of their distance, met inside 0.9 r: missed, or a point farther than 4 ulp from the surface";
    b4_grazing(2e5, 1e7): "B4", "rays that pass a centre at r (1 ± 2^-k), k = 1 to 24: wrong by the f64 referee, or NaN";
    b5_leaving(2e5, 1e7): "B5", "rays that leave spheres of r = 1e-4 to 1e8 outward: they meet it again; inward: the far side off by more than 4 ulp";
    b6_nested(6e4, 6e6): "B6", "eight nested shells, gaps of 1e-2 to 5e-7: the sixteen crossings out of order";
    b8_normals(1e5, 1e7): "B8", "normals: length off by more than 2 ulp, or angle by more than 4 ε (1 + distance / r)";
}

const EPS: f64 = f32::EPSILON as f64;
const BATCH: usize = 4096;

/// One sphere, in the tree or out of it.
fn alone(center: DVec3, radius: f64, in_tree: bool) -> FlatScene {
    let sphere = vec![(center.to_array(), radius)];
    let parts = match in_tree {
        true => Parts {
            tree_spheres: sphere,
            ..Parts::default()
        },
        false => Parts {
            looped: sphere,
            ..Parts::default()
        },
    };
    parts.scene(Accel::Bvh)
}

fn item(center: DVec3, radius: f64) -> [SphereItem; 1] {
    [SphereItem {
        center: center.to_array(),
        radius,
        prim: 0,
    }]
}

fn referee(spheres: &[SphereItem]) -> Referee<'_> {
    Referee::new(Primitives {
        spheres,
        ..Primitives::default()
    })
}

fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

fn unit(rng: &mut Rng) -> DVec3 {
    wide(rng.direction()).normalize()
}

fn b1_walls(trials: u64) -> Outcome {
    let mut rng = Rng(31);
    let (mut outcome, mut worst_t, mut worst_n, mut flat) =
        (Outcome::default(), 0.0f64, 0.0f64, 0u64);
    let each = trials as usize / 48;
    for case in 0..48 {
        let radius = 10f64.powi(1 + case / 6);
        let mut out = DVec3::ZERO;
        out[case as usize % 3] = if case % 6 < 3 { 1.0 } else { -1.0 };
        let aside = DVec3::new(0.3, -1.2, 2.1) * (1.0 - out.abs());
        // The room is 10 wide and the wall touches it from outside, as walls do.
        let center = out * (radius + 5.0) + aside;
        let scene = alone(center, radius, case % 2 == 0);
        let sphere = item(center, radius);
        let referee = referee(&sphere);
        for start in (0..each).step_by(BATCH) {
            let mut rays = Rays::default();
            while rays.len() < BATCH.min(each - start) {
                let o = Vec3::from(rng.in_cube(4.0));
                let d = Vec3::from(rng.direction());
                // Towards the wall, so that most meet it.
                let d = if d.as_dvec3().dot(out) < 0.0 { -d } else { d };
                rays.push(o.to_array(), d.to_array(), f32::MAX);
            }
            let hits = best(&scene, &rays);
            for i in 0..rays.len() {
                let r = ray(&rays, i);
                let exact = referee.trace(r, f32::MAX).exact();
                let d = wide(r[1]);
                let Some(exact) = exact.filter(|e| {
                    let n = (wide(r[0]) + e.t * d - center) / radius;
                    // Where the ray lies in the surface t is not for f64 to know.
                    n.dot(d).abs() > 1e-4
                }) else {
                    flat += 1;
                    continue;
                };
                let missed = hits.prim[i] == Hits::NONE;
                let [mut t, mut angle] = [0.0, 0.0];
                if !missed {
                    t = (f64::from(hits.t[i]) - exact.t).abs() / exact.t;
                    let (_, n) = sphere_point(r, hits.t[i], center.to_array(), radius);
                    let n64 = (wide(r[0]) + exact.t * d - center) / radius;
                    angle = wide(n).normalize().cross(n64.normalize()).length();
                }
                // The wall's own bending over an error of t is not an error of the normal.
                let bent = 1.2e-7 * exact.t / radius;
                [worst_t, worst_n] = [worst_t.max(t), worst_n.max(angle - bent)];
                let failed = missed || t > 1.2e-7 || angle > 2e-7 + bent;
                outcome.add(Outcome::new(1, usize::from(failed)));
            }
        }
    }
    assert!(flat < trials / 2, "{flat} rays of {trials} pass");
    outcome.saying(format!(
        "t within {worst_t:.2e}, normals within {worst_n:.2e} rad"
    ))
}

fn b3_far_and_small(trials: u64) -> Outcome {
    let mut rng = Rng(32);
    let (mut outcome, mut worst) = (Outcome::default(), 0.0f64);
    while outcome.trials < trials {
        // Rays first, then the sphere where they are: at such distances no f32 direction could aim.
        let o = Vec3::from(rng.in_cube(1.0));
        let d = Vec3::from(rng.direction());
        let distance = 10f64.powf(rng.range(0.0, 6.0));
        let ratio = 10f64.powf(rng.range(-8.0, -1.0));
        let radius = ratio * distance;
        let axis = d.as_dvec3().normalize();
        let beside = axis
            .cross(unit(&mut rng))
            .normalize_or(axis.any_orthonormal_vector());
        let center = o.as_dvec3() + distance * axis + beside * radius * rng.range(0.0, 0.9);
        let scene = alone(center, radius, outcome.trials % 2 == 0);
        let mut rays = Rays::default();
        for k in 0..8 {
            // Other lengths of the direction, and other origins on the same line.
            let scale = 2f32.powi(k - 4);
            rays.push(o.to_array(), (d * scale).to_array(), f32::MAX);
        }
        let hits = best(&scene, &rays);
        for i in 0..rays.len() {
            let missed = hits.prim[i] == Hits::NONE;
            let mut off = 0.0;
            if !missed {
                let (p, _) = sphere_point(ray(&rays, i), hits.t[i], center.to_array(), radius);
                let size = center.length().max(radius);
                off = ((wide(p) - center).length() - radius).abs() / (size * EPS);
            }
            worst = worst.max(off);
            outcome.add(Outcome::new(1, usize::from(missed || off > 4.0)));
        }
    }
    outcome.saying(format!("points within {worst:.2} ulp of the surface"))
}

fn b4_grazing(trials: u64) -> Outcome {
    let mut rng = Rng(33);
    let (mut outcome, mut inside) = (Outcome::default(), 0u64);
    while outcome.trials < trials {
        let o = Vec3::from(rng.in_cube(1.0));
        let d = Vec3::from(rng.direction());
        let radius = rng.log(-4.0, 4.0).abs();
        let distance = radius * rng.range(1.1, 1e3);
        let axis = d.as_dvec3().normalize();
        let beside = axis
            .cross(unit(&mut rng))
            .normalize_or(axis.any_orthonormal_vector());
        let mut rays = Rays::default();
        rays.push(o.to_array(), d.to_array(), f32::MAX);
        for k in 1..=24 {
            for side in [-1.0, 1.0] {
                let impact = radius * (1.0 + side * 0.5f64.powi(k));
                let center = o.as_dvec3() + distance * axis + impact * beside;
                let sphere = item(center, radius);
                let hits = best(&alone(center, radius, k % 2 == 0), &rays);
                let found = (hits.prim[0] != Hits::NONE).then(|| Found {
                    t: hits.t[0],
                    prim: hits.prim[0],
                });
                inside += u64::from(found.is_some());
                let verdict = referee(&sphere).trace(ray(&rays, 0), f32::MAX).judge(found);
                let failed =
                    verdict == Verdict::Wrong || hits.t[0].is_nan() || hits.err[0].is_nan();
                outcome.add(Outcome::new(1, usize::from(failed)));
            }
        }
    }
    outcome.saying(format!("{inside} hits"))
}

fn b5_leaving(trials: u64) -> Outcome {
    let mut rng = Rng(34);
    let (mut outcome, mut worst) = (Outcome::default(), 0.0f64);
    while outcome.trials < trials {
        let radius = 10f64.powf(rng.range(-4.0, 8.0));
        // Some pass near the origin, as walls do; some stand far off.
        let away = [1.001, 0.0, 1e2][rng.below(3)] * radius;
        let center = unit(&mut rng) * away;
        let scene = alone(center, radius, outcome.trials % 2 == 0);
        let mut rays = Rays::default();
        for _ in 0..50 {
            let target = center + unit(&mut rng) * radius * 0.9;
            let d = unit(&mut rng);
            let o = (target - d * radius * rng.range(0.0, 5.0)).as_vec3();
            let d = (target - o.as_dvec3()).normalize_or(d).as_vec3();
            rays.push(o.to_array(), d.to_array(), f32::MAX);
        }
        let (back, sent) = returns(&scene, &rays, &mut rng, 10);
        outcome.add(Outcome::new(sent, back));
        let (sent, wrong, most) = far_sides(&scene, &rays, &mut rng);
        worst = worst.max(most);
        outcome.add(Outcome::new(sent, wrong));
    }
    outcome.saying(format!("far side within {worst:.2} ulp"))
}

/// From every hit, a ray inward: how many, how many that do not meet the far side as f64 does, and the largest error.
fn far_sides(scene: &FlatScene, rays: &Rays, rng: &mut Rng) -> (usize, usize, f64) {
    let hits = best(scene, rays);
    let (center, radius) = (
        DVec3::from(scene.spheres.center(0)),
        scene.spheres.radius(0),
    );
    let mut inward = Rays::default();
    for i in 0..rays.len() {
        if hits.prim[i] == Hits::NONE {
            continue;
        }
        let (p, ng) = surface(scene, rays, &hits, i);
        let dir = unit(rng);
        let cos = dir.dot(wide(ng));
        let dir = (if cos > 0.0 { -dir } else { dir } - 0.05 * wide(ng))
            .normalize()
            .as_vec3();
        inward.push(
            offset_origin(p, ng, hits.err[i], dir.to_array()),
            dir.to_array(),
            f32::MAX,
        );
    }
    let sphere = item(center, radius);
    let referee = referee(&sphere);
    let far = best(scene, &inward);
    let (mut wrong, mut worst) = (0, 0.0f64);
    for i in 0..inward.len() {
        let exact = referee.trace(ray(&inward, i), f32::MAX).exact();
        let t = exact.map_or(f64::NAN, |e| e.t);
        // The far side of a chord is far: a chord of its cosine's length.
        let error = (f64::from(far.t[i]) - t).abs() / (t * EPS);
        let missed = far.prim[i] == Hits::NONE || f64::from(far.t[i]) < 0.04 * radius;
        wrong += usize::from(missed || error.is_nan() || error > 4.0);
        worst = worst.max(error);
    }
    (inward.len(), wrong, worst)
}

fn b6_nested(trials: u64) -> Outcome {
    const SHELLS: usize = 8;
    let mut rng = Rng(35);
    let gaps = [1e-2, 1e-3, 4e-5, 1e-5, 1e-6, 5e-7];
    let mut outcome = Outcome::default();
    for gap in gaps {
        for in_tree in [false, true] {
            let shells: Vec<([f64; 3], f64)> = (0..SHELLS)
                .map(|k| ([0.0; 3], 1.0 - gap * k as f64))
                .collect();
            let parts = match in_tree {
                true => Parts {
                    tree_spheres: shells,
                    ..Parts::default()
                },
                false => Parts {
                    looped: shells,
                    ..Parts::default()
                },
            };
            let scene = parts.scene(Accel::Bvh);
            let each = trials as usize / (2 * gaps.len());
            for start in (0..each).step_by(BATCH) {
                let n = BATCH.min(each - start);
                outcome.add(Outcome::new(n, wrong_orders(&scene, SHELLS, n, &mut rng)));
            }
        }
    }
    outcome
}

/// Of `n` rays straight through all shells, those whose crossings are not all of them in order.
fn wrong_orders(scene: &FlatScene, shells: usize, n: usize, rng: &mut Rng) -> usize {
    let mut rays = Rays::default();
    for _ in 0..n {
        let d = unit(rng);
        let beside = d.cross(unit(rng)).normalize_or(DVec3::X) * rng.range(0.0, 0.85);
        let o = (beside - d * rng.range(1.5, 4.0)).as_vec3();
        rays.push(o.to_array(), d.as_vec3().to_array(), f32::MAX);
    }
    let mut wrong = vec![false; n];
    for step in 0..=2 * shells {
        let hits = best(scene, &rays);
        let mut next = Rays::default();
        for (i, wrong) in wrong.iter_mut().enumerate() {
            // In through all of them, then out through all of them, then nothing.
            let expected = match step {
                _ if step == 2 * shells => Hits::NONE,
                _ if step < shells => Spheres::TAG | step as u32,
                _ => Spheres::TAG | (2 * shells - 1 - step) as u32,
            };
            let [o, dir] = ray(&rays, i);
            *wrong |= hits.prim[i] != expected;
            let start = if hits.prim[i] == Hits::NONE {
                o
            } else {
                let (p, ng) = surface(scene, &rays, &hits, i);
                offset_origin(p, ng, hits.err[i], dir)
            };
            next.push(start, dir, f32::MAX);
        }
        rays = next;
    }
    wrong.iter().filter(|w| **w).count()
}

fn b8_normals(trials: u64) -> Outcome {
    let mut rng = Rng(36);
    let (mut outcome, mut worst_length, mut worst_angle) = (Outcome::default(), 0.0f64, 0.0f64);
    while outcome.trials < trials {
        let radius = 10f64.powf(rng.range(-4.0, 8.0));
        let center = unit(&mut rng) * radius * 10f64.powf(rng.range(-2.0, 4.0));
        let scene = alone(center, radius, outcome.trials % 2 == 0);
        let mut rays = Rays::default();
        for _ in 0..200 {
            let target = center + unit(&mut rng) * radius * rng.range(0.0, 0.95);
            let o = (target - unit(&mut rng) * radius * rng.range(1.0, 5.0)).as_vec3();
            let d = (target - o.as_dvec3()).normalize_or(DVec3::X).as_vec3();
            rays.push(o.to_array(), d.to_array(), f32::MAX);
        }
        let hits = best(&scene, &rays);
        for i in 0..rays.len() {
            if hits.prim[i] == Hits::NONE {
                continue;
            }
            let (p, n) = sphere_point(ray(&rays, i), hits.t[i], center.to_array(), radius);
            let length = (wide(n).length() - 1.0).abs() / EPS;
            let radial = (wide(p) - center).normalize();
            let angle = wide(n).normalize().cross(radial).length();
            let allowed = 4.0 * EPS * (1.0 + center.length() / radius);
            worst_length = worst_length.max(length);
            worst_angle = worst_angle.max(angle / allowed);
            outcome.add(Outcome::new(
                1,
                usize::from(length > 2.0 || angle > allowed),
            ));
        }
    }
    outcome.saying(format!(
        "length within {worst_length:.2} ulp, angle within {worst_angle:.2} of the bound"
    ))
}
