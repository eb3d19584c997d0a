//! In which order samples are added up, and what error bars are made of.
//!
//! Eight samples in a row, the first of which is a multiple of eight, are a block; within it they are added in the order of
//! their index. Two neighbouring runs of 2ᵏ samples that together are an aligned run of 2ᵏ⁺¹ are added as soon as both are
//! there: blocks add up as a binary tree over their indices. So whoever traced a run, and when, has the same bits for it,
//! and a render can be taken up again, or put together from the samples of many machines. What is in no complete run
//! of twice the length is a node that waits: of n samples there are at most log₂ n.
//!
//! Samples of one pixel are not independent: any 2ᵏ of them that are aligned are spread evenly, and any 2ᵏ⁺¹ more evenly
//! still. So their scatter says too much of the error of their mean. But the half-difference of two aligned runs of 2ᵏ samples
//! has the variance V(2ᵏ) − V(2ᵏ⁺¹), where V(n) is the variance of a mean of n samples: by how much a doubling helps. These
//! squared half-differences, by level k, are taken where two nodes become one, and add up by the same tree.
//! [`super::Film::error`] makes the error of them.
//!
//! Deliberately absent: what single samples do, which would cost time for each of them; but for those of the first block, where
//! shorter runs are all that there is.

use super::Sums;
use std::ops::Range;

const BLOCK: u32 = Blocks::LENGTH;

/// Level of a block: 2³ samples.
const BLOCK_LEVEL: u32 = BLOCK.ilog2();

/// Levels whose differences are kept: those of the longest runs that are complete. The error is that of the next level, so
/// that shorter runs say little of it.
const LEVELS: u32 = 5;

/// The complete runs of samples of a window's pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Blocks {
    /// In the order of their samples; no two of them are halves of one run.
    pub(super) nodes: Vec<Node>,
    /// Squared half-differences within the first block, until it is complete.
    pub(super) early: Vec<Level>,
    /// The sums of the first block at the last power of two of its samples, until it is complete.
    pub(super) middle: Vec<[f32; 3]>,
    /// Whether differences mean nothing: samples are independent, and say their error by themselves.
    pub(super) independent: bool,
}

/// Sums over the samples from `first` on, 2^`level` of them and aligned.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Node {
    pub(super) first: u32,
    /// 0 for a block that will never be complete, which is nobody's half.
    pub(super) level: u32,
    pub(super) sums: Sums,
    /// Of every kept level below its own.
    pub(super) squares: Vec<Level>,
}

/// Sums over pairs of runs of 2ᵏ samples of the squared half-difference of their means.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Level {
    pub(super) k: u32,
    pub(super) squares: Vec<[f32; 3]>,
}

/// What all samples add up to.
#[derive(Clone, Debug, Default)]
pub(super) struct Whole {
    pub(super) sums: Sums,
    /// By level, the mean over its pairs of runs of the squared half-difference of their means, of each pixel and
    /// channel; empty where the level was not kept or no pair is complete.
    pub(super) gains: Vec<Vec<[f32; 3]>>,
}

impl Blocks {
    /// Samples of a block.
    pub const LENGTH: u32 = 8;

    /// No samples; `independent` ones are not compared.
    #[must_use]
    pub fn new(independent: bool) -> Blocks {
        Blocks {
            independent,
            ..Blocks::default()
        }
    }

    /// The number of samples at which [`super::Patch::advance`] must be called next, after `done`: where a block ends, and in the first
    /// one at powers of two.
    #[must_use]
    pub fn next(done: u32) -> u32 {
        match done {
            0..BLOCK => (done + 1).next_power_of_two(),
            _ => (done / BLOCK + 1).saturating_mul(BLOCK),
        }
    }

    /// The nearest ends of blocks to `share` of `spp` samples: where those of one machine may end and another's begin.
    #[must_use]
    pub fn share(spp: u32, (part, parts): (u32, u32)) -> u32 {
        let blocks = u64::from(spp.div_ceil(BLOCK));
        let blocks = blocks * u64::from(part) / u64::from(parts);
        spp.min(blocks as u32 * BLOCK)
    }

    /// Whether a block ends, or `spp` do, after so many samples.
    #[must_use]
    pub fn may_end(samples: u32, spp: u32) -> bool {
        samples.is_multiple_of(BLOCK) || samples == spp
    }

    /// Levels that are kept when so many samples are complete.
    pub(super) fn levels(samples: u32) -> Range<u32> {
        lowest(samples)..samples.ilog2()
    }

    /// Pairs of runs of 2ᵏ samples that were compared when so many samples are complete, if the level is kept.
    #[must_use]
    pub fn pairs(samples: u32, k: u32) -> u32 {
        match 1 << k {
            length if length < BLOCK => (samples >= 2 * length).into(),
            length => samples / (2 * length),
        }
    }

    /// Looks at `open`, the sums of the block that is not complete yet, when there are `samples` samples, which is one of those
    /// that [`Blocks::next`] gives. If the block ends there, they are taken, and zeros left, in the memory of `spare`, which is
    /// then that of what was added up.
    pub(super) fn take(&mut self, samples: u32, open: &mut Sums, spare: &mut Sums) {
        if samples <= BLOCK && !self.independent {
            self.look_early(samples, &open.rgb);
        }
        if samples.is_multiple_of(BLOCK) {
            self.middle = Vec::new();
            let squares = std::mem::take(&mut self.early);
            let node = Node {
                first: samples - BLOCK,
                level: BLOCK_LEVEL,
                sums: open.take(spare),
                squares,
            };
            self.push(node, spare);
        }
        let lowest = lowest(samples);
        let kept = self.nodes.iter_mut().map(|node| &mut node.squares);
        for levels in kept.chain([&mut self.early]) {
            levels.retain(|level| level.k >= lowest);
        }
    }

