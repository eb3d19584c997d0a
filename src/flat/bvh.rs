//! The linear bounding volume hierarchy: 8-wide nodes of four cache lines.

use crate::math::Aabb;

/// Children of an inner node.
pub const WIDTH: usize = 8;

/// Inner nodes on any path from the root. The builder keeps it (it splits at the median when a path grows long), so
/// that [`STACK`] entries always suffice.
pub const MAX_DEPTH: usize = 48;

/// Entries of a traversal stack: every inner node on a path leaves at most `WIDTH − 1` siblings behind.
pub const STACK: usize = MAX_DEPTH * (WIDTH - 1) + 1;

/// What a child is, with the number of blocks of a leaf: see [`LinearNode::kind`].
pub mod kind {
    /// Inner node; `child` is its index. Also the kind of an unused slot, whose box is empty.
    pub const INNER: u32 = 0;
    /// A run of triangle blocks; the low 30 bits are their number, `child` is the first.
    pub const TRIANGLES: u32 = 1 << 30;
    /// A run of sphere blocks, likewise.
    pub const SPHERES: u32 = 2 << 30;
    /// A run of instances, likewise; `child` is the first index into [`super::Bvh::instance_order`].
    pub const INSTANCES: u32 = 3 << 30;
    /// The bits that say which.
    pub const MASK: u32 = 3 << 30;
}

/// An inner node: the planes of its eight children's boxes in lanes, then what the children are.
///
/// Boxes are in the space of the geometry and contain their primitives exactly (f32 minima and maxima of f32
/// vertices; spheres and instances rounded outward). An unused slot has `min = +∞`, `max = −∞`.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct LinearNode {
    /// `planes[0..3]`: x, y, z of the minima; `planes[3..6]`: of the maxima. So the near plane of axis `a` for a
    /// ray with a negative direction is `planes[a + 3]`.
    pub planes: [[f32; WIDTH]; 6],
    /// Node index, first block or first instance: see `kind`.
    pub child: [u32; WIDTH],
    /// A [`kind`] with the length of the run.
    pub kind: [u32; WIDTH],
}

const _: () = assert!(size_of::<LinearNode>() == 256);

impl LinearNode {
    /// A node whose slots are all unused.
    pub const EMPTY: LinearNode = LinearNode {
        planes: [
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        child: [0; WIDTH],
        kind: [kind::INNER; WIDTH],
    };

    /// The box of a child.
    #[must_use]
    pub fn child_box(&self, i: usize) -> Aabb {
        let p = &self.planes;
        Aabb {
            min: glam::Vec3::new(p[0][i], p[1][i], p[2][i]),
            max: glam::Vec3::new(p[3][i], p[4][i], p[5][i]),
        }
    }
}

/// A tree. Traversal starts at the root *child*, so that a tree may also be one leaf (`--accel brute`) or nothing.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Inner nodes; a child has a larger index than its parent.
    pub nodes: Vec<LinearNode>,
    /// `child` of the root.
    pub root: u32,
    /// `kind` of the root; `INNER` with no nodes is the empty tree.
    pub root_kind: u32,
    /// Indices into the scene's instances, in leaf order; empty in a local tree.
    pub instance_order: Vec<u32>,
    /// The box of everything in it; empty for the empty tree.
    pub bounds: Aabb,
    /// Inner nodes on the longest path.
    pub depth: u32,
}
