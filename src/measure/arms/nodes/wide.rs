//! Eight children a node, their planes in lanes: 256 bytes. What Embree's BVH8 is (Wald et al., *Embree: A Kernel Framework
//! for Efficient CPU Ray Tracing*, 2014), and what the product walks.

use super::{Child, Node, Stack, Tree, child, root};
use crate::flat::bvh::WIDTH;
use crate::flat::{self, Bvh};
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::WalkRay;

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
        }
    }

    #[inline(always)]
    fn enter<L: Lanes>(&self, ray: &WalkRay<L>, cull: f32, stack: &mut Stack) -> Option<Child> {
        let mut near = [0.0; WIDTH];
        let mut met = 0;
        let mut at = 0;
        while at < WIDTH {
            let interval = ray.slabs(&self.planes, at);
            interval.near.store(&mut near[at..]);
            met |= L::bits(interval.meets(L::splat(cull))) << at;
            at += L::N;
        }
        if met == 0 {
            return None;
        }
        let mut nearest = lowest(met);
        met &= met - 1;
        let bottom = stack.top;
        while met != 0 {
            let mut far = lowest(met);
            met &= met - 1;
            if near[far] < near[nearest] {
                (far, nearest) = (nearest, far);
            }
            let mut place = stack.top;
            while place > bottom && stack.entries[place - 1].1 < near[far] {
                stack.entries[place] = stack.entries[place - 1];
                place -= 1;
            }
            stack.entries[place] = (self.child(far), near[far]);
            stack.top += 1;
        }
        Some(self.child(nearest))
    }
}

impl Wide {
    #[inline(always)]
    fn child(&self, slot: usize) -> Child {
        Child {
            first: self.first[slot],
            slots: self.slots[slot],
        }
    }
}

/// Index of the lowest set bit of eight.
#[inline(always)]
fn lowest(bits: u32) -> usize {
    bits.trailing_zeros() as usize & (WIDTH - 1)
}
