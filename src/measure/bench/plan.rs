//! What a run is asked for, and what it says meanwhile.

use super::{Generator, RayKind, Subject};
use crate::measure::arms::{Layout, Tree};
use crate::trace::Isa;
use std::time::Duration;

/// What to measure.
pub struct Plan {
    /// What is traced.
    pub sources: Vec<Source>,
    /// Ray sets.
    pub rays: Vec<RayKind>,
    /// Trees.
    pub trees: Vec<Tree>,
    /// Layouts.
    pub layouts: Vec<Layout>,
    /// Instruction sets.
    pub isas: Vec<Isa>,
    /// Primary and random rays; the other sets have as many as there are hits.
    pub count: usize,
    /// What the run should take; it takes longer if a few passes do.
    pub time: Duration,
}

/// A subject that need not exist yet: large ones are made one at a time.
pub enum Source {
    /// Made when its turn comes.
    Generated(Generator),
    /// A user's, with its name.
    Given(String, Box<Subject>),
}

impl Source {
    /// Its name in tables.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Source::Generated(generator) => generator.to_string(),
            Source::Given(name, _) => name.clone(),
        }
    }
}

/// What is going on, for people who wait.
#[derive(Clone, Debug, PartialEq)]
pub enum Stage {
    /// Making a subject and its trees.
    Building,
    /// Asking all arms for their answers.
    Checking(RayKind),
    /// Timing.
    Timing(RayKind),
}
