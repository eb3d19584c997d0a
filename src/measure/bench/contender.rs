//! An arm on an instruction set: what a row of the table is about.

use super::answers::Answers;
use crate::measure::arms::{Arm, Layout, Tree};
use crate::trace::{Isa, Rays};
use std::fmt;

/// An arm on an instruction set.
pub(super) struct Contender<'a> {
    pub(super) tree: Tree,
    pub(super) layout: Layout,
    pub(super) isa: Isa,
    pub(super) arm: &'a dyn Arm,
}

impl Contender<'_> {
    /// Traces a batch.
    pub(super) fn trace(&self, rays: &Rays, occlusion: bool, answers: &mut Answers) {
        if occlusion {
            self.arm.occluded(self.isa, rays, &mut answers.occluded);
        } else {
            self.arm.closest_hit(self.isa, rays, &mut answers.hits);
        }
    }
}

impl fmt::Display for Contender<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.tree, self.layout, self.isa.level())
    }
}
