//! An image beside its reference, checked once, with the pixels that count.

use super::Image;
use std::fmt;

/// An image and its reference: of one size, finite throughout, and at least one pixel counts.
#[derive(Clone, Debug)]
pub struct Pair<'a> {
    image: &'a Image,
    reference: &'a Image,
    counts: Vec<bool>,
}

/// Which pixels count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// All of them.
    #[default]
    All,
    /// Those where the largest channel of the reference is at most 2 and above 8 nowhere within 3 pixels, the image
    /// being a torus: lamps and their rims, which another renderer may filter otherwise, do not rule the result.
    Peers,
}

/// The largest channel that counts under [`Selection::Peers`].
const PEERS_LIMIT: f32 = 2.0;
/// A larger channel is a lamp.
const PEERS_LAMP: f32 = 8.0;
/// Pixels around a lamp that do not count, in each direction.
const PEERS_REACH: usize = 3;

/// Pixels of an image with a channel that is infinite or not a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NonFinite {
    /// How many.
    pub count: usize,
    /// Column and row of the first, by rows from the top.
    pub first: (usize, usize),
}

impl fmt::Display for NonFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (x, y) = self.first;
        match self.count {
            1 => write!(f, "1 pixel that is not finite, at column {x}, row {y}"),
            n => write!(
                f,
                "{n} pixels that are not finite, the first at column {x}, row {y}"
            ),
        }
    }
}

/// Why two images cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PairError {
    /// Width and height of the image, then of its reference.
    #[error("the image has {}×{} pixels, the reference {}×{}", .0.0, .0.1, .1.0, .1.1)]
    Sizes((usize, usize), (usize, usize)),
    /// In the image, in its reference.
    #[error("{}", non_finite(.0, .1))]
    NonFinite(Option<NonFinite>, Option<NonFinite>),
    /// No pixel counts.
    #[error("the mask leaves no pixel to compare")]
    Nothing,
}

fn non_finite(image: &Option<NonFinite>, reference: &Option<NonFinite>) -> String {
    let who = |who: &str, found: &Option<NonFinite>| found.map(|n| format!("the {who} has {n}"));
    let both = [who("image", image), who("reference", reference)];
    both.into_iter().flatten().collect::<Vec<_>>().join("; ")
}

impl<'a> Pair<'a> {
    /// Checks both images whole, the pixels that do not count included.
    ///
    /// # Errors
    /// If they differ in size, a pixel is not finite, or none counts.
    pub fn new(
        image: &'a Image,
        reference: &'a Image,
        selection: Selection,
    ) -> Result<Pair<'a>, PairError> {
        let size = |i: &Image| (i.width(), i.height());
        if size(image) != size(reference) {
            return Err(PairError::Sizes(size(image), size(reference)));
        }
        let bad = (find_non_finite(image), find_non_finite(reference));
        if bad != (None, None) {
            return Err(PairError::NonFinite(bad.0, bad.1));
        }
        let counts = match selection {
            Selection::All => vec![true; image.pixels().len()],
            Selection::Peers => peers_mask(reference),
        };
        if !counts.contains(&true) {
            return Err(PairError::Nothing);
        }
        Ok(Pair {
            image,
            reference,
            counts,
        })
    }

    /// What is measured.
    #[must_use]
    pub fn image(&self) -> &'a Image {
        self.image
    }

    /// What it should be.
    #[must_use]
    pub fn reference(&self) -> &'a Image {
        self.reference
    }

    /// Whether each pixel counts, by rows.
    #[must_use]
    pub fn counts(&self) -> &[bool] {
        &self.counts
    }

    /// Index, image and reference of each pixel that counts.
    pub fn pixels(&self) -> impl Iterator<Item = (usize, [f32; 3], [f32; 3])> {
        let both = self.image.pixels().iter().zip(self.reference.pixels());
        both.enumerate()
            .filter(|(i, _)| self.counts[*i])
            .map(|(i, (&x, &r))| (i, x, r))
    }

    /// Mean over the pixels that count of a value per pixel.
    #[must_use]
    pub fn mean(&self, values: &[f32]) -> f64 {
        let counted = values.iter().zip(&self.counts).filter(|(_, c)| **c);
        let (sum, count) = counted.fold((0.0, 0u64), |(sum, count), (&v, _)| {
            (sum + f64::from(v), count + 1)
        });
        sum / count as f64
    }
}

