//! `luxel stability`.

use super::failure::Failure;
use super::names::entity_name;
use super::output::check_writable;
use super::progress::words;
use super::stability_args::StabilityArgs;
use super::{diagnostics, load, print_result, say};
use crate::film;
use crate::flat::ObjectId;
use crate::measure::stability::{Placing, Plan, Report, Row, report, run as measure};
use crate::render::{Renderer, Settings};
use crate::scene::{SceneDesc, ShapeDesc};
use crate::trace::TraceOptions;
use serde_json::json;
use std::path::Path;
use std::time::{Duration, Instant};

/// Pixels of a picture, about.
const PIXELS: f64 = 3072.0;

/// Tries the scene elsewhere, and prints, draws and writes what came of it.
pub(crate) fn run(args: &StabilityArgs) -> Result<(), Failure> {
    for path in args.csv.iter().chain(&args.svg) {
        check_writable(path)?;
    }
    let (loaded, warnings) = load::scene(&args.scene, args.max_memory)?;
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(&warnings);
    let plan = Plan {
        placings: placings(&args.scales, &args.offsets),
        rays: args.rays as usize,
        frame: args.frame,
    };
    let (desc, world, assets) = loaded.into_parts();
    let start = |world, seed| {
        let settings = settings(args, &desc, seed);
        Renderer::new(&desc, world, &assets, settings).map_err(|e| Failure::threads(&e))
    };
    let found = measure(world, &plan, start, teller(plan.placings.len() + 1))?;
    let name = |entity| told(&desc, entity);
    let write = |path: &Path, text: String| {
        film::write_file(path, text.as_bytes())
            .map_err(|e| Failure::io(format!("\"{}\"", path.display()), &e))
    };
    if let Some(path) = &args.csv {
        write(path, report::csv(&found, name))?;
    }
    if let Some(path) = &args.svg {
        let scene = args.scene.file_name().unwrap_or_default();
        let title = format!("{} at other sizes and places", scene.to_string_lossy());
        write(path, report::svg(&found, &title))?;
    }
    let verdict = report::verdict(&found, name);
    let text = match args.json {
        true => format!("{:#}\n", json(&found, verdict.trim_end(), name)),
        false => report::table(&found, name) + &verdict,
    };
    print_result(text.as_bytes())?;
    match found.first_wrong() {
        None => Ok(()),
        Some(_) => Err(Failure::unstable()),
    }
}

/// What was asked for: every scale at every offset. By default the two axes, and the corners.
fn placings(scales: &[f64], offsets: &[f64]) -> Vec<Placing> {
    let place = |scale, offset| Placing { scale, offset };
    let mut all: Vec<Placing> = if scales.is_empty() && offsets.is_empty() {
        let scales = [
            1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6,
        ];
        // The picture must be the same to the bit at powers of two.
        let exact = [1.0 / 1_048_576.0, 1_048_576.0];
        let offsets = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7];
        let sizes = scales.iter().chain(&exact).map(|s| place(*s, 0.0));
        let places = offsets.iter().map(|t| place(1.0, *t));
        let corners = [place(1e-6, 1e7), place(1e6, 1e7)];
        sizes.chain(places).chain(corners).collect()
    } else {
        let or = |asked: &[f64], default: f64| match asked {
            [] => vec![default],
            asked => asked.to_vec(),
        };
        let offsets = or(offsets, 0.0);
        let at = |scale: f64| offsets.iter().map(move |t| place(scale, *t));
        or(scales, 1.0).into_iter().flat_map(at).collect()
    };
    all.retain(|placing| *placing != Placing::HOME);
    all
}

/// Settings of a small picture in the shape of the scene's.
fn settings(args: &StabilityArgs, desc: &SceneDesc, seed: u64) -> Settings {
    let defaults = Settings::of_scene(desc);
    let (width, height) = defaults.size;
    let shrink = (PIXELS / (f64::from(width) * f64::from(height)))
        .sqrt()
        .min(1.0);
    let side = |pixels: u32| (f64::from(pixels) * shrink).round().max(1.0) as u32;
    Settings {
        size: args.size.unwrap_or((side(width), side(height))),
        spp: args.spp,
        threads: args.threads.map(usize::from),
        // Small enough that every thread has some.
        tile: 8,
        trace: TraceOptions {
            seed,
            ids: true,
            ..defaults.trace
        },
        ..defaults
    }
}

/// Says what goes on, every two seconds at most.
fn teller(count: usize) -> impl FnMut(usize, Placing) {
    /// How long nobody minds.
    const PATIENCE: Duration = Duration::from_secs(2);
    let start = Instant::now();
    let mut told = start;
    move |k, placing| {
        if told.elapsed() < PATIENCE {
            return;
        }
        told = Instant::now();
        say(&format!(
            "{k} of {count}: scale {}, offset {} ({})",
            placing.scale,
            placing.offset,
            words(start.elapsed())
        ));
    }
}

/// An entity with its kind: `"cat" (the mesh of cat.obj)`.
fn told(desc: &SceneDesc, entity: u32) -> String {
    let name = entity_name(desc, ObjectId(entity));
    let named = desc.entities.get(entity as usize).map(|e| &e.value);
    let kind = match named.and_then(|e| e.shape.as_ref()) {
        Some(ShapeDesc::Sphere { .. }) => "a sphere".to_owned(),
        Some(ShapeDesc::Mesh { path, .. }) => format!("the mesh of {}", path.value),
        None => match named.and_then(|e| e.gltf.as_ref()) {
            Some(gltf) => format!("of {}", gltf.path.value),
            None => return name,
        },
    };
    format!("{name} ({kind})")
}

fn json(found: &Report, verdict: &str, name: impl Fn(u32) -> String) -> serde_json::Value {
    let row = |row: &Row| {
        json!({
            "scale": row.placing.scale,
            "offset": row.placing.offset,
            "rays": row.rays,
            "leaks": row.wrongs.leaks,
            "self_hits": row.wrongs.self_hits,
            "non_finite_samples": row.wrongs.non_finite,
            "pixels_differ": row.picture.pixels,
            "rmse": row.picture.rmse,
            "relmse": row.picture.relmse,
            "of_noise": row.picture.of_noise,
            "culprit": row.culprit().map(&name),
        })
    };
    json!({
        "safe": found.first_wrong().is_none(),
        "verdict": verdict,
        "size": [found.size.0, found.size.1],
        "spp": found.spp,
        "noise_rmse": found.noise,
        "offset_unit": found.width,
        "shared_edges": found.edges,
        "closed_parts": found.closed,
        "open_parts": found.open,
        "room": found.room,
        "placings": found.rows.iter().map(row).collect::<Vec<_>>(),
    })
}
