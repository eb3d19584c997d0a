//! The tree while it grows: items partitioned in place, nodes over ranges of them, eight children at a time.

use super::SUBTREE;
use super::item::{Extent, Item, Kinds};
use super::partition::partition;
use super::split::{self, Cut};
use crate::flat::bvh::{MAX_DEPTH, WIDTH};
use crate::flat::{self, BLOCK};
use crate::math::Aabb;
use rayon::prelude::*;
use std::ops::Range;

/// A child of a growing node.
#[derive(Clone, Debug)]
pub(super) struct Child {
    pub(super) bounds: Aabb,
    pub(super) shape: Shape,
}

/// What a child is.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// A range of the items in their final order, all of one kind.
    Leaf(Range<u32>),
    /// A block of triangles that is there already.
    Block(u32),
    /// A node of the same grove.
    Node(u32),
    /// The first node of a grove within this one.
    Grove(u32),
}

/// An inner node: two to eight children.
pub(super) type BuildNode = [Option<Child>; WIDTH];

/// Nodes that one task grew, and those that further tasks grew below them.
#[derive(Clone, Debug, Default)]
pub(super) struct Grove {
    /// Every node follows its parent.
    pub(super) nodes: Vec<BuildNode>,
    pub(super) groves: Vec<Grove>,
}

/// Inner levels that the surface area heuristic may shape. Below, every node splits its largest part at the median
/// until there are eight: a level then divides the number of items by eight, so that 2³² of them fall to single
/// items within 11 levels; a leaf of mixed kinds takes one more, a ready node another: 13 ≤ `MAX_DEPTH − SAH_DEPTH`.
const SAH_DEPTH: usize = 32;
const _: () = assert!(MAX_DEPTH - SAH_DEPTH >= 13);

/// Partitions the items and returns the root over them with what is below it, or nothing over none.
pub(super) fn grow(items: &mut [Item]) -> Option<(Child, Grove)> {
    (!items.is_empty()).then(|| {
        let extent = items
            .par_chunks(super::CHUNK)
            .map(Extent::of)
            .reduce(|| Extent::NOTHING, |a, b| a.union(&b));
        let mut grove = Grove::default();
        let root = Part::decided(items, 0, extent, 0).grow(0, &mut grove);
        (root, grove)
    })
}

/// A root over one leaf per group of triangles, one of all spheres and one of all instances, in the given order.
pub(super) fn over_kinds(items: &[Item], groups: &[Range<u32>]) -> Option<(Child, Grove)> {
    let first_of = |kind: Kinds| items.partition_point(|i| i.kind().order() < kind.order()) as u32;
    let (spheres, instances) = (first_of(Kinds::SPHERE), first_of(Kinds::INSTANCE));
    let row: Vec<Child> = groups
        .iter()
        .cloned()
        .chain([spheres..instances, instances..items.len() as u32])
        .filter(|range| !range.is_empty())
        .flat_map(|range| runs(items, range))
        .collect();
    let mut grove = Grove::default();
    (!row.is_empty()).then(|| (over(&row, &mut grove), grove))
}

/// Leaves of as many items as a run holds, all of them with the box of the whole range.
fn runs(items: &[Item], range: Range<u32>) -> impl Iterator<Item = Child> {
    let row = &items[range.start as usize..range.end as usize];
    let bounds = Extent::of(row).bounds.aabb();
    let lanes = if row[0].kind() == Kinds::INSTANCE {
        1
    } else {
        BLOCK as u32
    };
    let most = lanes * flat::Child::MAX_RUN;
    range.clone().step_by(most as usize).map(move |at| Child {
        bounds,
        shape: Shape::Leaf(at..range.end.min(at + most)),
    })
}

/// The parent of these children, or the only one.
fn over(children: &[Child], grove: &mut Grove) -> Child {
    if let [only] = children {
        return only.clone();
    }
    let at = grove.nodes.len();
    grove.nodes.push(BuildNode::default());
    let mut each = 1;
    while each * WIDTH < children.len() {
        each *= WIDTH;
    }
    let mut bounds = Aabb::EMPTY;
    for (slot, part) in children.chunks(each).enumerate() {
        let child = over(part, grove);
        bounds = bounds.union(child.bounds);
        grove.nodes[at][slot] = Some(child);
    }
    Child {
        bounds,
        shape: Shape::Node(at as u32),
    }
}

