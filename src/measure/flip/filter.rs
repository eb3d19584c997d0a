//! The filters of FLIP: the eye's contrast sensitivities as Gaussians, and detectors of edges and points.
//!
//! Every kernel is a sum of products of a horizontal and a vertical one, and is applied as such. Beyond its border a
//! picture goes on as its border.

use crate::math;
use std::f64::consts::PI;

/// One channel by rows.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    pub(super) width: usize,
    pub(super) values: Vec<f32>,
}

/// Weights of a line of pixels, an odd number, about the middle one.
type Kernel = Vec<f64>;

/// A contrast sensitivity as a sum of two Gaussians: pairs (a, b) of a √(π/b) e^(−π² d² / b), d in degrees, with
/// the parameters of the paper.
type Sensitivity = [(f64, f64); 2];

const ACHROMATIC: Sensitivity = [(1.0, 0.0047), (0.0, 1e-5)];
const RED_GREEN: Sensitivity = [(1.0, 0.0053), (0.0, 1e-5)];
const BLUE_YELLOW: Sensitivity = [(34.1, 0.04), (13.5, 0.025)];

/// The widest b of all: it rules the size of the kernels.
const WIDEST: f64 = 0.04;
/// Kernels end at three standard deviations.
const REACH: f64 = 3.0;
/// Width of the features that the eye detects, in degrees; half of it is the standard deviation.
const FEATURE_WIDTH: f64 = 0.082;

/// A blur by Gaussians: (share, normalised kernel), the shares adding up to 1.
pub(super) struct Blur(Vec<(f64, Kernel)>);

/// What the eye cannot resolve in Y_y, C_x and C_z.
pub(super) fn contrast_sensitivity(pixels_per_degree: f64) -> [Blur; 3] {
    // e^(−π² d²/b) has the standard deviation √(b / 2π²).
    let deviation = (WIDEST / (2.0 * PI * PI)).sqrt();
    let radius = (REACH * deviation * pixels_per_degree).ceil();
    [ACHROMATIC, RED_GREEN, BLUE_YELLOW].map(|terms| {
        let mut parts: Vec<(f64, Kernel)> = (terms.into_iter())
            .filter(|(a, _)| *a > 0.0)
            .map(|(a, b)| {
                let weight = |x: f64| {
                    let degrees = x / pixels_per_degree;
                    math::exp(-PI * PI * degrees * degrees / b)
                };
                let (sum, kernel) = normalised(sample(radius, weight));
                (a * (PI / b).sqrt() * sum * sum, kernel)
            })
            .collect();
        let total: f64 = parts.iter().map(|(share, _)| share).sum();
        for (share, _) in &mut parts {
            *share /= total;
        }
        Blur(parts)
    })
}

impl Blur {
    pub(super) fn blur(&self, plane: &Plane) -> Plane {
        let mut sum = vec![0.0f32; plane.values.len()];
        for (share, kernel) in &self.0 {
            let part = convolve(plane, kernel, kernel);
            for (s, v) in sum.iter_mut().zip(&part.values) {
                *s += *share as f32 * v;
            }
        }
        Plane {
            width: plane.width,
            values: sum,
        }
    }
}

/// What a detector looks for.
#[derive(Clone, Copy)]
pub(super) enum Feature {
    /// First derivative of a Gaussian.
    Edge,
    /// Second derivative.
    Point,
}

/// Norm of a detector's horizontal and vertical response at each pixel.
pub(super) fn strength(plane: &Plane, feature: Feature, pixels_per_degree: f64) -> Vec<f32> {
    let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    let radius = (REACH * deviation).ceil();
    let gauss = |x: f64| math::exp(-x * x / (2.0 * deviation * deviation));
    let across = sample(radius, |x| match feature {
        Feature::Edge => -x * gauss(x),
        Feature::Point => (x * x / (deviation * deviation) - 1.0) * gauss(x),
    });
    let across = balanced(across);
    let (_, along) = normalised(sample(radius, gauss));
    let horizontal = convolve(plane, &across, &along);
    let vertical = convolve(plane, &along, &across);
    (horizontal.values.iter().zip(&vertical.values))
        .map(|(h, v)| (h * h + v * v).sqrt())
        .collect()
}

