//! What the sampling tests share.

/// Standard score of Pearson's χ² for points that should be uniform in the unit square, on a grid of `rows` × `columns`
/// cells (Wilson and Hilferty's cube-root transform makes it normal).
pub(super) fn chi_squared(
    rows: usize,
    columns: usize,
    n: u32,
    points: impl Iterator<Item = [f64; 2]>,
) -> f64 {
    let mut counts = vec![0u32; rows * columns];
    for [x, y] in points {
        let row = ((x * rows as f64) as usize).min(rows - 1);
        counts[row * columns + ((y * columns as f64) as usize).min(columns - 1)] += 1;
    }
    let expected = f64::from(n) / counts.len() as f64;
    assert!(expected >= 5.0, "too few points a cell");
    let chi2: f64 = counts
        .iter()
        .map(|&c| (f64::from(c) - expected).powi(2) / expected)
        .sum();
    let freedom = counts.len() as f64 - 1.0;
    let spread = 2.0 / (9.0 * freedom);
    ((chi2 / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
}
