//! The sky: an image of the store as tracing reads it, with the table of its directions.

use crate::asset::{AssetStore, Filter, Panorama};
use crate::flat::{Environment, EnvironmentTable, FilterMode};
use crate::math::{sin, sin_cos_deg};
use crate::world::Sky;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The sky of a frame; its table is made once.
pub(crate) fn environment(
    sky: &Sky,
    store: &AssetStore,
    kept: &mut Option<Arc<EnvironmentTable>>,
) -> Environment {
    let image = store.panorama(sky.image);
    let filter = match sky.filter {
        Filter::Bilinear => FilterMode::Bilinear,
        Filter::Nearest => FilterMode::Nearest,
    };
    let made = || Arc::new(table(image, filter));
    let (sin, cos) = sin_cos_deg(sky.rotate_deg);
    Environment {
        texels: image.texels.clone(),
        width: image.width,
        height: image.height,
        filter,
        strength: sky.strength as f32,
        turn: [cos, sin],
        table: kept.get_or_insert_with(made).clone(),
    }
}

fn table(image: &Panorama, filter: FilterMode) -> EnvironmentTable {
    let (width, height) = (image.width as usize, image.height as usize);
    let heights: Vec<f64> = (0..=height)
        .map(|row| {
            // 1 − cos θ = 2 sin² (θ / 2), which does not cancel.
            let half = sin(PI * row as f64 / (2.0 * height as f64));
            2.0 * half * half
        })
        .collect();
    let mut columns = vec![0.0; height * (width + 1)];
    let means: Vec<f64> = columns
        .par_chunks_mut(width + 1)
        .enumerate()
        .map(|(row, sums)| running(sums, |x| weight(image, filter, x, row)) / width as f64)
        .collect();
    let mut rows = vec![0.0; height + 1];
    let total = running(&mut rows, |row| {
        means[row] * TAU * (heights[row + 1] - heights[row])
    });
    EnvironmentTable {
        rows,
        columns,
        heights,
        total,
    }
}

/// Fills the running sums of weights, divided by their sum, which it returns; zeros if that is 0.
fn running(sums: &mut [f32], weight: impl Fn(usize) -> f64) -> f64 {
    let count = sums.len() - 1;
    let total: f64 = (0..count).map(&weight).sum();
    if total > 0.0 {
        let mut sum = 0.0;
        for i in 0..count {
            sum += weight(i);
            sums[i + 1] = (sum / total) as f32;
        }
    }
    total
}

/// Mean filtered radiance of a texel's area in the image. Bilinear interpolation along an axis takes an eighth of it from
/// either neighbour.
fn weight(image: &Panorama, filter: FilterMode, x: usize, y: usize) -> f64 {
    let (width, height) = (image.width as usize, image.height as usize);
    let at = |x: usize, y: usize| {
        let [r, g, b] = image.texels[y * width + x].map(f64::from);
        (r + g + b) / 3.0
    };
    if filter == FilterMode::Nearest {
        return at(x, y);
    }
    let (left, right) = ((x + width - 1) % width, (x + 1) % width);
    let row = |y| 0.125 * (at(left, y) + at(right, y)) + 0.75 * at(x, y);
    0.125 * (row(y.saturating_sub(1)) + row((y + 1).min(height - 1))) + 0.75 * row(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, texels: Vec<[f32; 3]>) -> Panorama {
        Panorama {
            path: Default::default(),
            width,
            height: texels.len() as u32 / width,
            texels: texels.into(),
        }
    }

    /// Bilinear interpolation of a row of means, summed over the area of every texel.
    #[test]
    fn weights_are_means_of_what_is_seen() {
        let texels: Vec<[f32; 3]> = (0..15).map(|i| [i as f32, 1.0, (i * i) as f32]).collect();
        let image = image(5, texels.clone());
        let at = |x: i64, y: i64| {
            let [r, g, b] = texels[(y.clamp(0, 2) * 5 + x.rem_euclid(5)) as usize];
            f64::from(r + g + b) / 3.0
        };
        const STEPS: i64 = 50;
        for i in 0..15 {
            let (x, y) = (i % 5, i / 5);
            let mut sum = 0.0;
            for step in 0..STEPS * STEPS {
                let place = |i, step| (i as f64 + (step as f64 + 0.5) / STEPS as f64) - 0.5;
                let (px, py) = (place(x, step % STEPS), place(y, step / STEPS));
                let (x0, y0) = (px.floor() as i64, py.floor() as i64);
                let (fx, fy) = (px - px.floor(), py - py.floor());
                let row = |y| at(x0, y) * (1.0 - fx) + at(x0 + 1, y) * fx;
                sum += row(y0) * (1.0 - fy) + row(y0 + 1) * fy;
            }
            let mean = sum / (STEPS * STEPS) as f64;
            let found = weight(&image, FilterMode::Bilinear, x as usize, y as usize);
            assert!((found - mean).abs() < 1e-3 * mean, "{found} {mean}");
            let nearest = weight(&image, FilterMode::Nearest, x as usize, y as usize);
            assert!((nearest - at(x, y)).abs() < 1e-6);
        }
    }

    #[test]
    fn a_sky_of_one_colour_has_the_same_density_everywhere() {
        for filter in [FilterMode::Bilinear, FilterMode::Nearest] {
            let table = table(&image(8, vec![[1.0, 2.0, 3.0]; 32]), filter);
            assert!((table.total - 2.0 * 2.0 * TAU).abs() < 1e-12);
            assert_eq!((table.rows[0], table.rows[4]), (0.0, 1.0));
            for (row, height) in table.rows.iter().zip(&table.heights) {
                assert!((f64::from(*row) - height / 2.0).abs() < 1e-7);
            }
        }
    }

    #[test]
    fn a_black_sky_is_never_chosen() {
        let table = table(&image(4, vec![[0.0; 3]; 8]), FilterMode::Bilinear);
        assert_eq!(table.total, 0.0);
        assert!(
            table
                .rows
                .iter()
                .chain(&table.columns)
                .all(|sum| *sum == 0.0)
        );
    }
}
