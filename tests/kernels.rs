//! The kernels against each other (instruction sets, trees), against an f64 oracle, and against what geometry says must be hit.

mod support;

use luxel::build::bvh::{Accel, Primitives, SphereItem, build, sphere_bounds, validate::validate};
use luxel::flat::{FlatScene, Spheres};
use luxel::math::{Aabb, DAffine3, DQuat, DVec3, Vec3};
use luxel::trace::kernels::t_error_bound;
use luxel::trace::spawn::{
    instance_normal, instance_point, offset_origin, sphere_point, triangle_normal, triangle_point,
    triangle_vertices,
};
use luxel::trace::{Hits, Isa, Rays, closest_hit, occluded};
use support::{Parts, Rng, Solid};

const EVERY: [Accel; 3] = [Accel::Brute, Accel::Box, Accel::Bvh];

fn trace(scene: &FlatScene, isa: Isa, rays: &Rays) -> Hits {
    let mut hits = Hits::default();
    closest_hit(scene, isa, rays, &mut hits);
    hits
}

fn best(scene: &FlatScene, rays: &Rays) -> Hits {
    trace(scene, Isa::best(), rays)
}

fn misses(hits: &Hits) -> usize {
    hits.prim.iter().filter(|&&p| p == Hits::NONE).count()
}

fn bits(hits: &Hits) -> Vec<[u32; 6]> {
    (0..hits.t.len())
        .map(|i| {
            [
                hits.t[i].to_bits(),
                hits.u[i].to_bits(),
                hits.v[i].to_bits(),
                hits.prim[i],
                hits.instance[i],
                hits.err[i].to_bits(),
            ]
        })
        .collect()
}

fn ray(rays: &Rays, i: usize) -> [[f32; 3]; 2] {
    [
        [rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]],
        [rays.dir[0][i], rays.dir[1][i], rays.dir[2][i]],
    ]
}

/// Point and geometric normal of a hit, as the surface stage gets them.
fn surface(scene: &FlatScene, rays: &Rays, hits: &Hits, i: usize) -> ([f32; 3], [f32; 3]) {
    let [prim, instance] = [hits.prim[i], hits.instance[i]];
    let [u, v] = [hits.u[i], hits.v[i]];
    if prim & Spheres::TAG != 0 {
        let s = (prim & !Spheres::TAG) as usize;
        let (center, radius) = (scene.spheres.center[s], scene.spheres.radius[s]);
        sphere_point(ray(rays, i), hits.t[i], center, radius)
    } else if instance == Hits::WORLD {
        let vertices = triangle_vertices(&scene.world.triangles, prim);
        (triangle_point(vertices, u, v), triangle_normal(vertices))
    } else {
        let instance = &scene.instances[instance as usize];
        let local = &scene.local[instance.geometry as usize];
        let vertices = triangle_vertices(&local.triangles, prim);
        (
            instance_point(instance, triangle_point(vertices, u, v)),
            instance_normal(instance, triangle_normal(vertices)),
        )
    }
}

fn soup(rng: &mut Rng, n: usize, half: f64, size: f64) -> Vec<[Vec3; 3]> {
    (0..n)
        .map(|_| {
            let at = Vec3::from(rng.in_cube(half));
            [(); 3].map(|()| at + Vec3::from(rng.in_cube(size)))
        })
        .collect()
}

