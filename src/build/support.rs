//! How far a mesh reaches after a map, found by walking its tree: the same numbers as from all of its vertices, in the time
//! of a few dozen nodes.
//!
//! A vertex is no farther along a direction than the box it is in. That holds to the bit: what is computed of the box's corner
//! is computed by the same operations, each of which rounds upward or downward never against the order of its arguments. So
//! boxes may be left out as soon as they are not farther than what was found, and the tree's shape changes nothing.

use super::rebase::Extent;
use crate::flat::bvh::{Child, WIDTH, kind};
use crate::flat::{Geometry, LinearNode, TriangleBlock};
use crate::math::{DAffine3, DVec3};

/// The box of all vertices of `geometry` after the map; `None` if it has none.
pub(crate) fn extent(geometry: &Geometry, map: &DAffine3) -> Option<Extent> {
    let mut stack = Vec::with_capacity(STACK);
    let mut most = |row: Row| farthest(geometry, row, &mut stack);
    let rows = [0, 1, 2].map(|i| Row::of(map, i));
    let max = rows.map(&mut most);
    let min = rows.map(|row| -most(row.negated()));
    let extent = Extent {
        min: DVec3::from_array(min),
        max: DVec3::from_array(max),
    };
    (max[0] >= min[0]).then_some(extent)
}

/// Children that usually wait.
const STACK: usize = 64;

/// A row of an affine map: how far a point reaches along an axis after it.
#[derive(Clone, Copy)]
struct Row {
    linear: [f64; 3],
    offset: f64,
}

impl Row {
    fn of(map: &DAffine3, i: usize) -> Row {
        let m = &map.matrix3;
        Row {
            linear: [m.x_axis[i], m.y_axis[i], m.z_axis[i]],
            offset: map.translation[i],
        }
    }

    fn negated(self) -> Row {
        Row {
            linear: self.linear.map(|x| -x),
            offset: -self.offset,
        }
    }

    /// In the order of [`DAffine3::transform_point3`].
    fn at(&self, p: [f32; 3]) -> f64 {
        let [a, b, c] = self.linear;
        let [x, y, z] = p.map(f64::from);
        a * x + b * y + c * z + self.offset
    }

    /// The farthest corner of a child's box.
    fn of_child(&self, node: &LinearNode, slot: usize) -> f64 {
        let plane = |axis: usize| {
            let side = if self.linear[axis] < 0.0 {
                axis
            } else {
                axis + 3
            };
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
fn farthest(geometry: &Geometry, row: Row, stack: &mut Vec<(f64, Child)>) -> f64 {
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
                        let bound = row.of_child(node, slot);
                        stack.push((bound, Child(node.child[slot])));
                    }
                }
                stack[waiting..].sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            }
            kind::TRIANGLES => {
                let blocks = &geometry.triangles.blocks[first..first + child.run_len()];
                best = blocks
                    .iter()
                    .fold(best, |best, block| row.of_block(block, best));
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

    #[test]
    fn the_tree_finds_what_all_vertices_give_to_the_bit() {
        let seed = &mut 7;
        for (count, flat) in [
            (0, false),
            (1, false),
            (9, true),
            (3000, false),
            (3000, true),
        ] {
            let point = |seed: &mut u64| {
                let p = [(); 3].map(|()| random(seed) as f32);
                // Many vertices in one plane, as far as each other.
                Vec3::new(p[0], if flat { 0.25 } else { p[1] }, p[2])
            };
            let triangles: Vec<[Vec3; 3]> = (0..count)
                .map(|_| {
                    let at = point(seed);
                    [at, at + point(seed) * 0.01, at + point(seed) * 0.01]
                })
                .collect();
            let p = Primitives {
                triangles: &triangles,
                ..Primitives::default()
            };
            for (accel, quality) in [
                (Accel::Bvh, Quality::Good),
                (Accel::Bvh, Quality::Fast),
                (Accel::Brute, Quality::Good),
                (Accel::Box, Quality::Good),
            ] {
                let built = build_with(&p, accel, quality);
                let geometry = Geometry {
                    triangles: built.triangles,
                    bvh: built.bvh,
                    shading: Shading::default(),
                };
                for turn in 0..40 {
                    let turned =
                        axis_angle_deg(DVec3::new(1.0, random(seed), 2.0), f64::from(turn) * 22.5);
                    let stretch = DMat3::from_diagonal(DVec3::new(1.0, -0.5, 3.0));
                    let map = DAffine3 {
                        matrix3: if turn < 4 { stretch } else { turned * stretch },
                        translation: DVec3::new(random(seed), 1e-3, -2.0),
                    };
                    let mut wanted = Extent::EMPTY;
                    for p in triangles.iter().flatten() {
                        wanted.add(map.transform_point3(p.as_dvec3()));
                    }
                    let found = extent(&geometry, &map);
                    assert_eq!(found.is_some(), count > 0);
                    let found = found.unwrap_or(Extent::EMPTY);
                    assert_eq!(
                        (found.min, found.max),
                        (wanted.min, wanted.max),
                        "{count} {accel:?}"
                    );
                }
            }
        }
    }
}
