//! Instructions a ray, counted by Valgrind: what a noisy machine cannot blur. They tell what the kernels compute, not how
//! long they wait.
//!
//! `cargo bench -p luxel-peers --bench instructions`; needs `valgrind`, says so where there is none.
//!
//! The program runs itself below callgrind once without a pass over the rays and once with one, for each set and
//! instruction set; the difference is what the rays cost. Everything is deterministic, so that equal kernels count equal.

use luxel::build::bvh::{Accel, build};
use luxel::measure::bench::{RayKind, RaySets, Subject, meshes};
use luxel::trace::isa::Level;
use luxel::trace::{Hits, Isa, closest_hit, occluded};
use std::error::Error;
use std::hint::black_box;
use std::process::Command;

/// The argument that makes the program the one that is counted; then subject, level and set.
const COUNTED: &str = "--counted";

/// In place of a set: no pass.
const NOTHING: &str = "nothing";

/// Primary and random rays of a subject.
const RAYS: usize = 4096;

/// Makes a subject.
type Generator = fn() -> Subject;

/// Small, since Valgrind takes fifty times as long; deep enough to walk.
const SUBJECTS: [(&str, Generator); 2] = [
    ("3k", || meshes::ball(12)),
    ("soup-3k", || meshes::soup(3000)),
];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [COUNTED, subject, level, set] =
        arguments.iter().map(String::as_str).collect::<Vec<_>>()[..]
    {
        return counted(subject, level, set);
    }
    // As a test it would only wait.
    if !arguments.iter().any(|a| a == "--bench") {
        return Ok(());
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("instructions: skipped, there is no valgrind");
        return Ok(());
    }
    print!("{:<18}", "instructions a ray");
    RayKind::ALL.iter().for_each(|kind| print!("{kind:>10}"));
    println!();
    for (name, make) in SUBJECTS {
        let sets = sets(&make());
        // Valgrind knows no AVX-512.
        for level in [Level::Scalar, Level::Sse2, Level::Avx2] {
            if Isa::available(level).is_none() {
                continue;
            }
            print!("{:<18}", format!("{name} {level}"));
            let nothing = instructions(name, level, NOTHING)?;
            for kind in RayKind::ALL {
                let rays = sets.of(kind).len() as f64;
                let all = instructions(name, level, &kind.to_string())?;
                print!("{:>10.0}", (all - nothing) as f64 / rays);
            }
            println!();
        }
    }
    Ok(())
}

fn sets(subject: &Subject) -> RaySets {
    let scene = subject.scene(build(&subject.primitives(), Accel::Bvh));
    RaySets::new(subject, &scene, RAYS)
}

/// Runs the counted program; callgrind's last words are "Collected : N".
fn instructions(subject: &str, level: Level, set: &str) -> Result<i64, Box<dyn Error>> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe()?)
        .args([COUNTED, subject, &level.to_string(), set])
        // One thread: work is not divided by chance.
        .env("RAYON_NUM_THREADS", "1")
        .output()?;
    let words = String::from_utf8_lossy(&output.stderr);
    let collected = words
        .lines()
        .find_map(|line| line.split_once("Collected :"));
    let (_, count) = collected.ok_or_else(|| format!("callgrind failed:\n{words}"))?;
    Ok(count.trim().parse()?)
}

/// What is counted: everything is made, then one set is traced, or none.
fn counted(subject: &str, level: &str, set: &str) -> Result<(), Box<dyn Error>> {
    let known = SUBJECTS.iter().find(|(name, _)| *name == subject);
    let subject = known.ok_or("no such subject")?.1();
    let isa = Isa::available(level.parse()?).ok_or("no such instruction set here")?;
    let scene = subject.scene(build(&subject.primitives(), Accel::Bvh));
    let sets = RaySets::new(&subject, &scene, RAYS);
    let (mut hits, mut blocked) = (Hits::default(), Vec::new());
    if let Some(kind) = RayKind::ALL
        .into_iter()
        .find(|kind| kind.to_string() == set)
    {
        if kind.occlusion() {
            occluded(&scene, isa, sets.of(kind), &mut blocked);
        } else {
            closest_hit(&scene, isa, sets.of(kind), &mut hits);
        }
    }
    black_box((hits, blocked));
    Ok(())
}
