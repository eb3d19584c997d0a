//! The arms of the traversal benchmark: rivals of the product's kernels, and those kernels themselves.
//!
//! An arm is a tree with its primitives in some layout; the instruction set is chosen anew for every batch, so that the two
//! vary apart. All give the same hits to the bit, since all keep the rules of [`crate::trace::kernels`].

mod cheap;
mod entries;
mod layouts;
mod luxel;
mod nodes;
mod rival;
mod walk;
mod work;

pub use cheap::{Rule, twins};
pub use luxel::Luxel;
pub use work::Work;

use crate::build::Accel;
use crate::flat::FlatScene;
use crate::trace::isa::Level;
use crate::trace::{Hits, Isa, Rays};
use nodes::{Binary, Quantised, Wide};
use std::fmt;
use std::sync::Arc;

/// Something that traces rays.
pub trait Arm {
    /// As [`crate::trace::closest_hit`]; `hits.instance` and `hits.err` may stay as they were.
    fn closest_hit(&self, isa: Isa, rays: &Rays, hits: &mut Hits);
    /// As [`crate::trace::occluded`].
    fn occluded(&self, isa: Isa, rays: &Rays, out: &mut Vec<bool>);
    /// Bytes that traversal may touch: nodes and primitives.
    fn bytes(&self) -> usize;
}

/// The arm of a scene that was built with [`Tree::accel`] and holds triangles or spheres, not both; none where there is
/// none: the product walks one format of nodes, and of the rivals there are those that somebody compares.
#[must_use]
pub fn make(tree: Tree, layout: Layout, scene: &Arc<FlatScene>) -> Option<Box<dyn Arm>> {
    match (tree, layout) {
        (Tree::Bvh2 | Tree::Bvh8q, Layout::Luxel) => None,
        (_, Layout::Luxel) => Some(Box::new(Luxel(Arc::clone(scene)))),
        (Tree::Bvh2, _) => rival::make::<Binary>(layout, scene),
        (Tree::Bvh8q, _) => rival::make_quantised(layout, scene),
        _ => rival::make::<Wide>(layout, scene).or_else(|| rival::make_wide(layout, scene)),
    }
}

/// Counts the work of the rivals, which differ in their trees alone: see [`make`].
pub struct Counter(Box<dyn rival::Count>);

impl Counter {
    /// For the rivals of a tree.
    #[must_use]
    pub fn new(tree: Tree, scene: &Arc<FlatScene>) -> Counter {
        Counter(match tree {
            Tree::Bvh2 => rival::counter::<Binary>(scene),
            Tree::Bvh8q => rival::counter::<Quantised>(scene),
            _ => rival::counter::<Wide>(scene),
        })
    }

    /// What tracing these rays takes.
    #[must_use]
    pub fn count(&self, rays: &Rays, occlusion: bool) -> Work {
        self.0.count(rays, occlusion)
    }
}

/// What is walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tree {
    /// Two children a node.
    Bvh2,
    /// Eight children a node.
    Bvh8,
    /// The same with the children's boxes in bytes.
    Bvh8q,
    /// A box around the object, all of it inside, and one around its room.
    Box,
    /// No tree at all.
    Brute,
}

impl Tree {
    /// All, the widest known first.
    pub const ALL: [Tree; 5] = [Tree::Bvh2, Tree::Bvh8, Tree::Bvh8q, Tree::Box, Tree::Brute];

    /// What the product's builder is asked for.
    #[must_use]
    pub fn accel(self) -> Accel {
        match self {
            Tree::Bvh2 | Tree::Bvh8 | Tree::Bvh8q => Accel::Bvh,
            Tree::Box => Accel::Box,
            Tree::Brute => Accel::Brute,
        }
    }

    /// Whether every ray tests more or less every primitive.
    #[must_use]
    pub fn exhaustive(self) -> bool {
        matches!(self, Tree::Box | Tree::Brute)
    }

    /// Its name in tables and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Tree::Bvh2 => "bvh2",
            Tree::Bvh8 => "bvh8",
            Tree::Bvh8q => "bvh8q",
            Tree::Box => "box",
            Tree::Brute => "brute",
        }
    }
}

/// How primitives lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layout {
    /// Array of structs, one primitive tested at a time.
    Structs,
    /// The same array, eight primitives gathered into lanes.
    Gathered,
    /// An array for every coordinate.
    Arrays,
    /// Blocks of four lanes for every coordinate.
    Fours,
    /// Blocks of eight.
    Blocks,
    /// The product's kernels and buffers.
    Luxel,
}

impl Layout {
    /// All, the plainest first.
    pub const ALL: [Layout; 6] = [
        Layout::Structs,
        Layout::Gathered,
        Layout::Arrays,
        Layout::Fours,
        Layout::Blocks,
        Layout::Luxel,
    ];

    /// Whether it has kernels of its own for this instruction set.
    #[must_use]
    pub fn runs_on(self, level: Level) -> bool {
        match self {
            Layout::Luxel => true,
            // One lane at a time is what `Structs` and `Blocks` do.
            Layout::Gathered | Layout::Fours => matches!(level, Level::Sse2 | Level::Avx2),
            _ => level != Level::Avx512,
        }
    }

    /// The name in a sentence.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Layout::Structs => "array of structs",
            Layout::Gathered => "gathered structs",
            Layout::Arrays => "nine arrays",
            Layout::Fours => "blocks of four",
            Layout::Blocks => "lane blocks",
            Layout::Luxel => "luxel",
        }
    }

    /// Its name in tables and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Layout::Structs => "structs",
            Layout::Gathered => "gathered",
            Layout::Arrays => "arrays",
            Layout::Fours => "fours",
            Layout::Blocks => "blocks",
            Layout::Luxel => "luxel",
        }
    }
}

impl fmt::Display for Tree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
