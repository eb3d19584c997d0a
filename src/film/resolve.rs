//! Sums to linear f32 images: one division per pixel, at the very end.

use super::Film;

impl Film {
    /// Mean radiance of every pixel, linear RGB; 0 where there is no sample.
    #[must_use]
    pub fn radiance(&self) -> Vec<[f32; 3]> {
        let planes = self.planes();
        means(&planes.rgb, &planes.count)
    }

    /// Mean of a three-component feature over the samples that hit; 0 where none did.
    pub(super) fn feature(&self, sums: &[[f64; 3]]) -> Vec<[f32; 3]> {
        means(sums, &self.planes().hit_count)
    }

    /// Mean depth over the samples that hit, authored units; +inf where none did.
    #[must_use]
    pub fn depth(&self) -> Vec<f32> {
        let planes = self.planes();
        let mean = |(&sum, &n): (&f64, &u32)| match n {
            0 => f32::INFINITY,
            n => (sum / f64::from(n)) as f32,
        };
        planes
            .depth
            .iter()
            .zip(&planes.hit_count)
            .map(mean)
            .collect()
    }

    /// Standard error of the mean radiance; +inf below two samples.
    ///
    /// Of independent samples it is `sqrt((Σx² − (Σx)²/n) / (n (n − 1)))`. Samples that are spread evenly depend on each other
    /// and are nearer to the truth than that says: there it is told from blocks of them, a pixel's own and its neighbours'.
    #[must_use]
    pub fn standard_error(&self) -> Vec<[f32; 3]> {
        if let Some(errors) = self.block_errors() {
            return errors;
        }
        let planes = self.planes();
        let pixel = |i: usize| {
            let n = f64::from(planes.count[i]);
            std::array::from_fn(|c| {
                if n < 2.0 {
                    return f32::INFINITY;
                }
                let sum = planes.rgb[i][c];
                let scatter = (planes.rgb_squared[i][c] - sum * sum / n).max(0.0);
                (scatter / (n * (n - 1.0))).sqrt() as f32
            })
        };
        (0..planes.rgb_squared.len()).map(pixel).collect()
    }
}

fn means(sums: &[[f64; 3]], counts: &[u32]) -> Vec<[f32; 3]> {
    let mean = |(sum, &n): (&[f64; 3], &u32)| match n {
        0 => [0.0; 3],
        n => sum.map(|s| (s / f64::from(n)) as f32),
    };
    sums.iter().zip(counts).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Planes, Window};
    use super::*;

    const PIXEL: Window = Window {
        x: 0,
        y: 0,
        width: 1,
        height: 1,
    };

    fn film(samples: &[f64]) -> Film {
        let n = u32::try_from(samples.len()).expect("few");
        let mut film = Film::new(1, 1);
        let planes = Planes {
            rgb: vec![[samples.iter().sum(); 3]],
            rgb_squared: vec![[samples.iter().map(|x| x * x).sum(); 3]],
            count: vec![n],
            hit_count: vec![0],
            depth: vec![0.0],
            ..Planes::default()
        };
        film.put(PIXEL, &planes);
        film
    }

    #[test]
    fn the_standard_error_is_the_textbook_one() {
        let samples = [1.0, 2.0, 4.0, 9.0];
        // Mean 4, squared deviations 9 + 4 + 0 + 25 = 38, variance 38/3, of the mean 38/12.
        assert_eq!(film(&samples).radiance()[0], [4.0; 3]);
        assert_eq!(
            film(&samples).standard_error()[0],
            [(38.0f64 / 12.0).sqrt() as f32; 3]
        );
    }

    /// At a rim, where some samples hit nothing, the features are those of what is hit.
    #[test]
    fn features_are_means_over_the_samples_that_hit() {
        let mut film = film(&[1.0, 2.0, 4.0, 9.0]);
        let two_of_them = Planes {
            hit_count: vec![2],
            depth: vec![10.0],
            ..Planes::default()
        };
        film.put(PIXEL, &two_of_them);
        assert_eq!(film.depth(), [5.0]);
        assert_eq!(film.feature(&[[1.0, 0.5, -2.0]]), [[0.5, 0.25, -1.0]]);
    }

    #[test]
    fn too_few_samples_say_so() {
        assert_eq!(film(&[]).radiance()[0], [0.0; 3]);
        assert_eq!(film(&[3.0]).standard_error()[0], [f32::INFINITY; 3]);
        assert_eq!(film(&[3.0, 3.0]).standard_error()[0], [0.0; 3]);
        assert_eq!(film(&[3.0]).depth(), [f32::INFINITY]);
    }
}
