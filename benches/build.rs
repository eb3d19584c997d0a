//! What building trees takes, and what they are worth: process CPU time and wall time per million triangles, by mesh, mode
//! and threads; the heuristic's cost, the bytes that rays touch, and the nodes and blocks that a random ray visits.
//!
//! `cargo bench --bench build`, or `-- 1` for the meshes of up to so many million triangles.

use luxel::build::bvh::{Accel, Built, Primitives, Quality, build_with};
use luxel::flat::bvh::{STACK, WIDTH, kind};
use luxel::flat::{BLOCK, Child, LinearNode, TriangleBlock};
use luxel::math::{Aabb, Vec3};
use std::fs;
use std::time::Instant;

#[path = "../tests/support/mod.rs"]
mod support;

use support::{Rng, Solid};

/// The best of so many builds counts.
const TURNS: usize = 5;

/// Random rays that count nodes and blocks.
const RAYS: usize = 10_000;

/// A name, a number of triangles and what makes them.
type Mesh = (&'static str, usize, fn() -> Vec<[Vec3; 3]>);

fn main() {
    let most = std::env::args()
        .filter_map(|a| a.parse::<f64>().ok())
        .next();
    let most = 1e6 * most.unwrap_or(f64::INFINITY);
    let meshes: [Mesh; 5] = [
        ("ball", 81_920, || ball(6)),
        ("thin soup", 200_000, || thin(200_000)),
        ("ball", 1_310_720, || ball(8)),
        ("terrain", 1_048_352, || terrain(724)),
        ("terrain", 4_193_408, || terrain(1448)),
    ];
    println!(
        "CPU and wall: ms per million triangles, best of {TURNS}, in turns; blocks of {BLOCK}\n"
    );
    println!(
        "{:10} {:>9} {:5} {:>7} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6}",
        "mesh", "triangles", "mode", "threads", "CPU", "wall", "cost", "B/tri", "nodes", "blocks"
    );
    for (name, _, mesh) in meshes.iter().filter(|m| m.1 as f64 <= most) {
        time(name, &mesh());
    }
}

/// Prints four rows.
fn time(name: &str, triangles: &[[Vec3; 3]]) {
    let p = Primitives {
        triangles,
        ..Primitives::default()
    };
    let million = triangles.len() as f64 / 1e6;
    let pools = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        (threads, pool.build().expect("threads"))
    });
    let modes = [Quality::Good, Quality::Fast];
    let mut best = [[[f64::INFINITY; 2]; 2]; 2];
    for _ in 0..TURNS {
        for (mode, best) in modes.iter().zip(&mut best) {
            for ((_, pool), best) in pools.iter().zip(best) {
                let (cpu, wall) = (processor_ns(), Instant::now());
                let built = pool.install(|| build_with(&p, Accel::Bvh, *mode));
                let ns = [processor_ns() - cpu, wall.elapsed().as_nanos() as f64];
                drop(built);
                *best = [0, 1].map(|i| best[i].min(ns[i]));
            }
        }
    }
    for (mode, best) in modes.iter().zip(best) {
        let built = build_with(&p, Accel::Bvh, *mode);
        let nodes = built.bvh.nodes.len() * size_of::<LinearNode>();
        let blocks = built.triangles.blocks.len() * size_of::<TriangleBlock>();
        let bytes = (nodes + blocks) as f64 / triangles.len() as f64;
        let [visited, tested] = visits(&built);
        for ((threads, _), [cpu, wall]) in pools.iter().zip(best) {
            println!(
                "{name:10} {:9} {:5} {threads:7} {:6.0} {:6.0} {:6.2} {bytes:6.1} {visited:6.2} {tested:6.2}",
                triangles.len(),
                format!("{mode:?}"),
                cpu / 1e6 / million,
                wall / 1e6 / million,
                built.cost,
            );
        }
    }
}

/// A displaced icosphere.
fn ball(level: u32) -> Vec<[Vec3; 3]> {
    let wave =
        |v: Vec3| v * (1.0 + 0.05 * (9.0 * v.x).sin() * (7.0 * v.y).sin() * (8.0 * v.z).sin());
    let triangles = Solid::icosphere(level).triangles();
    triangles.into_iter().map(|t| t.map(wave)).collect()
}