/// Everything at once: two meshes, a soup with degenerate and broken triangles, equal triangles, spheres in the tree and
/// out of it, and instances that turn, stretch and mirror.
fn mixed() -> Parts {
    let mut rng = Rng(1);
    let mut triangles = Solid::uv_sphere(12, 16).triangles();
    let first = triangles.len() as u32;
    triangles.extend(soup(&mut rng, 300, 3.0, 0.5));
    triangles.extend([triangles[0]; 20]);
    triangles.push([Vec3::ONE; 3]);
    triangles.push([Vec3::ZERO, Vec3::splat(f32::NAN), Vec3::X]);
    triangles.push([Vec3::ZERO, Vec3::splat(f32::INFINITY), Vec3::X]);
    let groups = vec![0..first, first..triangles.len() as u32];
    let spheres = (0..40)
        .map(|_| {
            let c = rng.in_cube(3.0).map(f64::from);
            (c, 10f64.powf(rng.range(-2.0, -0.3)))
        })
        .collect();
    let turn = DQuat::from_xyzw(0.1, 0.5, -0.3, 0.8).normalize();
    let place = |x: f64, s: DVec3| {
        DAffine3::from_scale_rotation_translation(s, turn, DVec3::new(x, 0.3, -0.2))
    };
    Parts {
        triangles,
        groups,
        tree_spheres: spheres,
        looped: vec![([0.0, -1000.0, 0.0], 997.0), ([0.0, 1e5, 0.0], 1e5 - 4.0)],
        meshes: vec![
            Solid::icosphere(2).triangles(),
            soup(&mut rng, 50, 1.0, 0.7),
        ],
        instances: vec![
            (0, place(1.5, DVec3::ONE)),
            (0, place(-1.5, DVec3::new(2.0, 0.1, 0.5))),
            (1, place(0.0, DVec3::new(-1.0, 1.0, 1.0))),
            (1, place(0.5, DVec3::splat(1e-2))),
        ],
    }
}

/// Rays of all kinds, the hostile included.
fn hostile_rays(n: usize) -> Rays {
    let mut rng = Rng(2);
    let mut rays = Rays::default();
    let odd = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        1e-40,
        f32::MAX,
        1e-20,
    ];
    for i in 0..n {
        let mut origin = rng.in_cube(4.0);
        let mut dir = rng.direction();
        let mut t_max = f32::MAX;
        match i % 8 {
            0 => dir = [0, 1, 2].map(|_| odd[rng.below(4)]),
            1 => origin = origin.map(|x| x.round()),
            2 => dir = dir.map(|x| x * 1e3),
            3 => t_max = rng.range(0.0, 6.0) as f32,
            4 if i % 16 == 4 => origin[rng.below(3)] = odd[rng.below(odd.len())],
            5 if i % 16 == 5 => dir[rng.below(3)] = odd[rng.below(odd.len())],
            6 if i % 16 == 6 => t_max = odd[rng.below(odd.len())],
            _ => {}
        }
        rays.push(origin, dir, t_max);
    }
    rays
}

#[test]
fn every_instruction_set_and_every_tree_gives_the_same_bits() {
    let rays = hostile_rays(20_003);
    let parts = mixed();
    let reference = bits(&trace(&parts.scene(Accel::Bvh), Isa::SCALAR, &rays));
    let kinds = [
        |h: &[u32; 6]| h[3] == Hits::NONE,
        |h: &[u32; 6]| h[3] != Hits::NONE && h[3] & Spheres::TAG != 0,
        |h: &[u32; 6]| h[3] & Spheres::TAG == 0 && h[4] == Hits::WORLD,
        |h: &[u32; 6]| h[4] != Hits::WORLD,
    ];
    for kind in kinds {
        let count = reference.iter().filter(|h| kind(h)).count();
        assert!(
            count > 500,
            "only {count} rays of a kind: {rays:?}",
            rays = rays.len()
        );
    }
    for accel in EVERY {
        let scene = parts.scene(accel);
        for isa in Isa::all() {
            let found = bits(&trace(&scene, isa, &rays));
            for (i, (a, b)) in reference.iter().zip(&found).enumerate() {
                assert_eq!(a, b, "{accel:?} {isa:?} ray {i}: {:?}", ray(&rays, i));
            }
        }
    }
    for (i, h) in reference.iter().enumerate() {
        let [t, u, v, .., err] = h.map(f32::from_bits);
        assert!(
            t > 0.0 && u >= 0.0 && v >= 0.0 && (0.0..1.0).contains(&err),
            "ray {i}: {h:?}"
        );
        let limit = rays.t_max[i];
        assert!(
            h[3] == Hits::NONE || t <= limit,
            "ray {i} at {t} beyond {limit}"
        );
    }
}

