//! A binary tree of boxes, split at the median: nothing to tune, nothing shared with what it judges.

use crate::math::{Aabb, DVec3};

/// Items of a leaf.
const LEAF: usize = 4;

/// Boxes grow by this share of the largest coordinate involved: eight times what the f32 kernels may displace a vertex by,
/// so that no primitive is missed that they may hit.
const MARGIN: f64 = 1.0 / (1u64 << 18) as f64;

/// A ray in f64.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) origin: DVec3,
    pub(super) dir: DVec3,
}

/// A line, ready to be tested against boxes.
struct Slabs {
    origin: DVec3,
    inv_dir: DVec3,
    /// What boxes grow by.
    margin: DVec3,
}

/// Nodes depth first: the left child of an inner node follows it.
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// Items in leaf order.
    order: Vec<u32>,
}

struct Node {
    bounds: Aabb,
    /// Inner node: the right child. Leaf: its first place in `order`.
    at: u32,
    /// Items of a leaf; 0 for an inner node.
    len: u32,
}

impl Tree {
    /// Over boxes; an item is the index of its box. Empty boxes are left out.
    pub(super) fn new(boxes: &[Aabb]) -> Tree {
        let items = 0..boxes.len() as u32;
        let mut order: Vec<u32> = items.filter(|&i| !boxes[i as usize].is_empty()).collect();
        let mut nodes = Vec::new();
        if !order.is_empty() {
            grow(boxes, &mut order, 0, &mut nodes);
        }
        Tree { nodes, order }
    }

    /// Visits the items whose boxes the line meets between 0 and a limit, which `visit` may lower; near boxes first.
    pub(super) fn visit(&self, line: &Line, mut limit: f64, mut visit: impl FnMut(u32) -> f64) {
        if let Some(root) = self.nodes.first() {
            let corners = [root.bounds.min, root.bounds.max].map(|corner| corner.as_dvec3());
            let far = |p: DVec3| p.abs().max_element();
            let size = far(corners[0]).max(far(corners[1])).max(far(line.origin));
            let slabs = Slabs {
                origin: line.origin,
                inv_dir: line.dir.recip(),
                margin: DVec3::splat(MARGIN * size),
            };
            self.descend(0, &slabs, &mut limit, &mut visit);
        }
    }

    fn descend(
        &self,
        at: usize,
        slabs: &Slabs,
        limit: &mut f64,
        visit: &mut impl FnMut(u32) -> f64,
    ) {
        let node = &self.nodes[at];
        if node.len > 0 {
            let first = node.at as usize;
            for &item in &self.order[first..first + node.len as usize] {
                *limit = limit.min(visit(item));
            }
            return;
        }
        let mut children =
            [at + 1, node.at as usize].map(|child| (slabs.entry(&self.nodes[child].bounds), child));
        if children[1].0 < children[0].0 {
            children.swap(0, 1);
        }
        for (near, child) in children {
            if near <= *limit {
                self.descend(child, slabs, limit, visit);
            }
        }
    }
}

/// Appends the subtree over `order`, which begins at `first` of the whole.
fn grow(boxes: &[Aabb], order: &mut [u32], first: usize, nodes: &mut Vec<Node>) {
    let of = |&i: &u32| boxes[i as usize];
    let center = |i: &u32| of(i).min.as_dvec3() + of(i).max.as_dvec3();
    let bounds = order.iter().map(of).fold(Aabb::EMPTY, Aabb::union);
    let at = nodes.len();
    nodes.push(Node {
        bounds,
        at: first as u32,
        len: order.len() as u32,
    });
    if order.len() <= LEAF {
        return;
    }
    let (low, high) = order
        .iter()
        .map(center)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), c| {
            (low.min(c), high.max(c))
        });
    let axis = (high - low).max_position();
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |a, b| center(a)[axis].total_cmp(&center(b)[axis]));
    let (left, right) = order.split_at_mut(middle);
    grow(boxes, left, first, nodes);
    (nodes[at].at, nodes[at].len) = (nodes.len() as u32, 0);
    grow(boxes, right, first + middle, nodes);
}

impl Slabs {
    /// Where the line enters the widened box; infinite if it misses it or the box lies behind.
    fn entry(&self, bounds: &Aabb) -> f64 {
        let a = (bounds.min.as_dvec3() - self.margin - self.origin) * self.inv_dir;
        let b = (bounds.max.as_dvec3() + self.margin - self.origin) * self.inv_dir;
        // f64's minimum and maximum drop NaN, 0 · ∞: a line in the plane of a face counts as inside.
        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            near = near.max(a[axis].min(b[axis]));
            far = far.min(a[axis].max(b[axis]));
        }
        if near <= far { near } else { f64::INFINITY }
    }
}
