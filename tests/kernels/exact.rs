//! t against f64.

use crate::support::{Parts, Rng, exact};
use crate::{EVERY, best, ray, soup};
use luxel::build::bvh::Accel;
use luxel::math::{DVec3, Vec3};
use luxel::trace::kernels::t_error_bound;
use luxel::trace::{Hits, Rays};

fn oracle_hit(v: [Vec3; 3], r: [[f32; 3]; 2], slack: f64) -> Option<f64> {
    let [t, u, v] = exact::triangle(v, r);
    (t > 0.0 && u >= -slack && v >= -slack && u + v <= 1.0 + slack).then_some(t)
}

#[test]
fn triangles_agree_with_f64() {
    let mut rng = Rng(5);
    let (mut doubtful, mut hit, mut worst) = (0, 0, 0.0f64);
    for size in [1e-3, 1.0, 1e3] {
        let triangles = soup(&mut rng, 400, 3.0 * size, size);
        let scene = Parts::of(triangles.clone()).scene(Accel::Bvh);
        let mut rays = Rays::default();
        for _ in 0..4000 {
            rays.push(rng.in_cube(4.0 * size), rng.direction(), f32::MAX);
        }
        let hits = best(&scene, &rays);
        for i in 0..rays.len() {
            let r = ray(&rays, i);
            let bound = |k: usize| {
                f64::from(t_error_bound(
                    triangles[k].map(|v| v.to_array()),
                    r[0],
                    r[1],
                ))
            };
            let closest = |slack: f64| {
                let all = (0..triangles.len())
                    .filter_map(|k| Some((oracle_hit(triangles[k], r, slack)?, k)));
                all.min_by(|a, b| a.0.total_cmp(&b.0))
            };
            let found = (hits.prim[i] != Hits::NONE)
                .then_some((f64::from(hits.t[i]), hits.prim[i] as usize));
            match (found, closest(0.0)) {
                (None, None) => {}
                (Some((t, k)), Some((t64, k64))) if k == k64 => {
                    hit += 1;
                    // One more rounding: t itself, after clamping.
                    let limit = bound(k) + t64 * f64::from(f32::EPSILON) * 4.0;
                    worst = worst.max((t - t64).abs() / limit);
                    assert!((t - t64).abs() <= limit, "ray {i}: {t} {t64} ± {limit}");
                }
                (found, exact) => {
                    // Within the error of an edge, or two surfaces within their bounds.
                    doubtful += 1;
                    let on_edge = |k: usize| {
                        oracle_hit(triangles[k], r, 1e-4).is_some()
                            && oracle_hit(triangles[k], r, -1e-4).is_none()
                    };
                    let near =
                        |a: usize, b: usize, x: f64, y: f64| (x - y).abs() <= bound(a) + bound(b);
                    let excused = match (found, exact) {
                        (Some((x, a)), Some((y, b))) => {
                            near(a, b, x, y) || on_edge(a) || on_edge(b)
                        }
                        (Some((_, a)), None) => on_edge(a),
                        (None, Some((_, b))) => on_edge(b),
                        (None, None) => true,
                    };
                    assert!(excused, "ray {i}: {found:?}, f64 says {exact:?}");
                }
            }
        }
    }
    println!(
        "{hit} hits agree with f64, {doubtful} excused at edges; worst error {worst:.2} of its bound"
    );
    assert!(hit > 3000 && doubtful < 10);
}

#[test]
fn walls_are_right_to_the_last_bit() {
    let mut rng = Rng(6);
    let mut tested = 0;
    for k in 1..=8 {
        let r = 10f64.powi(k);
        for wall in 0..6 {
            let mut center = [0.0; 3];
            center[wall / 2] = if wall % 2 == 0 { -r } else { r };
            center[(wall / 2 + 1) % 3] = 1.25;
            let parts = Parts {
                looped: vec![(center, r)],
                ..Parts::default()
            };
            let mut rays = Rays::default();
            for _ in 0..2000 {
                let mut o = rng.in_cube(5.0);
                o[wall / 2] =
                    (if wall % 2 == 0 { 1.0 } else { -1.0 }) * rng.range(1.0, 10.0) as f32;
                rays.push(o, rng.direction(), f32::MAX);
            }
            let looped = best(&parts.scene(Accel::Bvh), &rays);
            let in_tree = Parts {
                tree_spheres: parts.looped.clone(),
                ..Parts::default()
            };
            let boxed = best(&in_tree.scene(Accel::Bvh), &rays);
            for i in 0..rays.len() {
                let [t, b] = [looped.t[i], boxed.t[i]];
                let Some(exact) = exact_root(center, r, ray(&rays, i)) else {
                    continue;
                };
                tested += 1;
                for t in [t, b] {
                    let error = (f64::from(t) - exact).abs() / exact;
                    assert!(error <= 1.2e-7, "R = {r} ray {i}: {t} {exact}");
                }
            }
        }
    }
    assert!(tested > 40_000, "{tested}");
}

/// The smallest root above 0 by the plain quadratic in f64, which is enough for a centre with one component ±r: there
/// |oc|² − r² is had without cancellation. Nothing for grazing rays, where t itself is ill-conditioned.
fn exact_root(c: [f64; 3], r: f64, [o, d]: [[f32; 3]; 2]) -> Option<f64> {
    let oc = DVec3::from(o.map(f64::from)) - DVec3::from(c);
    let d = DVec3::from(d.map(f64::from));
    let [a, b] = [d.dot(d), oc.dot(d)];
    let value = residual(c, r, o);
    let disc = b * b - a * value;
    if disc < 1e-6 * b * b + 1e-9 * r * r * a {
        return None;
    }
    let q = -(b + disc.sqrt().copysign(b));
    let [t0, t1] = [value / q, q / a];
    let (low, high) = (t0.min(t1), t0.max(t1));
    if low > 0.0 {
        Some(low)
    } else {
        (high > 0.0).then_some(high)
    }
}

/// |o − C|² − r² without cancellation, for a centre with one component ±r: o² − 2 o·C + (|C|² − r²), the last from
/// the other components alone.
fn residual(c: [f64; 3], r: f64, o: [f32; 3]) -> f64 {
    let o = o.map(f64::from);
    (0..3)
        .map(|a| {
            let own = if c[a].abs() == r { 0.0 } else { c[a] * c[a] };
            o[a] * o[a] - 2.0 * o[a] * c[a] + own
        })
        .sum()
}

#[test]
fn triangles_that_reach_to_infinity_are_never_hit() {
    let far = Vec3::new(0.0, f32::NEG_INFINITY, 0.0);
    let mut triangles = vec![[Vec3::ZERO, Vec3::X, far], [far, Vec3::NEG_X, Vec3::ZERO]];
    // In one block with them, so that they are tested.
    triangles.push([Vec3::Z, Vec3::X, Vec3::Y]);
    let mut rng = Rng(17);
    let mut rays = Rays::default();
    for _ in 0..2000 {
        let target = Vec3::new(rng.range(-1.0, 1.0) as f32, -rng.unit() as f32, 0.0);
        let origin = Vec3::from(rng.in_cube(2.0));
        rays.push(origin.to_array(), (target - origin).to_array(), f32::MAX);
    }
    for accel in EVERY {
        let hits = best(&Parts::of(triangles.clone()).scene(accel), &rays);
        assert!(
            hits.prim.iter().all(|&p| p == 2 || p == Hits::NONE),
            "{accel:?}"
        );
        assert!(hits.err.iter().all(|err| err.is_finite()), "{accel:?}");
    }
}
