//! Two children a node, both boxes in their parent, one cache line: what most trees in the field are (Aila and Laine,
//! *Understanding the Efficiency of Ray Traversal on GPUs*, 2009, for the node). The boxes are tested one after the other in
//! one lane, whatever the machine.
//!
//! Made from the product's tree: each wide node becomes a small tree over its children, pairs of least area first.

use super::{Child, Node, Stack, Tree, child, root};
use crate::flat::bvh::WIDTH;
use crate::flat::{self, Bvh};
use crate::math::Aabb;
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::{Interval, Plane, WIDENED, WalkRay};

/// A node.
#[repr(C, align(64))]
pub(in super::super) struct Binary {
    /// `planes[0..3]`: x, y, z of the minima; `planes[3..6]`: of the maxima; by child.
    planes: [[f32; 2]; 6],
    children: [Child; 2],
}

const _: () = assert!(size_of::<Binary>() == 64);

impl Node for Binary {
    type Boxes<L: Lanes> = f32;

    fn tree(bvh: &Bvh, leaf: impl Fn(u32, u32) -> Child) -> Tree<Binary> {
        let mut maker = Maker {
            bvh,
            leaf,
            nodes: Vec::with_capacity(WIDTH * bvh.nodes.len()),
        };
        let root = root(bvh, &maker.leaf).map(|root| maker.emit(&Pair::Child(root, bvh.bounds)));
        Tree {
            nodes: maker.nodes,
            root,
            slabs: WIDENED,
        }
    }

    #[inline(always)]
    fn enter<L: Lanes>(&self, ray: &WalkRay<f32>, cull: f32, stack: &mut Stack) -> Option<Child> {
        let [a, b] = [self.interval(ray, 0), self.interval(ray, 1)];
        match (a.meets(cull), b.meets(cull)) {
            (true, true) => {
                let [nearer, other] = self.children;
                let (nearer, farther) = match a.near <= b.near {
                    true => (nearer, (other, b.near)),
                    false => (other, (nearer, a.near)),
                };
                stack.entries[stack.top] = farther;
                stack.top += 1;
                Some(nearer)
            }
            (true, false) => Some(self.children[0]),
            (false, true) => Some(self.children[1]),
            (false, false) => None,
        }
    }
}

impl Binary {
    #[inline(always)]
    fn interval(&self, ray: &WalkRay<f32>, child: usize) -> Interval<f32> {
        let near = self.planes(child, ray.planes.near);
        ray.between(near, self.planes(child, ray.planes.far))
    }

    /// A plane for each axis.
    #[inline(always)]
    fn planes(&self, child: usize, of: [Plane; 3]) -> [f32; 3] {
        [
            self.planes[of[0].row()][child],
            self.planes[of[1].row()][child],
            self.planes[of[2].row()][child],
        ]
    }
}

/// A subtree over children of one wide node.
enum Pair {
    Child(Child, Aabb),
    Both(Box<[Pair; 2]>, Aabb),
}

impl Pair {
    fn bounds(&self) -> &Aabb {
        match self {
            Pair::Child(_, bounds) | Pair::Both(_, bounds) => bounds,
        }
    }
}

struct Maker<'a, F> {
    bvh: &'a Bvh,
    leaf: F,
    nodes: Vec<Binary>,
}

impl<F: Fn(u32, u32) -> Child> Maker<'_, F> {
    /// Appends what is below; parents come before their children.
    fn emit(&mut self, pair: &Pair) -> Child {
        match pair {
            Pair::Child(leaf, _) if leaf.slots > 0 => *leaf,
            Pair::Child(inner, _) => {
                let pair = self.paired(inner.first as usize);
                self.emit(&pair)
            }
            Pair::Both(both, _) => {
                let at = self.nodes.len();
                self.nodes.push(Binary {
                    planes: [[0.0; 2]; 6],
                    children: [Child::default(); 2],
                });
                for (slot, pair) in both.iter().enumerate() {
                    let child = self.emit(pair);
                    let node = &mut self.nodes[at];
                    node.children[slot] = child;
                    let bounds = pair.bounds();
                    for axis in 0..3 {
                        node.planes[axis][slot] = bounds.min[axis];
                        node.planes[axis + 3][slot] = bounds.max[axis];
                    }
                }
                Child {
                    first: at as u32,
                    slots: 0,
                }
            }
        }
    }

    /// The children of a wide node as one pair: always those two are joined whose common box is the smallest.
    fn paired(&self, at: usize) -> Pair {
        let node = &self.bvh.nodes[at];
        let used = |slot: &usize| node.child[*slot] != 0;
        let single = |slot: usize| {
            let child = child(flat::Child(node.child[slot]), &self.leaf);
            Pair::Child(child, node.child_box(slot))
        };
        let mut pairs: Vec<Pair> = (0..WIDTH).filter(used).map(single).collect();
        while pairs.len() > 1 {
            let (a, b) = closest(&pairs);
            let [b, a] = [pairs.swap_remove(b), pairs.swap_remove(a)];
            let bounds = a.bounds().union(*b.bounds());
            pairs.push(Pair::Both(Box::new([a, b]), bounds));
        }
        pairs.pop().expect("an inner node has children")
    }
}

/// The places, ascending, of the two whose common box has the least area.
fn closest(pairs: &[Pair]) -> (usize, usize) {
    let mut best = ((0, 1), f32::INFINITY);
    for b in 1..pairs.len() {
        for a in 0..b {
            let area = pairs[a].bounds().union(*pairs[b].bounds()).half_area();
            if area < best.1 {
                best = ((a, b), area);
            }
        }
    }
    best.0
}
