//! How an image's error falls while it is rendered. Means of ever more samples and a reference enter, a table and a chart
//! leave.
//!
//! Deliberately absent: the error of the reference itself, which no row can fall below: it should have 16 times the samples.

mod chart;

use super::{Image, Pair, PairError, Selection, errors};
use std::fmt::Write;
use std::time::Duration;

/// An image after one of its passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Samples per pixel.
    pub spp: u32,
    /// Time since tracing began, measuring left out.
    pub seconds: f64,
    /// sqrt(mean (x − r)²).
    pub rmse: f64,
    /// sqrt(mean (x − r)² / mean r²).
    pub relative_rmse: f64,
    /// mean (x − r)² / (r² + 0.01).
    pub relmse: f64,
    /// What the image itself says of its relative RMSE, and half the width of the 95 % interval of that.
    pub predicted: Option<(f64, f64)>,
}

/// The fall of the error towards a reference.
#[derive(Clone, Debug)]
pub struct Fall {
    reference: Image,
    rms: f64,
    rows: Vec<Row>,
}

impl Fall {
    /// Towards `reference`.
    #[must_use]
    pub fn new(reference: Image) -> Fall {
        let squares = reference.pixels().iter().flatten();
        let sum: f64 = squares.map(|&r| f64::from(r) * f64::from(r)).sum();
        Fall {
            rms: (sum / (3 * reference.pixels().len()) as f64).sqrt(),
            reference,
            rows: Vec::new(),
        }
    }

    /// What it falls towards.
    #[must_use]
    pub fn reference(&self) -> &Image {
        &self.reference
    }

    /// One row for each pass so far.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Measures an image.
    ///
    /// # Errors
    /// If it has another size than the reference, or either has a value that is not finite.
    pub fn add(
        &mut self,
        image: &Image,
        spp: u32,
        time: Duration,
        predicted: Option<(f64, f64)>,
    ) -> Result<(), PairError> {
        let found = errors(&Pair::new(image, &self.reference, Selection::All)?);
        self.rows.push(Row {
            spp,
            seconds: time.as_secs_f64(),
            rmse: found.rmse,
            relative_rmse: found.rmse / self.rms,
            relmse: found.relmse,
            predicted,
        });
        Ok(())
    }

    /// A header and one line for each pass; empty fields where nothing is predicted.
    #[must_use]
    pub fn csv(&self) -> String {
        let header =
            "spp,seconds,rmse,relative_rmse,relmse,predicted_relative_rmse,half_width_95\n";
        let mut csv = header.to_owned();
        for row in &self.rows {
            let Row {
                spp,
                seconds,
                rmse,
                relative_rmse,
                relmse,
                predicted,
            } = row;
            let predicted = match predicted {
                Some((relative, half)) => format!("{relative:.6e},{half:.6e}"),
                None => ",".to_owned(),
            };
            // Writing to a string does not fail.
            let _ = writeln!(
                csv,
                "{spp},{seconds:.4},{rmse:.6e},{relative_rmse:.6e},{relmse:.6e},{predicted}"
            );
        }
        csv
    }

    /// Relative RMSE over samples, both as powers: measured points, what each image says of itself, and lines of slope −½.
    #[must_use]
    pub fn svg(&self, title: &str) -> String {
        chart::svg(&self.rows, title)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(value: f32) -> Image {
        Image::new(2, vec![[value; 3]; 4]).expect("whole")
    }

    #[test]
    fn rows_are_the_errors_and_the_chart_shows_them() {
        let mut fall = Fall::new(grey(2.0));
        let second = Duration::from_secs(1);
        fall.add(&grey(2.5), 1, second, None).expect("one size");
        fall.add(&grey(2.25), 4, 4 * second, Some((0.12, 0.01)))
            .expect("one size");
        let row = fall.rows()[1];
        assert_eq!((row.rmse, row.relative_rmse), (0.25, 0.125));
        assert!((row.relmse - 0.0625 / 4.01).abs() < 1e-9);
        let csv = fall.csv();
        assert_eq!(csv.lines().count(), 3);
        assert!(
            csv.lines().all(|line| line.split(',').count() == 7),
            "{csv}"
        );
        assert!(csv.contains("\n4,4.0000,2.500000e-1,1.250000e-1,"), "{csv}");
        let svg = fall.svg("a < b");
        assert!(
            svg.contains("a &lt; b") && svg.matches("<circle").count() == 2,
            "{svg}"
        );
        let wide = Image::new(4, vec![[0.0; 3]; 4]).expect("whole");
        assert!(fall.add(&wide, 8, second, None).is_err());
    }

    #[test]
    fn a_chart_without_errors_is_empty_not_broken() {
        let mut fall = Fall::new(grey(1.0));
        fall.add(&grey(1.0), 1, Duration::ZERO, None)
            .expect("one size");
        let svg = fall.svg("");
        assert!(
            svg.ends_with("</svg>\n") && !svg.contains("NaN") && !svg.contains("inf"),
            "{svg}"
        );
    }
}
