//! Formats of nodes: a format is a module here, with what makes it from the product's tree.
//!
//! All have the leaves of the product's tree, so that formats differ in what lies above the leaves alone.

mod binary;
mod eight;
mod quantised;
mod wide;

pub(super) use binary::Binary;
pub(super) use quantised::Quantised;
pub(super) use wide::Wide;

use crate::flat::bvh::{STACK, kind};
use crate::flat::{self, Bvh};
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::WalkRay;

/// A child of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Child {
    /// Index of an inner node, or of a leaf's first slot of its layout.
    pub(super) first: u32,
    /// Slots of a leaf; 0 for an inner node.
    pub(super) slots: u32,
}

/// Children put off, with where the ray enters them, and how many they are. As long as the product's: a binary tree made
/// of wide nodes has at most seven levels in place of one, and puts one child off at each.
pub(super) struct Stack {
    entries: [(Child, f32); STACK],
    top: usize,
}

impl Stack {
    pub(super) const EMPTY: Stack = Stack {
        entries: [(Child { first: 0, slots: 0 }, 0.0); STACK],
        top: 0,
    };

    /// The nearest child that is not beyond `cull`.
    #[inline(always)]
    pub(super) fn pop(&mut self, cull: f32) -> Option<Child> {
        while self.top > 0 {
            self.top -= 1;
            let (child, near) = self.entries[self.top];
            if near <= cull {
                return Some(child);
            }
        }
        None
    }

    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.top = 0;
    }
}

/// A format.
pub(super) trait Node: Sized {
    /// The lanes that its boxes are tested in, on a machine of lanes `L`.
    type Boxes<L: Lanes>: Lanes;

    /// The same tree; `leaf` renames a run of the product's blocks.
    fn tree(bvh: &Bvh, leaf: impl Fn(u32, u32) -> Child) -> Tree<Self>;

    /// Tests the children's boxes; puts off those that the ray enters, farthest first, and returns the nearest.
    fn enter<L: Lanes>(
        &self,
        ray: &WalkRay<Self::Boxes<L>>,
        cull: f32,
        stack: &mut Stack,
    ) -> Option<Child>;
}

/// A tree.
pub(super) struct Tree<N> {
    /// Parents before their children.
    pub(super) nodes: Vec<N>,
    /// `None` for the empty tree.
    pub(super) root: Option<Child>,
    /// How boxes are widened, as [`WIDENED`](crate::trace::kernels::ray::WIDENED) says.
    pub(super) slabs: [f32; 2],
}

/// A child of the product's tree.
fn child(of: flat::Child, leaf: impl Fn(u32, u32) -> Child) -> Child {
    match of.kind() {
        kind::INNER => Child {
            first: of.index() as u32,
            slots: 0,
        },
        _ => leaf(of.index() as u32, of.run_len() as u32),
    }
}

/// The root of the product's tree.
fn root(bvh: &Bvh, leaf: impl Fn(u32, u32) -> Child) -> Option<Child> {
    let empty = bvh.root.kind() == kind::INNER && bvh.nodes.is_empty();
    (!empty).then(|| child(bvh.root, leaf))
}
