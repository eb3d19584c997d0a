//! What two threads reach of two processes: the same work done by one process on two threads, which share tree and
//! allocator, and by two processes of one thread each, pinned to a processor each (with `taskset`, where there is one), which
//! share nothing. In turns; the shortest time of each counts.
//!
//! `cargo bench --bench threads`

use luxel::build::bvh::{Accel, Quality, build, build_with};
use luxel::flat::FlatScene;
use luxel::measure::bench::{Generator, RayKind, RaySets, Subject};
use luxel::trace::{Hits, Isa, Rays, closest_hit};
use rayon::prelude::*;
use std::io::{self, BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

/// Times that each side does its work.
const TURNS: usize = 25;

/// Rays of a piece of work that a thread takes, about a tile's.
const BATCH: usize = 1024;

/// Rays in all.
const RAYS: usize = 1 << 18;

/// What is done; a name for each.
const WORK: [&str; 4] = ["trace shuffled", "trace primary", "build", "build fast"];

/// A mesh of a million triangles with what is to be done on it.
struct Bench {
    subject: Subject,
    scene: FlatScene,
    batches: [Vec<Rays>; 2],
}

impl Bench {
    fn new() -> Bench {
        let subject = Generator::Ball1m.make();
        let scene = subject.scene(build(&subject.primitives(), Accel::Bvh));
        let sets = RaySets::new(&subject, &scene, RAYS);
        let batches = [RayKind::Shuffled, RayKind::Primary].map(|kind| cut(sets.of(kind)));
        Bench {
            subject,
            scene,
            batches,
        }
    }

    /// Does a piece of work with this pool: on two threads all of it, on one half of it.
    fn work(&self, what: usize, threads: usize, pool: &rayon::ThreadPool) {
        pool.install(|| match what {
            0 | 1 => {
                let batches = &self.batches[what];
                let part = batches.len() * threads / 2;
                batches[..part]
                    .par_iter()
                    .for_each_init(Hits::default, |hits, rays| {
                        closest_hit(&self.scene, Isa::best(), rays, hits);
                    });
            }
            _ => {
                let quality = [Quality::Good, Quality::Fast][what - 2];
                // A build cannot be halved: two threads do two, one after the other.
                for _ in 0..threads {
                    drop(build_with(&self.subject.primitives(), Accel::Bvh, quality));
                }
            }
        });
    }
}

fn cut(rays: &Rays) -> Vec<Rays> {
    let starts = (0..rays.len()).step_by(BATCH);
    starts
        .map(|at| rays.part(at..rays.len().min(at + BATCH)))
        .collect()
}

fn pool(threads: usize) -> rayon::ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().expect("threads")
}

/// What a child does: for every line with the number of a piece of work, that work, and a line in answer.
fn child() {
    let (bench, pool) = (Bench::new(), pool(1));
    println!("ready");
    for line in io::stdin().lines() {
        let Some(what) = line.ok().and_then(|line| line.parse().ok()) else {
            return;
        };
        bench.work(what, 1, &pool);
        println!("done");
    }
}

/// A child on a processor.
struct Process {
    child: Child,
    answers: BufReader<std::process::ChildStdout>,
}

impl Process {
    fn new(processor: usize) -> io::Result<Process> {
        let own = std::env::current_exe()?;
        let mut pinned = Command::new("taskset");
        pinned.args(["-c", &processor.to_string()]).arg(&own);
        let start = |command: &mut Command| {
            let piped = command
                .arg("child")
                .stdin(Stdio::piped())
                .stdout(Stdio::piped());
            piped.spawn()
        };
        let mut child = start(&mut pinned).or_else(|_| start(&mut Command::new(&own)))?;
        let answers = child.stdout.take().ok_or(io::ErrorKind::BrokenPipe)?;
        Ok(Process {
            child,
            answers: BufReader::new(answers),
        })
    }

    fn ask(&mut self, what: usize) -> io::Result<()> {
        let to = self.child.stdin.as_mut().ok_or(io::ErrorKind::BrokenPipe)?;
        writeln!(to, "{what}")
    }

    fn wait(&mut self) -> io::Result<()> {
        match self.answers.read_line(&mut String::new())? {
            0 => Err(io::ErrorKind::UnexpectedEof.into()),
            _ => Ok(()),
        }
    }
}

fn main() -> io::Result<()> {
    if std::env::args().any(|a| a == "child") {
        child();
        return Ok(());
    }
    let (bench, pool) = (Bench::new(), pool(2));
    let mut processes = [Process::new(0)?, Process::new(1)?];
    for process in &mut processes {
        process.wait()?;
    }
    println!("two threads over two pinned processes: the best of {TURNS}, in turns; milliseconds");
    println!(
        "{:16} {:>9} {:>9} {:>6}",
        "", "processes", "threads", "share"
    );
    for (what, name) in WORK.iter().enumerate() {
        let mut best = [f64::INFINITY; 2];
        for _ in 0..TURNS {
            let start = Instant::now();
            for process in &mut processes {
                process.ask(what)?;
            }
            for process in &mut processes {
                process.wait()?;
            }
            best[0] = best[0].min(start.elapsed().as_secs_f64());
            let start = Instant::now();
            bench.work(what, 2, &pool);
            best[1] = best[1].min(start.elapsed().as_secs_f64());
        }
        let [apart, together] = best.map(|seconds| 1e3 * seconds);
        println!(
            "{name:16} {apart:9.1} {together:9.1} {:6.3}",
            apart / together
        );
    }
    for mut process in processes {
        drop(process.child.stdin.take());
        process.child.wait()?;
    }
    Ok(())
}
