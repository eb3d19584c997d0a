//! Tiles over threads.

use super::Control;
use super::passes::{Pass, Passes};
use crate::film::Blocks;
use crate::trace::{Rect, Sampler, TileSums};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// A tile and its sums so far.
#[derive(Clone)]
pub(super) struct Tile {
    pub(super) rect: Rect,
    pub(super) sums: TileSums,
    /// How blocks of its samples differ; where they are independent, that is no question.
    pub(super) blocks: Option<Blocks>,
}

/// The tiles of an image, row by row; those at the right and at the bottom may be smaller.
pub(super) fn cut((width, height): (u32, u32), side: u32, sampler: Sampler) -> Vec<Tile> {
    let starts = |length: u32| (0..length).step_by(side as usize);
    starts(height)
        .flat_map(|y| starts(width).map(move |x| (x, y)))
        .map(|(x, y)| Rect {
            x,
            y,
            width: side.min(width - x),
            height: side.min(height - y),
        })
        .map(|rect| Tile {
            rect,
            sums: TileSums::default(),
            blocks: (sampler == Sampler::Sobol).then(Blocks::default),
        })
        .collect()
}

/// Traces every tile in every pass on the threads of the current pool, each of which makes one worker per pass, and
/// returns the samples per pixel of the passes that were completed, or `done` if there is none. Within a tile the calls are in the order of the
/// sample index, with the same sums, whoever makes them. `watch` sees the tiles after each of these passes.
pub(super) fn run<W>(
    tiles: &mut [Tile],
    mut passes: Passes,
    control: &Control,
    mut watch: impl FnMut(&[Tile], u32),
    worker: impl Fn() -> W + Sync,
) -> u32
where
    W: FnMut(Rect, Range<u32>, &mut TileSums),
{
    let mut complete = passes.done();
    while let Some(pass) = passes.next_pass() {
        // One lock per tile and pass.
        let queue = Mutex::new(tiles.iter_mut());
        rayon::broadcast(|_| {
            let mut trace = worker();
            while let Some(tile) = next(&queue) {
                trace_pass(tile, &pass, control, &mut trace);
            }
        });
        if control.stopped() || pass.until.is_some() {
            break;
        }
        complete = pass.samples.end;
        watch(tiles, complete);
    }
    complete
}

fn next<'a>(queue: &Mutex<std::slice::IterMut<'a, Tile>>) -> Option<&'a mut Tile> {
    // Taking the next of an iterator cannot leave it half done.
    let mut queue = queue.lock().unwrap_or_else(PoisonError::into_inner);
    queue.next()
}

/// One tile's samples of a pass, unless the render was stopped: in pieces that end where blocks of samples do. A tile's
/// piece takes some tens of milliseconds.
fn trace_pass(
    tile: &mut Tile,
    pass: &Pass,
    control: &Control,
    trace: &mut impl FnMut(Rect, Range<u32>, &mut TileSums),
) {
    let pixels = u64::from(tile.rect.width) * u64::from(tile.rect.height);
    let late = || pass.until.is_some_and(|until| Instant::now() >= until);
    let mut first = pass.samples.start;
    while first < pass.samples.end && !control.stopped() && !late() {
        let block = Blocks::next(first);
        let end = pass.samples.end.min(block);
        trace(tile.rect, first..end, &mut tile.sums);
        if let Some(blocks) = &mut tile.blocks
            && end == block
        {
            blocks.take(end, &tile.sums.rgb);
        }
        control.add(pixels * u64::from(end - first));
        first = end;
    }
}

#[cfg(test)]
mod tests {
    use super::super::frame::assemble;
    use super::*;
    use crate::film::Film;

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

    fn film(threads: usize, side: u32) -> Film {
        let (width, height, spp) = (37, 23, 45);
        let mut tiles = cut((width, height), side, Sampler::Sobol);
        let control = Control::default();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let complete = pool.expect("threads").install(|| {
            run(
                &mut tiles,
                Passes::new(0, spp, None),
                &control,
                |_, _| (),
                || fake,
            )
        });
        assert_eq!(complete, spp);
        assert_eq!(control.progress().0, u64::from(width * height * spp));
        assemble(width, height, tiles)
    }

    #[test]
    fn threads_and_tiles_change_no_bit() {
        let mut whole = cut((37, 23), 64, Sampler::Sobol);
        fake(whole[0].rect, 0..45, &mut whole[0].sums);
        let in_one_go = assemble(37, 23, whole);
        let expected = film(1, 64);
        assert_eq!(expected.planes().rgb, in_one_go.planes().rgb);
        for (threads, side) in [(1, 8), (2, 8), (5, 7), (2, 1), (3, 64)] {
            let film = film(threads, side);
            assert_eq!(film.planes(), expected.planes(), "{threads} {side}");
        }
    }

    #[test]
    fn a_stop_ends_early_and_keeps_what_there_is() {
        let mut tiles = cut((16, 16), 8, Sampler::Sobol);
        let control = Control::default();
        let trace = |rect: Rect, samples: Range<u32>, sums: &mut TileSums| {
            if samples.start >= 4 {
                control.stop();
            }
            fake(rect, samples, sums);
        };
        let complete = run(
            &mut tiles,
            Passes::new(0, 1000, None),
            &control,
            |_, _| (),
            || trace,
        );
        assert_eq!(complete, 4);
        let film = assemble(16, 16, tiles);
        assert!(film.planes().count.iter().all(|&n| (4..16).contains(&n)));
    }
}
