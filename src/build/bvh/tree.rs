//! The tree while it grows: items partitioned in place, nodes over ranges of them, eight children at a time.

use super::split;
use crate::flat::bvh::{MAX_DEPTH, WIDTH};
use crate::math::Aabb;
use rayon::prelude::*;
use std::ops::Range;

/// What an item is; the order is that of the children in which a mixed leaf falls apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    /// A triangle.
    Triangle,
    /// A sphere.
    Sphere,
    /// An instance.
    Instance,
}

/// A primitive as the builder sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    /// Its box; empty if it can never be hit.
    pub(super) bounds: Aabb,
    /// What it is.
    pub(super) kind: Kind,
    /// Its index among those of its kind.
    pub(super) index: u32,
}

impl Item {
    pub(super) fn new(bounds: Aabb, kind: Kind, index: u32) -> Item {
        Item {
            bounds,
            kind,
            index,
        }
    }
}

/// A node with its box, over a range of the items in their final order.
#[derive(Clone, Debug)]
pub(super) struct BuildNode {
    pub(super) bounds: Aabb,
    pub(super) shape: Shape,
}

/// What a node is.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// Items of one kind.
    Leaf(Range<usize>),
    /// Two to eight children.
    Inner(Vec<BuildNode>),
}

/// Inner levels that the surface area heuristic may shape. Below, every node splits its largest part at the median
/// until there are eight: a level then divides the number of items by eight, so that 2³² of them fall to single
/// items within 11 levels, and a leaf of mixed kinds takes one more: 12 ≤ `MAX_DEPTH − SAH_DEPTH`.
const SAH_DEPTH: usize = 32;
const _: () = assert!(MAX_DEPTH - SAH_DEPTH >= 12);

/// Subtrees of at least so many items grow in parallel: some milliseconds of work.
const PARALLEL: usize = 8192;

/// Partitions the items and returns the root over them, or nothing over none.
pub(super) fn grow(items: &mut [Item]) -> Option<BuildNode> {
    (!items.is_empty()).then(|| {
        let root = Part::new(items, 0).decide(0);
        root.grow(0)
    })
}

/// A root over one leaf per group of triangles, one of all spheres and one of all instances, in the given order.
pub(super) fn over_kinds(items: &[Item], groups: &[Range<u32>]) -> Option<BuildNode> {
    let triangles = items.partition_point(|i| i.kind < Kind::Sphere);
    let spheres = items.partition_point(|i| i.kind < Kind::Instance);
    let mut row: Vec<BuildNode> = groups
        .iter()
        .map(|g| g.start as usize..g.end as usize)
        .chain([triangles..spheres, spheres..items.len()])
        .filter(|range| !range.is_empty())
        .map(|range| BuildNode {
            bounds: split::bounds_of(&items[range.clone()]),
            shape: Shape::Leaf(range),
        })
        .collect();
    while row.len() > 1 {
        row = row.chunks(WIDTH).map(over).collect();
    }
    row.pop()
}

/// The parent of these nodes.
fn over(children: &[BuildNode]) -> BuildNode {
    if let [only] = children {
        return only.clone();
    }
    let boxes = children.iter().map(|c| c.bounds);
    BuildNode {
        bounds: boxes.fold(Aabb::EMPTY, Aabb::union),
        shape: Shape::Inner(children.to_vec()),
    }
}

/// A part of the items on its way to be a child.
struct Part<'a> {
    items: &'a mut [Item],
    /// Index of its first item among all.
    first: usize,
    bounds: Aabb,
    /// Where it splits; nothing when it is a leaf.
    cut: Option<split::Cut>,
}

impl<'a> Part<'a> {
    fn new(items: &'a mut [Item], first: usize) -> Part<'a> {
        let bounds = split::bounds_of(items);
        Part {
            items,
            first,
            bounds,
            cut: None,
        }
    }

    /// Chooses its cut for a node `depth` inner nodes below the root.
    fn decide(mut self, depth: usize) -> Part<'a> {
        self.cut = if depth < SAH_DEPTH {
            split::choose(self.items, &self.bounds)
        } else {
            split::median(self.items)
        };
        self
    }

    /// How much it wants to be split before others: by area, or below [`SAH_DEPTH`] by count.
    fn urgency(&self, depth: usize) -> f32 {
        if self.cut.is_none() {
            f32::NEG_INFINITY
        } else if depth < SAH_DEPTH {
            split::half_area(&self.bounds)
        } else {
            self.items.len() as f32
        }
    }

    fn split(self, cut: split::Cut, depth: usize) -> [Part<'a>; 2] {
        let at = split::partition(self.items, &cut);
        let (left, right) = self.items.split_at_mut(at);
        [
            Part::new(left, self.first).decide(depth),
            Part::new(right, self.first + at).decide(depth),
        ]
    }

    /// Grows the subtree of this decided part; `depth` inner nodes lie above it.
    fn grow(self, depth: usize) -> BuildNode {
        let part = if depth == SAH_DEPTH {
            self.decide(depth)
        } else {
            self
        };
        let bounds = part.bounds;
        if part.cut.is_none() {
            return BuildNode {
                bounds,
                shape: Shape::Leaf(part.first..part.first + part.items.len()),
            };
        }
        let large = part.items.len() >= PARALLEL;
        let parts = part.into_children(depth);
        let grow = |p: Part| p.grow(depth + 1);
        let children = if large {
            parts.into_par_iter().map(grow).collect()
        } else {
            parts.into_iter().map(grow).collect()
        };
        BuildNode {
            bounds,
            shape: Shape::Inner(children),
        }
    }

    /// Splits the most urgent part again and again, until there are eight or all are leaves.
    fn into_children(self, depth: usize) -> Vec<Part<'a>> {
        let mut parts = vec![self];
        while parts.len() < WIDTH {
            let urgency = |i: &usize| parts[*i].urgency(depth);
            let most = (0..parts.len()).max_by(|a, b| urgency(a).total_cmp(&urgency(b)));
            let Some((i, cut)) = most.and_then(|i| parts[i].cut.take().map(|cut| (i, cut))) else {
                break;
            };
            let [left, right] = parts.remove(i).split(cut, depth);
            parts.insert(i, right);
            parts.insert(i, left);
        }
        parts
    }
}
