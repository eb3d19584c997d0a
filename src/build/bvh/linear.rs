//! Linearize: a grown tree becomes an array of nodes and blocks in leaf order.
//!
//! Nodes at the top lie breadth-first, since every ray passes them and a cache should hold nothing else beside them.
//! Below, they lie depth-first with the inner children of a node side by side: what is fetched together is
//! together. Blocks follow in the order in which their parents were placed.
#![allow(
    clippy::needless_range_loop,
    reason = "axes are numbers here: several arrays are indexed by one"
)]

use super::blocks::{Ready, sphere_block, triangle_block};
use super::item::{Item, Kinds};
use super::split::{self, NODE_COST};
use super::standing::{Below, Standing};
use super::tree::{BuildNode, Child, Grove, Shape};
use super::{Built, CHUNK, Primitives, SPHERES, SphereItem};
use crate::flat::bvh::{Child as To, WIDTH, kind};
use crate::flat::{BLOCK, Bvh, LinearNode, SphereBlock, TriangleBlock};
use crate::math::{Aabb, pages};
use rayon::prelude::*;
use std::ops::Range;

/// Nodes that lie breadth-first: 512 KiB, half of a second-level cache.
const TOP: usize = 2048;

/// Writes the tree down.
pub(super) fn linearize(
    p: &Primitives,
    items: &[Item],
    root: Option<(Child, Grove)>,
    ready: Ready,
    below: Option<&Below>,
) -> Built {
    let nothing = Child {
        bounds: Aabb::EMPTY,
        shape: Shape::Leaf(0..0),
    };
    let (root, grove) = root.unwrap_or((nothing, Grove::default()));
    let mut order = Order::new(items, &ready, half_area(&root.bounds), below);
    let to = order.all(&grove, &root);
    let blocks = order.blocks(p);
    Built {
        bvh: Bvh {
            nodes: order.linear(),
            root: to,
            instance_order: order.instances(),
            bounds: root.bounds,
            depth: order.depth,
        },
        sphere_blocks: order.sphere_blocks(p),
        cost: order.cost,
        triangles: ready.with(blocks),
    }
}

fn to_usize(range: &Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}

fn half_area(b: &Aabb) -> f32 {
    if b.is_empty() { 0.0 } else { b.half_area() }
}

/// Where everything goes.
struct Order<'a> {
    items: &'a [Item],
    ready: &'a Ready,
    /// What stands still, whose nodes and blocks lie before these.
    below: Option<&'a Below>,
    /// Which node is its root.
    copy: Option<usize>,
    /// Half the area of the root's box.
    area: f32,
    nodes: Vec<Placed<'a>>,
    /// Items of every further triangle block.
    triangles: Vec<Range<u32>>,
    /// Items of every sphere block.
    spheres: Vec<Range<u32>>,
    /// The item of every instance.
    instances: Vec<u32>,
    depth: u32,
    cost: f32,
}

/// How much of each array is there before.
#[derive(Default)]
struct Before {
    nodes: usize,
    spheres: usize,
    instances: usize,
}

/// A node in its place.
#[derive(Clone, Copy)]
struct Placed<'a> {
    grove: &'a Grove,
    node: &'a BuildNode,
    /// Inner nodes on the path that ends here.
    depth: u32,
    /// Where every child went.
    to: [To; WIDTH],
}

