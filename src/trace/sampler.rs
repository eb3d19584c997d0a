//! Random numbers: a pure function of (seed, frame, pixel, sample, dimension).
//!
//! Dimensions come in pairs, by a fixed table ([`Pair`]), and pairs whose places decide one thing together come in fours:
//! the place in the pixel and that on the light, then a direction and the place on the light where it leads. A four is
//! a (0, 4)-sequence in base 4, both of its pairs are (0, 2)-sequences in base 2; fours, and pairs that stand alone, are
//! padded: the sample index is shuffled for each, and every coordinate Owen-scrambled (Burley 2020, "Practical hash-based
//! Owen scrambling", JCGT 9(4)). On a plane under a lamp the error falls as the samples grow (`tests/trade/slopes.rs`).

use super::{Sampler, opacity::MAX_PASSES};
use crate::math::lanes::{BitLanes, Words};

/// What a pair of dimensions is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pair {
    /// Place in the pixel.
    Pixel,
    /// Place on the lens.
    Lens,
    /// Which light, and which lobe of the bsdf, at a bounce.
    Choice(u32),
    /// Place on the light.
    Light(u32),
    /// Direction of the bsdf.
    Direction(u32),
    /// Roulette; the second is not used.
    Roulette(u32),
    /// Which chain to a light, and which light.
    Chain(u32),
    /// Place on the light of a chain.
    ChainLight(u32),
    /// Whether a surface is there, at a bounce after so many that were not; the second is not used.
    Opacity(u32, u32),
}

/// Rows of a camera ray, and rows of every bounce.
const CAMERA_PAIRS: u32 = 2;
const BOUNCE_PAIRS: u32 = 3;

/// First row of chains, two a bounce: the table above has fewer, unless paths have 2²⁸ bounces.
const CHAIN_ROWS: u32 = 1 << 30;

/// First row of [`Pair::Opacity`]: likewise.
const OPACITY_ROWS: u32 = 1 << 31;

/// Which half of a four a pair is; one that stands alone is the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Half {
    First,
    Second,
}

impl Pair {
    /// Its row in the table of dimensions, which it shares with the other half of its four.
    fn place(self) -> (u32, Half) {
        let bounce = |b: u32, row| CAMERA_PAIRS + b * BOUNCE_PAIRS + row;
        match self {
            Pair::Pixel => (0, Half::First),
            Pair::Light(0) => (0, Half::Second),
            Pair::Lens => (1, Half::First),
            Pair::Choice(b) => (bounce(b, 0), Half::First),
            Pair::Direction(b) => (bounce(b, 1), Half::First),
            Pair::Light(b) => (bounce(b - 1, 1), Half::Second),
            Pair::Roulette(b) => (bounce(b, 2), Half::First),
            Pair::Chain(b) => (CHAIN_ROWS + 2 * b, Half::First),
            Pair::ChainLight(b) => (CHAIN_ROWS + 2 * b + 1, Half::First),
            Pair::Opacity(b, pass) => {
                let row = b.wrapping_mul(MAX_PASSES).wrapping_add(pass);
                (OPACITY_ROWS.wrapping_add(row), Half::First)
            }
        }
    }
}

/// The key of a pixel's random numbers.
#[must_use]
pub(super) fn pixel_key(seed: u64, frame: u32, x: u32, y: u32) -> u32 {
    let mut key = mix(seed as u32 ^ 0x9e37_79b9);
    for word in [(seed >> 32) as u32, frame, x, y] {
        key = mix(key ^ word);
    }
    key
}

/// Two numbers strictly between 0 and 1: (k + ½) 2⁻²³, so that no map from the square meets its own border. Inlined by
/// force, since the pair is a constant where it is called: out of line, a room took 7 % more instructions.
#[inline(always)]
#[must_use]
pub(super) fn sample_pair(sampler: Sampler, key: u32, sample: u32, pair: Pair) -> [f32; 2] {
    sample_pairs::<f32>(sampler, key, sample, pair)
}