fn find_non_finite(image: &Image) -> Option<NonFinite> {
    let is_bad = |p: &[f32; 3]| p.iter().any(|c| !c.is_finite());
    let first = image.pixels().iter().position(is_bad)?;
    Some(NonFinite {
        count: image.pixels().iter().filter(|p| is_bad(p)).count(),
        first: (first % image.width(), first / image.width()),
    })
}

fn peers_mask(reference: &Image) -> Vec<bool> {
    let (width, height) = (reference.width(), reference.height());
    let largest = |p: &[f32; 3]| p.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let mut counts: Vec<bool> = reference
        .pixels()
        .iter()
        .map(|p| largest(p) <= PEERS_LIMIT)
        .collect();
    let is_lamp = |p: &[f32; 3]| largest(p) > PEERS_LAMP;
    for (i, _) in (reference.pixels().iter().enumerate()).filter(|(_, p)| is_lamp(p)) {
        let (x, y) = (i % width, i / width);
        for row in around(y, height) {
            for column in around(x, width) {
                counts[row * width + column] = false;
            }
        }
    }
    counts
}

/// Places within reach of one on a ring.
fn around(at: usize, length: usize) -> impl Iterator<Item = usize> {
    // A whole number of turns keeps the difference positive.
    let start = at + PEERS_REACH.next_multiple_of(length) - PEERS_REACH;
    (0..=2 * PEERS_REACH).map(move |step| (start + step) % length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: usize, height: usize) -> Vec<[f32; 3]> {
        vec![[0.5; 3]; width * height]
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let wide = Image::new(4, grey(4, 3)).expect("whole");
        let high = Image::new(3, grey(3, 4)).expect("whole");
        let of = |a, b, s| Pair::new(a, b, s).err();
        assert_eq!(
            of(&wide, &high, Selection::All),
            Some(PairError::Sizes((4, 3), (3, 4)))
        );
        let mut pixels = grey(4, 3);
        pixels[6][1] = f32::NAN;
        pixels[7][2] = f32::NEG_INFINITY;
        let bad = Image::new(4, pixels).expect("whole");
        let error = of(&wide, &bad, Selection::All).expect("not finite");
        assert_eq!(
            error.to_string(),
            "the reference has 2 pixels that are not finite, the first at column 2, row 1"
        );
        let error = of(&bad, &bad, Selection::Peers).expect("not finite");
        assert!(error.to_string().starts_with("the image has 2 pixels"));
        let lamp = Image::new(4, vec![[9.0; 3]; 12]).expect("whole");
        assert_eq!(of(&wide, &lamp, Selection::Peers), Some(PairError::Nothing));
        assert_eq!(of(&wide, &lamp, Selection::All), None);
    }

    #[test]
    fn the_mask_of_peers_wraps_around() {
        const SIDE: usize = 16;
        let mut pixels = grey(SIDE, SIDE);
        pixels[SIDE + 2] = [0.0, 8.5, 0.0]; // column 2, row 1: a lamp
        pixels[9 * SIDE + 9] = [2.5, 0.0, 0.0]; // bright, no lamp
        pixels[9 * SIDE + 10] = [2.0, 0.0, 0.0]; // just dim enough
        let image = Image::new(SIDE, pixels).expect("whole");
        let counts = peers_mask(&image);
        for (i, &counted) in counts.iter().enumerate() {
            let (x, y) = (i % SIDE, i / SIDE);
            // Rows 14 … 4 and columns 15 … 5 across the border.
            let near = (y >= 14 || y <= 4) && (x == 15 || x <= 5);
            assert_eq!(counted, !near && (x, y) != (9, 9), "{x} {y}");
        }
    }

    #[test]
    fn rings_shorter_than_the_reach_are_covered() {
        for length in 1..12 {
            for at in 0..length {
                let all: Vec<usize> = around(at, length).collect();
                let turns = |step: isize| (at as isize + step).rem_euclid(length as isize) as usize;
                assert_eq!(all, (-3..=3).map(turns).collect::<Vec<_>>());
            }
        }
    }
}
