//! Instances against what they stand for: the same mesh, its vertices placed in f64.

use crate::judge::{Judge, Triangles};
use crate::stage::{Stage, obj, picture, points, trace};
use crate::support::{Rng, Solid};
use luxel::flat::FlatScene;
use luxel::math::{DMat3, DVec3, Vec3, quaternion};
use luxel::measure::referee::Verdict;
use luxel::trace::spawn::offset_origin;
use luxel::trace::{Hits, Rays, TraceOptions, hit_place, identity};
use std::fmt::Write;

/// Rotate, stretch, in scene units: how the entity of [`stretched`] is placed.
struct Placed {
    linear: DMat3,
    text: String,
}

impl Placed {
    fn random(rng: &mut Rng) -> Placed {
        let q = [(); 4].map(|()| rng.range(-1.0, 1.0));
        let s = [(); 3].map(|()| 10f64.powf(rng.range(-4.0, 4.0)));
        Placed {
            linear: quaternion(q) * DMat3::from_diagonal(DVec3::from(s)),
            text: format!(
                "rotate: Quat({:?}, {:?}, {:?}, {:?}), scale: ({:?}, {:?}, {:?})",
                q[0], q[1], q[2], q[3], s[0], s[1], s[2]
            ),
        }
    }
}

fn stretched(placed: &Placed) -> String {
    format!(
        "camera: (at: (0, 0, 0), look_at: (0, 0, -1)), entities: [(shape: Mesh(\"ball.obj\"), normals: Flat,
         spin: (axis: (0, 0, 1), deg_per_s: 90), transform: ({}))]",
        placed.text
    )
}

/// Stretched by 10^±4 along every axis: rays that are aimed at the middle of a triangle meet it or what lies before it,
/// with its normal, and what leaves it does not meet it again.
#[test]
fn stretched_instances_are_hit_where_f64_says() {
    let ball = Solid::icosphere(2);
    let stage = Stage::new("stretched").file("ball.obj", &obj(&points(&ball), &ball.faces));
    let mut rng = Rng(31);
    let (mut aimed, mut turned, mut sent): (u64, f64, u64) = (0, 0.0, 0);
    for case in 0..100 {
        let placed = Placed::random(&mut rng);
        let flat = stage.flat(&stretched(&placed));
        assert_eq!(flat.instances.len(), 1);
        let (origin, scale) = (DVec3::from(flat.rebase.origin), flat.rebase.scale);
        let exact: Vec<[DVec3; 3]> = ball
            .faces
            .iter()
            .map(|face| {
                face.map(|i| (placed.linear * ball.vertices[i].as_dvec3() - origin) * scale)
            })
            .collect();
        // The map of normals, in f64.
        let normals = placed.linear.inverse().transpose();
        let normal = |prim: u32| {
            let [a, b, c] = ball.faces[prim as usize].map(|i| ball.vertices[i].as_dvec3());
            (normals * (b - a).cross(c - a)).normalize()
        };
        let mut rays = Rays::default();
        for _ in 0..1000 {
            let target = rng.below(exact.len());
            let [a, b, c] = exact[target];
            let from = DVec3::from(rng.direction().map(f64::from)) * 1.5;
            rays.push(
                from.as_vec3().to_array(),
                ((a + b + c) / 3.0 - from).as_vec3().to_array(),
                f32::MAX,
            );
        }
        let hits = trace(&flat, &rays);
        let (mut away, mut left) = (Rays::default(), Vec::new());
        for i in 0..rays.len() {
            if hits.prim[i] == Hits::NONE {
                // A needle that is thinner than the last bit of the ray's own coordinates may be missed.
                continue;
            }
            aimed += 1;
            let [p, ng] = hit_place(&flat, &rays, &hits, i);
            let n = normal(hits.prim[i]);
            turned = turned.max(Vec3::from(ng).as_dvec3().cross(n).length());
            // Its place lies on the plane of the exact triangle, within the bound that rays leave by.
            let off = (Vec3::from(p).as_dvec3() - exact[hits.prim[i] as usize][0])
                .dot(n)
                .abs();
            assert!(
                off <= f64::from(hits.err[i]),
                "case {case}: off by {off}, {}",
                hits.err[i]
            );
            for _ in 0..10 {
                let dir = rng.direction();
                away.push(offset_origin(p, ng, hits.err[i], dir), dir, f32::MAX);
                left.push(hits.prim[i]);
            }
        }
        let again = trace(&flat, &away);
        let back = left.iter().zip(&again.prim).filter(|(a, b)| a == b).count();
        assert_eq!(back, 0, "case {case}: self-hits");
        sent += left.len() as u64;
    }
    println!("{aimed} hits, normals within {turned:.1e} rad, {sent} rays sent off, none back");
    assert!(aimed > 50_000, "{aimed}");
    assert!(turned <= 4e-6, "{turned}");
}

/// So many copies of a mesh, as entities and as one file with all of them.
const COPIES: usize = 10_000;

