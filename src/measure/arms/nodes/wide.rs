//! Eight children a node, their planes in lanes: 256 bytes. What Embree's BVH8 is (Wald et al., *Embree: A Kernel Framework
//! for Efficient CPU Ray Tracing*, 2014), and what the product walks.

use super::eight::{boxes_met, put_off};
use super::{Child, Node, Stack, Tree, child, root};
use crate::flat::bvh::WIDTH;
use crate::flat::{self, Bvh};
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::{WIDENED, WalkRay};

/// A node.
#[repr(C, align(64))]
pub(in super::super) struct Wide {
    /// As [`LinearNode::planes`](crate::flat::LinearNode::planes); unused slots are empty boxes.
    pub(super) planes: [[f32; WIDTH]; 6],
    pub(super) first: [u32; WIDTH],
    pub(super) slots: [u32; WIDTH],
}

const _: () = assert!(size_of::<Wide>() == 256);

impl Node for Wide {
    type Boxes<L: Lanes> = L;

    fn tree(bvh: &Bvh, leaf: impl Fn(u32, u32) -> Child) -> Tree<Wide> {
        let nodes = bvh.nodes.iter().map(|node| {
            let mut wide = Wide {
                planes: node.planes,
                first: [0; WIDTH],
                slots: [0; WIDTH],
            };
            for slot in 0..WIDTH {
                let child = child(flat::Child(node.child[slot]), &leaf);
                wide.first[slot] = child.first;
                wide.slots[slot] = child.slots;
            }
            wide
        });
        Tree {
            nodes: nodes.collect(),
            root: root(bvh, &leaf),
            slabs: WIDENED,
        }
    }

    #[inline(always)]
    fn enter<L: Lanes>(&self, ray: &WalkRay<L>, cull: f32, stack: &mut Stack) -> Option<Child> {
        let (near, met) = boxes_met(&self.planes, ray, cull);
        let child = |slot: usize| Child {
            first: self.first[slot],
            slots: self.slots[slot],
        };
        put_off(&near, met, child, &mut stack.entries, &mut stack.top)
    }
}
