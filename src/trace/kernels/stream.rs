//! Many rays in flight through one tree, in step, where the tree is too large for caches ([`pays`]).
//!
//! A ray by itself waits: for a node that is not in the cache, and for the branch that is taken once the node's boxes are
//! tested. So [`SLOTS`] rays go together. Each round takes every ray one step on, a stage at a time: the boxes of all rays
//! at inner nodes, then the order of their children and the next node of each, then the triangles of all rays at leaves.
//! What a stage finds, the next one reads, hence no ray's arithmetic waits for its own, and the only branches that depend
//! on a ray are those around a hit. The next node is asked for (prefetched) a round before it is read. Rays in flight are
//! the interleaving of Chen, Ailamaki, Gibbons and Mowry (*Improving hash join performance through prefetching*, 2004),
//! stages those of wavefront path tracing (Laine, Karras and Aila 2013), in a cache's first level.
//!
//! Tried in a probe with leaves of four (Zen 3, million rays a second, camera | random rays, mesh of 3,686 triangles; here
//! 8.5 | 7.1): each ray to its end before the next, branching on the number of children met, 9.2 | 5.3; in step, but branching so,
//! 8.3 | 6.1; queues from which stages take batches of constant size, 7.7 | 5.6; box tests by fused operations with slack
//! for their rounding, 7.9 | 6.5; the edge functions in a stage before that of the hits, here, 12 % more instructions.
//!
//! Deliberately absent: the choice of the rays, which is [`group`](super::group)'s.

use super::instances::InstanceLeaves;
use super::prepared::{AHEAD, Prepared};
use super::ray::{Setup, WalkRay};
use super::stack::{DONE, FETCHED, Stack};
use super::walk::{self, Best, Sink, Tree};
use crate::flat::bvh::{WIDTH, kind};
use crate::flat::{Child, LinearNode, TriangleBlock};
use crate::math::lanes::Lanes;
use crate::trace::Rays;

/// Rays in flight. 16 leave a memory's latency unhidden, 64 leave the first-level cache.
pub(super) const SLOTS: usize = 32;

/// Bytes of nodes and blocks from which on rays wait for memory, so that going together pays: a quarter of a third-level
/// cache. Zen 3, together over each by itself, camera rays to random ones: 0.74 to 1.09 at 4 MB, 0.71 to 1.67 at 11 MB (a
/// soup of thin triangles), 0.91 to 1.74 at 76 MB.
const COLD: usize = 8 << 20;

/// A ray in flight.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Slot<L> {
    ray: WalkRay<L>,
    /// Where the ray enters the boxes of its node; negative where it does not.
    near: [f32; WIDTH],
    /// The boxes that it enters, in bits.
    met: u32,
    /// Where it is.
    child: Child,
    /// Length of its stack.
    top: usize,
    best: Best,
    /// Index in the batch.
    ray_index: usize,
}

/// Slots that wait for a stage.
#[derive(Clone, Copy)]
struct List {
    slots: [u8; 2 * SLOTS],
    len: usize,
}

impl List {
    const EMPTY: List = List {
        slots: [0; 2 * SLOTS],
        len: 0,
    };

    #[inline(always)]
    fn push_if(&mut self, slot: u8, yes: bool) {
        self.slots[self.len % (2 * SLOTS)] = slot;
        self.len += usize::from(yes);
    }
}

/// Slots by what they are at: inner nodes, triangles, and the rest: spheres, instances, and done.
struct Lists {
    slots: [[u8; 2 * SLOTS]; 3],
    len: [usize; 3],
}

const INNER: usize = 0;
const TRIANGLES: usize = 1;
const REST: usize = 2;

impl Lists {
    const EMPTY: Lists = Lists {
        slots: [[0; 2 * SLOTS]; 3],
        len: [0; 3],
    };

