//! Generated subjects: a displaced ball in a room, a terrain, a soup of thin triangles, spheres.
//!
//! All are functions of their size alone. Triangles that share a vertex share its bits, so that the closed ones are closed.

use super::random::{Random, fractal};
use super::subject::{LENGTH, Subject, View};
use crate::build::bvh::SphereItem;
use crate::math::{DVec3, Vec3, pow};

/// Subdivisions of [`ball`] for 2,880, 69,620, 1,310,720 and 4,195,280 triangles, without the room's twelve.
pub const BALL_SIZES: [u32; 4] = [12, 59, 256, 458];

/// Side of [`terrain`] for 4,193,408 triangles.
pub const TERRAIN_SIDE: u32 = 1448;

/// Triangles of [`soup`].
pub const SOUP_SIZE: usize = 200_000;

/// A rough ball in a closed room: an icosahedron whose edges are cut into `n`, 20 n² triangles, displaced by noise, and
/// twelve of the room. Every ray hits something; triangles are well-shaped and of similar size but for the room's.
#[must_use]
pub fn ball(n: u32) -> Subject {
    let mut triangles = Vec::with_capacity(20 * (n as usize).pow(2) + 12);
    let corners = icosahedron();
    for face in faces(&corners) {
        let row = |i: u32| -> Vec<Vec3> {
            (0..=n - i)
                .map(|j| {
                    rough(between(
                        &corners,
                        [(face[0], n - i - j), (face[1], i), (face[2], j)],
                    ))
                })
                .collect()
        };
        let mut low = row(0);
        for i in 0..n {
            let high = row(i + 1);
            for j in 0..(n - i) as usize {
                triangles.push([low[j], high[j], low[j + 1]]);
                if j + 1 < high.len() {
                    triangles.push([high[j], high[j + 1], low[j + 1]]);
                }
            }
            low = high;
        }
    }
    Subject::open(triangles).in_room()
}

/// The twelve corners, cyclic permutations of (0, ±1, ±φ), on the unit sphere.
fn icosahedron() -> [DVec3; 12] {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut corners = [DVec3::ZERO; 12];
    for (i, [a, b]) in [
        [1.0, golden],
        [-1.0, golden],
        [1.0, -golden],
        [-1.0, -golden],
    ]
    .into_iter()
    .enumerate()
    {
        corners[3 * i] = DVec3::new(0.0, a, b).normalize();
        corners[3 * i + 1] = DVec3::new(a, b, 0.0).normalize();
        corners[3 * i + 2] = DVec3::new(b, 0.0, a).normalize();
    }
    corners
}

/// Triples of corners next to each other, counter-clockwise from outside.
fn faces(corners: &[DVec3; 12]) -> Vec<[usize; 3]> {
    // The cosine between neighbours is 1/√5 = 0.447, between others at most −0.447.
    let near = |a: usize, b: usize| corners[a].dot(corners[b]) > 0.0;
    let mut faces = Vec::with_capacity(20);
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    let outward = corners[a].cross(corners[b]).dot(corners[c]) > 0.0;
                    faces.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    faces
}

/// The direction with these weights of three corners: summed in the order of the corners, so that both faces at an edge
/// get the same bits.
fn between(corners: &[DVec3; 12], mut weights: [(usize, u32); 3]) -> DVec3 {
    weights.sort_unstable();
    let [a, b, c] = weights.map(|(corner, weight)| corners[corner] * f64::from(weight));
    (a + b + c).normalize()
}

/// The surface of the ball in a direction: hills of seven octaves on a sphere.
fn rough(direction: DVec3) -> Vec3 {
    let radius = 0.42 * LENGTH * (0.75 + 0.5 * fractal(3.0 * direction, 7));
    (direction * radius).as_vec3()
}

/// Hills under the open sky: `side`² squares of two triangles, seen from a corner. Many rays leave for the sky, and the
/// triangles that one meets differ in size by perspective alone.
#[must_use]
pub fn terrain(side: u32) -> Subject {
    let height = |x: u32, z: u32| {
        let at = |i: u32| f64::from(i) / f64::from(side);
        let hill = fractal(6.0 * DVec3::new(at(x), 0.0, at(z)), 9);
        (DVec3::new(at(x) - 0.5, 0.2 * (hill - 0.5), at(z) - 0.5) * LENGTH).as_vec3()
    };
    let row = |z: u32| -> Vec<Vec3> { (0..=side).map(|x| height(x, z)).collect() };
    let mut triangles = Vec::with_capacity(2 * (side as usize).pow(2));
    let mut near = row(0);
    for z in 0..side {
        let far = row(z + 1);
        for x in 0..side as usize {
            triangles.push([near[x], far[x], near[x + 1]]);
            triangles.push([near[x + 1], far[x], far[x + 1]]);
        }
        near = far;
    }
    let mut subject = Subject::open(triangles);
    let top = f64::from(subject.object.max.y);
    subject.view = View {
        eye: DVec3::new(-4.5, top + 1.2, -4.0),
        target: DVec3::new(1.0, 0.0, 1.0),
        ..subject.view
    };
    subject
}

/// `n` triangles without order, 40 times as long as high, in a cube: the worst case of boxes.
#[must_use]
pub fn soup(n: usize) -> Subject {
    const HALF_BASE: f64 = 0.02 * LENGTH;
    const HEIGHT: f64 = 0.001 * LENGTH;
    let mut random = Random::new(40);
    let half = DVec3::splat(0.5 * LENGTH);
    let triangle = |()| {
        let at = random.point(-half, half);
        let base = random.direction();
        let up = loop {
            let across = base.cross(random.direction());
            if across.length() > 0.01 {
                break across.normalize();
            }
        };
        [
            at - HALF_BASE * base,
            at + HALF_BASE * base,
            at + HEIGHT * up,
        ]
        .map(|v| v.as_vec3())
    };
    Subject::open(std::iter::repeat_n((), n).map(triangle).collect())
}

/// `n` spheres in a cube. Radii are 1/8 to 3/4 of the mean spacing, spread evenly over their logarithms, so that some
/// overlap.
#[must_use]
pub fn spheres(n: u32) -> Subject {
    let mut random = Random::new(41);
    let half = DVec3::splat(0.5 * LENGTH);
    let spacing = LENGTH * pow(f64::from(n), -1.0 / 3.0);
    let sphere = |prim| SphereItem {
        center: random.point(-half, half).to_array(),
        radius: spacing * 0.75 * pow(6.0, -random.unit()),
        prim,
    };
    Subject::of_spheres((0..n).map(sphere).collect())
}
