//! How far a mesh reaches in any direction, from a table: boxes of its instances in a time that knows nothing of its size.
//!
//! How far a set reaches along a sum of directions is at most the sum of how far it reaches along each. A direction is a
//! sum of four of the table, the corners of its cell on the face of a cube; so boxes are never too small. They are too
//! large by at most 1.6 % of the radius of a ball, and by at most an eighth of the length of an edge between two far
//! corners of what is angular. Along the corners themselves, such as the axes, they are as tight as can be.
//!
//! The table is made by walking the mesh's tree. A vertex is no farther along a direction than the box it is in, and that
//! holds to the bit: what is computed of the box's corner is computed by the same operations, and rounding keeps order. So
//! boxes are left out as soon as they are not farther than what was found, and the tree's shape changes nothing.

use super::rebase::Extent;
use crate::flat::bvh::{Child, WIDTH, kind};
use crate::flat::{Geometry, LinearNode, TriangleBlock};
use crate::math::{DAffine3, DVec3};
use rayon::prelude::*;

/// Cells along an edge of the cube: 486 directions, made in a hundredth of the time that the tree takes.
const CELLS: usize = 8;

/// How far vertices reach: `faces[2 k + s][i][j]` along the direction that is ±1 (s = 0, 1) on axis k, and on the two axes
/// behind it, in turn, 2 i / `CELLS` − 1 and 2 j / `CELLS` − 1. −∞ without vertices.
#[derive(Debug, PartialEq)]
pub(crate) struct Support {
    faces: Vec<[[f64; CELLS + 1]; CELLS + 1]>,
}

impl Support {
    pub(crate) fn of(geometry: &Geometry) -> Support {
        let face = |face: usize| {
            let mut stack = Vec::with_capacity(STACK);
            let at = |i: usize| 2.0 * i as f64 / CELLS as f64 - 1.0;
            let mut reach = |i: usize, j: usize| {
                let axis = face / 2;
                let mut direction = [0.0; 3];
                direction[axis] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
                direction[(axis + 1) % 3] = at(i);
                direction[(axis + 2) % 3] = at(j);
                farthest(geometry, &Direction(direction), &mut stack)
            };
            std::array::from_fn(|i| std::array::from_fn(|j| reach(i, j)))
        };
        Support {
            faces: (0..6).into_par_iter().map(face).collect(),
        }
    }

    /// A box of all vertices after the map; `None` if there is none.
    pub(crate) fn extent(&self, map: &DAffine3) -> Option<Extent> {
        if self.faces[0][0][0] == f64::NEG_INFINITY {
            return None;
        }
        let columns = &map.matrix3;
        let row = |i: usize| DVec3::new(columns.x_axis[i], columns.y_axis[i], columns.z_axis[i]);
        let max = [0, 1, 2].map(|i| map.translation[i] + self.along(row(i)));
        let min = [0, 1, 2].map(|i| map.translation[i] - self.along(-row(i)));
        Some(Extent {
            min: DVec3::from_array(min),
            max: DVec3::from_array(max),
        })
    }

    /// No less than any vertex reaches along a direction of any length.
    fn along(&self, direction: DVec3) -> f64 {
        let d = direction.to_array();
        let longest = |a: usize, b: usize| if d[b].abs() > d[a].abs() { b } else { a };
        let axis = [1, 2].into_iter().fold(0, longest);
        let length = d[axis].abs();
        if length == 0.0 {
            // All vertices come to one point, if there are any.
            return 0.0;
        }
        let face = &self.faces[2 * axis + usize::from(d[axis] < 0.0)];
        let cell = |x: f64| {
            let at = (x / length + 1.0) * (CELLS as f64 / 2.0);
            let first = (at as usize).min(CELLS - 1);
            (first, at - first as f64)
        };
        let ((i, x), (j, y)) = (cell(d[(axis + 1) % 3]), cell(d[(axis + 2) % 3]));
        let near = face[i][j] * (1.0 - y) + face[i][j + 1] * y;
        let far = face[i + 1][j] * (1.0 - y) + face[i + 1][j + 1] * y;
        length * (near * (1.0 - x) + far * x)
    }
}

/// Children that usually wait.
const STACK: usize = 64;

/// A direction of any length.
struct Direction([f64; 3]);

impl Direction {
    fn at(&self, p: [f32; 3]) -> f64 {
        let [a, b, c] = self.0;
        let [x, y, z] = p.map(f64::from);
        a * x + b * y + c * z
    }

    /// The farthest corner of a child's box.
    fn of_child(&self, node: &LinearNode, slot: usize) -> f64 {
        let plane = |axis: usize| {
            let side = if self.0[axis] < 0.0 { axis } else { axis + 3 };
            node.planes[side][slot]
        };
        self.at([plane(0), plane(1), plane(2)])
    }

