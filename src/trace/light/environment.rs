//! The sky as a light: a direction where it is bright, the density of that, and what a direction sees.
//!
//! A sample is judged by the direction as rounded, like that of a path that finds the sky by itself: radiance and density
//! are of one texel then, however bright its neighbour is.

use super::LightSample;
use crate::flat::{Environment, EnvironmentTable, FilterMode, FlatScene};
use crate::math::{DVec3, Vec3, atan2, sin_cos};
use crate::trace::vector::V3;
use std::f64::consts::{PI, TAU};

/// What a direction sees of the sky.
pub(in crate::trace) struct Seen {
    pub(in crate::trace) radiance: Vec3,
    /// Density over solid angle of sampling that direction, the choice of the light included.
    pub(in crate::trace) pdf: f32,
}

/// Looks at the sky; black where there is none.
pub(in crate::trace) fn see(scene: &FlatScene, dir: Vec3) -> Seen {
    let Some(sky) = &scene.environment else {
        return Seen {
            radiance: Vec3::ZERO,
            pdf: 0.0,
        };
    };
    let lights = &scene.lights;
    let share = match lights.environment {
        true => lights.share(lights.len() - 1),
        false => 0.0,
    };
    let place = Place::of(sky, dir);
    Seen {
        radiance: radiance(sky, &place),
        pdf: (share * pdf(sky, &place)) as f32,
    }
}

/// Samples the sky, which is chosen with the probability `share`; `None` where the sample finds nothing.
#[inline(never)]
pub(super) fn sample_environment(
    sky: &Environment,
    share: f64,
    u: [f32; 2],
) -> Option<LightSample<f32>> {
    let dir = sample(sky, u);
    let place = Place::of(sky, dir);
    let (radiance, pdf) = (radiance(sky, &place), (share * pdf(sky, &place)) as f32);
    (pdf > 0.0 && radiance != Vec3::ZERO).then_some(LightSample {
        dir: V3::from(dir),
        t_max: f32::MAX,
        radiance: V3::from(radiance),
        pdf,
        punctual: 0,
        valid: 1,
    })
}

/// Where a direction is in the image.
struct Place {
    /// Columns from the left, rows from the top; texel (i, j) is from (i, j) to (i + 1, j + 1).
    across: f64,
    down: f64,
    column: usize,
    row: usize,
}

impl Place {
    /// The angle from +Y by its tangent: by the cosine, the poles would be blurred by 10⁻⁴.
    fn of(sky: &Environment, dir: Vec3) -> Place {
        let [x, y, z] = dir.to_array().map(f64::from);
        let [cos, sin] = sky.turn;
        let (x, z) = (x * cos - z * sin, x * sin + z * cos);
        let around = 0.5 - atan2(x, z) / TAU;
        let below = atan2((x * x + z * z).sqrt(), y) / PI;
        let (across, down) = (around * f64::from(sky.width), below * f64::from(sky.height));
        Place {
            across,
            down,
            column: (across as usize).min(sky.width as usize - 1),
            row: (down as usize).min(sky.height as usize - 1),
        }
    }
}

/// A direction by the table. The numbers choose row and column, and what they leave is the place within.
fn sample(sky: &Environment, u: [f32; 2]) -> Vec3 {
    let table = &sky.table;
    let (row, down) = choose(&table.rows, u[0]);
    let (column, across) = choose(columns(sky, row), u[1]);
    let [above, below] = [table.heights[row], table.heights[row + 1]];
    let height = above + (below - above) * down;
    let sin_theta = (height * (2.0 - height)).max(0.0).sqrt();
    let around = (column as f64 + across) / f64::from(sky.width);
    let (sin_around, cos_around) = sin_cos(TAU * around);
    let (x, z) = (sin_theta * sin_around, -sin_theta * cos_around);
    let [cos, sin] = sky.turn;
    let (x, z) = (x * cos + z * sin, z * cos - x * sin);
    Vec3::new(x as f32, (1.0 - height) as f32, z as f32)
}

