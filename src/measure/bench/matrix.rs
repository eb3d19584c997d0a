//! The run: every subject, every ray set, every arm, every instruction set that was asked for.

use super::answers::{Answers, CHUNK, Chunk, Disagreement, NO_ANSWERS};
use super::contender::Contender;
use super::timing::{self, Timing, Turn};
use super::{Plan, RayKind, RaySets, Record, Source, Stage, Subject};
use crate::build::bvh::{Accel, build};
use crate::flat::FlatScene;
use crate::measure::arms::{self, Arm, Counter, Layout, Luxel, Tree, Work};
use crate::trace::Isa;
use std::sync::Arc;
use std::time::Instant;

/// Runs the plan. `watch` hears of every stage before it starts.
///
/// # Errors
/// If an arm does not give the answers of the product.
pub fn run(plan: Plan, mut watch: impl FnMut(&str, Stage)) -> Result<Vec<Record>, Disagreement> {
    let deadline = Instant::now() + plan.time;
    let mut cases = (plan.sources.len() * plan.rays.len()) as u32;
    let mut records = Vec::new();
    for source in plan.sources {
        let name = source.name();
        watch(&name, Stage::Building);
        let subject = match source {
            Source::Generated(generator) => generator.make(),
            Source::Given(_, subject) => *subject,
        };
        let bench = Bench::new(name, &subject, &plan.trees, &plan.layouts);
        let sets = RaySets::new(&subject, &bench.product, plan.count);
        for &kind in &plan.rays {
            let chunks = bench.chunks(&sets, kind);
            let turns = bench.turns(&chunks, &plan.isas);
            watch(&bench.name, Stage::Checking(kind));
            bench.check(&turns, kind)?;
            watch(&bench.name, Stage::Timing(kind));
            let now = Instant::now();
            let until = now + deadline.saturating_duration_since(now) / cases;
            cases -= 1;
            let timings = timing::in_turns(&turns, until);
            let checksum = chunks.iter().fold(NO_ANSWERS, |sum, c| c.checksum(sum));
            let work = bench.work(&turns, kind);
            let rows = turns.iter().zip(timings).zip(work);
            records.extend(
                rows.map(|((turn, timing), work)| bench.record(turn, kind, timing, work, checksum)),
            );
        }
    }
    Ok(records)
}

/// Tests of a primitive that an arm without a tree may do in a pass: about half a second.
const EXHAUSTING: usize = 1 << 29;

/// A subject with its arms.
struct Bench {
    name: String,
    primitives: usize,
    /// What makes the rays, and says what is right.
    product: Arc<FlatScene>,
    arms: Vec<Entrant>,
    /// What counts the work of each tree's rivals.
    counters: Vec<(Tree, Counter)>,
}

/// An arm that is ready.
struct Entrant {
    tree: Tree,
    layout: Layout,
    arm: Box<dyn Arm>,
    build_ms: f64,
}

impl Bench {
    fn new(name: String, subject: &Subject, trees: &[Tree], layouts: &[Layout]) -> Bench {
        let (mut arms, mut counters, mut product) = (Vec::new(), Vec::new(), None);
        for accel in [Accel::Bvh, Accel::Box, Accel::Brute] {
            let of_accel = |tree: &&Tree| tree.accel() == accel;
            let trees: Vec<Tree> = trees.iter().filter(of_accel).copied().collect();
            if accel != Accel::Bvh && trees.is_empty() {
                continue;
            }
            let start = Instant::now();
            let built = build(&subject.primitives(), accel);
            let build_ms = start.elapsed().as_secs_f64() * 1e3;
            let scene = Arc::new(subject.scene(built));
            for (&tree, &layout) in trees
                .iter()
                .flat_map(|t| layouts.iter().map(move |l| (t, l)))
            {
                arms.extend(arms::make(tree, layout, &scene).map(|arm| Entrant {
                    tree,
                    layout,
                    arm,
                    build_ms,
                }));
            }
            counters.extend(trees.iter().map(|&tree| (tree, Counter::new(tree, &scene))));
            product.get_or_insert(scene);
        }
        Bench {
            name,
            primitives: subject.len(),
            product: product.expect("the first tree is always built"),
            arms,
            counters,
        }
    }

