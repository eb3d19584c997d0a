//! Linearize: a grown tree becomes an array of nodes, depth first, and blocks in leaf order.
#![allow(
    clippy::needless_range_loop,
    reason = "axes are numbers here: several arrays are indexed by one"
)]

use super::split::{self, NODE_COST};
use super::tree::{BuildNode, Item, Kind, Shape};
use super::{Built, Primitives, SphereItem, sphere_bounds};
use crate::flat::bvh::kind;
use crate::flat::{BLOCK, Bvh, LinearNode, SphereBlock, TriangleBlock, Triangles};
use crate::math::{Aabb, Vec3};

/// Writes the tree down.
pub(super) fn linearize(p: &Primitives, items: &[Item], root: Option<BuildNode>) -> Built {
    let bounds = root.as_ref().map_or(Aabb::EMPTY, |r| r.bounds);
    let mut writer = Writer {
        p,
        items,
        area: split::half_area(&bounds),
        built: Built {
            bvh: Bvh {
                nodes: Vec::new(),
                root: 0,
                root_kind: kind::INNER,
                instance_order: Vec::new(),
                bounds,
                depth: 0,
            },
            triangles: Triangles {
                blocks: Vec::new(),
                place: vec![0; p.triangles.len()],
            },
            sphere_blocks: Vec::new(),
            cost: 0.0,
        },
    };
    if let Some(root) = root {
        let (child, kind) = writer.node(&root, 0);
        writer.built.bvh.root = child;
        writer.built.bvh.root_kind = kind;
    }
    writer.built
}

struct Writer<'a> {
    p: &'a Primitives<'a>,
    items: &'a [Item],
    /// Half the area of the root's box.
    area: f32,
    built: Built,
}

impl Writer<'_> {
    /// Appends a subtree below `depth` inner nodes; returns its `child` and `kind`.
    fn node(&mut self, node: &BuildNode, depth: u32) -> (u32, u32) {
        match &node.shape {
            Shape::Leaf(range) => {
                let items = &self.items[range.clone()];
                let (child, tagged) = self.leaf(items);
                let blocks = split::blocks(items.iter().map(split::units).sum());
                self.spend(node, blocks);
                (child, tagged)
            }
            Shape::Inner(children) => {
                self.spend(node, NODE_COST);
                let at = self.built.bvh.nodes.len();
                self.built.bvh.nodes.push(LinearNode::EMPTY);
                self.built.bvh.depth = self.built.bvh.depth.max(depth + 1);
                for (slot, child) in children.iter().enumerate() {
                    let (index, tagged) = self.node(child, depth + 1);
                    let out = &mut self.built.bvh.nodes[at];
                    for axis in 0..3 {
                        out.planes[axis][slot] = child.bounds.min[axis];
                        out.planes[axis + 3][slot] = child.bounds.max[axis];
                    }
                    out.child[slot] = index;
                    out.kind[slot] = tagged;
                }
                (at as u32, kind::INNER)
            }
        }
    }

    fn spend(&mut self, node: &BuildNode, work: f32) {
        if self.area > 0.0 {
            self.built.cost += work * split::half_area(&node.bounds) / self.area;
        }
    }

    /// Appends the blocks of a leaf.
    fn leaf(&mut self, items: &[Item]) -> (u32, u32) {
        let blocks = items.len().div_ceil(BLOCK) as u32;
        match items[0].kind {
            Kind::Triangle => {
                let first = self.built.triangles.blocks.len() as u32;
                items.chunks(BLOCK).for_each(|c| self.triangle_block(c));
                (first, kind::TRIANGLES | blocks)
            }
            Kind::Sphere => {
                let first = self.built.sphere_blocks.len() as u32;
                for chunk in items.chunks(BLOCK) {
                    let spheres: Vec<_> = chunk
                        .iter()
                        .map(|i| self.p.spheres[i.index as usize])
                        .collect();
                    self.built.sphere_blocks.push(sphere_block(&spheres));
                }
                (first, kind::SPHERES | blocks)
            }
            Kind::Instance => {
                let order = &mut self.built.bvh.instance_order;
                let first = order.len() as u32;
                order.extend(items.iter().map(|i| i.index));
                (first, kind::INSTANCES | items.len() as u32)
            }
        }
    }

    fn triangle_block(&mut self, items: &[Item]) {
        let triangles = &mut self.built.triangles;
        let at = (BLOCK * triangles.blocks.len()) as u32;
        let pad = self.p.triangles[items[0].index as usize][0];
        let mut block = TriangleBlock {
            v: [[[0.0; BLOCK]; 3]; 3],
            prim: [u32::MAX; BLOCK],
        };
        for lane in 0..BLOCK {
            let vertices = match items.get(lane) {
                Some(item) => {
                    block.prim[lane] = item.index;
                    triangles.place[item.index as usize] = at + lane as u32;
                    self.p.triangles[item.index as usize]
                }
                None => [pad; 3],
            };
            for (k, vertex) in vertices.iter().map(Vec3::to_array).enumerate() {
                for axis in 0..3 {
                    block.v[k][axis][lane] = vertex[axis];
                }
            }
        }
        triangles.blocks.push(block);
    }
}

/// A block of up to eight spheres.
pub(super) fn sphere_block(spheres: &[SphereItem]) -> SphereBlock {
    let mut block = SphereBlock {
        bounds: LinearNode::EMPTY.planes,
        center: [[0.0; BLOCK]; 3],
        radius: [0.0; BLOCK],
        prim: [u32::MAX; BLOCK],
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