/// The interval of running sums in which a number in (0, 1) lies, and where in it, from 0 to 1.
fn choose(sums: &[f32], number: f32) -> (usize, f64) {
    let last = sums.len() - 2;
    let i = sums[1..].partition_point(|&sum| sum <= number).min(last);
    let [from, to] = [sums[i], sums[i + 1]].map(f64::from);
    let within = (f64::from(number) - from) / (to - from);
    (i, if within.is_finite() { within } else { 0.5 })
}

fn columns(sky: &Environment, row: usize) -> &[f32] {
    let length = sky.width as usize + 1;
    &sky.table.columns[row * length..(row + 1) * length]
}

/// Density over solid angle of sampling a direction of a texel.
fn pdf(sky: &Environment, place: &Place) -> f64 {
    let EnvironmentTable { rows, heights, .. } = &*sky.table;
    let step = |sums: &[f32], i: usize| f64::from(sums[i + 1]) - f64::from(sums[i]);
    let row = step(rows, place.row);
    let column = step(columns(sky, place.row), place.column);
    let height = heights[place.row + 1] - heights[place.row];
    row * column * f64::from(sky.width) / (TAU * height)
}

/// In f64, in which equal texels stay what they are and a bright one leaves its neighbours their bits.
fn radiance(sky: &Environment, place: &Place) -> Vec3 {
    let (width, height) = (sky.width as usize, sky.height as usize);
    let texel = |x: usize, y: usize| Vec3::from(sky.texels[y * width + x]);
    if sky.filter == FilterMode::Nearest {
        return texel(place.column, place.row) * sky.strength;
    }
    // From the middle of the texel to that of the next one, left or right, up or down.
    let (x, y) = (place.across - 0.5, place.down - 0.5);
    let (x0, y0) = (x.floor(), y.floor());
    let column = |x: f64| (x + width as f64) as usize % width;
    let row = |y: f64| (y.max(0.0) as usize).min(height - 1);
    let between = |a: DVec3, b: DVec3, at: f64| a + (b - a) * at;
    let along = |y: usize| {
        let [left, right] = [x0, x0 + 1.0].map(|x| texel(column(x), y).as_dvec3());
        between(left, right, x - x0)
    };
    between(along(row(y0)), along(row(y0 + 1.0)), y - y0).as_vec3() * sky.strength
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Sampler::Independent;
    use crate::trace::sampler::{Pair, sample_pair};
    use crate::trace::test_support::score;
    use std::sync::Arc;

    const WIDTH: usize = 5;
    const HEIGHT: usize = 4;
    /// A dark texel, a dark row, a texel with nearly all of its row.
    const ROWS: [f32; 5] = [0.0, 0.2, 0.2, 0.9, 1.0];
    const COLUMNS: [[f32; 6]; 4] = [
        [0.0, 0.1, 0.1, 0.5, 0.8, 1.0],
        [0.0; 6],
        [0.0, 0.01, 0.02, 0.97, 0.98, 1.0],
        [0.0, 0.2, 0.4, 0.6, 0.8, 1.0],
    ];
    const TURN_DEG: f64 = 33.0;

    fn sky() -> Environment {
        let (sin, cos) = TURN_DEG.to_radians().sin_cos();
        Environment {
            texels: Arc::new([[1.0; 3]; WIDTH * HEIGHT]),
            width: WIDTH as u32,
            height: HEIGHT as u32,
            filter: FilterMode::Nearest,
            strength: 1.0,
            turn: [cos, sin],
            table: Arc::new(EnvironmentTable {
                rows: ROWS.to_vec(),
                columns: COLUMNS.as_flattened().to_vec(),
                heights: (0..=HEIGHT)
                    .map(|row| 1.0 - (PI * row as f64 / HEIGHT as f64).cos())
                    .collect(),
                total: 1.0,
            }),
        }
    }

    /// From what stands in the head of [`crate::flat::environment`].
    fn direction(around: f64, cos: f64) -> Vec3 {
        let longitude = TAU * (0.5 - around) + TURN_DEG.to_radians();
        let sin = (1.0 - cos * cos).sqrt();
        DVec3::new(sin * longitude.sin(), cos, sin * longitude.cos()).as_vec3()
    }

    /// Every texel cut into `CUT` × `CUT` pieces of one solid angle: their probability is density times solid angle.
    #[test]
    fn directions_come_by_their_density() {
        const CUT: usize = 3;
        const SAMPLES: u32 = 200_000;
        let sky = sky();
        let heights = sky.table.heights.clone();
        let columns = CUT * WIDTH;
        let mut expected = vec![0.0; CUT * HEIGHT * columns];
        for (i, expected) in expected.iter_mut().enumerate() {
            let (row, column) = (i / columns, i % columns);
            let [above, below] = [heights[row / CUT], heights[row / CUT + 1]];
            let height = above + (below - above) * ((row % CUT) as f64 + 0.5) / CUT as f64;
            let middle = direction((column as f64 + 0.5) / columns as f64, 1.0 - height);
            let angle = TAU / columns as f64 * (below - above) / CUT as f64;
            *expected = pdf(&sky, &Place::of(&sky, middle)) * angle * f64::from(SAMPLES);
        }
        let all: f64 = expected.iter().sum();
        assert!((all / f64::from(SAMPLES) - 1.0).abs() < 1e-6, "{all}");

        let mut counts = vec![0u32; expected.len()];
        for i in 0..SAMPLES {
            let dir = sample(&sky, sample_pair(Independent, 5, i, Pair::Pixel));
            assert!((dir.length() - 1.0).abs() < 3e-7);
            let [x, y, z] = dir.to_array().map(f64::from);
            let longitude = x.atan2(z) - TURN_DEG.to_radians();
            let column = (0.5 - longitude / TAU).rem_euclid(1.0) * columns as f64;
            let row = heights[1..HEIGHT].partition_point(|&height| height <= 1.0 - y);
            let within = (1.0 - y - heights[row]) / (heights[row + 1] - heights[row]);
            let row = CUT * row + ((within * CUT as f64) as usize).min(CUT - 1);
            counts[row * columns + (column as usize).min(columns - 1)] += 1;
        }
        let dark = counts.iter().zip(&expected).filter(|(_, e)| **e == 0.0);
        assert!(dark.map(|(count, _)| *count).max() <= Some(1));
        let z = score(&counts, &expected);
        assert!(z.abs() < 4.0, "z = {z}");
    }

    /// Where a direction is in the image, at the poles too, where its y says little.
    #[test]
    fn places_are_exact_at_the_poles() {
        let sky = sky();
        for k in 0..12 {
            let theta = f64::powi(10.0, -k);
            for around in [0.1, 0.6, 0.9] {
                let longitude = TAU * (0.5 - around) + TURN_DEG.to_radians();
                let (sin, cos) = theta.sin_cos();
                let dir = DVec3::new(sin * longitude.sin(), cos, sin * longitude.cos());
                let place = Place::of(&sky, dir.as_vec3());
                let down = theta / PI * HEIGHT as f64;
                assert!((place.down / down - 1.0).abs() < 1e-6, "{theta}");
                let across = around * WIDTH as f64;
                assert!((place.across - across).abs() < 1e-6 * across, "{theta}");
            }
        }
    }

    #[test]
    fn every_number_chooses_something_likely() {
        for number in [f32::MIN_POSITIVE, 0.2, 0.2f32.next_down(), 0.9, 1.0 - 1e-7] {
            let (row, within) = choose(&ROWS, number);
            assert!(ROWS[row] < ROWS[row + 1] && (0.0..=1.0).contains(&within));
        }
        assert_eq!(choose(&[0.0; 4], 0.5), (2, 0.5));
    }
}