#[test]
fn occluded_is_a_hit_below_the_limit() {
    let parts = mixed();
    let mut rays = hostile_rays(4_001);
    let free = best(&parts.scene(Accel::Bvh), &rays);
    for (i, &t) in free.t.iter().enumerate() {
        // Exactly at the hit, one step before, one step after.
        match i % 6 {
            0 => rays.t_max[i] = t,
            1 => rays.t_max[i] = t.next_up(),
            2 => rays.t_max[i] = t.next_down(),
            _ => {}
        }
    }
    for accel in EVERY {
        let scene = parts.scene(accel);
        for isa in Isa::all() {
            let hits = trace(&scene, isa, &rays);
            let mut out = vec![true; 3];
            occluded(&scene, isa, &rays, &mut out);
            for (i, &out) in out.iter().enumerate() {
                let expected = hits.t[i] < rays.t_max[i];
                assert_eq!(out, expected, "{accel:?} {isa:?} ray {i}");
            }
        }
    }
}

#[test]
fn batches_of_any_length_agree() {
    let scene = mixed().scene(Accel::Bvh);
    let all = hostile_rays(50);
    let whole = bits(&best(&scene, &all));
    for n in (0..35).chain([47, 48, 49]) {
        for isa in Isa::all() {
            let mut rays = Rays::default();
            (0..n).for_each(|i| rays.push(ray(&all, i)[0], ray(&all, i)[1], all.t_max[i]));
            assert_eq!(bits(&trace(&scene, isa, &rays)), whole[..n]);
        }
    }
    let nothing = support::empty_scene();
    for isa in Isa::all() {
        assert_eq!(misses(&trace(&nothing, isa, &all)), 50);
    }
}

/// Rays from inside a closed mesh to points of its edges and to its vertices.
fn aimed(solid: &Solid, n: usize, rng: &mut Rng) -> Rays {
    let mut rays = Rays::default();
    for i in 0..n {
        let face = solid.faces[rng.below(solid.faces.len())];
        let k = rng.below(3);
        let [a, b] = [face[k], face[(k + 1) % 3]].map(|i| solid.vertices[i]);
        let s = if i % 2 == 0 { 0.0 } else { rng.unit() as f32 };
        let target = a + (b - a) * s;
        let origin = if i % 16 == 0 {
            Vec3::ZERO
        } else {
            Vec3::from(rng.in_cube(0.4))
        };
        let mut dir = target - origin;
        if i % 3 == 0 {
            dir = dir.normalize();
        }
        rays.push(origin.to_array(), dir.to_array(), f32::MAX);
    }
    rays
}

#[test]
fn closed_meshes_have_no_cracks() {
    let mut rng = Rng(3);
    let mut star = Solid::icosphere(3);
    for v in &mut star.vertices {
        *v *= rng.range(1.0, 6.0) as f32;
    }
    let solids = [Solid::uv_sphere(24, 48), Solid::icosphere(4), star];
    for (k, solid) in solids.iter().enumerate() {
        let scene = Parts::of(solid.triangles()).scene(Accel::Bvh);
        let hits = best(&scene, &aimed(solid, 250_000, &mut rng));
        assert_eq!(misses(&hits), 0, "mesh {k}");
    }
    let solid = &solids[0];
    let turn = DQuat::from_xyzw(0.3, -0.2, 0.5, 0.7).normalize();
    let m = DAffine3::from_scale_rotation_translation(DVec3::ONE, turn, DVec3::ZERO);
    let parts = Parts {
        meshes: vec![solid.triangles()],
        instances: vec![(0, m)],
        ..Parts::default()
    };
    let mut turned = solid.clone();
    for v in &mut turned.vertices {
        *v = m.transform_point3(v.as_dvec3()).as_vec3();
    }
    let hits = best(&parts.scene(Accel::Bvh), &aimed(&turned, 250_000, &mut rng));
    assert_eq!(misses(&hits), 0, "instance");
}