/// The same for keys and samples in lanes.
#[inline(always)]
pub(super) fn sample_pairs<L: BitLanes>(
    sampler: Sampler,
    key: L::Bits,
    sample: L::Bits,
    pair: Pair,
) -> [L; 2] {
    let word = |x| <L::Bits as Words>::splat(x);
    let (row, half) = pair.place();
    let key = mix(key.xor(word(row.wrapping_mul(0x9e37_79b9))));
    let (x, y) = match sampler {
        Sampler::Sobol => {
            // The index shuffled; reversed, it is the first dimension.
            let index = laine_karras(sample.reversed(), key).reversed();
            let ([x, y], dimension) = match half {
                Half::First => ([index, second_reversed(index)], 1),
                Half::Second => (third_and_fourth_reversed(index), 3),
            };
            (
                laine_karras(x, mix(key.xor(word(dimension)))).reversed(),
                laine_karras(y, mix(key.xor(word(dimension + 1)))).reversed(),
            )
        }
        Sampler::Independent => {
            let key = key.xor(word(half as u32));
            let x = mix(mix(key.xor(sample)).xor(word(0x85eb_ca6b)));
            (x, mix(x.xor(key)))
        }
    };
    [unit(x), unit(y)]
}

/// The top 23 bits as the middle of their interval in (0, 1).
#[inline(always)]
fn unit<L: BitLanes>(x: L::Bits) -> L {
    (L::from_words(x.down::<9>()) + L::splat(0.5)) * L::splat(1.0 / 8_388_608.0)
}

/// A bijective mix of 32 bits: xor-shift and multiply with the constants of the "lowbias32" search by C. Wellons.
#[inline(always)]
fn mix<W: Words>(x: W) -> W {
    let x = x.xor(x.down::<16>()).times(W::splat(0x7feb_352d));
    let x = x.xor(x.down::<15>()).times(W::splat(0x846c_a68b));
    x.xor(x.down::<16>())
}

/// Owen scrambling, which flips every bit by a hash of those above it, on reversed bits: every bit is changed by lower bits
/// only (Laine and Karras 2011, constants of Burley 2020, listing 3).
#[inline(always)]
fn laine_karras<W: Words>(x: W, seed: W) -> W {
    let x = x.plus(seed);
    let x = x.xor(x.times(W::splat(0x6c50_b47c)));
    let x = x.xor(x.times(W::splat(0xb82f_1e52)));
    let x = x.xor(x.times(W::splat(0xc7af_e638)));
    x.xor(x.times(W::splat(0x8d22_f6e6)))
}

/// The second dimension, bits reversed: its generator matrix is Pascal's triangle modulo 2 (Sobol 1967).
#[inline(always)]
fn second_reversed<W: Words>(index: W) -> W {
    let x = pascal(index);
    x.xor(x.down::<1>().and(W::splat(LOW)))
}

/// The third and the fourth, bits reversed. With base-4 digits as elements of the field of four, {0, 1, ω, ω²}, the
/// generator matrices of a (0, 4)-sequence are Pᵃ for a = 0, 1, ω, ω², with P Pascal's triangle (Faure 1982; Niederreiter
/// 1987, "Point sets and sequences with small discrepancy", §6), and Pᵃ is D⁻¹ P D with D = diag(aʲ). The last step on the
/// digits of every other dimension, the same as in the second, makes pairs even in base 2 too, as the tests find.
#[inline(always)]
fn third_and_fourth_reversed<W: Words>(index: W) -> [W; 2] {
    let [once, twice] = scaled(index);
    let [_, third] = scaled(pascal(once));
    let [fourth, _] = scaled(pascal(twice));
    [third, fourth.xor(fourth.down::<1>().and(W::splat(LOW)))]
}

/// The lower bits of all digits.
const LOW: u32 = 0x5555_5555;

/// The bits of the digits j with j mod 3 = 0, 1, 2.
const DIGITS: [u32; 3] = [0xc30c_30c3, 0x0c30_c30c, 0x30c3_0c30];

/// Digit j times ωʲ, and digit j times ω⁻ʲ.
#[inline(always)]
fn scaled<W: Words>(x: W) -> [W; 2] {
    let low = x.and(W::splat(LOW));
    let high = x.down::<1>().and(W::splat(LOW));
    let sum = low.xor(high);
    // ω (b₀ + b₁ ω) = b₁ + (b₀ + b₁) ω, since ω² = 1 + ω; and once more.
    let by_omega = high.or(sum.up::<1>());
    let by_square = sum.or(low.up::<1>());
    let [zeroth, first, second] = [
        W::splat(DIGITS[0]),
        W::splat(DIGITS[1]),
        W::splat(DIGITS[2]),
    ];
    let same = x.and(zeroth);
    [
        same.or(by_omega.and(first)).or(by_square.and(second)),
        same.or(by_square.and(first)).or(by_omega.and(second)),
    ]
}

