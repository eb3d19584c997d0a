//! A6 to A8, A11: what a hit says, and what is no hit.

use crate::book::{Outcome, items};
use crate::support::shoot::{best, bits, ray, trace};
use crate::support::{Parts, Rng, exact};
use luxel::build::bvh::{Accel, Primitives};
use luxel::math::{DVec3, Vec3};
use luxel::measure::referee::{Found, Referee, Verdict};
use luxel::trace::kernels::t_error_bound;
use luxel::trace::{Hits, Isa, Rays};

items! {
    a6_accuracy(2e5, 1e7): "A6", "hits inside triangles at coordinates of 10^±6: t beyond its bound, or t, u, v of shapely ones off by more than 16 ulp";
    a7_grazing(2e5, 1e7): "A7", "rays at 1e-1 to 1e-7 rad to triangles of aspect 1 to 1e6: wrong by the f64 referee, or t outside the triangle's box";
    a8_degenerate(2e4, 1e6): "A8", "triangles with equal corners, with corners in a line, of subnormal size or not finite: hits of equal corners, outputs not finite, trees or instruction sets that differ";
    a11_coincident(2e4, 1e6): "A11", "identical triangles, turned over or not, and a stack of a thousand quads, shuffled: not the lowest id, or other bits";
}

/// Rays at a triangle before another is made.
const RAYS: usize = 500;

const EPS: f64 = f32::EPSILON as f64;

fn found(hits: &Hits, i: usize) -> Option<Found> {
    (hits.prim[i] != Hits::NONE).then(|| Found {
        t: hits.t[i],
        prim: hits.prim[i],
    })
}

fn a6_accuracy(trials: u64) -> Outcome {
    let mut rng = Rng(11);
    let (mut outcome, mut of_bound, mut ulps, mut shapely) =
        (Outcome::default(), 0.0f64, 0.0f64, 0u64);
    while outcome.trials < trials {
        let size = rng.log(-6.0, 6.0).abs();
        let middle = Vec3::from(rng.in_cube(1.0)) * (size * rng.log(-2.0, 4.0)) as f32;
        let v = [(); 3].map(|()| middle + Vec3::from(rng.in_cube(size)));
        let scene = Parts::of(vec![v]).scene(Accel::Bvh);
        let mut rays = Rays::default();
        for _ in 0..RAYS {
            // Beside an edge, weights are moved inward (A15).
            let a = rng.range(0.02, 0.96);
            let b = rng.range(0.02, 0.98 - a);
            let target =
                v[0].as_dvec3() + (v[1] - v[0]).as_dvec3() * a + (v[2] - v[0]).as_dvec3() * b;
            let d = DVec3::from(rng.direction().map(f64::from));
            let origin = (target - d * size * rng.range(0.5, 4.0)).as_vec3();
            rays.push(origin.to_array(), d.as_vec3().to_array(), f32::MAX);
        }
        let hits = best(&scene, &rays);
        let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]].map(|e| e.as_dvec3());
        let normal = edges[0].cross(edges[1]);
        let longest = edges.iter().map(|e| e.length()).fold(0.0, f64::max);
        for i in 0..rays.len() {
            if hits.prim[i] == Hits::NONE {
                continue;
            }
            let r = ray(&rays, i);
            let [t, u, w] = exact::triangle(v, r);
            let error = (f64::from(hits.t[i]) - t).abs();
            let bound =
                f64::from(t_error_bound(v.map(|v| v.to_array()), r[0], r[1])) + 4.0 * EPS * t;
            let d = DVec3::from(r[1].map(f64::from));
            // Neither thin nor seen at a slant, nor so far off that the coordinates themselves say less.
            let well = normal.length() > 0.3 * longest * longest
                && normal.normalize().dot(d).abs() > 0.3
                && f64::from(middle.abs().max_element()) < 4.0 * size
                && longest > 0.5 * size;
            let off = (error / t)
                .max((f64::from(hits.u[i]) - u).abs())
                .max((f64::from(hits.v[i]) - w).abs())
                / EPS;
            of_bound = of_bound.max(error / bound);
            if well {
                shapely += 1;
                ulps = ulps.max(off);
            }
            let failed = error > bound || well && off > 16.0;
            outcome.add(Outcome::new(1, usize::from(failed)));
        }
    }
    assert!(shapely > trials / 100, "{shapely} shapely ones");
    outcome.saying(format!(
        "t within {of_bound:.2} of its bound; {shapely} hits on shapely triangles within {ulps:.1} ulp"
    ))
}

