//! What takes part: luxel's kernels and Embree's, behind one pair of questions.

use crate::embree::{Embree, Scene};
use cpu_time::ProcessTime;
use luxel::build::buffer_bytes;
use luxel::build::bvh::{Accel, build};
use luxel::flat::FlatScene;
use luxel::measure::bench::{RayKind, Subject};
use luxel::trace::{Hits, Isa, Rays, closest_hit, occluded};
use rayon::ThreadPoolBuilder;
use std::error::Error;
use std::fmt;
use std::time::Duration;

/// Who is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Who {
    /// luxel as it renders.
    Luxel,
    /// Embree with these kernels and this mode.
    Embree { isa: &'static str, robust: bool },
}

impl fmt::Display for Who {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Who::Luxel => f.pad("luxel"),
            Who::Embree { isa, robust: false } => f.pad(&format!("Embree {isa}")),
            Who::Embree { isa, robust: true } => f.pad(&format!("Embree {isa} robust")),
        }
    }
}

/// Everyone that this machine can run.
pub(crate) fn everyone() -> Vec<Who> {
    let mut all = vec![Who::Luxel];
    for robust in [false, true] {
        for (isa, available) in [("avx2", has_avx2()), ("avx512", has_avx512())] {
            if available {
                all.push(Who::Embree { isa, robust });
            }
        }
    }
    all
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2")
}

#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl")
}

/// A tree, ready.
pub(crate) struct Engine<'a> {
    /// Whose.
    pub(crate) who: Who,
    tree: Tree<'a>,
    /// CPU time of the build.
    pub(crate) took: Duration,
    /// Bytes of what traversal touches.
    pub(crate) bytes: usize,
}

enum Tree<'a> {
    Luxel(Box<FlatScene>),
    Embree(Scene<'a>),
}

impl<'a> Engine<'a> {
    /// Builds on one thread.
    pub(crate) fn build(
        who: Who,
        embree: &'a Embree,
        subject: &Subject,
    ) -> Result<Engine<'a>, Box<dyn Error>> {
        match who {
            Who::Luxel => {
                let alone = ThreadPoolBuilder::new().num_threads(1).build()?;
                let (built, took) = alone.install(|| {
                    let start = ProcessTime::now();
                    let built = build(&subject.primitives(), Accel::Bvh);
                    (built, start.elapsed())
                });
                let scene = subject.scene(built);
                Ok(Engine {
                    who,
                    bytes: buffer_bytes(&scene).iter().map(|b| b.bytes).sum(),
                    tree: Tree::Luxel(Box::new(scene)),
                    took,
                })
            }
            Who::Embree { isa, robust } => {
                let config = format!("threads=1,isa={isa}");
                let scene = Scene::build(embree, &config, robust, subject)?;
                Ok(Engine {
                    who,
                    took: scene.took,
                    bytes: scene.bytes,
                    tree: Tree::Embree(scene),
                })
            }
        }
    }

    /// What the set asks for: t and primitives of `hits`, or `blocked`.
    pub(crate) fn trace(
        &self,
        kind: RayKind,
        rays: &Rays,
        hits: &mut Hits,
        blocked: &mut Vec<bool>,
    ) {
        match (&self.tree, kind.occlusion()) {
            (Tree::Luxel(scene), false) => closest_hit(scene, Isa::best(), rays, hits),
            (Tree::Luxel(scene), true) => occluded(scene, Isa::best(), rays, blocked),
            (Tree::Embree(scene), false) => scene.closest(rays, hits),
            (Tree::Embree(scene), true) => scene.occluded(rays, blocked),
        }
    }
}
