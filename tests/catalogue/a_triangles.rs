//! A: triangles. What must be hit is hit, and as exactly as is said.

use crate::book::{Outcome, items};
use crate::support::shoot::{best, misses};
use crate::support::{Parts, Rng, Solid};
use luxel::build::bvh::Accel;
use luxel::math::Vec3;
use luxel::trace::Rays;

items! {
    a1_edges(4e5, 1e8): "A1", "rays from inside closed meshes at points of their edges, sizes 1e±6, offsets to 1e6 sizes: misses";
    a2_vertices(4e5, 1e8): "A2", "the same at vertices, and at the middles of fans: misses";
    a3_lattice(1e5, 1e7): "A3", "rays along the lines and through the points of a lattice: misses";
    a4_far_sphere(1e5, 1e7): "A4", "a ball of radius 2 at (148376, 1234, −223423), from inside: misses";
}

/// Rays of a batch.
const BATCH: usize = 4096;

/// Sizes, and offsets in sizes: what is closed must stay closed everywhere.
const PLACES: [(f32, f32); 13] = [
    (1.0, 0.0),
    (1e-6, 0.0),
    (1e-3, 0.0),
    (1e3, 0.0),
    (1e6, 0.0),
    (1.0, 1e3),
    (1.0, 1e5),
    (1.0, 1e6),
    (1e-6, 1e3),
    (1e-6, 1e6),
    (1e6, 1e3),
    (1e6, 1e6),
    (1e-3, 1e5),
];

/// A closed mesh about the origin, and what is well inside: a ring of this radius, blurred by so much.
struct Closed {
    solid: Solid,
    ring: f32,
    blur: f64,
}

fn closed_meshes() -> [Closed; 4] {
    let star = Solid::star(3, &mut Rng(1));
    let of = |solid, ring, blur| Closed { solid, ring, blur };
    [
        of(Solid::uv_sphere(24, 48), 0.0, 0.4),
        of(Solid::icosphere(6), 0.0, 0.4),
        of(star, 0.0, 0.4),
        of(Solid::torus(24, 48), 1.0, 0.08),
    ]
}

#[derive(Clone, Copy, PartialEq)]
enum Aim {
    Edge,
    Vertex,
    Anywhere,
}

impl Closed {
    /// `n` rays from inside; the mesh has that size and offset.
    fn rays(&self, aim: Aim, n: usize, (size, offset): (f32, Vec3), rng: &mut Rng) -> Rays {
        let mut rays = Rays::default();
        for i in 0..n {
            let face = self.solid.faces[rng.below(self.solid.faces.len())];
            let k = rng.below(3);
            let [a, b, c] = [face[k], face[(k + 1) % 3], face[(k + 2) % 3]]
                .map(|i| self.solid.vertices[i] * size + offset);
            let target = match aim {
                Aim::Vertex => a,
                Aim::Edge => a + (b - a) * rng.unit() as f32,
                Aim::Anywhere => a + (b - a) * rng.unit() as f32 + (c - a) * rng.unit() as f32,
            };
            let (sin, cos) = rng.range(0.0, std::f64::consts::TAU).sin_cos();
            let ring = self.ring * Vec3::new(cos as f32, 0.0, sin as f32);
            let blur = if i % 16 == 0 { 0.0 } else { self.blur };
            let origin = (ring + Vec3::from(rng.in_cube(blur))) * size + offset;
            let mut dir = target - origin;
            if i % 3 == 0 {
                dir = dir.normalize_or(Vec3::X);
            }
            rays.push(origin.to_array(), dir.to_array(), f32::MAX);
        }
        rays
    }

    /// Misses of `n` rays.
    fn shoot(&self, aim: Aim, n: usize, place: (f32, Vec3), rng: &mut Rng) -> Outcome {
        let scene = Parts::of(self.solid.placed(place.0, place.1).triangles()).scene(Accel::Bvh);
        let mut outcome = Outcome::default();
        for start in (0..n).step_by(BATCH) {
            let rays = self.rays(aim, BATCH.min(n - start), place, rng);
            outcome.add(Outcome::new(rays.len(), misses(&best(&scene, &rays))));
        }
        outcome
    }
}

/// Misses of `trials` rays at all meshes in all places.
fn everywhere(aim: Aim, trials: u64) -> Outcome {
    let mut rng = Rng(2);
    let meshes = closed_meshes();
    let each = (trials as usize).div_ceil(meshes.len() * PLACES.len());
    let mut outcome = Outcome::default();
    for closed in &meshes {
        for (size, offset) in PLACES {
            let offset = Vec3::new(offset, -0.8 * offset, 0.6 * offset) * size;
            outcome.add(closed.shoot(aim, each, (size, offset), &mut rng));
        }
    }
    outcome
}

fn a1_edges(trials: u64) -> Outcome {
    everywhere(Aim::Edge, trials)
}

