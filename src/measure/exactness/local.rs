//! Choices that are no traversal: what happens at a surface and at a pixel.

use super::{PIECE, Row, in_turns, per_million};
use crate::build::bvh::{Accel, build};
use crate::flat::FlatScene;
use crate::math::lanes::baseline::F32x8;
use crate::math::{DVec3, Vec3};
use crate::measure::bench::{Random, Subject};
use crate::trace::fresnel::dielectric;
use crate::trace::kernels::bound::world_errors;
use crate::trace::spawn::{offset_origin, triangle_normal, triangle_point, triangle_vertices};
use crate::trace::{Fresnel, Hits, Isa, Rays, closest_hit};
use std::hint::black_box;
use std::time::Instant;

/// What a fixed offset is: of the order that renderers ship with.
const EPSILON: f32 = 1e-4;

/// Lengths of the closed shells that rays leave.
const SIZES: [f32; 3] = [1e-3, 1.0, 1e5];

/// The inner shell is smaller than the outer one by this share.
const GAP: f32 = 1e-3;

/// Cosine below which a ray into the gap may not reach the inner shell.
const STEEP: f64 = 0.1;

/// Two cubes, one in the other, along no axis.
fn shells(size: f32) -> Subject {
    let [x, y] = [Vec3::new(0.36, 0.48, -0.8), Vec3::new(-0.8, 0.6, 0.0)];
    let frame = [x, y, x.cross(y)];
    let corner = |i: usize, half: f32| {
        let side = |axis: usize| if i >> axis & 1 == 0 { -half } else { half };
        side(0) * frame[0] + side(1) * frame[1] + side(2) * frame[2]
    };
    let mut triangles = Vec::new();
    for half in [0.5 * size, 0.5 * size * (1.0 - GAP)] {
        // Corner i has its bits as coordinates; seen from outside, each face runs counter-clockwise.
        for face in [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ] {
            let [a, b, c, d] = face.map(|i| corner(i, half));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Subject::open(triangles)
}

/// Points of the outer shell's faces that rays from outside meet, away from its edges.
struct Starts {
    scene: FlatScene,
    hits: Hits,
    points: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    /// Directions, out of the shell and into it in turns.
    ways: Vec<[f32; 3]>,
}

impl Starts {
    fn new(size: f32, count: usize) -> Starts {
        let subject = shells(size);
        let scene = subject.scene(build(&subject.primitives(), Accel::Bvh));
        let mut random = Random::new(43);
        let mut rays = Rays::default();
        for _ in 0..count {
            let face = random.below(12);
            let [a, b, c] = subject.triangles[face];
            let [u, v] = [0.05 + 0.4 * random.unit(), 0.05 + 0.4 * random.unit()];
            let at = a + u as f32 * (b - a) + v as f32 * (c - a);
            let normal = (b - a).cross(c - a).normalize();
            let origin = at + normal * size;
            rays.push(origin.to_array(), (-normal).to_array(), f32::MAX);
        }
        let mut hits = Hits::default();
        closest_hit(&scene, Isa::best(), &rays, &mut hits);
        let (mut points, mut normals, mut ways) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..count {
            let v = triangle_vertices(&scene.world.triangles, hits.prim[i] % 24);
            let normal = triangle_normal(v);
            points.push(triangle_point(v, hits.u[i], hits.v[i]));
            normals.push(normal);
            ways.push(way(&mut random, normal, i.is_multiple_of(2)).to_array());
        }
        Starts {
            scene,
            hits,
            points,
            normals,
            ways,
        }
    }

    /// Wrong next hits: a ray out hits anything, or a ray in does not hit the inner shell.
    fn wrong(&self, leave: impl Fn(usize) -> [f32; 3]) -> usize {
        let mut rays = Rays::default();
        for (i, way) in self.ways.iter().enumerate() {
            rays.push(leave(i), *way, f32::MAX);
        }
        let mut next = Hits::default();
        closest_hit(&self.scene, Isa::best(), &rays, &mut next);
        let inner = |prim: u32| (12..24).contains(&prim);
        let right = |i: usize| match i.is_multiple_of(2) {
            true => next.prim[i] == Hits::NONE,
            false => inner(next.prim[i]),
        };
        (0..rays.len()).filter(|&i| !right(i)).count()
    }

    fn exact(&self, i: usize) -> [f32; 3] {
        offset_origin(
            self.points[i],
            self.normals[i],
            self.hits.err[i],
            self.ways[i],
        )
    }

    fn cheap(&self, i: usize) -> [f32; 3] {
        let [p, n] = [self.points[i], self.normals[i]].map(Vec3::from);
        let cos = n.dot(Vec3::from(self.ways[i]));
        (p + n * EPSILON.copysign(cos)).to_array()
    }
}

/// A direction on a side of a surface, not along it.
fn way(random: &mut Random, normal: [f32; 3], out: bool) -> Vec3 {
    let normal = Vec3::from(normal).as_dvec3();
    loop {
        let way: DVec3 = random.direction();
        let cos = way.dot(normal);
        if cos.abs() > STEEP {
            let outward = way * cos.signum();
            return if out { outward } else { -outward }.as_vec3();
        }
    }
}

/// How a ray leaves a surface.
pub(super) fn offset(count: usize, until: Instant) -> Row {
    let each = count.div_ceil(SIZES.len());
    let mut wrong = [0; 2];
    for size in SIZES {
        let starts = Starts::new(size, each);
        wrong[0] += starts.wrong(|i| starts.exact(i));
        wrong[1] += starts.wrong(|i| starts.cheap(i));
    }
    let mut starts = Starts::new(1.0, PIECE);
    let pieces = count.div_ceil(PIECE);
    let total = in_turns(pieces, until, |side, _| {
        if side == 0 {
            world_errors::<F32x8>(&starts.scene.world.triangles, &mut starts.hits);
            (0..PIECE).for_each(|i| {
                black_box(starts.exact(i));
            });
        } else {
            (0..PIECE).for_each(|i| {
                black_box(starts.cheap(i));
            });
        }
    });
    let judged = each * SIZES.len();
    Row {
        choice: "leaving a surface",
        exact: "error bound",
        cheap: "epsilon 1e-4",
        unit: "ray",
        ns: total.map(|ns| ns / (pieces * PIECE) as f64),
        wrong: wrong.map(|wrong| per_million(wrong, judged)),
        judged,
        counted: "rays off shells of size 1e-3, 1 and 1e5 that hit their own or miss the one below, a thousandth deeper",
    }
}

/// Reflectance of a dielectric.
pub(super) fn fresnel(count: usize, until: Instant) -> Row {
    /// Water, glass, glass from inside, water upon glass.
    const ETAS: [f32; 4] = [1.333, 1.5, 1.0 / 1.5, 1.125];
    /// Reflectance that counts as wrong.
    const OFF: f64 = 0.01;
    let mut random = Random::new(47);
    let inputs: Vec<(f32, f32)> = (0..count)
        .map(|i| (random.unit() as f32, ETAS[i % ETAS.len()]))
        .collect();
    let modes = [Fresnel::Exact, Fresnel::Schlick];
    let wrong = modes.map(|mode| {
        let off = |&&(cos, eta): &&(f32, f32)| {
            let (found, _) = dielectric(mode, cos, eta);
            (f64::from(found) - reflectance(cos.into(), eta.into())).abs() > OFF
        };
        inputs.iter().filter(off).count()
    });
    let pieces: Vec<&[(f32, f32)]> = inputs.chunks(PIECE).collect();
    let total = in_turns(pieces.len(), until, |side, piece| {
        let mode = modes[side];
        let sum = pieces[piece]
            .iter()
            .map(|&(cos, eta)| dielectric(mode, cos, eta).0);
        black_box(sum.sum::<f32>());
    });
    Row {
        choice: "Fresnel reflectance",
        exact: "exact",
        cheap: "Schlick",
        unit: "hit",
        ns: total.map(|ns| ns / inputs.len() as f64),
        wrong: wrong.map(|wrong| per_million(wrong, inputs.len())),
        judged: inputs.len(),
        counted: "reflectances of water and glass that are more than 0.01 off, all angles",
    }
}

/// Fresnel's equations in f64, by amplitudes.
fn reflectance(cos_i: f64, eta: f64) -> f64 {
    let squared = 1.0 - (1.0 - cos_i * cos_i) / (eta * eta);
    if squared <= 0.0 {
        return 1.0;
    }
    let cos_t = squared.sqrt();
    let s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    0.5 * (s * s + p * p)
}

/// The sum of a pixel's samples.
pub(super) fn film(count: usize, until: Instant) -> Row {
    /// Samples of a pixel.
    const SAMPLES: usize = 1 << 16;
    /// Values of samples: multiples of 2⁻²⁴, so that integers can add them up.
    const UNIT: f32 = 1.0 / (1 << 24) as f32;
    /// Relative error that counts as wrong: eight ulps.
    const OFF: f64 = 1e-6;
    let pixels = count.div_ceil(1 << 8);
    let mut random = Random::new(53);
    let values: Vec<u32> = (0..SAMPLES).map(|_| random.bits() as u32 >> 8).collect();
    let radiance: Vec<f32> = values.iter().map(|&v| v as f32 * UNIT).collect();
    let exact: u64 = values.iter().map(|&v| u64::from(v)).sum();
    let exact = exact as f64 * f64::from(UNIT);
    let mut wrong = [0; 2];
    for _ in 0..pixels {
        // A pixel's samples begin somewhere in that row and go around.
        let (later, first) = radiance.split_at(random.below(SAMPLES));
        let samples = || first.iter().chain(later);
        let double: f64 = samples().map(|&x| f64::from(x)).sum();
        let single: f32 = samples().sum();
        for (wrong, found) in wrong.iter_mut().zip([double, single.into()]) {
            *wrong += usize::from((found - exact).abs() > OFF * exact);
        }
    }
    // What is timed: samples added to the pixels of a tile, one sample of each after the other.
    let mut singles = vec![[0f32; 3]; PIECE];
    let mut doubles = vec![[0f64; 3]; PIECE];
    let pieces = count.div_ceil(PIECE);
    let total = in_turns(pieces, until, |side, piece| {
        let row = &radiance[piece * 3 % 1024..][..3 * PIECE];
        let (rgb, _) = row.as_chunks::<3>();
        if side == 0 {
            for (sum, rgb) in doubles.iter_mut().zip(rgb) {
                for (sum, x) in sum.iter_mut().zip(rgb) {
                    *sum += f64::from(*x);
                }
            }
            black_box(&mut doubles);
        } else {
            for (sum, rgb) in singles.iter_mut().zip(rgb) {
                for (sum, x) in sum.iter_mut().zip(rgb) {
                    *sum += *x;
                }
            }
            black_box(&mut singles);
        }
    });
    Row {
        choice: "sum of samples",
        exact: "f64",
        cheap: "f32",
        unit: "sample",
        ns: total.map(|ns| ns / (pieces * PIECE) as f64),
        wrong: wrong.map(|wrong| per_million(wrong, pixels)),
        judged: pixels,
        counted: "pixels of 65,536 samples whose sum is more than 1e-6 off",
    }
}
