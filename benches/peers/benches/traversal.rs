//! Time: luxel, `obvhs` and `bvh` on the same rays in the same run, by Criterion over the CPU time of the thread. Before
//! anything is timed, luxel's f64 referee judges every hit.
//!
//! `cargo bench -p luxel-peers --bench traversal [-- FILTER]`, where a filter is part of `subject/set/engine`; the trees of
//! all are built and judged in any case. Engines take turns set by set, not pass by pass: read differences below 10 % as ties.

use cpu_time::ThreadTime;
use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use luxel::build::bvh::{Accel, build};
use luxel::measure::bench::{RayKind, RaySets, Subject, meshes};
use luxel::measure::referee::{Found, Referee, Verdict};
use luxel::trace::{Hits, Rays};
use luxel_peers::{Engine, Who};
use std::time::Duration;

/// Primary and random rays of a subject; the others are about as many. More than caches hold of a large tree.
const RAYS: usize = 1 << 16;

/// Rays of a batch: a wave of the renderer.
const BATCH: usize = 1024;

/// Criterion's samples of one set and engine, its least.
const SAMPLES: usize = 10;

/// Makes a subject.
type Generator = fn() -> Subject;

fn traversal(criterion: &mut Criterion) {
    let subjects: [(&str, Generator); 3] = [
        ("3k", || meshes::ball(meshes::BALL_SIZES[0])),
        ("1m", || meshes::ball(meshes::BALL_SIZES[2])),
        ("soup", || meshes::soup(meshes::SOUP_SIZE)),
    ];
    for (name, make) in subjects {
        let subject = make();
        let engines = Who::ALL.map(|who| (who, Engine::build(who, &subject)));
        let scene = subject.scene(build(&subject.primitives(), Accel::Bvh));
        let sets = RaySets::new(&subject, &scene, RAYS);
        let referee = Referee::new(subject.primitives());
        for kind in RayKind::ALL {
            let batches = batches(sets.of(kind));
            if batches.is_empty() {
                continue;
            }
            for (who, engine) in &engines {
                check(
                    &format!("{name}/{kind}"),
                    *who,
                    engine,
                    kind,
                    &batches,
                    &referee,
                );
            }
            let mut group = criterion.benchmark_group(format!("{name}/{kind}"));
            group
                .throughput(Throughput::Elements(sets.of(kind).len() as u64))
                .sample_size(SAMPLES)
                .sampling_mode(SamplingMode::Flat)
                .warm_up_time(Duration::from_millis(200))
                .measurement_time(Duration::from_secs(1));
            for (who, engine) in &engines {
                group.bench_function(who.name(), |bencher| {
                    bencher.iter_custom(|passes| time(engine, kind, &batches, passes));
                });
            }
            group.finish();
        }
    }
}

/// CPU time of so many passes over the batches.
fn time(engine: &Engine, kind: RayKind, batches: &[Rays], passes: u64) -> Duration {
    let (mut hits, mut blocked) = (Hits::default(), Vec::new());
    let start = ThreadTime::now();
    for _ in 0..passes {
        for rays in batches {
            engine.trace(kind, rays, &mut hits, &mut blocked);
        }
    }
    start.elapsed()
}

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

/// Judges every hit: luxel's by its bounds, of which none may be wrong; those of others by the loose rule, and told.
fn check(set: &str, who: Who, engine: &Engine, kind: RayKind, batches: &[Rays], referee: &Referee) {
    let (mut hits, mut blocked) = (Hits::default(), Vec::new());
    let mut counts = [0; 4];
    for rays in batches {
        engine.trace(kind, rays, &mut hits, &mut blocked);
        for i in 0..rays.len() {
            let ray = [&rays.origin, &rays.dir].map(|a| [a[0][i], a[1][i], a[2][i]]);
            let traced = referee.trace(ray, rays.t_max[i]);
            let found = || {
                let [t, prim] = [hits.t[i].to_bits(), hits.prim[i]];
                (prim != Hits::NONE).then(|| Found {
                    t: f32::from_bits(t),
                    prim,
                })
            };
            let verdict = match (kind.occlusion(), who) {
                (false, Who::Luxel) => traced.judge(found()),
                (false, _) => traced.judge_loosely(found()),
                (true, Who::Luxel) => traced.judge_occlusion(blocked[i]),
                (true, _) => traced.judge_occlusion_loosely(blocked[i]),
            };
            counts[verdict as usize] += 1;
        }
    }
    let of = |verdict: Verdict| counts[verdict as usize];
    let [wrong, edges, ties] = [Verdict::Wrong, Verdict::Edge, Verdict::Tie].map(of);
    println!(
        "{set}/{}: {wrong} wrong, {edges} at edges, {ties} ties",
        who.name()
    );
    assert!(who != Who::Luxel || wrong == 0);
    // A peer so far off would not be measured, but misused.
    assert!(wrong < RAYS / 1000, "{} is misused", who.name());
}

criterion_group!(benches, traversal);
criterion_main!(benches);
