//! Pictures with their variances, and the tests on them. Every test prints the smallest bias that it would see.

/// Tests fail at this many standard errors: once in 16 000 by chance, and seeds are fixed.
pub(crate) const Z_BAR: f64 = 4.0;

/// A bias of this many standard errors fails the test five times of six: the bar and one more.
const DETECTABLE: f64 = Z_BAR + 1.0;

/// Rounding of f32 radiances, relative; it matters only where the variance is zero.
const ROUNDING: f64 = 1e-5;

/// Sums over the samples of every pixel, by channel.
#[derive(Clone)]
pub(crate) struct Picture {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) sum: Vec<[f64; 3]>,
    pub(crate) squares: Vec<[f64; 3]>,
    pub(crate) count: Vec<f64>,
}

/// A mean with its standard error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mean {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Picture {
    pub(crate) fn new(width: usize, height: usize) -> Picture {
        Picture {
            width,
            height,
            sum: vec![[0.0; 3]; width * height],
            squares: vec![[0.0; 3]; width * height],
            count: vec![0.0; width * height],
        }
    }

    pub(crate) fn add(&mut self, x: usize, y: usize, sample: [f64; 3]) {
        let i = y * self.width + x;
        self.count[i] += 1.0;
        for (c, s) in sample.into_iter().enumerate() {
            self.sum[i][c] += s;
            self.squares[i][c] += s * s;
        }
    }

    /// Mean of a pixel, and the variance of that mean.
    pub(crate) fn pixel(&self, i: usize, c: usize) -> (f64, f64) {
        let n = self.count[i];
        let mean = self.sum[i][c] / n;
        let variance = (self.squares[i][c] / n - mean * mean).max(0.0) / (n - 1.0).max(1.0);
        (mean, variance)
    }

    /// Mean of a channel over the pixels that `inside` (column, row) takes.
    pub(crate) fn mean(&self, c: usize, inside: impl Fn(usize, usize) -> bool) -> Mean {
        let (mut sum, mut variance, mut pixels) = (0.0, 0.0, 0.0);
        for i in (0..self.count.len()).filter(|i| inside(i % self.width, i / self.width)) {
            let (m, v) = self.pixel(i, c);
            sum += m;
            variance += v;
            pixels += 1.0;
        }
        Mean {
            value: sum / pixels,
            error: variance.sqrt() / pixels,
        }
    }

    /// Mean of a channel over the picture.
    pub(crate) fn whole(&self, c: usize) -> Mean {
        self.mean(c, |_, _| true)
    }
}

impl Mean {
    /// A known value.
    pub(crate) fn exact(value: f64) -> Mean {
        Mean { value, error: 0.0 }
    }

    /// Mean and standard error of independent estimates.
    pub(crate) fn of(estimates: &[f64]) -> Mean {
        let n = estimates.len() as f64;
        let value = estimates.iter().sum::<f64>() / n;
        let squares: f64 = estimates.iter().map(|e| (e - value) * (e - value)).sum();
        Mean {
            value,
            error: (squares / (n - 1.0) / n).sqrt(),
        }
    }

    /// Difference in standard errors of the difference (Welch), and the detectable bias relative to `truth`.
    pub(crate) fn against(self, truth: Mean) -> (f64, f64) {
        let error = self.error.hypot(truth.error);
        let difference = (self.value - truth.value).abs();
        let beyond = (difference - ROUNDING * truth.value.abs()).max(0.0);
        let z = if beyond == 0.0 { 0.0 } else { beyond / error };
        let detectable = DETECTABLE * error / truth.value.abs();
        (z, if error == 0.0 { 0.0 } else { detectable })
    }
}

/// Asserts a mean against a known or measured one.
pub(crate) fn assert_mean(name: &str, found: Mean, truth: Mean, detectable_at_most: f64) {
    let (z, detectable) = found.against(truth);
    println!(
        "{name}: {:.6} ± {:.6}, expected {:.6} ± {:.6}, z {z:.2}, detectable bias {:.3} %",
        found.value,
        found.error,
        truth.value,
        truth.error,
        100.0 * detectable
    );
    assert!(found.value.is_finite(), "{name}: not finite");
    assert!(z < Z_BAR, "{name}: z {z:.2}");
    assert!(
        detectable <= detectable_at_most,
        "{name}: would not see a bias of {:.3} %",
        100.0 * detectable
    );
}

/// Asserts that two pictures have the same expectation: over the picture, where a bias above `detectable_at_most`
/// would be seen, and over its four quarters.
pub(crate) fn assert_agree(name: &str, found: &Picture, truth: &Picture, detectable_at_most: f64) {
    for (c, channel) in ["R", "G", "B"].into_iter().enumerate() {
        let (a, b) = (found.whole(c), truth.whole(c));
        assert_mean(&format!("{name} {channel}"), a, b, detectable_at_most);
        for quarter in 0..4 {
            let inside =
                |x: usize, y: usize| (2 * x / truth.width) + 2 * (2 * y / truth.height) == quarter;
            let (z, _) = found.mean(c, inside).against(truth.mean(c, inside));
            assert!(z < Z_BAR, "{name} {channel}, quarter {quarter}: z {z:.2}");
        }
    }
}

#[test]
fn a_bias_of_the_detectable_size_is_detected() {
    let truth = Mean::exact(1.0);
    let found = Mean {
        value: 1.0,
        error: 0.001,
    };
    let (_, detectable) = found.against(truth);
    let biased = Mean {
        value: 1.0 + detectable,
        ..found
    };
    assert!(biased.against(truth).0 > Z_BAR);
    assert!(found.against(truth).0 == 0.0);
    assert!(Mean::exact(1.001).against(truth).0 > Z_BAR);
}
