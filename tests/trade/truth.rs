//! What the errors really are, told by many renders that differ in their seed alone.

use crate::stage::{Ask, Stage};
use luxel::film::Film;

/// Renders of the same frame and what they are estimates of.
pub(crate) struct Truth {
    pub(crate) films: Vec<Film>,
    /// Sum over the films of each pixel's radiance.
    sums: Vec<[f64; 3]>,
    /// sqrt(mean variance of the pixels / mean of their squared expectation): unbiased but for the root.
    pub(crate) relative: f64,
}

impl Truth {
    pub(crate) fn of(stage: &Stage, ask: Ask, seeds: u64) -> Truth {
        let films: Vec<Film> = (0..seeds)
            .map(|seed| stage.film(Ask { seed, ..ask }))
            .collect();
        let pictures: Vec<Vec<[f32; 3]>> = films.iter().map(Film::radiance).collect();
        let mut sums = vec![[0.0; 3]; films[0].pixels()];
        for picture in &pictures {
            for (sum, x) in sums.iter_mut().zip(picture) {
                for c in 0..3 {
                    sum[c] += f64::from(x[c]);
                }
            }
        }
        let n = seeds as f64;
        let (mut variance, mut square) = (0.0, 0.0);
        for (i, sum) in sums.iter().enumerate() {
            for c in 0..3 {
                let mean = sum[c] / n;
                let deviations = pictures.iter().map(|p| (f64::from(p[i][c]) - mean).powi(2));
                let own = deviations.sum::<f64>() / (n - 1.0);
                variance += own;
                square += mean * mean - own / n;
            }
        }
        Truth {
            films,
            sums,
            relative: (variance / square).sqrt(),
        }
    }

    /// Of the pixels and channels whose standard error is not 0, the share in which 1.96 of them cover the mean of the other
    /// films, whose own error is allowed for.
    pub(crate) fn coverage(&self) -> f64 {
        let others = (self.films.len() - 1) as f64;
        let allowance = (1.0 + 1.0 / others).sqrt();
        let (mut inside, mut all) = (0u64, 0u64);
        for film in &self.films {
            let pixels = film.radiance().into_iter().zip(film.standard_error());
            for ((x, error), sum) in pixels.zip(&self.sums) {
                for c in 0..3 {
                    let (x, error) = (f64::from(x[c]), f64::from(error[c]));
                    if error > 0.0 {
                        let mean = (sum[c] - x) / others;
                        all += 1;
                        inside += u64::from((x - mean).abs() <= 1.96 * error * allowance);
                    }
                }
            }
        }
        inside as f64 / all as f64
    }

    /// The relative error that a film really has: from the mean of the others, whose own error is taken out.
    pub(crate) fn actual(&self, film: usize) -> f64 {
        let others = (self.films.len() - 1) as f64;
        let (mut error, mut square) = (0.0, 0.0);
        for (x, sum) in self.films[film].radiance().into_iter().zip(&self.sums) {
            for c in 0..3 {
                let x = f64::from(x[c]);
                let mean = (sum[c] - x) / others;
                error += (x - mean).powi(2);
                square += mean * mean;
            }
        }
        (error / square / (1.0 + 1.0 / others)).sqrt()
    }
}
