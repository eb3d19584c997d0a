//! Damaged files never panic, hang or eat the memory: they are refused, or load and render to finite pixels.
//!
//! Every file goes the way that `luxel render` takes it: `scene::parse`, `world::spawn`, the build, and a picture of
//! 4 × 4 pixels of what loads. Each may take [`MAX_TIME`] and [`MAX_MEMORY`]. The long run, with the collection of real
//! files as seeds, for a release:
//!
//! ```text
//! LUXEL_DATA=../shared/data cargo test --release --test mutate -- --ignored --nocapture
//! ```
//!
//! `LUXEL_MUTANT=N` runs the file of that number alone, and leaves it in the temporary folder.

mod memory;
mod mutator;
mod seeds;
#[path = "../support/mod.rs"]
mod support;

use luxel::asset::{Limits, Loader};
use luxel::render::{Control, Renderer, Settings};
use luxel::{scene, world};
use seeds::{SUFFIXES, Seed, seeds};
use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};
use support::Rng;

/// A file that takes longer is run once more, since a busy machine is no fault of it.
const MAX_TIME: Duration = Duration::from_secs(2);
/// Bytes allocated at any moment.
const MAX_MEMORY: usize = 1 << 30;
/// A file that takes so long is taken to hang.
const HANG: Duration = Duration::from_secs(120);

const QUICK: u64 = 1_500;
const LONG: u64 = 100_000;

#[test]
fn damaged_files_are_refused_or_rendered() {
    run(QUICK);
}

#[test]
#[ignore = "minutes: see the head of this file"]
fn a_hundred_thousand_damaged_files_are_refused_or_rendered() {
    run(LONG);
}

/// How a file ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Refused,
    Rendered,
    /// Rendered, and some samples were not finite: they are left out of the sums, and counted.
    NotFinite,
}

/// What a file cost.
struct Cost {
    time: Duration,
    memory: usize,
}

fn run(count: u64) {
    let only = std::env::var("LUXEL_MUTANT")
        .ok()
        .and_then(|number| number.parse().ok());
    let numbers = only.map_or(0..count, |number| number..number + 1);
    let (tell, told) = channel();
    let worker = std::thread::spawn(move || {
        let mutants = Mutants::new();
        for number in numbers {
            let ran = catch_unwind(AssertUnwindSafe(|| mutants.run(number)));
            if tell.send((number, ran.map_err(drop))).is_err() {
                return;
            }
        }
        if only.is_none() {
            let _ = fs::remove_dir_all(&mutants.folder);
        }
    });
    let mut ends: BTreeMap<(&str, End), u64> = BTreeMap::new();
    let mut wrong = Vec::new();
    let (mut slowest, mut largest) = ((Duration::ZERO, 0), (0, 0));
    let start = Instant::now();
    let mut next = 0;
    loop {
        match told.recv_timeout(HANG) {
            Ok((number, Ok((suffix, end, cost)))) => {
                next = number + 1;
                *ends.entry((suffix, end)).or_default() += 1;
                slowest = slowest.max((cost.time, number));
                largest = largest.max((cost.memory, number));
                if cost.time > MAX_TIME || cost.memory > MAX_MEMORY {
                    wrong.push(format!("{number}: {:?}, {} bytes", cost.time, cost.memory));
                }
            }
            Ok((number, Err(()))) => {
                next = number + 1;
                wrong.push(format!("{number}: panicked"));
            }
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => panic!("file {next} hangs (LUXEL_MUTANT={next})"),
        }
    }
    worker.join().expect("the worker");
    println!(
        "{} files in {:?}",
        ends.values().sum::<u64>(),
        start.elapsed()
    );
    println!("slowest {slowest:?}, largest {largest:?}");
    for ((suffix, end), count) in &ends {
        println!("{suffix:>5} {end:?}: {count}");
    }
    assert!(
        wrong.is_empty(),
        "LUXEL_MUTANT=N runs one:\n{}",
        wrong.join("\n")
    );
    if only.is_none() {
        assert_eq!(ends.values().sum::<u64>(), count);
        for suffix in SUFFIXES.into_iter().filter(|suffix| *suffix != "jpeg") {
            let of = |end| ends.get(&(suffix, end)).copied().unwrap_or_default();
            assert!(
                of(End::Refused) > 0,
                "no {suffix} was refused: nothing was damaged"
            );
            assert!(
                of(End::Rendered) > 0,
                "no {suffix} was rendered: all is damaged too much"
            );
        }
    }
}

