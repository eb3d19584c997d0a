//! `closest_hit` by instruction set on the room: six walls of R = 940 at ±1000 and two balls, rays of a camera and of two
//! diffuse bounces. In turns, so that a noisy machine disturbs all alike; checksums first.
//!
//! `cargo bench --bench isa`

#[path = "../tests/support/mod.rs"]
mod support;

use luxel::build::bvh::Accel;
use luxel::flat::{FlatScene, Spheres};
use luxel::math::Vec3;
use luxel::trace::spawn::{offset_origin, sphere_point};
use luxel::trace::{Hits, Isa, Rays, closest_hit};
use std::time::Instant;
use support::{Parts, Rng, Solid};

/// Rays of a batch, as the tracer makes them.
const BATCH: usize = 1024;
const TURNS: usize = 15;

fn main() {
    let mut room = Parts::default();
    for axis in 0..3 {
        for side in [-1000.0, 1000.0] {
            let mut center = [0.0; 3];
            center[axis] = side;
            room.looped.push((center, 940.0));
        }
    }
    room.looped.push(([10.0, 0.0, 0.0], 25.0));
    room.looped.push(([-20.0, 30.0, 20.0], 8.0));
    let scene = room.scene(Accel::Bvh);
    let batches: Vec<Rays> = (0..64).flat_map(|b| paths(&scene, b)).collect();
    compare("room of eight spheres", &scene, &batches);

    let mut rng = Rng(77);
    let mesh = Parts::of(Solid::icosphere(5).triangles()).scene(Accel::Bvh);
    let random = (0..64).map(|_| {
        let mut rays = Rays::default();
        for _ in 0..BATCH {
            let at = Vec3::from(rng.in_cube(0.7));
            let o = Vec3::from(rng.direction()) * 2.0;
            rays.push(o.to_array(), (at - o).normalize().to_array(), f32::MAX);
        }
        rays
    });
    compare(
        "icosphere of 20480 triangles",
        &mesh,
        &random.collect::<Vec<_>>(),
    );
}

/// A batch of camera rays and two batches of their diffuse bounces.
fn paths(scene: &FlatScene, seed: u64) -> Vec<Rays> {
    let mut rng = Rng(seed);
    let mut rays = Rays::default();
    for _ in 0..BATCH {
        let image = Vec3::new(
            rng.range(-0.6, 0.6) as f32,
            rng.range(-0.6, 0.6) as f32,
            -1.0,
        );
        rays.push([0.0, 0.0, 55.0], image.normalize().to_array(), f32::MAX);
    }
    let mut all = vec![rays];
    for _ in 0..2 {
        let rays = all[all.len() - 1].clone();
        let mut hits = Hits::default();
        closest_hit(scene, Isa::best(), &rays, &mut hits);
        let mut next = Rays::default();
        for i in 0..rays.len() {
            let ray = [&rays.origin, &rays.dir].map(|a| [a[0][i], a[1][i], a[2][i]]);
            if hits.prim[i] == Hits::NONE {
                next.push(ray[0], ray[1], f32::MAX);
                continue;
            }
            let s = (hits.prim[i] & !Spheres::TAG) as usize;
            let (center, radius) = (scene.spheres.center(s), scene.spheres.radius(s));
            let (p, ng) = sphere_point(ray, hits.t[i], center, radius);
            // The side that the ray came from, then by the cosine.
            let n = Vec3::from(ng) * -Vec3::from(ng).dot(Vec3::from(ray[1])).signum();
            let dir = (n + Vec3::from(rng.direction()) * 0.999)
                .normalize()
                .to_array();
            next.push(offset_origin(p, ng, hits.err[i], dir), dir, f32::MAX);
        }
        all.push(next);
    }
    all
}

fn compare(name: &str, scene: &FlatScene, batches: &[Rays]) {
    let isas: Vec<Isa> = Isa::all().collect();
    let mut hits = Hits::default();
    let sums: Vec<u64> = isas
        .iter()
        .map(|&isa| checksum(scene, isa, batches))
        .collect();
    assert!(
        sums.iter().all(|s| *s == sums[0]),
        "instruction sets disagree"
    );
    let mut times = vec![Vec::new(); isas.len()];
    for _ in 0..TURNS {
        for (isa, times) in isas.iter().zip(&mut times) {
            let start = Instant::now();
            for rays in batches {
                closest_hit(scene, *isa, rays, &mut hits);
            }
            times.push(start.elapsed().as_secs_f64());
        }
    }
    let rays: usize = batches.iter().map(Rays::len).sum();
    println!("{name}, {rays} rays, checksum {:016x}", sums[0]);
    let median = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let scalar = median(&mut times[0]);
    for (isa, times) in isas.iter().zip(&mut times) {
        let t = median(times);
        let ns = t / rays as f64 * 1e9;
        println!(
            "  {:8} {ns:7.1} ns/ray   {:.2} x scalar",
            isa.level().to_string(),
            scalar / t
        );
    }
}

fn checksum(scene: &FlatScene, isa: Isa, batches: &[Rays]) -> u64 {
    let mut hits = Hits::default();
    let mut sum = 0u64;
    for rays in batches {
        closest_hit(scene, isa, rays, &mut hits);
        for i in 0..rays.len() {
            for bits in [hits.t[i].to_bits(), hits.prim[i], hits.err[i].to_bits()] {
                sum = (sum ^ u64::from(bits)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
    sum
}
