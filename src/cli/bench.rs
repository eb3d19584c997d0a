//! `luxel bench`.

use super::bench_args::BenchArgs;
use super::failure::Failure;
use super::output::check_writable;
use super::progress::words;
use super::start::{self, What};
use super::{diagnostics, print_result, say};
use crate::film;
use crate::math::DAffine3;
use crate::measure::arms::{Layout, Tree};
use crate::measure::bench::{
    Generator, Plan, RayKind, Record, Source, Stage, Subject, report, run as measure,
};
use crate::measure::exactness as exact;
use crate::trace::Isa;
use crate::trace::isa::Level;
use serde_json::json;
use std::path::Path;
use std::time::{Duration, Instant};

/// How long nobody minds.
const PATIENCE: Duration = Duration::from_secs(2);

/// Times what is asked for, and prints, draws and writes it.
pub(crate) fn run(args: &BenchArgs) -> Result<(), Failure> {
    for path in args.csv.iter().chain(&args.svg) {
        check_writable(path)?;
    }
    if args.exactness {
        return exactness(args);
    }
    let records = measure(plan(args)?, teller()).map_err(Failure::different)?;
    if records.is_empty() {
        return Err(Failure::usage(
            "none of these layouts runs with these trees and instruction sets",
            "bvh2 is for rivals, bvh8q for blocks of triangles, avx512 for luxel, gathered and fours for triangles on bvh8 with sse2 or avx2, box and brute for small scenes",
        ));
    }
    if let Some(path) = &args.csv {
        write(path, report::csv(&records))?;
    }
    if let Some(path) = &args.svg {
        write(path, report::svg(&records))?;
    }
    let text = match args.json {
        true => format!("{:#}\n", json(&records)),
        false => report::summary(&records) + &report::table(&records),
    };
    print_result(text.as_bytes())
}

fn write(path: &Path, text: String) -> Result<(), Failure> {
    film::write_file(path, text.as_bytes())
        .map_err(|e| Failure::io(format!("\"{}\"", path.display()), &e))
}

/// Times and judges what exactness costs.
fn exactness(args: &BenchArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let rows = exact::run(args.count as usize, args.time, |choice| {
        if start.elapsed() >= PATIENCE {
            say(&format!("{choice} ({})", words(start.elapsed())));
        }
    });
    if let Some(path) = &args.csv {
        write(path, exact::csv(&rows))?;
    }
    let text = match args.json {
        true => format!("{:#}\n", exact_json(&rows)),
        false => exact::table(&rows),
    };
    print_result(text.as_bytes())
}

fn exact_json(rows: &[exact::Row]) -> serde_json::Value {
    let row = |r: &exact::Row| {
        json!({
            "choice": r.choice,
            "exact": r.exact,
            "cheap": r.cheap,
            "unit": r.unit,
            "ns_exact": r.ns[0],
            "ns_cheap": r.ns[1],
            "wrong_per_million_exact": r.wrong[0],
            "wrong_per_million_cheap": r.wrong[1],
            "judged": r.judged,
            "counted": r.counted,
        })
    };
    rows.iter().map(row).collect()
}

/// What was named, else what `--all` or the defaults say.
fn plan(args: &BenchArgs) -> Result<Plan, Failure> {
    let mut sources = named(
        &args.size,
        args.all && args.mesh.is_none(),
        &Generator::ALL,
        &[],
    )
    .into_iter()
    .map(Source::Generated)
    .collect::<Vec<_>>();
    match &args.mesh {
        Some(path) => sources.push(mesh(path, args)?),
        None if sources.is_empty() => {
            let some = [Generator::Ball3k, Generator::Ball1m];
            sources.extend(some.map(Source::Generated));
        }
        None => {}
    }
    let isas: Vec<Isa> = Isa::all().collect();
    let portable = |isa: &Isa| isa.level() == Level::Sse2;
    let some_isas: Vec<Isa> = isas
        .iter()
        .filter(|isa| !portable(isa) || portable(&Isa::best()))
        .copied()
        .collect();
    let some_layouts = [
        Layout::Structs,
        Layout::Arrays,
        Layout::Blocks,
        Layout::Luxel,
    ];
    Ok(Plan {
        sources,
        rays: named(&args.rays, args.all, &RayKind::ALL, &RayKind::ALL),
        trees: named(&args.accel, args.all, &Tree::ALL, &[Tree::Bvh8]),
        layouts: named(&args.layout, args.all, &Layout::ALL, &some_layouts),
        isas: named(&args.isa, args.all, &isas, &some_isas),
        count: args.count as usize,
        time: args.time,
    })
}

fn named<T: Copy>(asked: &[T], all: bool, every: &[T], some: &[T]) -> Vec<T> {
    match (asked, all) {
        ([], true) => every.to_vec(),
        ([], false) => some.to_vec(),
        (asked, _) => asked.to_vec(),
    }
}

/// Reads a user's mesh.
fn mesh(path: &Path, args: &BenchArgs) -> Result<Source, Failure> {
    let read = start::mesh(path, args.max_memory)?;
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(read.loader.warnings());
    let parts = match read.what {
        What::Mesh(id) => vec![(id, DAffine3::IDENTITY)],
        What::Model(id) => read.loader.loaded_model(id).placed(),
    };
    let parts: Vec<_> = parts
        .into_iter()
        .map(|(id, to)| (&**read.loader.loaded(id), to))
        .collect();
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let message = format!("\"{}\" has nothing to trace", path.display());
    let subject = Subject::of_meshes(&parts).ok_or_else(|| Failure::bad_file(message))?;
    let subject = match args.room {
        true => subject.in_room(),
        false => subject,
    };
    Ok(Source::Given(name.into_owned(), Box::new(subject)))
}

/// Says what goes on, every two seconds at most.
fn teller() -> impl FnMut(&str, Stage) {
    let start = Instant::now();
    let mut told = start;
    move |subject, stage| {
        if told.elapsed() < PATIENCE {
            return;
        }
        told = Instant::now();
        let what = match stage {
            Stage::Building => "building".to_owned(),
            Stage::Checking(rays) => format!("comparing the arms' hits, {rays} rays"),
            Stage::Timing(rays) => format!("timing {rays} rays"),
        };
        say(&format!("{subject}: {what} ({})", words(start.elapsed())));
    }
}

/// What an arm does not count is null.
fn json(records: &[Record]) -> serde_json::Value {
    let row = |r: &Record| {
        let per_ray = |count: u64| count as f64 / r.timed as f64;
        json!({
            "subject": r.subject,
            "primitives": r.primitives,
            "rays": r.rays.to_string(),
            "tree": r.tree.to_string(),
            "layout": r.layout.to_string(),
            "isa": r.isa.to_string(),
            "timed_rays": r.timed,
            "passes": r.passes,
            "mrays_per_s": r.mrays(),
            "ns_per_ray": r.ns(),
            "nodes_per_ray": r.work.map(|w| per_ray(w.nodes)),
            "primitives_per_ray": r.work.map(|w| per_ray(w.primitives)),
            "lanes_per_ray": r.work.map(|w| per_ray(w.lanes)),
            "bytes_per_primitive": r.bytes,
            "build_ms": r.build_ms,
            "checksum": format!("{:016x}", r.checksum),
        })
    };
    records.iter().map(row).collect()
}
