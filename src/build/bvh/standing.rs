//! What stands still keeps its tree from frame to frame: its nodes and blocks lie at the front of their arrays, and those of
//! what moves behind them.
//!
//! The tree of a frame is grown over the things that move and over one item more, which is all that stands. Its root there is
//! a copy, so that inner children lie side by side as everywhere. That the children of this copy lie before it is all that
//! tells such a tree from one that was built at once.

use super::item::{self, Bounds, Item, Kinds};
use super::{Built, Primitives, blocks::Ready, linear, tree};
use crate::flat::bvh::{Child, MAX_DEPTH};
use crate::flat::{BLOCK, Bvh, LinearNode, SphereBlock};
use crate::math::Aabb;

/// A tree over what stands still, without its arrays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Where a ray begins that only meets what stands.
    pub(super) root: Child,
    pub(super) bounds: Aabb,
    pub(super) depth: u32,
    pub(super) cost: f32,
    pub(super) nodes: usize,
    pub(super) sphere_blocks: usize,
    pub(super) instances: usize,
}

impl Standing {
    /// What `built` is a tree over.
    #[must_use]
    pub fn of(built: &Built) -> Standing {
        Standing {
            root: built.bvh.root,
            bounds: built.bvh.bounds,
            depth: built.bvh.depth,
            cost: built.cost,
            nodes: built.bvh.nodes.len(),
            sphere_blocks: built.sphere_blocks.len(),
            instances: built.bvh.instance_order.len(),
        }
    }

    /// Expected work of a ray that meets its box.
    #[must_use]
    pub fn cost(&self) -> f32 {
        self.cost
    }

    /// How many instances stand: those that move follow in the order.
    #[must_use]
    pub fn instances(&self) -> usize {
        self.instances
    }

    /// Cuts the arrays of a frame back to what stands.
    pub fn cut_back(&self, bvh: &mut Bvh, spheres: &mut Vec<SphereBlock>) {
        cut(&mut bvh.nodes, self.nodes);
        cut(&mut bvh.instance_order, self.instances);
        bvh.root = self.root;
        bvh.bounds = self.bounds;
        bvh.depth = self.depth;
        cut(spheres, self.sphere_blocks);
    }

    /// The tree of a frame over `standing`, which is this, and spheres and instances that move.
    ///
    /// # Errors
    /// With `standing` where the tree would be too deep: then all of it must be built at once.
    pub fn with(&self, mut standing: Built, moving: &Primitives) -> Result<Built, Built> {
        let mut items: Vec<Item> = item::others(moving).collect();
        if items.is_empty() {
            return Ok(standing);
        }
        if !self.bounds.is_empty() {
            let bounds: Bounds = self.bounds.into();
            items.push(Item::new(bounds, Kinds::STANDING, 0, BLOCK));
        }
        let root = tree::grow(&mut items);
        let node = standing.bvh.nodes.first().copied();
        let below = Below {
            standing: *self,
            node: node.unwrap_or(LinearNode::EMPTY),
        };
        let above = linear::linearize(moving, &items, root, Ready::new(0), Some(&below));
        if above.bvh.depth as usize > MAX_DEPTH {
            return Err(standing);
        }
        append(&mut standing.bvh.nodes, above.bvh.nodes);
        append(&mut standing.bvh.instance_order, above.bvh.instance_order);
        standing.bvh.root = above.bvh.root;
        standing.bvh.bounds = above.bvh.bounds;
        standing.bvh.depth = above.bvh.depth;
        standing.cost = above.cost;
        append(&mut standing.sphere_blocks, above.sphere_blocks);
        Ok(standing)
    }
}

/// Puts `more` behind `all`, without a copy where that is nothing.
fn append<T>(all: &mut Vec<T>, more: Vec<T>) {
    if all.is_empty() {
        *all = more;
    } else {
        all.extend(more);
    }
}

/// Leaves the first `len`; of nothing, no room either.
fn cut<T>(all: &mut Vec<T>, len: usize) {
    all.truncate(len);
    if len == 0 {
        *all = Vec::new();
    }
}

/// What stands, for the tree above it.
pub(super) struct Below {
    pub(super) standing: Standing,
    /// Its root, if that is a node.
    pub(super) node: LinearNode,
}
