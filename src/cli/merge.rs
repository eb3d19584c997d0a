//! `luxel merge`: the part films of one render to its image.

use super::failure::Failure;
use super::merge_args::MergeArgs;
use super::output::{Encoding, Output};
use super::part::OWN;
use super::sequence::difference_of;
use super::stats::error_words;
use super::{print_result, say};
use crate::film::part::{Entry, PartError, PartFile};
use crate::film::{Aov, Film, Metadata, Patch, Window};
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;

/// What a share says of itself that another of the same render says otherwise.
const FREE: &[&str] = &[
    "part.shard",
    "part.samples",
    "part.tiles",
    "part.noise",
    "part.pilot",
];

/// Puts the parts together and writes the image.
pub(crate) fn run(args: &MergeArgs) -> Result<(), Failure> {
    let mut parts = Vec::new();
    for path in &args.parts {
        parts.push((path.as_path(), open(path)?));
    }
    let plan = Plan::of(&parts)?;
    let output = Output::choose(Some(&args.output), Path::new(""), &plan.aovs)?;
    if output.path.is_none() {
        return Err(Failure::usage("an image has a name", "-o FILE.exr"));
    }
    let gaps = plan.check(&parts)?;
    if let (Some(gap), false) = (&gaps, args.allow_gaps) {
        return Err(Failure::usage(
            gap,
            "render what is missing, or give --allow-gaps to see what there is",
        ));
    }
    let merged = plan.film(&mut parts)?;
    let metadata = match gaps {
        None => plan.metadata.clone(),
        Some(_) => plan.metadata_with_gaps(&merged.film),
    };
    let encoding = Encoding::new(output.format, metadata, plan.exposure, &plan.aovs);
    output.write(&merged.film, &encoding)?;
    print_result(format!("{output}\n").as_bytes())?;
    tell(&output, &plan, &merged, gaps.as_deref(), parts.len());
    Ok(())
}

fn tell(output: &Output, plan: &Plan, merged: &Merged, gaps: Option<&str>, parts: usize) {
    let (width, height) = plan.size;
    say(&format!(
        "{output} · {width}×{height} · {} spp · of {parts} {} · {}",
        plan.spp,
        if parts == 1 { "part" } else { "parts" },
        error_words(merged.film.error().as_ref()),
    ));
    if let Some(gap) = gaps {
        say(&format!("warning: {gap}"));
    }
    let lost = merged.film.total_non_finite();
    if lost > 0 {
        let frame = plan.metadata.value("frame").unwrap_or("0");
        let mut some = merged.lost.clone();
        some.sort_unstable();
        let names = some.iter().take(4);
        let names: String = names
            .map(|(y, x, sample)| format!("\n  {frame},{x},{y},{sample}"))
            .collect();
        say(&format!(
            "warning: {lost} samples were not finite and were left out of their pixels' means; \
             `luxel render --replay` shows how one came about:{names}"
        ));
    }
}

/// A part film of this luxel's, whole.
pub(super) fn open(path: &Path) -> Result<PartFile, Failure> {
    const HINT: &str = "render it again: `luxel info` on another part of it shows the line";
    let file = PartFile::open(path).map_err(|e| match e {
        PartError::Io(e) if e.kind() == ErrorKind::NotFound => Failure::no_input(path, &e),
        e => Failure::bad_part(path, &e, HINT),
    })?;
    let version = file.header.value("version").unwrap_or("?");
    if version != env!("CARGO_PKG_VERSION") {
        let reason = format!(
            "it was made by luxel {version}, and this is {}",
            env!("CARGO_PKG_VERSION")
        );
        let hint = "take the luxel that made it, or render it again";
        return Err(Failure::bad_part(path, &reason, hint));
    }
    Ok(file)
}

/// What the parts are of.
struct Plan {
    size: (u32, u32),
    spp: u32,
    aovs: Vec<Aov>,
    exposure: f64,
    /// The image's.
    metadata: Metadata,
    /// By row and column: the patches of a window, in the order of their samples, and whose they are.
    windows: BTreeMap<(u32, u32), Vec<(usize, Entry)>>,
}

struct Merged {
    film: Film,
    /// Row, column and index of samples that were left out.
    lost: Vec<(u32, u32, u32)>,
}

impl Plan {
    /// Refuses parts of different renders.
    fn of(parts: &[(&Path, PartFile)]) -> Result<Plan, Failure> {
        let (first, file) = &parts[0];
        for (path, other) in &parts[1..] {
            if let Some(difference) = difference_of(&other.header, &file.header, FREE) {
                return Err(Failure::usage(
                    format!(
                        "\"{}\" is of another render than \"{}\": it {difference}",
                        path.display(),
                        first.display()
                    ),
                    "give parts of one render: of the same scene, files and settings",
                ));
            }
        }
        let bad = || Failure::bad_part(first, &"its header makes no sense", "render it again");
        let number = |key| file.header.value(key)?.parse().ok();
        let size = file.header.value("size").and_then(|s| s.split_once('x'));
        let size = size.and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
        let mut plan = Plan {
            size: size.ok_or_else(bad)?,
            spp: number("spp").ok_or_else(bad)?,
            aovs: aovs_of(&file.header).ok_or_else(bad)?,
            exposure: file
                .header
                .value("part.exposure")
                .and_then(|e| e.parse().ok())
                .ok_or_else(bad)?,
            metadata: image_metadata(&file.header),
            windows: BTreeMap::new(),
        };
        for (whose, (_, part)) in parts.iter().enumerate() {
            for entry in part.entries.iter().filter(|e| e.first < e.done) {
                let place = (entry.window.y, entry.window.x);
                plan.windows.entry(place).or_default().push((whose, *entry));
            }
        }
        for entries in plan.windows.values_mut() {
            entries.sort_by_key(|(_, entry)| entry.first);
        }
        Ok(plan)
    }