    /// The farthest vertex of a block, or `best`.
    fn of_block(&self, block: &TriangleBlock, mut best: f64) -> f64 {
        for [x, y, z] in &block.v {
            for ((x, y), z) in x.iter().zip(y).zip(z) {
                // Unused lanes are not numbers, and maxima leave these out.
                best = best.max(self.at([*x, *y, *z]));
            }
        }
        best
    }
}

/// The farthest that any vertex reaches; −∞ if there is none.
fn farthest(geometry: &Geometry, along: &Direction, stack: &mut Vec<(f64, Child)>) -> f64 {
    let mut best = f64::NEG_INFINITY;
    stack.clear();
    stack.push((f64::INFINITY, geometry.bvh.root));
    while let Some((bound, child)) = stack.pop() {
        if bound <= best {
            continue;
        }
        let first = child.index();
        match child.kind() {
            kind::INNER => {
                let Some(node) = geometry.bvh.nodes.get(first) else {
                    continue;
                };
                let waiting = stack.len();
                for slot in 0..WIDTH {
                    // An unused slot has no box.
                    if node.planes[0][slot] <= node.planes[3][slot] {
                        let bound = along.of_child(node, slot);
                        stack.push((bound, Child(node.child[slot])));
                    }
                }
                stack[waiting..].sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            }
            kind::TRIANGLES => {
                let blocks = &geometry.triangles.blocks[first..first + child.run_len()];
                best = blocks
                    .iter()
                    .fold(best, |best, block| along.of_block(block, best));
            }
            // A mesh has neither spheres nor instances.
            _ => {}
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::bvh::{Accel, Primitives, Quality, build_with};
    use crate::flat::Shading;
    use crate::math::{DMat3, Vec3, axis_angle_deg};

    /// Any bits, from a counter.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    }

    /// How many triangles, what becomes of a random point, and by what share of it a box may be larger.
    type Cloud = (usize, fn(Vec3) -> Vec3, f64);

    /// Triangles between random points of a cube, each of them moved.
    fn cloud(seed: &mut u64, count: usize, place: fn(Vec3) -> Vec3) -> Vec<[Vec3; 3]> {
        let mut point = || Vec3::from([(); 3].map(|()| random(seed) as f32));
        (0..count)
            .map(|_| [(); 3].map(|()| place(point())))
            .collect()
    }

    fn table(triangles: &[[Vec3; 3]], accel: Accel, quality: Quality) -> Support {
        let p = Primitives {
            triangles,
            ..Primitives::default()
        };
        let built = build_with(&p, accel, quality);
        Support::of(&Geometry {
            triangles: built.triangles,
            bvh: built.bvh,
            shading: Shading::default(),
        })
    }

    #[test]
    fn boxes_hold_all_vertices_and_little_more() {
        let seed = &mut 7;
        let (flat, ball) = (|p: Vec3| p.with_y(0.25), |p: Vec3| p.normalize_or_zero());
        let clouds: [Cloud; 6] = [
            (0, |p| p, 0.0),
            (1, |p| p, f64::INFINITY),
            (9, flat, f64::INFINITY),
            (3000, |p| p, f64::INFINITY),
            (3000, flat, f64::INFINITY),
            // 1.6 %, and what a ball of so many corners lacks of one.
            (3000, ball, 0.02),
        ];
        for (count, place, share) in clouds {
            let triangles = cloud(seed, count, place);
            let support = table(&triangles, Accel::Bvh, Quality::Good);
            for (accel, quality) in [
                (Accel::Bvh, Quality::Fast),
                (Accel::Brute, Quality::Good),
                (Accel::Box, Quality::Good),
            ] {
                let other = table(&triangles, accel, quality);
                assert_eq!(other, support, "{accel:?} {quality:?}: other bits");
            }
            for turn in 0..40 {
                let axis = DVec3::new(1.0, random(seed), 2.0);
                let turned = axis_angle_deg(axis, f64::from(turn) * 22.5);
                let stretch = DMat3::from_diagonal(DVec3::new(1.0, -0.5, 3.0));
                let map = DAffine3 {
                    matrix3: if turn < 4 { stretch } else { turned * stretch },
                    translation: DVec3::new(random(seed), 1e-3, -2.0),
                };
                let mut wanted = Extent::EMPTY;
                for p in triangles.iter().flatten() {
                    wanted.add(map.transform_point3(p.as_dvec3()));
                }
                let Some(found) = support.extent(&map) else {
                    assert_eq!(count, 0);
                    continue;
                };
                // Rows are at most 3 long; along the axes nothing is lost.
                let most = if turn < 4 { 1e-14 } else { 3.0 * share };
                for over in [found.max - wanted.max, wanted.min - found.min] {
                    for over in over.to_array() {
                        assert!((-1e-14..=most).contains(&over), "{count} {turn}: {over:e}");
                    }
                }
            }
        }
    }
}
