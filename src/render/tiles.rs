//! Tiles over threads.

use super::Control;
use super::passes::Passes;
use crate::trace::{Rect, TileSums};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Samples traced between two looks at [`Control::stopped`]: a tile's worth is some tens of milliseconds.
const SAMPLES_PER_LOOK: u32 = 8;

/// A tile and its sums so far.
pub(super) type Tile = (Rect, TileSums);

/// The tiles of an image, row by row; those at the right and at the bottom may be smaller.
pub(super) fn cut(width: u32, height: u32, side: u32) -> Vec<Tile> {
    let starts = |length: u32| (0..length).step_by(side as usize);
    starts(height)
        .flat_map(|y| starts(width).map(move |x| (x, y)))
        .map(|(x, y)| Rect {
            x,
            y,
            width: side.min(width - x),
            height: side.min(height - y),
        })
        .map(|rect| (rect, TileSums::default()))
        .collect()
}

/// Traces every tile in every pass on the threads of the current pool, each of which makes one worker per pass, and
/// returns the samples per pixel of the passes that were completed. Within a tile the calls are in the order of the
/// sample index, with the same sums, whoever makes them.
pub(super) fn run<W>(
    tiles: &mut [Tile],
    mut passes: Passes,
    control: &Control,
    worker: impl Fn() -> W + Sync,
) -> u32
where
    W: FnMut(Rect, Range<u32>, &mut TileSums),
{
    let mut complete = 0;
    while let Some(pass) = passes.next_pass() {
        // One lock per tile and pass.
        let queue = Mutex::new(tiles.iter_mut());
        rayon::broadcast(|_| {
            let mut trace = worker();
            while let Some((rect, sums)) = next(&queue) {
                trace_pass(*rect, pass.clone(), control, |samples| {
                    trace(*rect, samples, sums);
                });
            }
        });
        if control.stopped() {
            break;
        }
        complete = pass.end;
    }
    complete
}

fn next<'a>(queue: &Mutex<std::slice::IterMut<'a, Tile>>) -> Option<&'a mut Tile> {
    // Taking the next of an iterator cannot leave it half done.
    let mut queue = queue.lock().unwrap_or_else(PoisonError::into_inner);
    queue.next()
}

/// One tile's samples of a pass, in pieces, unless the render was stopped.
fn trace_pass(rect: Rect, pass: Range<u32>, control: &Control, mut trace: impl FnMut(Range<u32>)) {
    let pixels = u64::from(rect.width) * u64::from(rect.height);
    for first in pass.clone().step_by(SAMPLES_PER_LOOK as usize) {
        if control.stopped() {
            return;
        }
        let end = pass.end.min(first + SAMPLES_PER_LOOK);
        trace(first..end);
        control.add(pixels * u64::from(end - first));
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
        let mut tiles = cut(width, height, side);
        let control = Control::default();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let complete = pool
            .expect("threads")
            .install(|| run(&mut tiles, Passes::new(spp, None), &control, || fake));
        assert_eq!(complete, spp);
        assert_eq!(control.progress().0, u64::from(width * height * spp));
        assemble(width, height, tiles)
    }

    #[test]
    fn threads_and_tiles_change_no_bit() {
        let mut whole = cut(37, 23, 64);
        fake(whole[0].0, 0..45, &mut whole[0].1);
        let expected = assemble(37, 23, whole);
        for (threads, side) in [(1, 8), (2, 8), (5, 7), (2, 1), (3, 64)] {
            let film = film(threads, side);
            assert_eq!(film.planes(), expected.planes(), "{threads} {side}");
        }
    }

    #[test]
    fn a_stop_ends_early_and_keeps_what_there_is() {
        let mut tiles = cut(16, 16, 8);
        let control = Control::default();
        let trace = |rect: Rect, samples: Range<u32>, sums: &mut TileSums| {
            if samples.start >= 4 {
                control.stop();
            }
            fake(rect, samples, sums);
        };
        let complete = run(&mut tiles, Passes::new(1000, None), &control, || trace);
        assert_eq!(complete, 4);
        let film = assemble(16, 16, tiles);
        assert!(film.planes().count.iter().all(|&n| (4..16).contains(&n)));
    }
}