    /// What is missing, if anything is; what is there twice is an error.
    fn check(&self, parts: &[(&Path, PartFile)]) -> Result<Option<String>, Failure> {
        let name = |whose: usize| format!("\"{}\"", parts[whose].0.display());
        let mut gap = None;
        let mut covered = Covered::new(self.size);
        for entries in self.windows.values() {
            let (whose, first) = entries[0];
            let window = first.window;
            if entries.iter().any(|(_, e)| e.window != window) || !covered.add(window) {
                return Err(Failure::usage(
                    format!("{} is cut into other tiles than the others", name(whose)),
                    "render all shares with the same --tile",
                ));
            }
            let mut done = 0;
            for (i, (whose, entry)) in entries.iter().enumerate() {
                if entry.first < done {
                    return Err(overlap(name(entries[i - 1].0), name(*whose), entry, done));
                }
                if entry.first > done {
                    gap.get_or_insert_with(|| missing(done, entry.first, window));
                }
                done = entry.done;
            }
            if done < self.spp {
                gap.get_or_insert_with(|| missing(done, self.spp, window));
            }
        }
        Ok(gap.or_else(|| covered.hole()))
    }

    /// Adds the patches of every window, one window after the other.
    fn film(&self, parts: &mut [(&Path, PartFile)]) -> Result<Merged, Failure> {
        let mut merged = Merged {
            film: Film::new(self.size.0, self.size.1),
            lost: Vec::new(),
        };
        let (features, ids) = (
            self.aovs.iter().any(|aov| aov.is_feature()),
            self.aovs.iter().any(|aov| aov.is_id()),
        );
        for entries in self.windows.values() {
            let mut whole: Option<Patch> = None;
            for (whose, entry) in entries {
                let (path, file) = &mut parts[*whose];
                let patch = file.patch(entry).ok();
                let patch = patch.filter(|patch| patch.fits(self.size, features, ids));
                let patch = patch.ok_or_else(|| {
                    let reason = "its patches do not fit its header";
                    Failure::bad_part(path, &reason, "render it again")
                })?;
                match &mut whole {
                    None => whole = Some(patch),
                    Some(whole) => whole.append(patch),
                }
            }
            if let Some(patch) = whole {
                let w = patch.window;
                let place = |[pixel, sample]: &[u32; 2]| {
                    (w.y + pixel / w.width, w.x + pixel % w.width, *sample)
                };
                merged.lost.extend(patch.lost.iter().map(place));
                merged.film.put(w, &patch.into_planes());
            }
        }
        Ok(merged)
    }

    /// An image with gaps is none that a render makes, and says so.
    fn metadata_with_gaps(&self, film: &Film) -> Metadata {
        let mut metadata = self.metadata.clone();
        let pixels = film.pixels() as u64;
        let held = film.total_samples() + film.total_non_finite();
        metadata.push(
            "gaps",
            format!("{held} of {} samples", pixels * u64::from(self.spp)),
        );
        metadata
    }
}

fn overlap(one: String, other: String, entry: &Entry, done: u32) -> Failure {
    let end = done.min(entry.done);
    let w = entry.window;
    Failure::usage(
        format!(
            "{one} and {other} both have samples {}..{end} of the tile at ({}, {})",
            entry.first, w.x, w.y
        ),
        "give each share once",
    )
}

fn missing(from: u32, to: u32, window: Window) -> String {
    format!(
        "no part has samples {from}..{to} of the tile at ({}, {})",
        window.x, window.y
    )
}

/// Which pixels are in a window.
struct Covered {
    size: (u32, u32),
    pixels: Vec<bool>,
}

impl Covered {
    fn new(size: (u32, u32)) -> Covered {
        Covered {
            size,
            pixels: vec![false; size.0 as usize * size.1 as usize],
        }
    }

    /// Marks a window; false if it leaves the image or meets another.
    fn add(&mut self, w: Window) -> bool {
        let inside = |from: u32, length: u32, whole: u32| {
            from.checked_add(length).is_some_and(|end| end <= whole)
        };
        if !inside(w.x, w.width, self.size.0) || !inside(w.y, w.height, self.size.1) {
            return false;
        }
        (w.y..w.y + w.height).all(|y| {
            let start = y as usize * self.size.0 as usize + w.x as usize;
            let row = &mut self.pixels[start..start + w.width as usize];
            let free = row.iter().all(|there| !there);
            row.fill(true);
            free
        })
    }

    fn hole(&self) -> Option<String> {
        let at = self.pixels.iter().position(|there| !there)?;
        let width = self.size.0 as usize;
        Some(format!(
            "no part has pixel ({}, {})",
            at % width,
            at / width
        ))
    }
}

/// The auxiliary images that a part was rendered for.
pub(super) fn aovs_of(header: &Metadata) -> Option<Vec<Aov>> {
    let list = header.value("part.aov")?;
    let names = list.split(',').filter(|name| *name != "none");
    names
        .map(|name| Aov::ALL.into_iter().find(|aov| aov.name() == name))
        .collect()
}

/// What the image of a part will say.
pub(super) fn image_metadata(header: &Metadata) -> Metadata {
    let mut metadata = Metadata::default();
    for (key, value) in header.entries().filter(|(key, _)| !key.starts_with(OWN)) {
        metadata.push(key, value);
    }
    metadata
}