/// Pascal's triangle modulo 2 on base-4 digits, by doubling steps.
#[inline(always)]
fn pascal<W: Words>(digits: W) -> W {
    let x = digits.xor(digits.down::<16>().and(W::splat(0x0000_ffff)));
    let x = x.xor(x.down::<8>().and(W::splat(0x00ff_00ff)));
    let x = x.xor(x.down::<4>().and(W::splat(0x0f0f_0f0f)));
    x.xor(x.down::<2>().and(W::splat(0x3333_3333)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The second dimension by its definition: direction numbers v(k) = v(k−1) ^ (v(k−1) >> 1) (Sobol 1967).
    fn sobol_by_definition(index: u32) -> u32 {
        let mut direction = 1u32 << 31;
        let mut x = 0;
        for bit in 0..32 {
            if index >> bit & 1 == 1 {
                x ^= direction;
            }
            direction ^= direction >> 1;
        }
        x
    }

    #[test]
    fn second_dimension_is_sobols() {
        for i in (0..4096).chain((0..2000).map(mix)) {
            assert_eq!(
                second_reversed(i).reverse_bits(),
                sobol_by_definition(i),
                "{i}"
            );
        }
    }

    /// Neither 0 nor 1 for any hash, so that no map from the square meets its border; and every half, quarter … 2⁻¹² of the
    /// interval holds as many numbers as another.
    #[test]
    fn numbers_are_inside_and_evenly_spread() {
        assert!(unit::<f32>(0) > 0.0 && unit::<f32>(u32::MAX) < 1.0);
        let mut last = 0.0;
        for k in 0..1u32 << 23 {
            let u = unit::<f32>(k << 9 | k & 0x1ff);
            assert!(u > last && u < 1.0, "{k}");
            last = u;
        }
        const CELLS: usize = 1 << 12;
        let n = 1u32 << 20;
        for sampler in [Sampler::Independent, Sampler::Sobol] {
            for pair in [Pair::Pixel, Pair::Light(3), Pair::Roulette(900)] {
                let mut counts = [[0u32; CELLS]; 2];
                for s in 0..n {
                    let numbers = sample_pair(sampler, pixel_key(5, 6, 7, 8), s, pair);
                    for (counts, u) in counts.iter_mut().zip(numbers) {
                        counts[(u * CELLS as f32) as usize] += 1;
                    }
                }
                let mean = f64::from(n) / CELLS as f64;
                for counts in counts {
                    let chi2: f64 = counts
                        .iter()
                        .map(|&c| (f64::from(c) - mean).powi(2) / mean)
                        .sum();
                    // Four standard deviations of χ² with 4095 degrees of freedom; Sobol points are evener than chance.
                    let limit = (CELLS - 1) as f64 + 4.0 * (2.0 * (CELLS - 1) as f64).sqrt();
                    assert!(chi2 < limit, "{sampler:?} {pair:?}: {chi2}");
                }
            }
        }
    }

    /// Every elementary interval of area 2⁻ᵐ holds exactly one of 2ᵐ consecutive aligned samples, for each pair.
    #[test]
    fn elementary_intervals_hold_one_point() {
        for (m, pair) in [
            (4, Pair::Pixel),
            (7, Pair::Light(0)),
            (8, Pair::Light(0)),
            (10, Pair::Direction(3)),
            (11, Pair::Light(4)),
        ] {
            for block in [0u32, 1, 7] {
                for log_columns in 0..=m {
                    let columns = 1u32 << log_columns;
                    let rows = 1u32 << (m - log_columns);
                    let mut seen = vec![false; 1 << m];
                    for s in 0..1u32 << m {
                        let [x, y] = sample_pair(Sampler::Sobol, 77, (block << m) + s, pair);
                        let cell = (x * columns as f32) as u32 + columns * (y * rows as f32) as u32;
                        assert!(
                            !std::mem::replace(&mut seen[cell as usize], true),
                            "m {m} block {block} {columns} columns"
                        );
                    }
                }
            }
        }
    }

    /// Every interval of volume 4⁻ᵐ that base 4 cuts the cube of four dimensions into holds exactly one of 4ᵐ consecutive
    /// aligned samples.
    #[test]
    fn fours_hold_one_point_in_every_interval_of_four_dimensions() {
        let four = |pairs: [Pair; 2], s| {
            let [[a, b], [c, d]] = pairs.map(|pair| sample_pair(Sampler::Sobol, 78, s, pair));
            [a, b, c, d]
        };
        for pairs in [
            [Pair::Pixel, Pair::Light(0)],
            [Pair::Direction(2), Pair::Light(3)],
        ] {
            let cuts = |m: u32| {
                let all = (0..=m).flat_map(move |a| (0..=m).map(move |b| [a, b]));
                let all = all.flat_map(move |[a, b]| (0..=m).map(move |c| [a, b, c]));
                all.filter(move |cut| cut.iter().sum::<u32>() <= m)
                    .map(move |[a, b, c]| [a, b, c, m - a - b - c])
            };
            for (m, block) in [(1, 3), (2, 0), (3, 1), (4, 0), (5, 2)] {
                for cut in cuts(m) {
                    let mut seen = vec![false; 1 << (2 * m)];
                    for s in 0..1u32 << (2 * m) {
                        let place = four(pairs, (block << (2 * m)) + s);
                        let cell = place.iter().zip(cut).fold(0, |cell, (u, digits)| {
                            let parts = 1u32 << (2 * digits);
                            cell * parts + (u * parts as f32) as u32
                        });
                        let twice = std::mem::replace(&mut seen[cell as usize], true);
                        assert!(!twice, "{pairs:?} m {m} block {block} cut {cut:?}");
                    }
                }
            }
        }
    }

    /// No two uses share a place in the table: numbers that decide two things tie them together.
    #[test]
    fn every_use_has_a_place_of_its_own() {
        let bounces = (0..64).flat_map(|b| {
            [
                Pair::Choice(b),
                Pair::Light(b),
                Pair::Direction(b),
                Pair::Roulette(b),
                Pair::Opacity(b, 0),
                Pair::Opacity(b, MAX_PASSES - 1),
            ]
        });
        let uses = [Pair::Pixel, Pair::Lens].into_iter().chain(bounces);
        let place = |pair: Pair| {
            let (row, half) = pair.place();
            (row, half as u32)
        };
        let mut places: Vec<_> = uses.map(|pair| (place(pair), pair)).collect();
        places.sort_by_key(|(place, _)| *place);
        for two in places.windows(2) {
            assert!(two[0].0 != two[1].0, "{:?} and {:?}", two[0].1, two[1].1);
        }
    }

    #[test]
    fn pairs_pixels_and_seeds_are_uncorrelated() {
        let n = 1u32 << 14;
        for sampler in [Sampler::Independent, Sampler::Sobol] {
            let others = [
                (pixel_key(0, 0, 0, 0), Pair::Light(0)),
                (pixel_key(0, 0, 0, 0), Pair::Opacity(0, 0)),
                (pixel_key(0, 0, 0, 0), Pair::Opacity(3, 17)),
                (pixel_key(0, 0, 1, 0), Pair::Pixel),
                (pixel_key(0, 1, 0, 0), Pair::Pixel),
                (pixel_key(1, 0, 0, 0), Pair::Pixel),
            ];
            for (key, pair) in others {
                let mut sum = 0.0;
                for s in 0..n {
                    let a = sample_pair(sampler, pixel_key(0, 0, 0, 0), s, Pair::Pixel);
                    let b = sample_pair(sampler, key, s, pair);
                    sum += (f64::from(a[0]) - 0.5) * (f64::from(b[0]) - 0.5);
                    sum += (f64::from(a[1]) - 0.5) * (f64::from(b[1]) - 0.5);
                }
                // Standard deviation of the mean product of independent uniforms: 1 / (12 √(2 n)).
                let z = sum / f64::from(2 * n) * 12.0 * f64::from(2 * n).sqrt();
                assert!(z.abs() < 4.0, "{sampler:?} {pair:?}: z = {z}");
            }
        }
    }
}