#[test]
fn an_integer_grid_has_no_cracks() {
    let n = 32;
    let mut rng = Rng(4);
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let p = |x: i32, y: i32| Vec3::new((i + x) as f32, (j + y) as f32, 0.0);
            triangles.push([p(0, 0), p(1, 0), p(1, 1)]);
            triangles.push([p(0, 0), p(1, 1), p(0, 1)]);
        }
    }
    let mut rays = Rays::default();
    for i in 0..200_000 {
        let line = |rng: &mut Rng| rng.below(n as usize + 1) as f32;
        let free = |rng: &mut Rng| (rng.unit() * f64::from(n)) as f32;
        let x = if i % 2 == 0 {
            line(&mut rng)
        } else {
            free(&mut rng)
        };
        let y = if i % 4 < 2 {
            line(&mut rng)
        } else {
            free(&mut rng)
        };
        let zero = if i % 8 < 4 { 0.0 } else { -0.0 };
        rays.push([x, y, 10.0], [zero, zero, -1.0], f32::MAX);
    }
    // The quad whose diagonal a published test runs along.
    let s = 5.0;
    let quad = [[-s, -s], [s, -s], [s, s], [-s, s]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let diagonal = vec![[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]];
    let mut along = Rays::default();
    along.push(
        [0.0, 0.0, 10.0],
        [0.304_584_47, 0.304_584_47, -0.902_472_5],
        f32::MAX,
    );
    for accel in EVERY {
        assert_eq!(
            misses(&best(&Parts::of(triangles.clone()).scene(accel), &rays)),
            0
        );
        assert_eq!(
            misses(&best(&Parts::of(diagonal.clone()).scene(accel), &along)),
            0
        );
    }
}

/// Möller–Trumbore in f64, no box, no tree.
fn oracle(v: [Vec3; 3], [o, d]: [[f32; 3]; 2]) -> Option<[f64; 3]> {
    let [v0, v1, v2] = v.map(|v| v.as_dvec3());
    let [o, d] = [o, d].map(|x| DVec3::from(x.map(f64::from)));
    let (e1, e2) = (v1 - v0, v2 - v0);
    let p = d.cross(e2);
    let det = e1.dot(p);
    let s = o - v0;
    let q = s.cross(e1);
    let [t, u, v] = [e2.dot(q) / det, s.dot(p) / det, d.dot(q) / det];
    Some([t, u, v])
}

fn oracle_hit(v: [Vec3; 3], r: [[f32; 3]; 2], slack: f64) -> Option<f64> {
    let [t, u, v] = oracle(v, r)?;
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
                for t in [t, b] {
                    let error = (f64::from(t) - exact).abs() / exact;
                    assert!(error <= 1.2e-7, "R = {r} ray {i}: {t} {exact}");
                }
            }
        }
    }
}

