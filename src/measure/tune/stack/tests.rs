use super::*;
use crate::measure::bench::Random;

/// Pictures of known mean and variance: uniform noise of the given width around 1 and 2, plus a bias.
fn stack(seeds: u64, first: u64, bias: f64, width: f64) -> Stack {
    let mut stack = Stack::default();
    for seed in first..first + seeds {
        let mut random = Random::new(seed);
        let pixels: Vec<[f64; 3]> = (0..4096)
            .map(|i| {
                let truth = 1.0 + f64::from(i % 2) + bias;
                [0; 3].map(|_| truth + width * (random.unit() - 0.5))
            })
            .collect();
        stack.add(pixels.into_iter());
    }
    stack
}

/// Mean of 1 and 4.
const POWER: f64 = 2.5;

#[test]
fn bias_and_variance_come_apart_whatever_the_noise_of_the_reference() {
    for width in [0.1, 2.0] {
        let reference = stack(4, 100, 0.0, width);
        assert!((reference.power() / POWER - 1.0).abs() < 0.01);
        for bias in [0.0, 0.1] {
            let found = stack(8, 0, bias, 1.0).against(&reference);
            let off = found.bias_squared.value - bias * bias / POWER;
            assert!(off.abs() < 2.0 * found.bias_squared.half_width, "{found:?}");
            assert!(found.bias_squared.half_width < 0.002, "{found:?}");
            let off = found.variance.value * POWER - 1.0 / 12.0;
            assert!(off.abs() < 0.001, "{found:?}");
            let sum = found.bias_squared.value + found.variance.value;
            assert!((found.squared.value - sum).abs() < 1e-12);
            let off = found.brightness.value - bias / 1.5;
            assert!(off.abs() < 2.0 * found.brightness.half_width, "{found:?}");
            assert_eq!(found.brightness.differs_from_zero(), bias > 0.0);
        }
    }
}

/// Differences seed by seed tell a bias that the noise of the pictures hides.
#[test]
fn what_pictures_have_in_common_cancels() {
    let mut differences = Stack::default();
    for seed in 0..4 {
        let mut random = Random::new(seed);
        let each = (0..4096).map(|_| [0; 3].map(|_| 0.01 + 0.01 * random.unit()));
        differences.add(each.collect::<Vec<_>>().into_iter());
    }
    let found = differences.squared_mean(POWER);
    let wanted = 0.015 * 0.015 / POWER;
    assert!((found.value / wanted - 1.0).abs() < 0.02, "{found:?}");
    assert!(found.half_width < 0.1 * wanted);
}

/// 95 % of the intervals hold the truth: of 400, 380 give or take four standard deviations.
#[test]
fn intervals_hold_what_they_say() {
    let held = (0..400).filter(|k| {
        let sample = |first: u64, n: u64| -> Vec<f64> {
            let each = (first..first + n).map(|seed| {
                let mut random = Random::new(seed);
                1.0 + random.unit() - 0.5
            });
            each.collect()
        };
        let found = welch(&sample(k * 100, 8), &sample(k * 100 + 50, 5));
        !found.differs_from_zero()
    });
    let held = held.count();
    assert!((362..=398).contains(&held), "{held}");
}
