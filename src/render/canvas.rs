//! The sums of a frame while it is traced: tile by tile, each behind a lock of its own, so that they may be looked at, and
//! saved, at any moment while others are traced. What a tile has at such a moment is whole by itself: it may have a few samples
//! more than another.

use super::Settings;
use super::pilot::Verdict;
use crate::film::{Film, Patch, Window};
use crate::trace::Sampler;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// Which of a frame's samples are to be traced.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Share {
    /// These of each pixel; all that [`Settings`] ask for if not said. The ends are those of blocks ([`crate::film::Blocks::may_end`]).
    pub samples: Option<Range<u32>>,
    /// The first of these in every so many tiles; all if not said.
    pub tiles: Option<(u32, u32)>,
}

/// All tiles of a frame, or some.
#[derive(Debug)]
pub struct Canvas {
    size: (u32, u32),
    /// One after the last sample that is to be traced, if that is not as [`Settings`] say.
    pub(super) end: Option<u32>,
    pub(super) tiles: Vec<Mutex<Tile>>,
    /// What the pilot found, once it is known.
    pub(super) verdict: OnceLock<Verdict>,
}

/// A tile and its sums so far.
#[derive(Clone, Debug)]
pub(super) struct Tile {
    pub(super) patch: Patch,
    /// One after the last sample that it is to have, if it has not all by then.
    pub(super) goal: u32,
}

impl Canvas {
    /// Without a sample.
    #[must_use]
    pub fn new(settings: &Settings, share: &Share) -> Canvas {
        let independent = settings.trace.sampler == Sampler::Independent;
        Canvas::blank(settings.size, settings.side(), share, independent)
    }

    /// Says how many samples each tile is to have.
    pub(super) fn set_goals(&self, goals: &[u32]) {
        for (tile, &goal) in self.tiles.iter().zip(goals) {
            lock(tile).goal = goal;
        }
    }

    pub(super) fn blank(size: (u32, u32), side: u32, share: &Share, independent: bool) -> Canvas {
        let first = share.samples.as_ref().map_or(0, |range| range.start);
        let (part, parts) = share.tiles.unwrap_or((0, 1));
        let own = cut(size, side).skip(part as usize).step_by(parts as usize);
        let patches = own.map(|window| Patch::new(window, first, independent));
        Canvas::of_patches(size, share, patches.collect())
    }

    /// To go on with.
    #[must_use]
    pub fn of_patches(size: (u32, u32), share: &Share, patches: Vec<Patch>) -> Canvas {
        let tile = |patch| {
            Mutex::new(Tile {
                patch,
                goal: u32::MAX,
            })
        };
        Canvas {
            size,
            end: share.samples.as_ref().map(|range| range.end),
            tiles: patches.into_iter().map(tile).collect(),
            verdict: OnceLock::new(),
        }
    }

    /// What the pilot found, if it was asked and is through.
    #[must_use]
    pub fn verdict(&self) -> Option<Verdict> {
        self.verdict.get().copied()
    }

    /// Spares the pilot, which has been asked before.
    pub fn trust(&self, verdict: Verdict) {
        // Whoever was first is right: the same question has the same answer.
        let _ = self.verdict.set(verdict);
    }