impl<'a> Order<'a> {
    fn new(items: &'a [Item], ready: &'a Ready, area: f32, below: Option<&'a Below>) -> Order<'a> {
        Order {
            items,
            ready,
            below,
            copy: None,
            area,
            nodes: pages::with_capacity((items.len() + ready.children.len()) / BLOCK),
            triangles: pages::with_capacity(items.len() / (BLOCK / 2)),
            spheres: Vec::new(),
            instances: Vec::new(),
            depth: 0,
            cost: 0.0,
        }
    }

    /// Places everything below the root; returns where.
    fn all(&mut self, grove: &'a Grove, root: &'a Child) -> To {
        let to = self.child(grove, root, 1);
        let mut next = 0;
        while next < self.nodes.len() && self.nodes.len() < TOP {
            self.children(next);
            next += 1;
        }
        let mut stack: Vec<usize> = (next..self.nodes.len()).rev().collect();
        while let Some(at) = stack.pop() {
            stack.extend(self.children(at).rev());
        }
        to
    }

    /// Places the children of a node; returns where the inner ones are.
    fn children(&mut self, at: usize) -> Range<usize> {
        let first = self.nodes.len();
        let Placed {
            grove, node, depth, ..
        } = self.nodes[at];
        for (slot, child) in node.iter().flatten().enumerate() {
            self.nodes[at].to[slot] = self.child(grove, child, depth + 1);
        }
        first..self.nodes.len()
    }

    /// Places a child; returns where.
    fn child(&mut self, grove: &'a Grove, child: &'a Child, depth: u32) -> To {
        let share = if self.area > 0.0 {
            half_area(&child.bounds) / self.area
        } else {
            0.0
        };
        let (grove, index) = match &child.shape {
            Shape::Leaf(range) => {
                let items = &self.items[to_usize(range)];
                if let [item] = items {
                    if item.kind() == Kinds::READY {
                        let child = &self.ready.children[item.index() as usize];
                        return self.child(&self.ready.grove, child, depth);
                    }
                    if let (Kinds::STANDING, Some(below)) = (item.kind(), self.below) {
                        return self.standing(below, grove, depth, share);
                    }
                }
                let units = items.iter().map(Item::units).sum();
                self.cost += share * split::blocks(units);
                return self.leaf(range.clone());
            }
            Shape::Block(index) => {
                self.cost += share;
                return To::run(kind::TRIANGLES, *index, 1);
            }
            Shape::Node(index) => (grove, *index as usize),
            Shape::Grove(index) => (&grove.groves[*index as usize], 0),
        };
        self.cost += share * NODE_COST;
        self.depth = self.depth.max(depth);
        self.nodes.push(Placed {
            grove,
            node: &grove.nodes[index],
            depth,
            to: [To::inner(0); WIDTH],
        });
        To::inner((self.before().nodes + self.nodes.len()) as u32 - 1)
    }

    /// Places the root of what stands; returns where.
    fn standing(&mut self, below: &Below, grove: &'a Grove, depth: u32, share: f32) -> To {
        let Standing {
            root,
            depth: levels,
            cost,
            ..
        } = below.standing;
        self.cost += share * cost;
        if root.kind() != kind::INNER {
            return root;
        }
        self.depth = self.depth.max(depth - 1 + levels);
        self.copy = Some(self.nodes.len());
        self.nodes.push(Placed {
            grove,
            node: const { &[const { None }; WIDTH] },
            depth,
            to: [To::inner(0); WIDTH],
        });
        To::inner((self.before().nodes + self.nodes.len()) as u32 - 1)
    }

    /// How much lies before what is placed here.
    fn before(&self) -> Before {
        match self.below {
            None => Before::default(),
            Some(Below { standing, .. }) => Before {
                nodes: standing.nodes,
                spheres: standing.sphere_blocks,
                instances: standing.instances,
            },
        }
    }

    /// Places the blocks of a leaf; returns where.
    fn leaf(&mut self, range: Range<u32>) -> To {
        let what = self.items.get(range.start as usize).map(Item::kind);
        let standing = self.before().spheres;
        let (list, before, lanes, tag) = match what {
            None => return To::inner(0),
            Some(Kinds::INSTANCE) => {
                let first = (self.before().instances + self.instances.len()) as u32;
                self.instances.extend(range.clone());
                return To::run(kind::INSTANCES, first, range.len() as u32);
            }
            Some(Kinds::SPHERE) => (&mut self.spheres, standing, SPHERES, kind::SPHERES),
            Some(_) => (
                &mut self.triangles,
                self.ready.blocks.len(),
                BLOCK,
                kind::TRIANGLES,
            ),
        };
        let first = list.len() as u32;
        let starts = range.clone().step_by(lanes);
        list.extend(starts.map(|at| at..range.end.min(at + lanes as u32)));
        let count = list.len() as u32 - first;
        To::run(tag, before as u32 + first, count)
    }

    fn instances(&self) -> Vec<u32> {
        let items = self.instances.iter().map(|&i| &self.items[i as usize]);
        items.map(Item::index).collect()
    }

    fn sphere_blocks(&self, p: &Primitives) -> Vec<SphereBlock> {
        let of = |i: &Item| p.spheres[i.index() as usize];
        let blocks = self.spheres.iter().map(|range| {
            let spheres: Vec<SphereItem> = self.items[to_usize(range)].iter().map(of).collect();
            sphere_block(&spheres)
        });
        blocks.collect()
    }

    fn linear(&self) -> Vec<LinearNode> {
        let mut nodes = pages::with_capacity(self.nodes.len());
        let placed = self.nodes.par_iter().with_min_len(CHUNK / WIDTH);
        placed.map(Placed::linear).collect_into_vec(&mut nodes);
        if let (Some(at), Some(below)) = (self.copy, self.below) {
            nodes[at] = below.node;
        }
        nodes
    }

    /// The further triangle blocks.
    fn blocks(&self, p: &Primitives) -> Vec<TriangleBlock> {
        let Ready { blocks, place, .. } = self.ready;
        let mut further = pages::with_capacity(self.triangles.len());
        let ranges = self.triangles.par_iter().with_min_len(CHUNK / BLOCK);
        let block = |(at, range): (usize, &Range<u32>)| {
            let items = &self.items[to_usize(range)];
            let prim = |lane: usize| items[lane].index();
            triangle_block(p.triangles, items.len(), prim, blocks.len() + at, place)
        };
        ranges.enumerate().map(block).collect_into_vec(&mut further);
        further
    }
}

impl Placed<'_> {
    fn linear(&self) -> LinearNode {
        let mut out = LinearNode::EMPTY;
        for (slot, child) in self.node.iter().flatten().enumerate() {
            for axis in 0..3 {
                out.planes[axis][slot] = child.bounds.min[axis];
                out.planes[axis + 3][slot] = child.bounds.max[axis];
            }
            out.child[slot] = self.to[slot].0;
        }
        out
    }
}