    /// Appends a slot to its list without a branch: to the other two it is written beyond their ends.
    #[inline(always)]
    fn push(&mut self, len: &mut [usize; 3], slot: u8, child: Child) {
        let kind = child.kind();
        let is = [
            kind == kind::INNER,
            kind == kind::TRIANGLES,
            kind > kind::TRIANGLES,
        ];
        for list in 0..3 {
            self.slots[list][len[list] % (2 * SLOTS)] = slot;
            len[list] += usize::from(is[list]);
        }
    }

    /// Empties a list.
    #[inline(always)]
    fn take(&mut self, list: usize) -> List {
        List {
            slots: self.slots[list],
            len: std::mem::take(&mut self.len[list]),
        }
    }
}

/// Room for what [`walk_all`] keeps of its rays, from batch to batch.
pub(super) struct Scratch {
    pub(super) stacks: Box<[Stack; SLOTS]>,
    pub(super) prepared: Box<Prepared>,
}

impl Default for Scratch {
    fn default() -> Scratch {
        Scratch {
            stacks: Box::new([Stack::BOTTOM; SLOTS]),
            prepared: Box::default(),
        }
    }
}

/// Rays in flight through one tree.
struct Flight<'a, L> {
    tree: &'a Tree<'a>,
    nodes: &'a [LinearNode],
    blocks: &'a [TriangleBlock],
    slots: [Slot<L>; SLOTS],
    lists: Lists,
    stacks: &'a mut [Stack; SLOTS],
}

/// Whether rays through this tree should go together.
#[inline(always)]
pub(super) fn pays<L: Lanes>(tree: &Tree) -> bool {
    let bytes =
        size_of_val(&tree.bvh.nodes[..]) + size_of_val(tree.triangles) + size_of_val(tree.spheres);
    L::TOGETHER && bytes > COLD
}

/// Walks rays of a batch through the tree, together. With `ANY`, a ray is done at its first hit below its limit, of which
/// `best` then tells the primitive.
#[inline(always)]
pub(super) fn walk_all<
    L: Lanes,
    I: InstanceLeaves<L>,
    R: Sink,
    const T: bool,
    const S: bool,
    const ANY: bool,
>(
    tree: &Tree,
    rays: &Rays,
    which: &[u32],
    sink: &mut R,
    instances: &mut I,
    scratch: &mut Scratch,
) {
    let Scratch { stacks, prepared } = scratch;
    let mut flight = Flight::<L>::new(tree, stacks);
    let mut free = List::EMPTY;
    for slot in 0..SLOTS {
        free.push_if(slot as u8, true);
    }
    let mut next = 0;
    loop {
        for &slot in &free.slots[..free.len] {
            while next < which.len() {
                let (k, i) = (next, which[next] as usize);
                next += 1;
                if k.is_multiple_of(AHEAD) {
                    prepared.fill::<L>(rays, &which[k..]);
                }
                if let Some(best) = sink.best(i) {
                    flight.start(slot, i, prepared.ray(k), best);
                    break;
                }
            }
        }
        flight.inner_nodes();
        if T {
            flight.triangle_blocks::<ANY>();
        }
        free = flight.rest::<I, R, S, ANY>(sink, instances);
        if free.len == 0 && flight.lists.len == [0; 3] {
            return;
        }
    }
}