/// Sides up to 1 and as thin as 1e-6; every tenth has the sides of a known false hit far beyond a triangle.
fn thin(k: u64, rng: &mut Rng) -> [Vec3; 3] {
    let [x, y, z] = [(); 3].map(|()| Vec3::from(rng.direction()));
    if k.is_multiple_of(10) {
        let far = Vec3::from(rng.in_cube(400.0));
        return [
            far,
            far + 11.2 * x,
            far + 9.7 * x + 1.4 * (y - x * x.dot(y)),
        ];
    }
    let aspect = rng.range(-6.0, 0.0);
    let at = Vec3::from(rng.in_cube(1.0));
    [
        at,
        at + x,
        at + x * rng.unit() as f32 + (10f64.powf(aspect) as f32) * z,
    ]
}

fn a7_grazing(trials: u64) -> Outcome {
    let mut rng = Rng(12);
    let (mut outcome, mut hit, mut edge) = (Outcome::default(), 0u64, 0u64);
    for k in 0.. {
        if outcome.trials >= trials {
            break;
        }
        let v = thin(k, &mut rng);
        let normal = (v[1] - v[0]).as_dvec3().cross((v[2] - v[0]).as_dvec3());
        let mut rays = Rays::default();
        for _ in 0..RAYS {
            let [a, b] = [rng.unit(), rng.unit()];
            let target = v[0].as_dvec3()
                + (v[1] - v[0]).as_dvec3() * a
                + (v[2] - v[0]).as_dvec3() * b * (1.0 - a);
            let angle = 10f64.powf(rng.range(-7.0, -1.0));
            let n = normal.normalize_or(DVec3::Y);
            let across = n.cross(DVec3::from(rng.direction().map(f64::from)));
            let d = across.normalize_or(n.any_orthonormal_vector()) + angle * n;
            let far = if k.is_multiple_of(10) {
                600.0
            } else {
                rng.range(0.5, 50.0)
            };
            let origin = (target - d * far).as_vec3();
            rays.push(origin.to_array(), d.as_vec3().to_array(), f32::MAX);
        }
        let hits = best(&Parts::of(vec![v]).scene(Accel::Bvh), &rays);
        let triangles = [v];
        let referee = Referee::new(Primitives {
            triangles: &triangles,
            ..Primitives::default()
        });
        for i in 0..rays.len() {
            let r = ray(&rays, i);
            let verdict = referee.trace(r, f32::MAX).judge(found(&hits, i));
            hit += u64::from(hits.prim[i] != Hits::NONE);
            edge += u64::from(verdict == Verdict::Edge);
            let outside = hits.prim[i] != Hits::NONE && !in_box(&v, r, hits.t[i]);
            let failed = verdict == Verdict::Wrong || outside;
            if failed {
                println!("{verdict:?}, t {}: {v:?} {r:?}", hits.t[i]);
            }
            outcome.add(Outcome::new(1, usize::from(failed)));
        }
    }
    assert!(hit > trials / 20, "only {hit} hits");
    outcome.saying(format!(
        "{hit} hits; {edge} rays so near an edge that f32 cannot tell"
    ))
}

/// Whether t lies where the ray is in the triangle's box: widened by four units in the last place at either end, as the
/// kernels do, and by two for the rounding of that.
fn in_box(v: &[Vec3; 3], [o, d]: [[f32; 3]; 2], t: f32) -> bool {
    let (mut near, mut far) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let [a, b, c] = v.map(|v| f64::from(v[axis]) - f64::from(o[axis]));
        let d = f64::from(d[axis]);
        let [low, high] = [a.min(b).min(c) / d, a.max(b).max(c) / d];
        if low.is_nan() || high.is_nan() {
            continue;
        }
        near = near.max(low.min(high));
        far = far.min(low.max(high));
    }
    let t = f64::from(t);
    t >= near * (1.0 - 6.0 * EPS) && t <= far * (1.0 + 6.0 * EPS)
}

