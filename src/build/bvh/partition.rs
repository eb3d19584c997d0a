//! Partitioning in place: items of the left side to the front, both sides measured on the way.

use super::item::{Extent, Item};
use super::split::Cut;
use super::{CHUNK, SHARED};
use rayon::prelude::*;

/// Moves the left items of the cut to the front. Returns their number, neither none nor all, and what is known of both
/// sides. Where an item comes to lie does not depend on the number of threads.
pub(super) fn partition(items: &mut [Item], cut: &Cut) -> (usize, [Extent; 2]) {
    match *cut {
        Cut::Bin { grid, limit } => {
            let left = |i: &Item| grid.place(i.center()).cmplt(limit).any();
            if items.len() >= SHARED {
                by_chunks(items, left)
            } else {
                by(items, left)
            }
        }
        Cut::Kind => {
            let kind = items[0].kind();
            by(items, |i| i.kind() == kind)
        }
        Cut::Median { axis } => {
            let half = items.len() / 2;
            let key = |i: &Item| (i.kind().order(), i.index());
            items.select_nth_unstable_by(half, |a, b| {
                let by_place = a.center()[axis].total_cmp(&b.center()[axis]);
                by_place.then(key(a).cmp(&key(b)))
            });
            let (left, right) = items.split_at(half);
            (half, [left, right].map(Extent::of))
        }
    }
}

/// Without a branch on the side, which nobody could predict; the sides are measured afterwards for the same reason.
fn by(items: &mut [Item], left: impl Fn(&Item) -> bool) -> (usize, [Extent; 2]) {
    let mut half = 0;
    for i in 0..items.len() {
        let item = items[i];
        let goes_left = left(&item);
        items[i] = items[half];
        items[half] = item;
        half += usize::from(goes_left);
    }
    let (left, right) = items.split_at(half);
    (half, [left, right].map(Extent::of))
}

/// Every chunk by itself, then what lies on the wrong side of the middle of all changes places.
fn by_chunks(items: &mut [Item], left: impl Fn(&Item) -> bool + Sync) -> (usize, [Extent; 2]) {
    let parts: Vec<(usize, [Extent; 2])> = items
        .par_chunks_mut(CHUNK)
        .map(|chunk| by(chunk, &left))
        .collect();
    let half = parts.iter().map(|p| p.0).sum();
    let sides = parts.iter().fold([Extent::NOTHING; 2], |sides, p| {
        [0, 1].map(|s| sides[s].union(&p.1[s]))
    });
    let (mut wrong_left, mut wrong_right) = (Vec::new(), Vec::new());
    let mut at = 0;
    for (chunk, (left, _)) in items.chunks_mut(CHUNK).zip(&parts) {
        let len = chunk.len();
        // This chunk's left items lie at `at..at + left` of all, its right ones at `at + left..at + len`.
        let (lefts, rights) = chunk.split_at_mut(*left);
        let right_of_half = lefts.len().min((at + left).saturating_sub(half));
        let left_of_half = rights.len().min(half.saturating_sub(at + left));
        let cut = lefts.len() - right_of_half;
        wrong_right.push(&mut lefts[cut..]);
        wrong_left.push(&mut rights[..left_of_half]);
        at += len;
    }
    exchange(wrong_left, wrong_right);
    (half, sides)
}

/// Swaps the items of two lists of slices, of equally many in all, in order.
fn exchange<'a>(a: Vec<&'a mut [Item]>, b: Vec<&'a mut [Item]>) {
    let mut pairs = Vec::new();
    let (mut a, mut b) = (a.into_iter(), b.into_iter());
    let (mut x, mut y): (&mut [Item], &mut [Item]) = (&mut [], &mut []);
    loop {
        if x.is_empty() {
            let Some(next) = a.next() else { break };
            x = next;
        } else if y.is_empty() {
            let Some(next) = b.next() else { break };
            y = next;
        } else {
            let (from_x, rest_x) = x.split_at_mut(x.len().min(y.len()));
            let (from_y, rest_y) = y.split_at_mut(from_x.len());
            pairs.push((from_x, from_y));
            (x, y) = (rest_x, rest_y);
        }
    }
    pairs
        .into_par_iter()
        .for_each(|(x, y)| x.swap_with_slice(y));
}
