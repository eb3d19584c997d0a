//! Counting what a walk does, outside the timing.

use std::iter::Sum;

/// What was done for some rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Inner nodes whose children's boxes were tested.
    pub nodes: u64,
    /// Triangles or spheres that were tested.
    pub primitives: u64,
    /// Lanes that were tested, eight at a time: those primitives and the padding of leaves.
    pub lanes: u64,
    /// The same, four at a time.
    pub fours: u64,
}

impl Sum for Work {
    fn sum<I: Iterator<Item = Work>>(all: I) -> Work {
        all.fold(Work::default(), |sum, w| Work {
            nodes: sum.nodes + w.nodes,
            primitives: sum.primitives + w.primitives,
            lanes: sum.lanes + w.lanes,
            fours: sum.fours + w.fours,
        })
    }
}

/// Who hears of the steps of a walk.
pub(super) trait Watch {
    /// A node is entered.
    fn node(&mut self);
    /// A leaf is tested.
    fn leaf(&mut self, primitives: impl FnOnce() -> u64, lanes: u32);
}

/// Nobody: what is timed.
impl Watch for () {
    #[inline(always)]
    fn node(&mut self) {}
    #[inline(always)]
    fn leaf(&mut self, _: impl FnOnce() -> u64, _: u32) {}
}

impl Watch for Work {
    #[inline(always)]
    fn node(&mut self) {
        self.nodes += 1;
    }
    #[inline(always)]
    fn leaf(&mut self, primitives: impl FnOnce() -> u64, lanes: u32) {
        let primitives = primitives();
        self.primitives += primitives;
        self.lanes += u64::from(lanes);
        self.fours += primitives.next_multiple_of(4);
    }
}