fn a8_degenerate(trials: u64) -> Outcome {
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    // Two equal corners, or something not finite.
    let never = [
        [p(0.0, 0.0, 0.0); 3],
        [p(1.0, 2.0, 3.0), p(1.0, 2.0, 3.0), p(-1.0, 0.5, 0.25)],
        [p(1.0, 2.0, 3.0), p(-1.0, 0.5, 0.25), p(1.0, 2.0, 3.0)],
        [p(0.0, nan, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)],
        [p(0.0, 0.0, 0.0), p(inf, 0.0, 0.0), p(0.0, 1.0, 0.0)],
        [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, -inf, 0.0)],
        [p(nan, nan, nan); 3],
    ];
    // These may be hit by rays that come so near that only rounding tells: else closed meshes of such would have cracks.
    let tiny = [
        [p(-1.0, -1.0, -1.0), p(0.0, 0.0, 0.0), p(1.0, 1.0, 1.0)],
        [p(0.0, 0.0, 0.0), p(0.25, 0.5, 0.75), p(0.5, 1.0, 1.5)],
        [p(0.0, 0.0, 0.0), p(1e-40, 0.0, 0.0), p(0.0, 1e-40, 0.0)],
        [p(0.0, 0.0, 0.0), p(1e-19, 0.0, 0.0), p(0.0, 1e-19, 0.0)],
        [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.5, 1e-38, 0.0)],
        [
            p(0.0, 0.0, 0.0),
            p(1.0, 1.0, 1.0),
            p(0.333_333_34, 0.333_333_34, 0.333_333_3),
        ],
        [p(-1e18, 0.0, 0.0), p(1e18, 0.0, 0.0), p(0.0, 1e18, 0.0)],
    ];
    let all: Vec<[Vec3; 3]> = never.iter().chain(&tiny).copied().collect();
    let scene = Parts::of(all.clone()).scene(Accel::Bvh);
    let mut rng = Rng(13);
    let mut rays = Rays::default();
    for i in 0..trials as usize {
        let v = all[i % all.len()];
        let [a, b] = [rng.unit() as f32, rng.unit() as f32];
        let target = match i % 3 {
            0 => v[rng.below(3)],
            1 => v[0] + (v[1] - v[0]) * a,
            _ => v[0] * (1.0 - a) + (v[1] * (1.0 - b) + v[2] * b) * a,
        };
        let target = if target.is_finite() && target.length() < 1e6 {
            target
        } else {
            Vec3::ZERO
        };
        let origin = Vec3::from(rng.in_cube(2.0));
        rays.push(origin.to_array(), (target - origin).to_array(), f32::MAX);
    }
    let hits = best(&scene, &rays);
    let same = bits(&hits);
    let mut failures = 0;
    for i in 0..rays.len() {
        let hit = hits.prim[i] != Hits::NONE;
        let finite = !hit
            || [hits.t[i], hits.u[i], hits.v[i], hits.err[i]]
                .iter()
                .all(|x| x.is_finite());
        failures += usize::from(!finite || hit && (hits.prim[i] as usize) < never.len());
    }
    for isa in Isa::all() {
        for accel in [Accel::Brute, Accel::Bvh] {
            let again = bits(&trace(&Parts::of(all.clone()).scene(accel), isa, &rays));
            failures += again.iter().zip(&same).filter(|(a, b)| a != b).count();
        }
    }
    Outcome::new(rays.len(), failures)
}

fn a11_coincident(trials: u64) -> Outcome {
    let mut rng = Rng(14);
    let quad =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.5));
    let [front, back] = [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]];
    let over = |t: [Vec3; 3]| [t[0], t[2], t[1]];
    // What is hit: of a quad turned over as often as not, each half a thousand times; then other things in its plane.
    let mut stack: Vec<[Vec3; 3]> = Vec::new();
    for k in 0..1000 {
        let turn = |t| if k % 2 == 0 { t } else { over(t) };
        stack.extend([turn(front), turn(back)]);
    }
    for _ in 0..200 {
        stack.push([(); 3].map(|()| Vec3::from(rng.in_cube(1.5)).with_z(0.5)));
    }
    let mut rays = Rays::default();
    for _ in 0..trials / 10 {
        let origin = Vec3::from(rng.in_cube(2.0)).with_z(-1.0);
        let target = Vec3::from(rng.in_cube(0.99)).with_z(0.5);
        rays.push(origin.to_array(), (target - origin).to_array(), f32::MAX);
    }
    let mut outcome = Outcome::default();
    let mut t: Option<Vec<u32>> = None;
    for _ in 0..10 {
        for i in (1..stack.len()).rev() {
            stack.swap(i, rng.below(i + 1));
        }
        let hits = best(&Parts::of(stack.clone()).scene(Accel::Bvh), &rays);
        let brute = best(&Parts::of(stack.clone()).scene(Accel::Brute), &rays);
        let first = |t: [Vec3; 3]| {
            let equal = stack.iter().position(|s| *s == t);
            equal.expect("one of the stack") as u32
        };
        let of_t: Vec<u32> = hits.t.iter().map(|t| t.to_bits()).collect();
        let known = t.get_or_insert_with(|| of_t.clone());
        let lowest: Vec<u32> = stack.iter().map(|&s| first(s)).collect();
        let failures = (0..rays.len()).filter(|&i| {
            let prim = hits.prim[i];
            prim == Hits::NONE
                || prim != brute.prim[i]
                || lowest[prim as usize] != prim
                || of_t[i] != known[i]
        });
        outcome.add(Outcome::new(rays.len(), failures.count()));
    }
    outcome
}