/// The smallest root above 0, in twice the digits of f64: coefficients as sums of two f64, then one step of Newton on
/// |o + t d − C|² − r² evaluated exactly enough. Nothing for grazing rays, where t itself is ill-conditioned.
fn exact_root(c: [f64; 3], r: f64, [o, d]: [[f32; 3]; 2]) -> Option<f64> {
    let oc = DVec3::from(o.map(f64::from)) - DVec3::from(c);
    let d = DVec3::from(d.map(f64::from));
    let [a, b] = [d.dot(d), oc.dot(d)];
    // (|oc| − r)(|oc| + r) cancels where |oc| is near r: take it component by component, C = ±r e + rest.
    let value = residual(c, r, o);
    let disc = b * b - a * value;
    if disc < 1e-6 * b * b + 1e-9 * r * r * a {
        return disc_negative(disc);
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

fn disc_negative(_: f64) -> Option<f64> {
    None
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
fn rays_that_leave_a_triangle_do_not_meet_it_again() {
    let mut rng = Rng(7);
    for case in 0..2000 {
        let [span, offset] = [
            rng.log(-6.0, 6.0),
            if case % 2 == 0 {
                0.0
            } else {
                rng.log(-3.0, 7.0)
            },
        ];
        let at = DVec3::from([(); 3].map(|()| offset * rng.range(-1.0, 1.0)));
        let v = [(); 3]
            .map(|()| (at + DVec3::from([(); 3].map(|()| span * rng.range(-1.0, 1.0)))).as_vec3());
        let scene = Parts::of(vec![v]).scene(Accel::Bvh);
        let toward = |rng: &mut Rng| {
            let [a, b] = [rng.unit() as f32, rng.unit() as f32];
            let (a, b) = if a + b > 1.0 {
                (1.0 - a, 1.0 - b)
            } else {
                (a, b)
            };
            v[0] + (v[1] - v[0]) * a + (v[2] - v[0]) * b
        };
        let mut rays = Rays::default();
        for _ in 0..40 {
            let d = Vec3::from(rng.direction());
            let distance = (span.abs() * rng.range(0.1, 10.0)) as f32;
            rays.push(
                (toward(&mut rng) - d * distance).to_array(),
                d.to_array(),
                f32::MAX,
            );
        }
        assert_eq!(
            returns(&scene, &rays, &mut rng, 10),
            0,
            "case {case}: {v:?}"
        );
    }
}

/// Traces, then sends `n` rays off every hit to each side; returns how many meet the same primitive again, which a flat one
/// never, a sphere only from inside may.
fn returns(scene: &FlatScene, rays: &Rays, rng: &mut Rng, n: usize) -> usize {
    let hits = best(scene, rays);
    let mut away = Rays::default();
    let mut from = Vec::new();
    for i in 0..rays.len() {
        if hits.prim[i] == Hits::NONE {
            continue;
        }
        let (p, ng) = surface(scene, rays, &hits, i);
        for k in 0..n {
            let mut dir = Vec3::from(rng.direction());
            if k == 0 {
                // Nearly along the surface.
                dir = (dir.cross(Vec3::from(ng)) + 1e-3 * Vec3::from(ng)).normalize_or(dir);
            }
            let sphere = hits.prim[i] & Spheres::TAG != 0;
            if sphere && dir.as_dvec3().dot(Vec3::from(ng).as_dvec3()) < 0.0 {
                dir = -dir;
            }
            let dir = dir.to_array();
            away.push(offset_origin(p, ng, hits.err[i], dir), dir, f32::MAX);
            from.push((hits.instance[i], hits.prim[i]));
        }
    }
    let again = best(scene, &away);
    let pairs = again.instance.iter().zip(&again.prim);
    from.iter()
        .zip(pairs)
        .filter(|(a, b)| (a.0, a.1) == (*b.0, *b.1))
        .count()
}

#[test]
fn rays_that_leave_a_sphere_do_not_meet_it_again() {
    let mut rng = Rng(8);
    for k in -4..=8 {
        for case in 0..24 {
            let r = 10f64.powi(k);
            let away = [0.0, 1.0, 1e3][case % 3] * r;
            let center = rng.direction().map(|d| f64::from(d) * away);
            // Half of them pass near the scene's origin, as walls do.
            let center = if case % 2 == 0 {
                center
            } else {
                DVec3::from(rng.direction().map(f64::from))
                    .normalize()
                    .to_array()
                    .map(|d| d * r * 1.001)
            };
            let parts = match case % 4 {
                0 | 1 => Parts {
                    looped: vec![(center, r)],
                    ..Parts::default()
                },
                _ => Parts {
                    tree_spheres: vec![(center, r)],
                    ..Parts::default()
                },
            };
            let mut rays = Rays::default();
            for _ in 0..100 {
                let target =
                    DVec3::from(center) + DVec3::from(rng.direction().map(f64::from)) * r * 0.9;
                let d = DVec3::from(rng.direction().map(f64::from));
                let o = target - d * r * rng.range(0.0, 5.0);
                rays.push(
                    o.as_vec3().to_array(),
                    (target - o).normalize_or(d).as_vec3().to_array(),
                    f32::MAX,
                );
            }
            assert_eq!(
                returns(&parts.scene(Accel::Bvh), &rays, &mut rng, 10),
                0,
                "r = {r}, case {case}"
            );
        }
    }
}

#[test]
fn rays_that_leave_an_instance_do_not_meet_it_again() {
    let mut rng = Rng(9);
    for case in 0..300 {
        let q = DQuat::from_xyzw(
            rng.range(-1.0, 1.0),
            rng.range(-1.0, 1.0),
            rng.range(-1.0, 1.0),
            0.5,
        )
        .normalize();
        let scale = DVec3::new(rng.log(-3.0, 3.0), rng.log(-3.0, 3.0), rng.log(-3.0, 3.0));
        let move_by = DVec3::new(rng.log(-3.0, 5.0), rng.log(-3.0, 5.0), rng.log(-3.0, 5.0));
        let m = DAffine3::from_scale_rotation_translation(scale, q, move_by);
        let v = [(); 3].map(|()| Vec3::from(rng.in_cube(1.0)));
        let parts = Parts {
            meshes: vec![vec![v]],
            instances: vec![(0, m)],
            ..Parts::default()
        };
        let scene = parts.scene(Accel::Bvh);
        let mut rays = Rays::default();
        for _ in 0..40 {
            let target = m
                .transform_point3(((v[0] + v[1] + v[2]) / 3.0).as_dvec3())
                .as_vec3();
            let d = Vec3::from(rng.direction());
            rays.push(
                (target - d * scale.abs().max_element() as f32).to_array(),
                d.to_array(),
                f32::MAX,
            );
        }
        assert_eq!(
            returns(&scene, &rays, &mut rng, 20),
            0,
            "case {case}: {m:?}"
        );
    }
}

#[test]
fn corners_and_planes_of_boxes_are_inside() {
    // Two triangles that fill the box's faces x = 0 and x = 1, met by rays that run in its planes, along its edges and
    // through its corners.
    let quad = |x: f32| {
        let p = |y: f32, z: f32| Vec3::new(x, y, z);
        [
            [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0)],
            [p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)],
        ]
    };
    let scene = Parts::of([quad(0.0), quad(1.0)].concat()).scene(Accel::Bvh);
    let mut rays = Rays::default();
    for y in [0.0, 0.5, 1.0] {
        for z in [0.0, 0.25, 1.0] {
            for zero in [0.0f32, -0.0] {
                rays.push([-1.0, y, z], [1.0, zero, -zero], f32::MAX);
                rays.push([2.0, y, z], [-1.0, zero, zero], f32::MAX);
                rays.push([-2.0, y, z], [1e-3, zero, zero], f32::MAX);
            }
        }
    }
    assert_eq!(misses(&best(&scene, &rays)), 0);
    // Corner rays: from anywhere to a vertex of a box that is a triangle's vertex too.
    let mut rng = Rng(10);
    for offset in [0.0, 1e2, 1e4] {
        let solid = {
            let mut s = Solid::icosphere(1);
            s.vertices
                .iter_mut()
                .for_each(|v| *v += Vec3::splat(offset));
            s
        };
        let scene = Parts::of(solid.triangles()).scene(Accel::Bvh);
        let mut rays = Rays::default();
        for _ in 0..20_000 {
            let target = solid.vertices[rng.below(solid.vertices.len())];
            let origin = Vec3::splat(offset) + Vec3::from(rng.in_cube(0.3));
            rays.push(origin.to_array(), (target - origin).to_array(), f32::MAX);
        }
        assert_eq!(misses(&best(&scene, &rays)), 0, "offset {offset}");
    }
}

#[test]
fn powers_of_two_scale_bits() {
    let rays = {
        let mut rng = Rng(11);
        let mut rays = Rays::default();
        (0..4000).for_each(|_| rays.push(rng.in_cube(4.0), rng.direction(), f32::MAX));
        rays
    };
    let mut parts = mixed();
    parts.instances.clear();
    parts.triangles.truncate(parts.triangles.len() - 2);
    let one = best(&parts.scene(Accel::Bvh), &rays);
    for k in [-20, -1, 1, 20] {
        let s = 2f64.powi(k);
        let mut scaled = parts.clone();
        scaled
            .triangles
            .iter_mut()
            .flatten()
            .for_each(|v| *v *= s as f32);
        for sphere in scaled.tree_spheres.iter_mut().chain(&mut scaled.looped) {
            sphere.0.iter_mut().for_each(|c| *c *= s);
            sphere.1 *= s;
        }
        let mut moved = rays.clone();
        moved
            .origin
            .iter_mut()
            .flatten()
            .for_each(|x| *x *= s as f32);
        let other = best(&scaled.scene(Accel::Bvh), &moved);
        for i in 0..rays.len() {
            let [t, err] = [other.t[i] / s as f32, other.err[i] / s as f32];
            let same = (
                t.to_bits(),
                other.u[i].to_bits(),
                other.prim[i],
                err.to_bits(),
            );
            assert_eq!(
                same,
                (
                    one.t[i].to_bits(),
                    one.u[i].to_bits(),
                    one.prim[i],
                    one.err[i].to_bits()
                ),
                "2^{k} ray {i}"
            );
        }
    }
}

#[test]
fn trees_keep_their_promises() {
    let mut rng = Rng(12);
    let equal = vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 100_000];
    let spaced: Vec<[Vec3; 3]> = (0..240)
        .map(|i| 2f32.powi(i - 120))
        .map(|x| {
            [
                Vec3::splat(x),
                Vec3::splat(x * 1.1),
                Vec3::new(x, x, 1.1 * x),
            ]
        })
        .collect();
    let broken: Vec<[Vec3; 3]> = (0..99)
        .map(|i| {
            [
                Vec3::splat(if i % 3 == 0 { f32::NAN } else { i as f32 }),
                Vec3::X,
                Vec3::splat(f32::MAX),
            ]
        })
        .collect();
    let sets = [
        Vec::new(),
        equal[..1].to_vec(),
        equal,
        spaced,
        broken,
        soup(&mut rng, 30_000, 1.0, 0.02),
    ];
    let spheres: Vec<SphereItem> = (0..300)
        .map(|i| SphereItem {
            center: rng.in_cube(1.0).map(f64::from),
            radius: 10f64.powi(i as i32 % 5 - 4),
            prim: i,
        })
        .collect();
    let boxes: Vec<Aabb> = spheres
        .iter()
        .map(|s| sphere_bounds(s.center, s.radius))
        .collect();
    for triangles in &sets {
        for (s, i) in [(0, 0), (300, 0), (0, 100), (3, 2), (300, 100)] {
            for accel in EVERY {
                let half = triangles.len() as u32 / 2;
                let groups = [0..half, half..triangles.len() as u32];
                let p = Primitives {
                    triangles,
                    groups: &groups,
                    spheres: &spheres[..s],
                    instances: &boxes[..i],
                };
                let built = build(&p, accel);
                validate(&p, &built)
                    .unwrap_or_else(|e| panic!("{accel:?} {} {s} {i}: {e}", triangles.len()));
            }
        }
    }
}
