//! Pictures of the full size: what they vary by, and what smaller ones err that are enlarged.

use super::dials::Dials;
use super::lab::Lab;
use super::race::LADDER;
use super::stack::Estimate;

/// Sides are divided by these.
const DIVISORS: [u32; 2] = [2, 4];

/// A smaller picture is at least so many pixels wide and high.
const SMALLEST: u32 = 16;

/// Seeds of these pictures: others than those of the race and of the reference.
const SEEDS: [u64; 2] = [1 << 33, (1 << 33) + 1];

/// One sample may take this many times as long as was thought of: without the full size, absolute numbers are guesses.
const PATIENCE: f64 = 3.0;

/// Side of the blocks of pixels whose errors are taken as independent: wider than what an enlarged pixel reaches.
const BLOCK: usize = 16;

/// A smaller picture, enlarged bilinearly to the full size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shrunk {
    /// Its sides are the full ones over this.
    pub divisor: u32,
    /// Its width and height.
    pub size: (u32, u32),
    /// Relative squared bias against pictures of the full size.
    pub bias_squared: Estimate,
    /// Variance over that of the full size with equal samples per pixel.
    pub variance: f64,
    /// Time of a sample over that at the full size.
    pub time: f64,
}

/// What pictures of the full size are like.
pub(super) struct Full {
    /// Their samples.
    pub(super) spp: u32,
    /// Relative variance.
    pub(super) variance: f64,
    /// CPU seconds of a sample.
    pub(super) per_sample: f64,
    /// Smaller ones.
    pub(super) shrunk: Vec<Shrunk>,
}

/// Renders the full size and its parts with two seeds each and as many samples of the ladder as `seconds` of CPU time
/// allow, if one takes `per_sample`. `None` if one would take much longer than that.
pub(super) fn measure(
    lab: &mut Lab<'_>,
    dials: &Dials,
    full: (u32, u32),
    per_sample: f64,
    seconds: f64,
) -> Option<Full> {
    let pixels = f64::from(full.0) * f64::from(full.1);
    let parts: f64 = DIVISORS.iter().map(|d| 1.0 / f64::from(d * d)).sum();
    let cost = |spp: u32| 2.0 * (1.0 + parts) * pixels * f64::from(spp) * per_sample;
    let fits = LADDER.into_iter().rev().find(|spp| cost(*spp) <= seconds);
    let spp = fits.or_else(|| (cost(LADDER[0]) <= PATIENCE * seconds).then_some(LADDER[0]))?;
    let mut shoot = |size: (u32, u32)| {
        let shots = SEEDS.map(|seed| lab.shoot(dials, size, spp, seed));
        let samples = f64::from(size.0) * f64::from(size.1) * f64::from(spp);
        let least = shots[0].seconds.min(shots[1].seconds) / samples;
        let [a, b] = shots.map(|shot| shot.pixels);
        lab.forget(size);
        ([a, b], least)
    };
    let (truth, per_sample) = shoot(full);
    let power = mean(&truth[0], &truth[1], |a, b| a * b);
    let noise = |p: &[Vec<[f32; 3]>; 2]| mean(&p[0], &p[1], |a, b| 0.5 * (a - b) * (a - b));
    let of_full = noise(&truth);
    let mut shrunk = Vec::new();
    for divisor in DIVISORS {
        let size = (full.0 / divisor, full.1 / divisor);
        if size.0.min(size.1) < SMALLEST {
            break;
        }
        let (small, time) = shoot(size);
        let large = small.map(|pixels| enlarge(&pixels, size, full));
        shrunk.push(Shrunk {
            divisor,
            size,
            bias_squared: bias(&large, &truth, full.0 as usize, power),
            variance: noise(&large) / of_full.max(f64::MIN_POSITIVE),
            time: time / per_sample,
        });
    }
    Some(Full {
        spp,
        variance: of_full / power,
        per_sample,
        shrunk,
    })
}

/// Mean over pixels and channels.
fn mean(a: &[[f32; 3]], b: &[[f32; 3]], of: impl Fn(f64, f64) -> f64) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    let sum: f64 = pairs.map(|(&a, &b)| of(a.into(), b.into())).sum();
    sum / (3 * a.len()) as f64
}