fn sample(radius: f64, weight: impl Fn(f64) -> f64) -> Kernel {
    let radius = radius as i32;
    (-radius..=radius).map(|x| weight(f64::from(x))).collect()
}

/// The sum, and the kernel divided by it.
fn normalised(kernel: Kernel) -> (f64, Kernel) {
    let sum: f64 = kernel.iter().sum();
    (sum, kernel.into_iter().map(|w| w / sum).collect())
}

/// Positive weights add up to 1, negative ones to −1.
fn balanced(kernel: Kernel) -> Kernel {
    let sum = |sign: f64| kernel.iter().map(|w| (w * sign).max(0.0)).sum::<f64>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    let share = |w: f64| if w > 0.0 { w / positive } else { w / negative };
    kernel.into_iter().map(share).collect()
}

/// Applies a product kernel: first along rows, then along columns.
fn convolve(plane: &Plane, horizontal: &[f64], vertical: &[f64]) -> Plane {
    let width = plane.width;
    let mut rows = Vec::with_capacity(plane.values.len());
    let mut padded = Vec::new();
    let mut sums = vec![0.0; width];
    for row in plane.values.chunks_exact(width) {
        pad(row, horizontal.len() / 2, &mut padded);
        let shifted = horizontal.iter().enumerate();
        accumulate(&mut sums, shifted.map(|(k, &w)| (w, &padded[k..])));
        rows.extend(sums.iter().map(|&s| s as f32));
    }
    let height = rows.len() / width;
    let radius = vertical.len() / 2;
    let mut values = Vec::with_capacity(rows.len());
    for y in 0..height {
        let shifted = vertical.iter().enumerate();
        let line = |k: usize| (y + k).saturating_sub(radius).min(height - 1) * width;
        accumulate(&mut sums, shifted.map(|(k, &w)| (w, &rows[line(k)..])));
        values.extend(sums.iter().map(|&s| s as f32));
    }
    Plane { width, values }
}

/// The row with its ends repeated.
fn pad(row: &[f32], radius: usize, padded: &mut Vec<f32>) {
    padded.clear();
    let (first, last) = (row[0], row[row.len() - 1]);
    padded.extend(std::iter::repeat_n(first, radius));
    padded.extend(row);
    padded.extend(std::iter::repeat_n(last, radius));
}

/// Sets `sums` to the weighted sum of the beginnings of lines.
fn accumulate<'a>(sums: &mut [f64], lines: impl Iterator<Item = (f64, &'a [f32])>) {
    sums.fill(0.0);
    for (weight, line) in lines {
        for (sum, &value) in sums.iter_mut().zip(line) {
            *sum += weight * f64::from(value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_kernel_is_the_kernel_of_products() {
        let (width, height) = (5i32, 4i32);
        let values: Vec<f32> = (0..width * height).map(|i| (i * i % 23) as f32).collect();
        let plane = Plane {
            width: width as usize,
            values,
        };
        // Wider than the picture, and lopsided.
        let h = [0.5, -1.0, 2.0, 0.25, 3.0, 1.0, -0.5];
        let v = [1.0, 2.0, -3.0];
        let got = convolve(&plane, &h, &v);
        for y in 0..height {
            for x in 0..width {
                let mut sum = 0.0;
                for (j, b) in v.iter().enumerate() {
                    for (i, a) in h.iter().enumerate() {
                        let px = (x + i as i32 - 3).clamp(0, width - 1);
                        let py = (y + j as i32 - 1).clamp(0, height - 1);
                        sum += a * b * f64::from(plane.values[(py * width + px) as usize]);
                    }
                }
                // Small integers and quarters: exact.
                assert_eq!(f64::from(got.values[(y * width + x) as usize]), sum);
            }
        }
    }

    #[test]
    fn kernels_keep_what_is_even() {
        let flat = Plane {
            width: 30,
            values: vec![0.7; 30 * 30],
        };
        for blur in contrast_sensitivity(super::super::PIXELS_PER_DEGREE) {
            let all = blur.blur(&flat).values;
            assert!(all.iter().all(|v| (v - 0.7).abs() < 1e-6));
        }
        for feature in [Feature::Edge, Feature::Point] {
            let all = strength(&flat, feature, super::super::PIXELS_PER_DEGREE);
            assert!(all.iter().all(|v| *v < 1e-6));
        }
    }
}