/// A part of the items on its way to be a child.
struct Part<'a> {
    items: &'a mut [Item],
    /// Index of its first item among all.
    first: u32,
    extent: Extent,
    /// Where it splits; nothing when it is a leaf.
    cut: Option<Cut>,
}

impl<'a> Part<'a> {
    /// With its cut chosen for a node `depth` inner nodes below the root.
    fn decided(items: &'a mut [Item], first: u32, extent: Extent, depth: usize) -> Part<'a> {
        let cut = if depth < SAH_DEPTH {
            split::choose(items, &extent)
        } else {
            split::median(items, &extent)
        };
        Part {
            items,
            first,
            extent,
            cut,
        }
    }

    /// How much it wants to be split before others: by area, then by count; below [`SAH_DEPTH`] by count alone.
    /// Nothing for a leaf.
    fn urgency(&self, depth: usize) -> Option<(f32, usize)> {
        let area = if depth < SAH_DEPTH {
            self.extent.bounds.half_area()
        } else {
            0.0
        };
        self.cut.is_some().then_some((area, self.items.len()))
    }

    fn split(self, cut: Cut, depth: usize) -> [Part<'a>; 2] {
        let (at, [left, right]) = partition(self.items, &cut);
        let (lefts, rights) = self.items.split_at_mut(at);
        [
            Part::decided(lefts, self.first, left, depth),
            Part::decided(rights, self.first + at as u32, right, depth),
        ]
    }

    /// Grows the subtree of this decided part into the grove; `depth` inner nodes lie above it.
    fn grow(self, depth: usize, grove: &mut Grove) -> Child {
        let part = if depth == SAH_DEPTH {
            Part::decided(self.items, self.first, self.extent, depth)
        } else {
            self
        };
        let bounds = part.extent.bounds.aabb();
        if part.cut.is_none() {
            let range = part.first..part.first + part.items.len() as u32;
            return Child {
                bounds,
                shape: Shape::Leaf(range),
            };
        }
        let large = part.items.len() >= SUBTREE;
        let at = grove.nodes.len();
        grove.nodes.push(BuildNode::default());
        let parts = part.into_children(depth);
        if large {
            let below: Vec<(Child, Grove)> = parts
                .into_par_iter()
                .flatten()
                .map(|part| {
                    let mut below = Grove::default();
                    (part.grow(depth + 1, &mut below), below)
                })
                .collect();
            for (slot, (mut child, below)) in below.into_iter().enumerate() {
                if let Shape::Node(_) = child.shape {
                    child.shape = Shape::Grove(grove.groves.len() as u32);
                    grove.groves.push(below);
                }
                grove.nodes[at][slot] = Some(child);
            }
        } else {
            for (slot, part) in parts.into_iter().flatten().enumerate() {
                let child = part.grow(depth + 1, grove);
                grove.nodes[at][slot] = Some(child);
            }
        }
        Child {
            bounds,
            shape: Shape::Node(at as u32),
        }
    }

    /// Splits the most urgent part again and again, until there are eight or all are leaves.
    fn into_children(self, depth: usize) -> [Option<Part<'a>>; WIDTH] {
        let mut parts = [const { None }; WIDTH];
        parts[0] = Some(self);
        for len in 1..WIDTH {
            let urgency = |i: usize| Some((i, parts[i].as_ref()?.urgency(depth)?));
            let most = (0..len)
                .filter_map(urgency)
                .max_by(|(_, a), (_, b)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            if let Some((i, _)) = most
                && let Some(mut part) = parts[i].take()
                && let Some(cut) = part.cut.take()
            {
                let [left, right] = part.split(cut, depth);
                parts[i] = Some(left);
                parts[len] = Some(right);
            } else {
                break;
            }
        }
        parts
    }
}