impl<'a, L: Lanes> Flight<'a, L> {
    #[inline(always)]
    fn new(tree: &'a Tree<'a>, stacks: &'a mut [Stack; SLOTS]) -> Flight<'a, L> {
        let no_setup = Setup {
            inv: [[0.0; 3]; 2],
            shear: [0.0; 3],
            kz: 0.0,
        };
        let idle = Slot {
            ray: WalkRay::prepared([0.0; 3], [0.0; 3], &no_setup),
            near: [0.0; WIDTH],
            met: 0,
            child: DONE,
            top: 0,
            best: Best::below(0.0),
            ray_index: 0,
        };
        Flight {
            tree,
            nodes: &tree.bvh.nodes,
            blocks: tree.triangles,
            slots: [idle; SLOTS],
            lists: Lists::EMPTY,
            stacks,
        }
    }

    #[inline(always)]
    fn start(&mut self, slot: u8, index: usize, ray: WalkRay<L>, best: Best) {
        let s = &mut self.slots[slot as usize % SLOTS];
        s.ray = ray;
        s.best = best;
        s.ray_index = index;
        s.child = self.tree.bvh.root;
        s.top = 1;
        let mut len = self.lists.len;
        self.lists.push(&mut len, slot, s.child);
        self.lists.len = len;
    }

    /// One step of every ray at an inner node.
    #[inline(always)]
    fn inner_nodes(&mut self) {
        let list = self.lists.take(INNER);
        let list = &list.slots[..list.len];
        let nodes = self.nodes;
        for &slot in list {
            let s = &mut self.slots[slot as usize % SLOTS];
            s.met = walk::boxes(&nodes[s.child.index()], &s.ray, s.best.cull(), &mut s.near);
        }
        let mut len = self.lists.len;
        for &slot in list {
            let s = &mut self.slots[slot as usize % SLOTS];
            let node = &nodes[s.child.index()];
            let stack = &mut self.stacks[slot as usize % SLOTS];
            if let Some(children) = stack.children[s.top..].first_chunk_mut()
                && let Some(entries) = stack.entries[s.top..].first_chunk_mut()
            {
                s.top += L::sort_falling(&s.near, s.met, &node.child, children, entries);
            }
            s.child = stack.pop(&mut s.top, s.best.cull());
            self.go(&mut len, slot);
        }
        self.lists.len = len;
    }

    /// Sends a ray to its child.
    #[inline(always)]
    fn go(&mut self, len: &mut [usize; 3], slot: u8) {
        let child = self.slots[slot as usize % SLOTS].child;
        L::prefetch(self.tree.address(child), FETCHED);
        self.lists.push(len, slot, child);
    }

    /// One block of every ray at a leaf of triangles.
    #[inline(always)]
    fn triangle_blocks<const ANY: bool>(&mut self) {
        let list = self.lists.take(TRIANGLES);
        let list = &list.slots[..list.len];
        for &slot in list {
            let s = &mut self.slots[slot as usize % SLOTS];
            let block = &self.blocks[s.child.index()];
            if walk::triangle_block::<L, ANY>(self.tree, block, &s.ray, &mut s.best) {
                s.top = 1;
                s.child = s.child.alone();
            }
        }
        let mut len = self.lists.len;
        for &slot in list {
            let s = &mut self.slots[slot as usize % SLOTS];
            let stack = &self.stacks[slot as usize % SLOTS];
            s.child = match s.child.rest() {
                Some(rest) => rest,
                None => stack.pop(&mut s.top, s.best.cull()),
            };
            self.go(&mut len, slot);
        }
        self.lists.len = len;
    }

    /// The rays at spheres and instances, each by itself; returns the slots of those that are done.
    #[inline(always)]
    fn rest<I: InstanceLeaves<L>, R: Sink, const S: bool, const ANY: bool>(
        &mut self,
        sink: &mut R,
        instances: &mut I,
    ) -> List {
        let list = self.lists.take(REST);
        let mut free = List::EMPTY;
        let mut len = self.lists.len;
        for &slot in &list.slots[..list.len] {
            let s = &mut self.slots[slot as usize % SLOTS];
            if s.child == DONE {
                sink.done(s.ray_index, &s.best);
                free.push_if(slot, true);
                continue;
            }
            let child = s.child;
            if walk::leaf::<L, I, false, S, ANY>(self.tree, child, &s.ray, instances, &mut s.best) {
                s.top = 1;
            }
            s.child = self.stacks[slot as usize % SLOTS].pop(&mut s.top, s.best.cull());
            self.go(&mut len, slot);
        }
        self.lists.len = len;
        free
    }
}