fn copies() -> (Stage, [String; 2]) {
    let ball = Solid::icosphere(0);
    let mut rng = Rng(32);
    let head = r#"camera: (at: (0, 0, 14), look_at: (0, 0, 0), vfov_deg: 50),
        materials: {"chalk": Diffuse(color: Linear(0.8, 0.7, 0.6))}, entities: ["#;
    let mut entities = head.to_owned();
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for _ in 0..COPIES {
        let q = [(); 4].map(|()| rng.range(-1.0, 1.0));
        let s = rng.range(0.05, 0.2);
        let at = DVec3::from([(); 3].map(|()| rng.range(-5.0, 5.0)));
        writeln!(
            entities,
            "(shape: Mesh(\"ball.obj\"), normals: Flat, material: \"chalk\", transform: (translate: ({:?}, {:?}, {:?}),
             rotate: Quat({:?}, {:?}, {:?}, {:?}), scale: {s:?})),",
            at.x, at.y, at.z, q[0], q[1], q[2], q[3]
        )
        .unwrap();
        let first = vertices.len();
        let turn = quaternion(q);
        vertices.extend(ball.vertices.iter().map(|v| turn * (v.as_dvec3() * s) + at));
        faces.extend(ball.faces.iter().map(|face| face.map(|i| i + first)));
    }
    let baked = format!("{head}(shape: Mesh(\"all.obj\"), normals: Flat, material: \"chalk\")]");
    let stage = Stage::new("copies")
        .file("ball.obj", &obj(&points(&ball), &ball.faces))
        .file("all.obj", &obj(&vertices, &faces));
    (stage, [entities + "]", baked])
}

#[test]
fn ten_thousand_instances_are_their_baked_copy() {
    let (stage, [entities, baked]) = copies();
    let [placed, flat] = [entities, baked].map(|body| stage.flat(&body));
    assert_eq!((placed.instances.len(), flat.instances.len()), (COPIES, 0));
    assert_eq!(placed.rebase, flat.rebase);
    let faces = placed.local[0].triangles.place.len() as u32;
    // The number of a triangle in the baked copy.
    let name = |scene: &FlatScene, hits: &Hits, i: usize| {
        let (prim, instance) = (hits.prim[i], hits.instance[i]);
        (prim != Hits::NONE).then(|| {
            let (triangle, entity) = identity(scene, prim, instance);
            entity * faces + triangle
        })
    };
    let mut rng = Rng(33);
    let mut rays = Rays::default();
    for _ in 0..200_000 {
        let from = DVec3::from(rng.direction().map(f64::from));
        let to = DVec3::from(rng.in_cube(0.3).map(f64::from));
        rays.push(
            from.as_vec3().to_array(),
            (to - from).as_vec3().to_array(),
            f32::MAX,
        );
    }
    let scenes = [&placed, &flat];
    let triangles = scenes.map(Triangles::of);
    let judges = [0, 1].map(|k| Judge::new(scenes[k], &triangles[k]));
    let hits = scenes.map(|scene| trace(scene, &rays));
    let (mut differ, mut hit) = (0, 0);
    for i in 0..rays.len() {
        let names = [0, 1].map(|k| name(scenes[k], &hits[k], i));
        hit += u64::from(names[1].is_some());
        if names[0] == names[1] {
            continue;
        }
        differ += 1;
        let verdicts = [0, 1].map(|k| judges[k].verdict(&rays, &hits[k], i));
        assert!(
            !verdicts.contains(&Verdict::Wrong),
            "ray {i}: {names:?} {verdicts:?}"
        );
    }
    println!("{differ} of {hit} hits differ, all within their bounds");
    assert!(hit > 50_000 && differ < 20, "{hit} {differ}");
}

/// Tile by tile, by another seed: the means differ by noise alone.
#[test]
fn a_picture_of_instances_is_that_of_their_copy() {
    const SPP: u32 = 64;
    let (stage, bodies) = copies();
    let [a, b] = [0, 1].map(|k| {
        let flat = stage.flat(&bodies[k]);
        let options = TraceOptions {
            seed: k as u64,
            max_bounces: 3,
            sampler: luxel::trace::Sampler::Independent,
            ..TraceOptions::default()
        };
        picture(&flat, SPP, &options)
    });
    let n = f64::from(SPP);
    let (width, height) = (24, 16);
    for (tx, ty) in (0..width / 8).flat_map(|x| (0..height / 8).map(move |y| (x, y))) {
        let (mut apart, mut variance) = (0.0, 0.0);
        for i in (0..64).map(|k| (ty * 8 + k / 8) * width + tx * 8 + k % 8) {
            for sums in [&a, &b] {
                let mean = sums.rgb[i][0] / n;
                variance += (sums.rgb_squared[i][0] / n - mean * mean) / (n - 1.0);
            }
            apart += (a.rgb[i][0] - b.rgb[i][0]) / n;
        }
        let z = apart / variance.sqrt().max(1e-12);
        assert!(z.abs() < 4.0, "tile {tx}, {ty}: z = {z}");
    }
}
