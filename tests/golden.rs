//! Every scene under `tests/golden`, 8 × 8 pixels and one feature each, is the picture in its `.txt`: a line per pixel,
//! linear R G B, to the bit, whatever the machine, the instruction set and the threads.
//!
//! `BLESS=1` writes the pictures and fails, so that nothing approves itself: look at the differences, say why, run again.
//! What a picture should be is the business of the reference tracer (`tests/light`); these only notice a change.

use luxel::render::{Control, Renderer, Settings};
use luxel::trace::Isa;
use luxel::{scene, world};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// The frame that is rendered: scenes that turn have turned.
const FRAME: u32 = 5;

fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let entries = fs::read_dir(folder).expect("the folder of golden scenes");
    let mut scenes: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "ron"))
        .collect();
    scenes.sort();
    scenes
}

fn picture(path: &Path, isa: Isa) -> Vec<[f32; 3]> {
    let desc = scene::load(path).expect("a scene").desc;
    let spawned = world::spawn(&desc, luxel::asset::Loader::new()).expect("its files");
    let mut settings = Settings::of_scene(&desc);
    settings.trace.isa = isa;
    let renderer = Renderer::new(&desc, spawned.world, &spawned.assets, settings);
    let mut renderer = renderer.expect("threads");
    renderer.render(FRAME, &Control::default()).film.radiance()
}

fn text(pixels: &[[f32; 3]]) -> String {
    let mut text = String::new();
    for [r, g, b] in pixels {
        writeln!(text, "{r:?} {g:?} {b:?}").expect("a string takes all");
    }
    text
}

fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace()
        .map(|n| n.parse().unwrap_or(f64::NAN))
        .collect()
}

#[test]
fn pictures_are_to_the_bit_what_they_were() {
    let bless = std::env::var_os("BLESS").is_some_and(|v| v == "1");
    let mut wrong = Vec::new();
    for path in scenes() {
        let found = text(&picture(&path, Isa::best()));
        let expectation = path.with_extension("txt");
        let wanted = fs::read_to_string(&expectation).unwrap_or_default();
        if found == wanted {
            continue;
        }
        let (a, b) = (numbers(&found), numbers(&wanted));
        let differences = a
            .iter()
            .zip(&b)
            .map(|(a, b)| (a - b).abs() / (b.abs() + 1e-3));
        let largest = differences.clone().fold(0.0, f64::max);
        let many = differences.filter(|&d| d > 0.0).count();
        wrong.push(format!(
            "{}: {many} of {} numbers differ, by {largest:.1e} at most",
            path.display(),
            a.len()
        ));
        if bless {
            fs::write(&expectation, found).expect("the picture is written");
        }
    }
    assert!(
        !bless,
        "blessed; run again without BLESS\n{}",
        wrong.join("\n")
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn instruction_sets_agree() {
    for path in scenes() {
        let first = picture(&path, Isa::SCALAR);
        assert!(
            first.iter().flatten().any(|&c| c > 0.0),
            "{} is black",
            path.display()
        );
        for isa in Isa::all() {
            assert_eq!(
                text(&first),
                text(&picture(&path, isa)),
                "{} {}",
                path.display(),
                isa.level()
            );
        }
    }
}
