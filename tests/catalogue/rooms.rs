//! Closed convex solids whose corners are small integers, so that they are convex to the bit wherever they stand.

use crate::support::Solid;
use luxel::math::Vec3;
use std::fmt::Write;

/// Corners and faces that run counter-clockwise, seen from outside.
fn solid<const V: usize, const F: usize>(corners: [[i32; 3]; V], faces: [[usize; 3]; F]) -> Solid {
    Solid {
        vertices: corners.map(|c| Vec3::from(c.map(|x| x as f32))).to_vec(),
        faces: faces.to_vec(),
    }
}

/// Faces that meet at 109°.
pub(crate) fn octahedron() -> Solid {
    solid(
        [
            [2, 0, 0],
            [-2, 0, 0],
            [0, 2, 0],
            [0, -2, 0],
            [0, 0, 2],
            [0, 0, -2],
        ],
        [
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ],
    )
}

/// From −1 to 1.
pub(crate) fn cube() -> Solid {
    let side = |k: usize, bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let corners = (0..8).map(|k| Vec3::new(side(k, 0), side(k, 1), side(k, 2)));
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    Solid {
        vertices: corners.collect(),
        faces: quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect(),
    }
}

/// Regular: faces meet at 71°.
pub(crate) fn tetrahedron() -> Solid {
    solid(
        [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]],
        [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
    )
}

/// A prism over a right triangle with two equal sides: two pairs of its walls meet at 45°.
pub(crate) fn wedge() -> Solid {
    solid(
        [
            [-1, -1, -1],
            [3, -1, -1],
            [-1, 3, -1],
            [-1, -1, 1],
            [3, -1, 1],
            [-1, 3, 1],
        ],
        [
            [0, 2, 1],
            [3, 4, 5],
            [0, 1, 4],
            [0, 4, 3],
            [1, 2, 5],
            [1, 5, 4],
            [2, 0, 3],
            [2, 3, 5],
        ],
    )
}

/// A file of it, its faces turned over so that it shines inward.
pub(crate) fn inward(solid: &Solid) -> String {
    let mut text = String::new();
    for v in &solid.vertices {
        writeln!(text, "v {} {} {}", v.x, v.y, v.z).expect("a string");
    }
    for [a, b, c] in &solid.faces {
        writeln!(text, "f {} {} {}", a + 1, c + 1, b + 1).expect("a string");
    }
    text
}
