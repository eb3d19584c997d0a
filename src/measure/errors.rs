//! Statistics of the difference of an image x from its reference r, over pixels and channels, in linear light.

use super::Pair;
use crate::math;

/// Added to r² where it divides, so that an error on black is finite; 0.01 is the customary floor.
const RELATIVE_FLOOR: f64 = 0.01;
/// Two-sided 95 % quantile of the normal distribution.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// How far an image is from its reference. Everything in f64 sums in the order of the pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// How many pixels counted.
    pub pixels: usize,
    /// sqrt(mean (x − r)²).
    pub rmse: f64,
    /// mean (x − r)² / (r² + 0.01).
    pub relmse: f64,
    /// 10 log₁₀(1 / mean (x − r)²) in dB: the peak is 1, the white of a screen. Infinite for equal images.
    pub psnr: f64,
    /// Per channel.
    pub bias: [Bias; 3],
    /// The worst value.
    pub maximum: Maximum,
}

/// The mean difference x − r of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bias {
    /// mean (x − r).
    pub mean: f64,
    /// Half of the 95 % interval of the mean, by the normal law from the spread of the pixels, whose errors are taken
    /// as independent of each other; infinite for a single pixel.
    pub half_width: f64,
    /// mean(x) / mean(r) − 1; not finite if the channel of the reference is black.
    pub relative: f64,
}

/// The largest |x − r|.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maximum {
    /// |x − r|.
    pub value: f64,
    /// 0 to 2: R, G, B.
    pub channel: usize,
    /// Column and row, from the top left.
    pub at: (usize, usize),
}

/// Measures a pair.
#[must_use]
pub fn errors(pair: &Pair<'_>) -> Errors {
    let channels = [0, 1, 2].map(|c| Channel::of(pair, c));
    let mean = |of: fn(&Channel) -> f64| channels.iter().map(of).sum::<f64>() / 3.0;
    let mse = mean(|c| c.mean_squared);
    let mut worst = 0;
    for c in 1..3 {
        if channels[c].largest.0 > channels[worst].largest.0 {
            worst = c;
        }
    }
    let (value, place) = channels[worst].largest;
    let width = pair.reference().width();
    Errors {
        pixels: channels[0].count,
        rmse: mse.sqrt(),
        relmse: mean(|c| c.mean_relative),
        psnr: -10.0 / math::ln(10.0) * math::ln(mse),
        bias: channels.each_ref().map(Channel::bias),
        maximum: Maximum {
            value,
            channel: worst,
            at: (place % width, place / width),
        },
    }
}

/// (x − r)² / (r² + 0.01), the mean of a pixel's channels; 0 where a pixel does not count.
#[must_use]
pub fn relative_squared(pair: &Pair<'_>) -> Vec<f32> {
    let mut map = vec![0.0; pair.counts().len()];
    for (i, x, r) in pair.pixels() {
        let sum: f64 = (0..3).map(|c| relative(x[c].into(), r[c].into())).sum();
        map[i] = (sum / 3.0) as f32;
    }
    map
}

fn relative(x: f64, r: f64) -> f64 {
    (x - r) * (x - r) / (r * r + RELATIVE_FLOOR)
}

/// What one channel gives.
struct Channel {
    count: usize,
    mean_squared: f64,
    mean_relative: f64,
    mean_difference: f64,
    mean_reference: f64,
    /// Variance of x − r among the pixels.
    variance: f64,
    /// |x − r| and the index of its pixel.
    largest: (f64, usize),
}

impl Channel {
    /// Two passes: the variance is summed about the mean, so that nothing cancels.
    fn of(pair: &Pair<'_>, c: usize) -> Channel {
        let (mut count, mut largest) = (0, (0.0, 0));
        let (mut squared, mut rel, mut difference, mut reference) = (0.0, 0.0, 0.0, 0.0);
        for (i, x, r) in pair.pixels() {
            let (x, r) = (f64::from(x[c]), f64::from(r[c]));
            let d = x - r;
            count += 1;
            squared += d * d;
            rel += relative(x, r);
            difference += d;
            reference += r;
            // The first pixel that counts is the place of a maximum of 0.
            if count == 1 || d.abs() > largest.0 {
                largest = (d.abs(), i);
            }
        }
        let n = count as f64;
        let mean = difference / n;
        let spread = |(_, x, r): (usize, [f32; 3], [f32; 3])| {
            let d = f64::from(x[c]) - f64::from(r[c]) - mean;
            d * d
        };
        Channel {
            count,
            mean_squared: squared / n,
            mean_relative: rel / n,
            mean_difference: mean,
            mean_reference: reference / n,
            variance: pair.pixels().map(spread).sum::<f64>() / (n - 1.0),
            largest,
        }
    }