    /// Puts what will never be a whole block among the nodes: its other samples are not there.
    pub(super) fn leave(&mut self, first: u32, open: Sums) {
        self.nodes.push(Node {
            first: first / BLOCK * BLOCK,
            level: 0,
            sums: open,
            squares: std::mem::take(&mut self.early),
        });
        self.middle = Vec::new();
    }

    /// Adds runs of later samples.
    pub(super) fn append(&mut self, next: Blocks) {
        for node in next.nodes {
            self.push(node, &mut Sums::default());
        }
        self.early = next.early;
        self.middle = next.middle;
    }

    /// Adds a node behind all others, and makes one of two as long as there are halves. Memory that is over goes to `spare`.
    fn push(&mut self, mut node: Node, spare: &mut Sums) {
        while let Some(left) = self.nodes.pop_if(|left| left.is_left_of(&node)) {
            (node, *spare) = left.join(node, self.independent);
        }
        self.nodes.push(node);
    }

    /// Adds up what waits, from the last to the first, beginning with the block that is not complete.
    pub(super) fn finish(mut self, samples: u32, open: Sums) -> Whole {
        let levels = (lowest(samples.max(1))..u32::BITS).map_while(|k| {
            let longer = self.nodes.iter().any(|node| node.level > k);
            (longer || self.early.iter().any(|level| level.k >= k)).then_some(k)
        });
        let levels: Vec<(u32, f32)> = levels.map(|k| (k, self.pairs_of(k))).collect();
        let mut last = Node {
            sums: open,
            squares: std::mem::take(&mut self.early),
            ..Node::default()
        };
        for mut node in self.nodes.into_iter().rev() {
            // Without an open block there is nothing yet.
            if !last.sums.rgb.is_empty() {
                node.sums.add(&last.sums);
            }
            add_levels(&mut node.squares, last.squares);
            last = node;
        }
        let mut gains = Vec::new();
        for (k, pairs) in levels {
            let at = last.squares.iter().position(|level| level.k == k);
            let mut squares = at.map_or(Vec::new(), |at| last.squares.swap_remove(at).squares);
            for square in &mut squares {
                *square = square.map(|s| s / pairs);
            }
            gains.resize(k as usize, Vec::new());
            gains.push(squares);
        }
        Whole {
            sums: last.sums,
            gains,
        }
    }

    /// Pairs of runs of 2ᵏ samples that were compared.
    fn pairs_of(&self, k: u32) -> f32 {
        if k < BLOCK_LEVEL {
            return 1.0;
        }
        let longer = self.nodes.iter().filter(|node| node.level > k);
        longer
            .map(|node| (1u64 << (node.level - 1 - k)) as f32)
            .sum()
    }

    /// Within the first block, at powers of two: compares its halves.
    fn look_early(&mut self, samples: u32, sums: &[[f64; 3]]) {
        let now: Vec<[f32; 3]> = sums.iter().map(|sum| sum.map(|s| s as f32)).collect();
        if samples > 1 {
            let scale = 1.0 / samples as f32;
            let squares = now.iter().zip(&self.middle).map(|(sum, middle)| {
                std::array::from_fn(|c| {
                    let half = (middle[c] - (sum[c] - middle[c])) * scale;
                    half * half
                })
            });
            self.early.push(Level {
                k: samples.ilog2() - 1,
                squares: squares.collect(),
            });
        }
        self.middle = now;
    }
}

impl Node {
    /// Whether both are halves of one run.
    fn is_left_of(&self, right: &Node) -> bool {
        let length = 1u64 << self.level;
        self.level == right.level
            && u64::from(self.first).is_multiple_of(2 * length)
            && u64::from(self.first) + length == u64::from(right.first)
    }

    /// The run of both, and the sums that are no longer needed.
    fn join(mut self, right: Node, independent: bool) -> (Node, Sums) {
        if !independent {
            // 2ᵏ⁺¹ = twice the samples of a half: of the difference of means, a half.
            let scale = 0.5 / (1u64 << self.level) as f64;
            let pairs = self.sums.rgb.iter().zip(&right.sums.rgb);
            let squares = pairs.map(|(left, right)| {
                std::array::from_fn(|c| {
                    let half = ((left[c] - right[c]) * scale) as f32;
                    half * half
                })
            });
            let own = Level {
                k: self.level,
                squares: squares.collect(),
            };
            add_levels(&mut self.squares, right.squares);
            self.squares.push(own);
        }
        self.sums.add(&right.sums);
        self.level += 1;
        (self, right.sums)
    }
}

/// The lowest level that is kept when there are so many samples.
fn lowest(samples: u32) -> u32 {
    samples.ilog2().saturating_sub(LEVELS)
}

fn add_levels(into: &mut Vec<Level>, from: Vec<Level>) {
    for level in from {
        match into.iter_mut().find(|there| there.k == level.k) {
            Some(there) => {
                let sums = there.squares.as_flattened_mut().iter_mut();
                for (sum, square) in sums.zip(level.squares.as_flattened()) {
                    *sum += square;
                }
            }
            None => into.push(level),
        }
    }
}

#[cfg(test)]
mod tests;