/// The seeds by kind, and the folder that damaged files are written to.
struct Mutants {
    seeds: Vec<(&'static str, Vec<Seed>)>,
    folder: PathBuf,
}

impl Mutants {
    fn new() -> Mutants {
        let mut by_suffix: BTreeMap<&str, Vec<Seed>> = BTreeMap::new();
        for seed in seeds() {
            by_suffix.entry(seed.suffix).or_default().push(seed);
        }
        let folder = std::env::temp_dir().join(format!("luxel-mutants-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        for (name, text) in [("m.obj", seeds::OBJ), ("m.mtl", seeds::MTL)] {
            fs::write(folder.join(name), text).expect("a file");
        }
        fs::write(
            folder.join("t.png"),
            seeds::image(png::ColorType::Rgba, png::BitDepth::Eight),
        )
        .expect("a file");
        let mutants = Mutants {
            seeds: by_suffix.into_iter().collect(),
            folder,
        };
        mutants.place_neighbours();
        mutants
    }

    /// Copies what glTF files name, buffers and images, to where their damaged copies will stand.
    fn place_neighbours(&self) {
        let of_gltf = self.seeds.iter().filter(|(suffix, _)| *suffix == "gltf");
        for (_, seeds) in of_gltf {
            for seed in seeds {
                let to = self.beside(&seed.folder);
                for (name, bytes) in seeds::neighbours(seed) {
                    let file = to.join(name);
                    fs::create_dir_all(file.parent().unwrap_or(&to)).expect("a folder");
                    fs::write(file, bytes).expect("a file");
                }
            }
        }
    }

    /// The folder for damaged files from a folder: one that holds their neighbours.
    fn beside(&self, from: &Path) -> PathBuf {
        let name: String = from.to_string_lossy().replace(['/', '\\', ':'], "_");
        let folder = self.folder.join(name);
        fs::create_dir_all(&folder).expect("a folder");
        folder
    }

    /// Damages and tries the file of a number.
    fn run(&self, number: u64) -> (&'static str, End, Cost) {
        let mut rng = Rng(number);
        let (suffix, seeds) = &self.seeds[rng.below(self.seeds.len())];
        let seed = &seeds[rng.below(seeds.len())];
        let other = &seeds[rng.below(seeds.len())];
        let bytes = mutator::mutate(&mut rng, &seed.bytes, &other.bytes);
        let (text, path) = self.scene(suffix, bytes, &seed.folder);
        let (mut end, mut cost) = measure(|| render(&text, &path));
        if cost.time > MAX_TIME {
            (end, cost) = measure(|| render(&text, &path));
        }
        (suffix, end, cost)
    }

    /// Writes the damaged file. Returns the text of a scene that uses it, and where that scene would stand.
    fn scene(&self, suffix: &str, bytes: Vec<u8>, from: &Path) -> (Vec<u8>, PathBuf) {
        let beside = match suffix {
            "gltf" => self.beside(from),
            _ => self.folder.clone(),
        };
        let write = |name: &str, bytes: &[u8]| {
            fs::write(beside.join(name), bytes).expect("a file");
        };
        if suffix == "ron" {
            let own = from.as_os_str().is_empty();
            let folder = if own { self.folder.as_path() } else { from };
            return (bytes, folder.join("mutant.ron"));
        }
        let name = format!("a.{suffix}");
        write(&name, &bytes);
        let background = match suffix {
            "hdr" | "exr" => format!("Hdr({name:?})"),
            _ => "Linear(1, 1, 1)".to_owned(),
        };
        let (image, entity) = match suffix {
            "obj" => (String::new(), format!("(shape: Mesh({name:?}))")),
            "mtl" => {
                write("b.obj", &triangle_of_each_material(&bytes));
                (String::new(), "(shape: Mesh(\"b.obj\"))".to_owned())
            }
            "hdr" | "exr" => (String::new(), "(shape: Sphere(radius: 1))".to_owned()),
            "gltf" | "glb" => (String::new(), format!("(gltf: {name:?})")),
            _ => (
                format!("\"image\": Diffuse(color: Texture({name:?}))"),
                "(shape: Sphere(radius: 1), material: \"image\")".to_owned(),
            ),
        };
        let text = format!(
            "Scene(version: 1, camera: (at: (1, 2, 5), look_at: (0, 0, 0)), background: {background},\n\
             materials: {{ {image} }}, entities: [{entity}])"
        );
        (text.into_bytes(), beside.join("scene.ron"))
    }
}

/// An OBJ file that uses the first materials of an MTL file.
fn triangle_of_each_material(mtl: &[u8]) -> Vec<u8> {
    let mut obj = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n".to_vec();
    let lines = mtl.split(|&byte| byte == b'\n');
    let names = lines.filter_map(|line| line.strip_prefix(b"newmtl "));
    for name in names.take(20) {
        obj.extend([b"usemtl ", name, b"\nf 1/1 2/2 3/3\n"].concat());
    }
    obj
}

fn measure(run: impl FnOnce() -> End) -> (End, Cost) {
    let start = Instant::now();
    let (end, memory) = memory::peak(run);
    let time = start.elapsed();
    (end, Cost { time, memory })
}

/// As `luxel render` does it, but small.
fn render(text: &[u8], path: &Path) -> End {
    let Ok(text) = std::str::from_utf8(text) else {
        return End::Refused;
    };
    let Ok((desc, _)) = scene::parse(text, path) else {
        return End::Refused;
    };
    let loader = Loader::with_limits(Limits {
        memory: MAX_MEMORY as u64 / 2,
    });
    let Ok(spawned) = world::spawn(&desc, loader) else {
        return End::Refused;
    };
    let settings = Settings {
        size: (4, 4),
        spp: 1,
        threads: Some(1),
        ..Settings::of_scene(&desc)
    };
    let mut renderer =
        Renderer::new(&desc, spawned.world, &spawned.assets, settings).expect("a thread");
    let film = renderer.render(0, &Control::default()).film;
    assert!(film.radiance().iter().flatten().all(|c| c.is_finite()));
    match film.total_non_finite() {
        0 => End::Rendered,
        _ => End::NotFinite,
    }
}
