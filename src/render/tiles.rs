//! Tiles over threads.

use super::Control;
use super::canvas::{Tile, lock};
use super::passes::{Pass, Passes};
use crate::film::{Blocks, Patch, Sums, Window};
use crate::trace::{LostSample, Rect, Tallies, TileSums};
use std::mem::take;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Traces every tile in every pass on the threads of the current pool, each of which makes one worker per pass, and
/// returns the samples per pixel of the passes that were completed, or `done` if there is none. Within a tile the calls are
/// in the order of the sample index, with the same sums, whoever makes them; samples that a tile has already are passed over.
/// `watch` is told after each of these passes.
pub(super) fn run<W>(
    tiles: &[Mutex<Tile>],
    mut passes: Passes,
    control: &Control,
    mut watch: impl FnMut(u32),
    worker: impl Fn() -> W + Sync,
) -> u32
where
    W: FnMut(Rect, Range<u32>, &mut TileSums),
{
    let mut complete = passes.done();
    while let Some(pass) = passes.next_pass() {
        let next = AtomicUsize::new(0);
        rayon::broadcast(|_| {
            let (mut trace, mut spare) = (worker(), Sums::default());
            while let Some(tile) = tiles.get(next.fetch_add(1, Ordering::Relaxed)) {
                trace_pass(&mut lock(tile), &pass, control, &mut trace, &mut spare);
            }
        });
        if control.stopped() || pass.until.is_some() {
            break;
        }
        complete = pass.samples.end;
        watch(complete);
    }
    complete
}

/// One tile's samples of a pass, unless the render was stopped: in pieces that end where blocks of samples do. A tile's
/// piece takes some tens of milliseconds.
fn trace_pass(
    tile: &mut Tile,
    pass: &Pass,
    control: &Control,
    trace: &mut impl FnMut(Rect, Range<u32>, &mut TileSums),
    spare: &mut Sums,
) {
    let Tile { patch, goal } = tile;
    let end = pass.samples.end.min(*goal);
    let rect = rect(patch.window);
    let pixels = u64::from(rect.width) * u64::from(rect.height);
    let late = || pass.until.is_some_and(|until| Instant::now() >= until);
    while patch.done < end && !control.stopped() && !late() {
        let samples = patch.done..end.min(Blocks::next(patch.done));
        let mut sums = lend(patch);
        trace(rect, samples.clone(), &mut sums);
        take_back(patch, sums);
        patch.advance(samples.end, spare);
        control.add(pixels * samples.len() as u64);
    }
}

fn rect(window: Window) -> Rect {
    Rect {
        x: window.x,
        y: window.y,
        width: window.width,
        height: window.height,
    }
}

/// Moves the arrays of a patch to where tracing adds to them: it may not know the film, nor the film tracing.
fn lend(patch: &mut Patch) -> TileSums {
    let lost = take(&mut patch.lost).into_iter();
    TileSums {
        rgb: take(&mut patch.open.rgb),
        rgb_squared: take(&mut patch.open.rgb_squared),
        count: take(&mut patch.count),
        non_finite: take(&mut patch.non_finite),
        lost: lost
            .map(|[pixel, sample]| LostSample { pixel, sample })
            .collect(),
        hit_count: take(&mut patch.hit_count),
        albedo: take(&mut patch.open.albedo),
        normal: take(&mut patch.open.normal),
        geonormal: take(&mut patch.open.geonormal),
        depth: take(&mut patch.open.depth),
        uv: take(&mut patch.uv),
        prim: take(&mut patch.prim),
        entity: take(&mut patch.entity),
        cost: Tallies::default(),
    }
}

/// Moves them back.
fn take_back(patch: &mut Patch, sums: TileSums) {
    patch.open = Sums {
        rgb: sums.rgb,
        rgb_squared: sums.rgb_squared,
        albedo: sums.albedo,
        normal: sums.normal,
        geonormal: sums.geonormal,
        depth: sums.depth,
    };
    patch.count = sums.count;
    patch.non_finite = sums.non_finite;
    patch.hit_count = sums.hit_count;
    patch.uv = sums.uv;
    patch.prim = sums.prim;
    patch.entity = sums.entity;
    let lost = sums.lost.into_iter();
    patch.lost = lost.map(|lost| [lost.pixel, lost.sample]).collect();
}

#[cfg(test)]
mod tests {
    use super::super::canvas::{Canvas, Share};
    use super::*;
    use crate::film::Film;

    const SIZE: (u32, u32) = (37, 23);
    const SPP: u32 = 45;