    fn bias(&self) -> Bias {
        let half_width = match self.count {
            1 => f64::INFINITY,
            n => NORMAL_95 * (self.variance / n as f64).sqrt(),
        };
        Bias {
            mean: self.mean_difference,
            half_width,
            relative: self.mean_difference / self.mean_reference,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Image, Selection};
    use super::*;

    /// Deviations in R alone, exact in binary.
    fn images() -> (Image, Image) {
        let reference = [0.5, 1.0, 2.0, 4.0].map(|r| [r, 0.25, 0.0]);
        let image = [0.75, 1.0, 1.5, 4.5].map(|x| [x, 0.25, 0.0]);
        let of = |pixels: [[f32; 3]; 4]| Image::new(2, pixels.to_vec()).expect("whole");
        (of(image), of(reference))
    }

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-14 * b.abs().max(1.0), "{a} {b}");
    }

    #[test]
    fn agree_with_hand_computed_values() {
        let (image, reference) = images();
        let pair = Pair::new(&image, &reference, Selection::All).expect("comparable");
        let e = errors(&pair);
        assert_eq!(e.pixels, 4);
        // Differences in R: 1/4, 0, −1/2, 1/2. Squares: 1/16, 0, 1/4, 1/4: 9/16 in 12 values.
        near(e.rmse, (9.0f64 / 16.0 / 12.0).sqrt());
        near(
            e.relmse,
            (0.0625 / 0.26 + 0.25 / 4.01 + 0.25 / 16.01) / 12.0,
        );
        near(e.psnr, -10.0 * (9.0f64 / 16.0 / 12.0).log10());
        near(e.bias[0].mean, 1.0 / 16.0);
        near(e.bias[0].relative, 0.25 / 7.5);
        let variance = (9.0 / 16.0 - 4.0 / 256.0) / 3.0;
        near(
            e.bias[0].half_width,
            1.959_963_984_540_054 * f64::sqrt(variance / 4.0),
        );
        assert_eq!((e.bias[1].mean, e.bias[1].half_width), (0.0, 0.0));
        assert!(e.bias[2].relative.is_nan());
        let first_of_two = Maximum {
            value: 0.5,
            channel: 0,
            at: (0, 1),
        };
        assert_eq!(e.maximum, first_of_two);
        let map = relative_squared(&pair);
        // The map is f32: half a unit in the last place of each pixel.
        assert!((pair.mean(&map) / e.relmse - 1.0).abs() < 1e-7);
    }

    #[test]
    fn only_counted_pixels_enter() {
        let pixels = |x: f32| {
            let mut all = vec![[1.0; 3]; 100];
            all[0] = [x; 3];
            all[55] = [0.5; 3];
            Image::new(10, all).expect("whole")
        };
        let (image, reference) = (pixels(1.0), pixels(100.0));
        let all = Pair::new(&image, &reference, Selection::All).expect("comparable");
        assert_eq!(errors(&all).maximum.value, 99.0);
        let masked = Pair::new(&image, &reference, Selection::Peers).expect("comparable");
        let e = errors(&masked);
        assert_eq!((e.pixels, e.rmse, e.maximum.value), (51, 0.0, 0.0));
        assert_eq!(relative_squared(&masked), vec![0.0; 100]);
    }

    #[test]
    fn equal_images_have_no_error() {
        let (_, reference) = images();
        let pair = Pair::new(&reference, &reference, Selection::All).expect("comparable");
        let e = errors(&pair);
        assert_eq!((e.rmse, e.relmse, e.maximum.value), (0.0, 0.0, 0.0));
        assert_eq!(e.psnr, f64::INFINITY);
        assert_eq!(e.bias.map(|b| (b.mean, b.half_width)), [(0.0, 0.0); 3]);
    }
}