    fn chunks(&self, sets: &RaySets, kind: RayKind) -> Vec<Chunk> {
        let product = Luxel(self.product.clone());
        let reference = Contender {
            tree: Tree::Bvh8,
            layout: Layout::Luxel,
            isa: Isa::best(),
            arm: &product,
        };
        Chunk::cut(sets.of(kind), kind.occlusion(), &reference)
    }

    /// Who traces what: all chunks, or some where every primitive is tested; nobody who would not finish one.
    fn turns<'a>(&'a self, chunks: &'a [Chunk], isas: &[Isa]) -> Vec<Turn<'a>> {
        let mut turns = Vec::new();
        for entrant in &self.arms {
            let affordable = match entrant.tree.exhaustive() {
                true => EXHAUSTING / (self.primitives * CHUNK).max(1),
                false => chunks.len(),
            };
            if affordable == 0 {
                continue;
            }
            let step = chunks.len().div_ceil(affordable).max(1);
            for &isa in isas
                .iter()
                .filter(|isa| entrant.layout.runs_on(isa.level()))
            {
                let contender = Contender {
                    tree: entrant.tree,
                    layout: entrant.layout,
                    isa,
                    arm: &*entrant.arm,
                };
                turns.push((contender, chunks.iter().step_by(step).collect()));
            }
        }
        turns
    }

    fn check(&self, turns: &[Turn], kind: RayKind) -> Result<(), Disagreement> {
        let mut answers = Answers::default();
        for (contender, chunks) in turns {
            for chunk in chunks {
                chunk.trace(contender, &mut answers);
                chunk.check(&answers).map_err(|wrong| Disagreement {
                    arm: contender.to_string(),
                    case: format!("{kind} rays of {}", self.name),
                    ..wrong
                })?;
            }
        }
        Ok(())
    }

    /// What each contender did; counted once a tree, since neither layout nor instruction set changes it, but for the
    /// padding: structs have none, and blocks of four less. The product's walk is another.
    fn work(&self, turns: &[Turn], kind: RayKind) -> Vec<Option<Work>> {
        let mut known: Vec<(Tree, Work)> = Vec::new();
        let mut of_tree = |tree: Tree, chunks: &[&Chunk]| {
            if let Some((_, work)) = known.iter().find(|(t, _)| *t == tree) {
                return Some(*work);
            }
            let (_, counter) = self.counters.iter().find(|(t, _)| *t == tree)?;
            let count = |chunk: &&Chunk| counter.count(&chunk.rays, kind.occlusion());
            let work = chunks.iter().map(count).sum();
            known.push((tree, work));
            Some(work)
        };
        let of_turn = |(contender, chunks): &Turn| match contender.layout {
            Layout::Luxel => None,
            Layout::Structs => of_tree(contender.tree, chunks).map(|work| Work {
                lanes: work.primitives,
                ..work
            }),
            Layout::Fours => of_tree(contender.tree, chunks).map(|work| Work {
                lanes: work.fours,
                ..work
            }),
            _ => of_tree(contender.tree, chunks),
        };
        turns.iter().map(of_turn).collect()
    }

    fn record(
        &self,
        (contender, chunks): &Turn,
        rays: RayKind,
        timing: Timing,
        work: Option<Work>,
        checksum: u64,
    ) -> Record {
        let same = |e: &&Entrant| (e.tree, e.layout) == (contender.tree, contender.layout);
        Record {
            subject: self.name.clone(),
            primitives: self.primitives,
            rays,
            tree: contender.tree,
            layout: contender.layout,
            isa: contender.isa.level(),
            timed: chunks.iter().map(|chunk| chunk.rays.len()).sum(),
            passes: timing.passes,
            seconds: timing.seconds,
            work,
            bytes: contender.arm.bytes() as f64 / self.primitives as f64,
            build_ms: self.arms.iter().find(same).map_or(0.0, |e| e.build_ms),
            checksum,
        }
    }
}
