//! What a checkpoint costs: of the largest usual film, with everything that a file can hold.

use luxel::film::part::{PartWriter, encode_patch};
use luxel::film::{Metadata, Patch, Sums, Window, write_streamed};
use nix::time::{ClockId, clock_gettime};
use std::path::Path;
use std::time::{Duration, Instant};

/// Side of a tile, and how many there are in 3840×2160 pixels: 120 × 67.5.
const SIDE: u32 = 32;
const TILES: usize = 8100;

/// How often a render is saved.
const EVERY: Duration = Duration::from_secs(60);

/// A tile after 48 samples: of two nodes. Passes are of 16, so that of a render of 64 no tile has more for long.
fn tile() -> Patch {
    let window = Window {
        x: 0,
        y: 0,
        width: SIDE,
        height: SIDE,
    };
    let pixels = (SIDE * SIDE) as usize;
    let mut patch = Patch::new(window, 0, false);
    let three = || vec![[0.1; 3]; pixels];
    for end in [1, 2, 4, 8, 16, 24, 32, 40, 48] {
        patch.open = Sums {
            rgb: three(),
            rgb_squared: three(),
            albedo: three(),
            normal: three(),
            geonormal: three(),
            depth: vec![0.1; pixels],
        };
        patch.advance(end, &mut Sums::default());
    }
    for counts in [
        &mut patch.count,
        &mut patch.non_finite,
        &mut patch.hit_count,
    ] {
        *counts = vec![48; pixels];
    }
    patch.uv = vec![[0.5; 2]; pixels];
    (patch.prim, patch.entity) = (vec![7; pixels], vec![7; pixels]);
    patch
}

fn of_this_thread() -> Duration {
    let now = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).expect("Linux");
    Duration::new(now.tv_sec() as u64, now.tv_nsec() as u32)
}

/// What one saving took: bytes, processor time, and time until it was on the disk.
fn save(path: &Path, tiles: &[Patch]) -> (usize, Duration, Duration) {
    let (wall, cpu) = (Instant::now(), of_this_thread());
    let mut bytes = 0;
    let saved = write_streamed(path, |out| {
        let mut part = PartWriter::begin(out, &Metadata::default(), TILES as u32)?;
        let mut buffer = Vec::new();
        for tile in tiles.iter().cycle().take(TILES) {
            encode_patch(tile, &mut buffer);
            part.patch(&buffer)?;
            bytes += buffer.len();
        }
        part.finish().map(drop)
    });
    saved.expect("room");
    (bytes, of_this_thread() - cpu, wall.elapsed())
}

/// `cargo test --release --test parts percent -- --ignored --nocapture`, half a minute and 3 GB of disk. Saving is a thread's
/// beside those that trace: its share is of what all cores do in the time. The least of three, since others use the machine.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "writes 3 GB"]
fn a_checkpoint_a_minute_costs_under_a_percent() {
    let path = std::env::temp_dir().join(format!("luxel-cost-{}.part", std::process::id()));
    // As many different ones as no cache holds.
    let tiles: Vec<Patch> = vec![tile(); 256];
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut least = f64::INFINITY;
    for _ in 0..3 {
        let (bytes, cpu, wall) = save(&path, &tiles);
        let share = cpu.as_secs_f64() / (EVERY.as_secs_f64() * cores as f64);
        println!(
            "{} MB: {cpu:.2?} of one thread, {:.2} % of {cores} cores; {wall:.2?} until it is on the disk",
            bytes >> 20,
            100.0 * share
        );
        least = least.min(share);
    }
    std::fs::remove_file(&path).expect("ours");
    assert!(least < 0.01, "{least}");
}