fn a2_vertices(trials: u64) -> Outcome {
    let mut outcome = everywhere(Aim::Vertex, trials / 4 * 3);
    let mut rng = Rng(3);
    for k in 0..trials / 4 / 2000 {
        outcome.add(fan(3 + k as usize % 6, &mut rng));
    }
    outcome
}

/// 2000 rays from 2 to 8 away at the middle of a fan of triangles of a size between 1e-4 and 1.
fn fan(valence: usize, rng: &mut Rng) -> Outcome {
    let size = rng.log(-4.0, 0.0).abs();
    let middle = Vec3::from(rng.in_cube(3.0));
    let axis = Vec3::from(rng.direction());
    let (x, y) = axis.any_orthonormal_pair();
    let corner: Vec<Vec3> = (0..valence)
        .map(|k| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / valence as f64).sin_cos();
            let lift = rng.range(-0.4, 0.4) as f32;
            middle + size as f32 * (x * cos as f32 + y * sin as f32 + axis * lift)
        })
        .collect();
    let triangles: Vec<[Vec3; 3]> = (0..valence)
        .map(|k| [middle, corner[k], corner[(k + 1) % valence]])
        .collect();
    let mut rays = Rays::default();
    for i in 0..2000 {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let away = (side * axis + 0.3 * Vec3::from(rng.direction())).normalize();
        let origin = middle + away * rng.range(2.0, 8.0) as f32;
        rays.push(origin.to_array(), (middle - origin).to_array(), f32::MAX);
    }
    let hits = best(&Parts::of(triangles).scene(Accel::Bvh), &rays);
    Outcome::new(rays.len(), misses(&hits))
}

/// A square of 64 × 64 cells of two triangles at integers, its quads' diagonals both ways.
fn a3_lattice(trials: u64) -> Outcome {
    const N: usize = 64;
    let mut triangles = Vec::new();
    for i in 0..N {
        for j in 0..N {
            let p = |x: usize, y: usize| Vec3::new((i + x) as f32, (j + y) as f32, 0.0);
            if (i + j) % 2 == 0 {
                triangles.push([p(0, 0), p(1, 0), p(1, 1)]);
                triangles.push([p(0, 0), p(1, 1), p(0, 1)]);
            } else {
                triangles.push([p(0, 0), p(1, 0), p(0, 1)]);
                triangles.push([p(1, 0), p(1, 1), p(0, 1)]);
            }
        }
    }
    let mut rng = Rng(4);
    let mut outcome = Outcome::default();
    let sides = [1.0, 1e-6, 1e6, 2f32.powi(-37), 2f32.powi(41)];
    for size in sides {
        let placed: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(|v| v * size)).collect();
        let scene = Parts::of(placed).scene(Accel::Bvh);
        let each = trials as usize / sides.len();
        for start in (0..each).step_by(BATCH) {
            let mut rays = Rays::default();
            for i in 0..BATCH.min(each - start) {
                let mut place = |line: bool| match line {
                    true => rng.below(N + 1) as f32,
                    false => (rng.unit() * N as f64) as f32,
                };
                let mut target = Vec3::new(place(i % 4 != 0), place(i % 4 != 1), 0.0);
                let zero = if i % 8 < 4 { 0.0 } else { -0.0 };
                let mut dir = Vec3::new(zero, zero, -16.0 * size);
                if i % 3 == 0 {
                    // From above another point; not at the rim, which rounding may put outside.
                    let above = [(); 2].map(|()| rng.below(N + 1) as f32);
                    target = target
                        .clamp(Vec3::ONE, Vec3::splat(N as f32 - 1.0))
                        .with_z(0.0);
                    dir = (target - Vec3::new(above[0], above[1], 16.0)) * size;
                }
                target *= size;
                rays.push((target - dir).to_array(), dir.to_array(), f32::MAX);
            }
            outcome.add(Outcome::new(rays.len(), misses(&best(&scene, &rays))));
        }
    }
    // The quad whose diagonal a published test runs along.
    let quad =
        [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let mut along = Rays::default();
    along.push(
        [0.0, 0.0, 10.0],
        [0.304_584_47, 0.304_584_47, -0.902_472_5],
        f32::MAX,
    );
    let diagonal = vec![[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]];
    outcome.add(Outcome::new(
        1,
        misses(&best(&Parts::of(diagonal).scene(Accel::Bvh), &along)),
    ));
    outcome
}

fn a4_far_sphere(trials: u64) -> Outcome {
    let mut rng = Rng(5);
    let place = (2.0, Vec3::new(148_376.0, 1_234.0, -223_423.0));
    let mut outcome = Outcome::default();
    let balls = [
        Solid::uv_sphere(24, 48),
        Solid::uv_sphere(250, 500),
        Solid::icosphere(4),
    ];
    for solid in balls {
        let closed = Closed {
            solid,
            ring: 0.0,
            blur: 0.4,
        };
        for aim in [Aim::Edge, Aim::Vertex, Aim::Anywhere] {
            outcome.add(closed.shoot(aim, trials as usize / 9, place, &mut rng));
        }
    }
    outcome
}