    /// Sums whose last bits depend on the order of addition.
    fn fake(rect: Rect, samples: Range<u32>, sums: &mut TileSums) {
        let pixels = (rect.width * rect.height) as usize;
        sums.rgb.resize(pixels, [0.0; 3]);
        sums.count.resize(pixels, 0);
        for i in 0..pixels as u32 {
            let (x, y) = (rect.x + i % rect.width, rect.y + i / rect.width);
            for s in samples.clone() {
                let value = 1.0 / f64::from(1 + x + 31 * y + 977 * s);
                let sum = &mut sums.rgb[i as usize];
                *sum = sum.map(|v| v + value);
                sums.count[i as usize] += 1;
            }
        }
    }

    /// Traces what of `canvas` is missing up to `spp`.
    fn trace(canvas: &Canvas, threads: usize, spp: u32) {
        let control = Control::default();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let passes = Passes::new(canvas.done().0, spp, None);
        let complete = pool
            .expect("threads")
            .install(|| run(&canvas.tiles, passes, &control, |_| (), || fake));
        assert_eq!(complete, spp);
        assert_eq!(canvas.done(), (spp, spp));
    }

    fn film(threads: usize, side: u32) -> Film {
        let canvas = Canvas::blank(SIZE, side, &Share::default(), false);
        trace(&canvas, threads, SPP);
        assert_eq!(canvas.samples(), u64::from(37 * 23 * SPP));
        canvas.into_film()
    }

    #[test]
    fn threads_and_tiles_change_no_bit() {
        let expected = film(1, 64);
        for (threads, side) in [(1, 8), (2, 8), (5, 7), (2, 1), (3, 64)] {
            let film = film(threads, side);
            assert_eq!(film.planes(), expected.planes(), "{threads} {side}");
        }
    }

    /// Stopped wherever it may, some tiles further than others: the rest gives the bits of one go.
    #[test]
    fn going_on_changes_no_bit() {
        let expected = film(1, 8);
        for at in [1, 2, 3, 5, 8, 12, 16, 40] {
            let canvas = Canvas::blank(SIZE, 8, &Share::default(), false);
            trace(&canvas, 1, at);
            trace_pass(
                &mut lock(&canvas.tiles[3]),
                &Pass {
                    samples: at..at + 3,
                    until: None,
                },
                &Control::default(),
                &mut fake,
                &mut Sums::default(),
            );
            assert_eq!(canvas.done(), (at, at + 3));
            let patches = canvas.patches().map(|patch| patch.clone()).collect();
            let again = Canvas::of_patches(SIZE, &Share::default(), patches);
            trace(&again, 2, SPP);
            assert_eq!(again.film().planes(), expected.planes(), "{at}");
        }
    }

    #[test]
    fn shares_put_together_change_no_bit() {
        let expected = film(1, 8);
        let halves = [0..16, 16..SPP].map(|samples| {
            let end = samples.end;
            let share = Share {
                samples: Some(samples),
                tiles: None,
            };
            let canvas = Canvas::blank(SIZE, 8, &share, false);
            trace(&canvas, 2, end);
            canvas
        });
        let mut film = Film::new(SIZE.0, SIZE.1);
        for (first, second) in halves[0].patches().zip(halves[1].patches()) {
            let mut patch = first.clone();
            patch.append(second.clone());
            film.put(patch.window, &patch.into_planes());
        }
        assert_eq!(film.planes(), expected.planes());
        let mut film = Film::new(SIZE.0, SIZE.1);
        for part in 0..3 {
            let share = Share {
                samples: None,
                tiles: Some((part, 3)),
            };
            let canvas = Canvas::blank(SIZE, 8, &share, false);
            trace(&canvas, 1, SPP);
            for patch in canvas.patches() {
                film.put(patch.window, &patch.clone().into_planes());
            }
        }
        assert_eq!(film.planes(), expected.planes());
    }

    #[test]
    fn a_stop_ends_early_and_keeps_what_there_is() {
        let canvas = Canvas::blank((16, 16), 8, &Share::default(), false);
        let control = Control::default();
        let trace = |rect: Rect, samples: Range<u32>, sums: &mut TileSums| {
            if samples.start >= 4 {
                control.stop();
            }
            fake(rect, samples, sums);
        };
        let passes = Passes::new(0, 1000, None);
        let complete = run(&canvas.tiles, passes, &control, |_| (), || trace);
        assert_eq!(complete, 4);
        let film = canvas.into_film();
        assert!(film.planes().count.iter().all(|&n| (4..16).contains(&n)));
    }
}