/// Squared difference of what x and r converge to: the product of the differences of two seeds, whose noise is
/// independent, has no noise in its expectation.
fn bias(x: &[Vec<[f32; 3]>; 2], r: &[Vec<[f32; 3]>; 2], width: usize, power: f64) -> Estimate {
    let across = width.div_ceil(BLOCK);
    let height = x[0].len() / width;
    let mut blocks = vec![(0.0, 0.0); across * height.div_ceil(BLOCK)];
    for i in 0..x[0].len() {
        let off = |k: usize, c: usize| f64::from(x[k][i][c]) - f64::from(r[k][i][c]);
        let product: f64 = (0..3).map(|c| off(0, c) * off(1, c)).sum();
        let block = &mut blocks[i / width / BLOCK * across + i % width / BLOCK];
        block.0 += product / (3.0 * power);
        block.1 += 1.0;
    }
    let count = blocks.len() as f64;
    let pixels = x[0].len() as f64;
    let value = blocks.iter().map(|b| b.0).sum::<f64>() / pixels;
    // Blocks at the border are smaller: what a block adds to the mean has this spread.
    let spread: f64 = (blocks.iter())
        .map(|b| (b.0 - value * b.1) * (b.0 - value * b.1))
        .sum();
    let unbiased = count / (count - 1.0).max(1.0);
    Estimate {
        value,
        half_width: 2.0 * (spread * unbiased).sqrt() / pixels,
    }
}

/// Bilinear: every pixel is a mean of the four small ones whose centres surround its own.
fn enlarge(pixels: &[[f32; 3]], size: (u32, u32), to: (u32, u32)) -> Vec<[f32; 3]> {
    let taps = |i: u32, from: u32, to: u32| {
        let last = f64::from(from - 1);
        let at = (f64::from(i) + 0.5) * f64::from(from) / f64::from(to) - 0.5;
        let at = at.clamp(0.0, last);
        let low = at.floor();
        ([low as usize, (low + 1.0).min(last) as usize], at - low)
    };
    let pixel = |x: u32, y: u32| {
        let (columns, u) = taps(x, size.0, to.0);
        let (rows, v) = taps(y, size.1, to.1);
        let at = |row: usize, column: usize, c: usize| {
            f64::from(pixels[rows[row] * size.0 as usize + columns[column]][c])
        };
        let along = |row: usize, c: usize| at(row, 0, c) + u * (at(row, 1, c) - at(row, 0, c));
        [0, 1, 2].map(|c| (along(0, c) + v * (along(1, c) - along(0, c))) as f32)
    };
    (0..to.1)
        .flat_map(|y| (0..to.0).map(move |x| (x, y)))
        .map(|(x, y)| pixel(x, y))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bench::Random;

    #[test]
    fn a_ramp_stays_a_ramp() {
        let small: Vec<[f32; 3]> = (0..8 * 4)
            .map(|i| [(i % 8) as f32 + 0.5, (i / 8) as f32 + 0.5, 1.0])
            .collect();
        let large = enlarge(&small, (8, 4), (16, 8));
        for (i, p) in large.iter().enumerate() {
            let (x, y) = (i % 16, i / 16);
            if (1..15).contains(&x) && (1..7).contains(&y) {
                assert_eq!(p[0], (x as f32 + 0.5) / 2.0, "{x}");
                assert_eq!(p[1], (y as f32 + 0.5) / 2.0, "{y}");
            }
            assert_eq!(p[2], 1.0);
        }
    }

    #[test]
    fn noise_is_no_bias() {
        let noisy = |seed: u64, mean: f64| -> Vec<[f32; 3]> {
            let mut random = Random::new(seed);
            let each = (0..100 * 60).map(|_| [0; 3].map(|_| (mean + random.unit() - 0.5) as f32));
            each.collect()
        };
        let truth = [noisy(1, 1.0), noisy(2, 1.0)];
        for offset in [0.0, 0.1] {
            let x = [noisy(3, 1.0 + offset), noisy(4, 1.0 + offset)];
            let found = bias(&x, &truth, 100, 1.0);
            let off = (found.value - offset * offset).abs();
            assert!(off < found.half_width, "{offset}: {found:?}");
            assert!(found.half_width < 0.006, "{found:?}");
        }
    }
}
