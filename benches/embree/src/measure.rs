//! The measuring: a subject enters, a row for each engine leaves.

use crate::embree::Embree;
use crate::engine::{Engine, Who, everyone};
use cpu_time::ThreadTime;
use luxel::build::bvh::{Accel, build};
use luxel::measure::bench::{RayKind, RaySets, Subject};
use luxel::measure::referee::{Found, Referee, Verdict};
use luxel::trace::{Hits, Rays};
use rayon::prelude::*;
use std::error::Error;
use std::time::Duration;

/// Rays of a batch: a wave of the renderer.
const BATCH: usize = 1024;

/// Batches of a chunk, which is timed at once: long against the clock's resolution, short against a time slice.
const CHUNK: usize = 8;

/// What one engine did with one subject.
pub(crate) struct Row {
    pub(crate) who: Who,
    /// In the order of [`RayKind::ALL`].
    pub(crate) sets: Vec<Set>,
    /// Smallest CPU time of two builds.
    pub(crate) build: Duration,
    pub(crate) bytes: usize,
}

/// What it did with one set of rays.
#[derive(Clone)]
pub(crate) struct Set {
    pub(crate) rays: usize,
    /// The chunks' smallest times, added.
    pub(crate) time: Duration,
    /// Of the first pass, in the order of [`Verdict`].
    pub(crate) verdicts: [usize; 4],
}

impl Set {
    /// Millions of rays in a second; 0 for a set without rays.
    pub(crate) fn mrays(&self) -> f64 {
        if self.rays == 0 {
            0.0
        } else {
            self.rays as f64 * 1e-6 / self.time.as_secs_f64()
        }
    }
}

/// Builds every engine's tree, then lets them take turns on every set of rays.
pub(crate) fn measure(
    subject: &Subject,
    embree: &Embree,
    count: usize,
    passes: usize,
) -> Result<Vec<Row>, Box<dyn Error>> {
    let rays = {
        let scene = subject.scene(build(&subject.primitives(), Accel::Bvh));
        RaySets::new(subject, &scene, count)
    };
    let mut engines = Vec::new();
    let mut rows = Vec::new();
    for who in everyone() {
        let first = Engine::build(who, embree, subject)?.took;
        let engine = Engine::build(who, embree, subject)?;
        rows.push(Row {
            who,
            sets: Vec::new(),
            build: first.min(engine.took),
            bytes: engine.bytes,
        });
        engines.push(engine);
    }
    let referee = Referee::new(subject.primitives());
    for kind in RayKind::ALL {
        let rays = rays.of(kind);
        let batches = batches(rays);
        let verdicts = judge(&engines, kind, &batches, &referee);
        let times = turns(&engines, kind, &batches, passes);
        for ((row, verdicts), time) in rows.iter_mut().zip(verdicts).zip(times) {
            row.sets.push(Set {
                rays: rays.len(),
                time,
                verdicts,
            });
        }
    }
    Ok(rows)
}

/// The rays in batches, in order.
fn batches(rays: &Rays) -> Vec<Rays> {
    let batch = |first: usize| {
        let range = first..rays.len().min(first + BATCH);
        let part = |array: &Vec<f32>| array[range.clone()].to_vec();
        Rays {
            origin: [0, 1, 2].map(|axis| part(&rays.origin[axis])),
            dir: [0, 1, 2].map(|axis| part(&rays.dir[axis])),
            t_max: part(&rays.t_max),
        }
    };
    (0..rays.len()).step_by(BATCH).map(batch).collect()
}

/// The time of each engine: the smallest of each chunk over the passes, added.
fn turns(engines: &[Engine], kind: RayKind, batches: &[Rays], passes: usize) -> Vec<Duration> {
    let chunks = batches.len().div_ceil(CHUNK);
    let mut best = vec![vec![Duration::MAX; chunks]; engines.len()];
    let (mut hits, mut blocked) = (Hits::default(), Vec::new());
    for _ in 0..passes {
        for (engine, best) in engines.iter().zip(&mut best) {
            for (chunk, best) in batches.chunks(CHUNK).zip(best) {
                let start = ThreadTime::now();
                for rays in chunk {
                    engine.trace(kind, rays, &mut hits, &mut blocked);
                }
                *best = start.elapsed().min(*best);
            }
        }
    }
    best.into_iter()
        .map(|chunks| chunks.into_iter().sum())
        .collect()
}

/// What the referee says to every engine's answers: luxel by its bounds, the others by the loose rule.
fn judge(
    engines: &[Engine],
    kind: RayKind,
    batches: &[Rays],
    referee: &Referee,
) -> Vec<[usize; 4]> {
    let strict: Vec<bool> = engines.iter().map(|e| e.who == Who::Luxel).collect();
    let mut counts = vec![[0; 4]; engines.len()];
    let mut answers = vec![(Hits::default(), Vec::new()); engines.len()];
    for rays in batches {
        for (engine, (hits, blocked)) in engines.iter().zip(&mut answers) {
            engine.trace(kind, rays, hits, blocked);
        }
        let verdicts = |i: usize| -> Vec<Verdict> {
            let ray = [&rays.origin, &rays.dir].map(|a| [a[0][i], a[1][i], a[2][i]]);
            let traced = referee.trace(ray, rays.t_max[i]);
            let verdict = |(strict, (hits, blocked)): (&bool, &(Hits, Vec<bool>))| match (
                kind.occlusion(),
                *strict,
            ) {
                (false, true) => traced.judge(found(hits, i)),
                (false, false) => traced.judge_loosely(found(hits, i)),
                (true, true) => traced.judge_occlusion(blocked[i]),
                (true, false) => traced.judge_occlusion_loosely(blocked[i]),
            };
            strict.iter().zip(&answers).map(verdict).collect()
        };
        let all: Vec<Vec<Verdict>> = (0..rays.len()).into_par_iter().map(verdicts).collect();
        for verdicts in all {
            for (counts, verdict) in counts.iter_mut().zip(verdicts) {
                counts[verdict as usize] += 1;
            }
        }
    }
    counts
}

fn found(hits: &Hits, i: usize) -> Option<Found> {
    (hits.prim[i] != Hits::NONE).then(|| Found {
        t: hits.t[i],
        prim: hits.prim[i],
    })
}
