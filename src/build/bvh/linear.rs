//! Linearize: a grown tree becomes an array of nodes and blocks in leaf order.
//!
//! Nodes at the top lie breadth-first, since every ray passes them and a cache should hold nothing else beside them.
//! Below, they lie depth-first with the inner children of a node side by side: what is fetched together is
//! together. Blocks follow in the order in which their parents were placed.
#![allow(
    clippy::needless_range_loop,
    reason = "axes are numbers here: several arrays are indexed by one"
)]

use super::item::{Item, Kinds};
use super::split::{self, NODE_COST};
use super::tree::{BuildNode, Child, Grove, Shape};
use super::{Built, CHUNK, Primitives, SPHERES, SphereItem, sphere_bounds};
use crate::flat::bvh::{Child as To, WIDTH, kind};
use crate::flat::{BLOCK, Bvh, LinearNode, SphereBlock, TriangleBlock, Triangles};
use crate::math::{Aabb, Vec3, pages};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

/// Nodes that lie breadth-first: 512 KiB, half of a second-level cache.
const TOP: usize = 2048;

/// Writes the tree down.
pub(super) fn linearize(p: &Primitives, items: &[Item], root: Option<(Child, Grove)>) -> Built {
    let nothing = Child {
        bounds: Aabb::EMPTY,
        shape: Shape::Leaf(0..0),
    };
    let (root, grove) = root.unwrap_or((nothing, Grove::default()));
    let mut order = Order::new(items, half_area(&root.bounds));
    let to = order.all(&grove, &root);
    let place: Vec<AtomicU32> = (0..p.triangles.len()).map(|_| AtomicU32::new(0)).collect();
    let mut blocks = pages::with_capacity(order.triangles.len());
    let ranges = order.triangles.par_iter().enumerate();
    ranges
        .with_min_len(CHUNK / BLOCK)
        .map(|(at, range)| triangle_block(p, &items[to_usize(range)], at, &place))
        .collect_into_vec(&mut blocks);
    let mut nodes = pages::with_capacity(order.nodes.len());
    let placed = order.nodes.par_iter().with_min_len(CHUNK / WIDTH);
    placed.map(Placed::linear).collect_into_vec(&mut nodes);
    let spheres = order.spheres.iter().map(|range| {
        let of = |i: &Item| p.spheres[i.index() as usize];
        sphere_block(&items[to_usize(range)].iter().map(of).collect::<Vec<_>>())
    });
    Built {
        bvh: Bvh {
            nodes,
            root: to,
            instance_order: order
                .instances
                .iter()
                .map(|i| items[*i as usize].index())
                .collect(),
            bounds: root.bounds,
            depth: order.depth,
        },
        triangles: Triangles {
            blocks,
            place: place.into_iter().map(AtomicU32::into_inner).collect(),
        },
        sphere_blocks: spheres.collect(),
        cost: order.cost,
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
    /// Half the area of the root's box.
    area: f32,
    nodes: Vec<Placed<'a>>,
    /// Items of every triangle block.
    triangles: Vec<Range<u32>>,
    /// Items of every sphere block.
    spheres: Vec<Range<u32>>,
    /// The item of every instance.
    instances: Vec<u32>,
    depth: u32,
    cost: f32,
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
    fn new(items: &'a [Item], area: f32) -> Order<'a> {
        Order {
            items,
            area,
            nodes: Vec::new(),
            triangles: Vec::with_capacity(items.len() / (BLOCK / 2)),
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
                let units = items.iter().map(Item::units).sum();
                self.cost += share * split::blocks(units);
                return self.leaf(range.clone());
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
        To::inner(self.nodes.len() as u32 - 1)
    }

    /// Places the blocks of a leaf; returns where.
    fn leaf(&mut self, range: Range<u32>) -> To {
        let what = self.items.get(range.start as usize).map(Item::kind);
        let (list, lanes, tag) = match what {
            None => return To::inner(0),
            Some(Kinds::INSTANCE) => {
                let first = self.instances.len() as u32;
                self.instances.extend(range.clone());
                return To::run(kind::INSTANCES, first, range.len() as u32);
            }
            Some(Kinds::SPHERE) => (&mut self.spheres, SPHERES, kind::SPHERES),
            Some(_) => (&mut self.triangles, BLOCK, kind::TRIANGLES),
        };
        let first = list.len() as u32;
        let starts = range.clone().step_by(lanes);
        list.extend(starts.map(|at| at..range.end.min(at + lanes as u32)));
        To::run(tag, first, list.len() as u32 - first)
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

/// The triangle block of these items, whose places it notes.
fn triangle_block(p: &Primitives, items: &[Item], at: usize, place: &[AtomicU32]) -> TriangleBlock {
    let mut block = TriangleBlock {
        v: [[[0.0; BLOCK]; 3]; 3],
        prim: [u32::MAX; BLOCK],
    };
    for lane in 0..BLOCK {
        let vertices = match items.get(lane) {
            Some(item) => {
                let prim = item.index() as usize;
                block.prim[lane] = prim as u32;
                place[prim].store((BLOCK * at + lane) as u32, Ordering::Relaxed);
                p.triangles[prim]
            }
            None => [Vec3::NAN; 3],
        };
        for (k, vertex) in vertices.iter().map(Vec3::to_array).enumerate() {
            for axis in 0..3 {
                block.v[k][axis][lane] = vertex[axis];
            }
        }
    }
    block
}

/// A block of so many spheres as there are lanes, or fewer.
pub(super) fn sphere_block(spheres: &[SphereItem]) -> SphereBlock {
    let mut block = SphereBlock {
        bounds: LinearNode::EMPTY.planes.map(|p| [p[0]; SPHERES]),
        center: [[0.0; SPHERES]; 3],
        radius: [0.0; SPHERES],
        prim: [u32::MAX; SPHERES],
    };
    for (lane, s) in spheres.iter().enumerate() {
        let bounds = sphere_bounds(s.center, s.radius);
        for axis in 0..3 {
            block.bounds[axis][lane] = bounds.min[axis];
            block.bounds[axis + 3][lane] = bounds.max[axis];
            block.center[axis][lane] = s.center[axis];
        }
        block.radius[lane] = s.radius;
        block.prim[lane] = s.prim;
    }
    block
}