/// Hills over a grid of `side` × `side` squares.
fn terrain(side: usize) -> Vec<[Vec3; 3]> {
    let at = |x: usize, z: usize| {
        let [x, z] = [x, z].map(|i| i as f32 / side as f32);
        let hills =
            (31.0 * x).sin() * (23.0 * z).cos() + 0.2 * (170.0 * x).cos() * (190.0 * z).sin();
        Vec3::new(x, 0.03 * hills, z)
    };
    let mut triangles = Vec::with_capacity(2 * side * side);
    for z in 0..side {
        for x in 0..side {
            let [a, b, c, d] = [at(x, z), at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)];
            triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    triangles
}

/// Triangles about forty times as long as wide, in any direction.
fn thin(n: usize) -> Vec<[Vec3; 3]> {
    let mut rng = Rng(31);
    (0..n)
        .map(|_| {
            let at = Vec3::from(rng.in_cube(1.0));
            let along = 0.1 * Vec3::from(rng.direction());
            [
                at,
                at + along,
                at + 0.5 * along + 0.0025 * Vec3::from(rng.direction()),
            ]
        })
        .collect()
}

/// Nodes and blocks that a random ray visits on its way to the closest hit, nearest child first.
fn visits(built: &Built) -> [f64; 2] {
    let mut rng = Rng(32);
    let Aabb { min, max } = built.bvh.bounds;
    let mut counts = [0; 2];
    for _ in 0..RAYS {
        let inside = Vec3::from(rng.in_cube(1.0)) * 0.5 + 0.5;
        let origin = min + inside * (max - min);
        let ray = [origin, Vec3::from(rng.direction())];
        for (sum, count) in counts.iter_mut().zip(walk(built, ray)) {
            *sum += count;
        }
    }
    counts.map(|count| count as f64 / RAYS as f64)
}

fn walk(built: &Built, [origin, dir]: [Vec3; 2]) -> [usize; 2] {
    let mut counts = [0; 2];
    let mut closest = f32::INFINITY;
    let mut stack = Vec::with_capacity(STACK);
    stack.push((0.0, built.bvh.root));
    while let Some((near, child)) = stack.pop() {
        if near > closest {
            continue;
        }
        if child.kind() == kind::TRIANGLES {
            counts[1] += child.run_len();
            for block in &built.triangles.blocks[child.index()..][..child.run_len()] {
                closest = (0..BLOCK).fold(closest, |t, lane| t.min(hit(block, lane, origin, dir)));
            }
            continue;
        }
        counts[0] += 1;
        let node = &built.bvh.nodes[child.index()];
        let first = stack.len();
        for slot in 0..WIDTH {
            let b = node.child_box(slot);
            let empty = b.is_empty();
            let (a, b) = ((b.min - origin) / dir, (b.max - origin) / dir);
            let (near, far) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
            if !empty && near <= far && near <= closest {
                stack.push((near, Child(node.child[slot])));
            }
        }
        stack[first..].sort_by(|a, b| b.0.total_cmp(&a.0));
    }
    counts
}

/// Distance to a triangle (Möller and Trumbore 1997).
fn hit(block: &TriangleBlock, lane: usize, origin: Vec3, dir: Vec3) -> f32 {
    let [a, b, c] = block
        .v
        .map(|axes| Vec3::from(axes.map(|lanes| lanes[lane])));
    let (ab, ac, from) = (b - a, c - a, origin - a);
    let (p, q) = (dir.cross(ac), from.cross(ab));
    let det = ab.dot(p);
    let [u, v, t] = [from.dot(p), dir.dot(q), ac.dot(q)].map(|x| x / det);
    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 {
        t
    } else {
        f32::INFINITY
    }
}

/// What all threads of this process have run so far, in nanoseconds; 0 where there is no `/proc`.
fn processor_ns() -> f64 {
    let tasks = fs::read_dir("/proc/self/task")
        .into_iter()
        .flatten()
        .flatten();
    tasks
        .filter_map(|task| {
            let text = fs::read_to_string(task.path().join("schedstat")).ok()?;
            text.split_whitespace().next()?.parse::<f64>().ok()
        })
        .sum()
}
