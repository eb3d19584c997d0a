//! What the sampling tests share.

/// Standard score of Pearson's χ² for points that should be uniform in the unit square, on a grid of `rows` × `columns`
/// cells.
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
    score(
        &counts,
        &vec![f64::from(n) / counts.len() as f64; counts.len()],
    )
}

/// Standard score of Pearson's χ² for counts of cells that are expected to be these; cells that nothing is expected in are
/// left out. (Wilson and Hilferty's cube-root transform makes it normal.)
pub(super) fn score(counts: &[u32], expected: &[f64]) -> f64 {
    let cells = || counts.iter().zip(expected).filter(|(_, e)| **e > 0.0);
    assert!(cells().all(|(_, e)| *e >= 5.0), "too few points a cell");
    let chi2: f64 = cells()
        .map(|(&count, expected)| (f64::from(count) - expected).powi(2) / expected)
        .sum();
    let freedom = cells().count() as f64 - 1.0;
    let spread = 2.0 / (9.0 * freedom);
    ((chi2 / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
}