    /// How many tiles there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.tiles.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// Shows one tile after the other.
    pub fn patches(&self) -> impl Iterator<Item = PatchGuard<'_>> {
        self.tiles.iter().map(|tile| PatchGuard(lock(tile)))
    }

    /// The fewest and the most samples that a tile has, told as one after the last.
    #[must_use]
    pub fn done(&self) -> (u32, u32) {
        let done = || self.patches().map(|patch| patch.done);
        (done().min().unwrap_or(0), done().max().unwrap_or(0))
    }

    /// The mean over pixels of what each tile is to have, rounded.
    pub(super) fn mean(&self, goals: &[u32]) -> u32 {
        let (mut pixels, mut samples) = (0, 0);
        for (patch, &goal) in self.patches().zip(goals) {
            let size = u64::from(patch.window.width) * u64::from(patch.window.height);
            pixels += size;
            samples += size * u64::from(goal);
        }
        ((samples + pixels / 2) / pixels.max(1)) as u32
    }

    /// Whether tiles are as [`Settings`] need them: those that get samples of their own number have their own size.
    #[must_use]
    pub fn suits(&self, settings: &Settings) -> bool {
        let windows = self.patches().map(|patch| patch.window);
        !settings.is_adaptive() || windows.eq(cut(settings.size, settings.side()))
    }

    /// What a tile has and was to have, if one has more than that.
    #[must_use]
    pub fn surplus(&self) -> Option<(u32, u32)> {
        let of_all = self.verdict().map_or(u32::MAX, |verdict| verdict.spp);
        let limits = self.tiles.iter().map(|tile| {
            let Tile { patch, goal, .. } = &*lock(tile);
            let limit = if *goal == u32::MAX { of_all } else { *goal };
            (patch.done, limit)
        });
        limits.into_iter().find(|(done, limit)| done > limit)
    }

    /// The mean over pixels of what they have, rounded.
    #[must_use]
    pub fn spp(&self) -> u32 {
        let done: Vec<u32> = self.patches().map(|patch| patch.done).collect();
        self.mean(&done)
    }

    /// Samples of all pixels together.
    #[must_use]
    pub fn samples(&self) -> u64 {
        let of = |patch: PatchGuard<'_>| {
            let w = patch.window;
            u64::from(w.width) * u64::from(w.height) * u64::from(patch.done - patch.first)
        };
        self.patches().map(of).sum()
    }

    /// Samples that are missing up to `end` in every pixel, or up to its tile's goal.
    pub(super) fn missing(&self, end: u32) -> u64 {
        let of = |tile: &Mutex<Tile>| {
            let Tile { patch, goal, .. } = &*lock(tile);
            let (w, end) = (patch.window, end.min(*goal));
            u64::from(w.width) * u64::from(w.height) * u64::from(end.saturating_sub(patch.done))
        };
        self.tiles.iter().map(of).sum()
    }

    /// The film as it would be if this were all.
    #[must_use]
    pub fn film(&self) -> Film {
        assemble(self.size, self.patches().map(|patch| patch.clone()))
    }

    /// The film; memory of tiles is given back on the way.
    #[must_use]
    pub fn into_film(self) -> Film {
        let own = |tile: Mutex<Tile>| tile.into_inner().unwrap_or_else(PoisonError::into_inner);
        let patches = self.tiles.into_iter().map(|tile| own(tile).patch);
        assemble(self.size, patches)
    }
}

/// A tile that nobody traces meanwhile.
pub struct PatchGuard<'a>(MutexGuard<'a, Tile>);

impl std::ops::Deref for PatchGuard<'_> {
    type Target = Patch;

    fn deref(&self) -> &Patch {
        &self.0.patch
    }
}

/// A tile for oneself. A thread that died with it has ended the process.
pub(super) fn lock(tile: &Mutex<Tile>) -> MutexGuard<'_, Tile> {
    tile.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The tiles of an image, row by row; those at the right and at the bottom may be smaller.
fn cut((width, height): (u32, u32), side: u32) -> impl Iterator<Item = Window> {
    let starts = move |length: u32| (0..length).step_by(side as usize);
    let places = starts(height).flat_map(move |y| starts(width).map(move |x| (x, y)));
    places.map(move |(x, y)| Window {
        x,
        y,
        width: side.min(width - x),
        height: side.min(height - y),
    })
}

fn assemble((width, height): (u32, u32), patches: impl IntoIterator<Item = Patch>) -> Film {
    let mut film = Film::new(width, height);
    for patch in patches {
        if patch.done > patch.first {
            film.put(patch.window, &patch.into_planes());
        }
    }
    film
}
