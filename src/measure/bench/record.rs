//! What a run gives.

use super::RayKind;
use crate::measure::arms::{Layout, Tree, Work};
use crate::trace::isa::Level;

/// An arm on an instruction set with a subject's ray set: a row.
#[derive(Clone, Debug)]
pub struct Record {
    /// Name of the subject.
    pub subject: String,
    /// Its triangles and spheres.
    pub primitives: usize,
    /// The ray set.
    pub rays: RayKind,
    /// What is walked.
    pub tree: Tree,
    /// How primitives lie.
    pub layout: Layout,
    /// Instructions.
    pub isa: Level,
    /// Rays that were timed: all, but for arms that test every primitive a share of them, evenly spread.
    pub timed: usize,
    /// How often.
    pub passes: u32,
    /// The sum over chunks of rays of each one's shortest CPU time.
    pub seconds: f64,
    /// What those rays took, for arms that count.
    pub work: Option<Work>,
    /// Bytes of nodes and primitives, a primitive.
    pub bytes: f64,
    /// Building the product's tree, by the wall clock, milliseconds; rivals are derived from it.
    pub build_ms: f64,
    /// FNV-1a over the answers of the whole ray set, the same for every arm.
    pub checksum: u64,
}

impl Record {
    /// Nanoseconds a ray.
    #[must_use]
    pub fn ns(&self) -> f64 {
        self.seconds * 1e9 / self.timed as f64
    }

    /// Million rays a second.
    #[must_use]
    pub fn mrays(&self) -> f64 {
        1e3 / self.ns()
    }
}
