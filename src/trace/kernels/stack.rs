//! The stack of kernels that order a node's children all at once, and ask for them.

use crate::flat::bvh::{STACK, WIDTH};
use crate::flat::{Child, TriangleBlock};

/// At the bottom of every stack: the walk is done.
pub(super) const DONE: Child = Child(u32::MAX);

/// Bytes that are asked for: a node, a block of triangles, or the bounds of a block of spheres.
pub(super) const FETCHED: usize = size_of::<TriangleBlock>();

/// Children put off by one ray or packet. Eight entries are written at once, hence as many beyond the last.
#[derive(Clone, Copy)]
pub(super) struct Stack {
    pub(super) children: [u32; STACK + WIDTH],
    /// Where the ray enters them, or less.
    pub(super) entries: [f32; STACK + WIDTH],
}

impl Default for Stack {
    fn default() -> Stack {
        Stack::BOTTOM
    }
}

impl Stack {
    /// Nothing but [`DONE`], which every ray enters.
    pub(super) const BOTTOM: Stack = Stack {
        children: [DONE.0; STACK + WIDTH],
        entries: [f32::NEG_INFINITY; STACK + WIDTH],
    };

    /// Takes the next child off the stack of a length that may hold a closer hit.
    #[inline(always)]
    pub(super) fn pop(&self, top: &mut usize, cull: f32) -> Child {
        let mut at = *top - 1;
        while self.entries[at] > cull {
            at -= 1;
        }
        *top = at;
        Child(self.children[at])
    }
}
