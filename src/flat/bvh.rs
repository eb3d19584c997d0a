//! The linear bounding volume hierarchy: 8-wide nodes of four cache lines.

use crate::math::Aabb;

/// Children of an inner node.
pub const WIDTH: usize = 8;

/// Inner nodes on any path from the root. The builder keeps it (it splits at the median when a path grows long), so
/// that [`STACK`] entries always suffice.
pub const MAX_DEPTH: usize = 48;

/// Entries of a traversal stack: every inner node on a path leaves at most `WIDTH − 1` siblings behind.
pub const STACK: usize = MAX_DEPTH * (WIDTH - 1) + 1;

/// What a node points to: an inner node, or a run of blocks or instances of one kind. One word, so that a traversal stack
/// is two arrays.
///
/// Two bits of kind, four of length less one, 26 of index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct Child(pub u32);

/// The kinds of a [`Child`], in its two highest bits.
pub mod kind {
    /// An inner node; the index of a node. Also an unused slot's, with index 0 and an empty box.
    pub const INNER: u32 = 0;
    /// A run of triangle blocks, from the index on.
    pub const TRIANGLES: u32 = 1 << 30;
    /// A run of sphere blocks.
    pub const SPHERES: u32 = 2 << 30;
    /// A run of instances; the index is into [`super::Bvh::instance_order`].
    pub const INSTANCES: u32 = 3 << 30;
    /// The bits that say which.
    pub const MASK: u32 = 3 << 30;
}

impl Child {
    /// Bits of the index: 2²⁶ nodes are 16 GiB.
    const INDEX_BITS: u32 = 26;

    /// Blocks or instances of a leaf at most.
    pub const MAX_RUN: u32 = 1 << (30 - Child::INDEX_BITS);

    /// An inner node.
    #[must_use]
    pub const fn inner(node: u32) -> Child {
        Child(node)
    }

    /// A run of `len` blocks, 1 to [`Child::MAX_RUN`].
    #[must_use]
    pub const fn run(kind: u32, first: u32, len: u32) -> Child {
        Child(kind | (len - 1) << Child::INDEX_BITS | first)
    }

    /// One of [`kind`].
    #[inline(always)]
    #[must_use]
    pub const fn kind(self) -> u32 {
        self.0 & kind::MASK
    }

    /// Index of the node, or of the first of the run.
    #[inline(always)]
    #[must_use]
    pub const fn index(self) -> usize {
        (self.0 & ((1 << Child::INDEX_BITS) - 1)) as usize
    }

    /// The run without its first; nothing of a run of one.
    #[inline(always)]
    #[must_use]
    pub const fn rest(self) -> Option<Child> {
        if self.run_len() == 1 {
            None
        } else {
            Some(Child(self.0 - (1 << Child::INDEX_BITS) + 1))
        }
    }

    /// The run's first by itself.
    #[inline(always)]
    #[must_use]
    pub const fn alone(self) -> Child {
        Child(self.0 & (kind::MASK | ((1 << Child::INDEX_BITS) - 1)))
    }

    /// Length of the run.
    #[inline(always)]
    #[must_use]
    pub const fn run_len(self) -> usize {
        ((self.0 & !kind::MASK) >> Child::INDEX_BITS) as usize + 1
    }
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
    /// What the children are, [`Child`]'s words.
    pub child: [u32; WIDTH],
    /// Fills the fourth cache line.
    pub padding: [u32; WIDTH],
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
        padding: [0; WIDTH],
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
    /// Inner nodes. Children lie side by side and have larger indices than their parent, except that of a scene in which
    /// things move, the nodes of all that stands lie before the others.
    pub nodes: Vec<LinearNode>,
    /// The root; an inner one where there are no nodes is the empty tree.
    pub root: Child,
    /// Indices into the scene's instances, in leaf order; empty in a local tree.
    pub instance_order: Vec<u32>,
    /// The box of everything in it; empty for the empty tree.
    pub bounds: Aabb,
    /// Inner nodes on the longest path.
    pub depth: u32,
}
