use super::*;
use crate::build::{Accel, Quality as Tree};
use crate::measure::tune::Row;
use crate::measure::tune::{Dials, Differences, Estimate};
use crate::trace::{Fresnel, Sampler};

const EXACT: Dials = Dials {
    bounces: 8,
    nee: true,
    mis: true,
    sampler: Sampler::Sobol,
    roulette: true,
    fresnel: Fresnel::Exact,
    accel: Accel::Bvh,
    quality: Tree::Good,
};

fn estimate(value: f64, half_width: f64) -> Estimate {
    Estimate { value, half_width }
}

/// A setting whose variance with one sample is `variance` and falls with the power `slope`.
fn row(dials: Dials, per_sample: f64, variance: f64, slope: f64, bias: f64) -> Row {
    let level = |spp: u32| Level {
        spp,
        seeds: 8,
        seconds: [per_sample; 2],
        differences: Differences {
            variance: estimate(variance * pow(f64::from(spp), -slope), 0.0),
            ..Differences::default()
        },
    };
    let biases = usize::from(dials.bounces != 8);
    Row {
        dials,
        biases,
        turned: dials.arguments(&EXACT).len(),
        build: 0.0,
        per_sample,
        bias_squared: estimate(bias * bias, 0.0),
        levels: [1, 4, 16, 64].map(level).to_vec(),
        dropped: false,
    }
}

fn report(rows: Vec<Row>) -> Report {
    Report {
        rows,
        full: (100, 100),
        size: (100, 100),
        scale: None,
        shrunk: Vec::new(),
        reference: (8, 64),
        threads: 1,
    }
}

fn goal(quality: Quality, error: f64) -> Goal {
    Goal { quality, error }
}

#[test]
fn samples_are_as_many_as_the_error_wants() {
    let report = report(vec![row(EXACT, 1e-6, 0.16, 1.0, 0.3)]);
    for (error, spp) in [(0.4, 1), (0.1, 16), (0.04, 100), (0.01, 1600)] {
        let pick = choose(&report, goal(Quality::Final, error)).expect("there is one");
        // A bias that dials cannot have does not count: it is noise.
        assert!(pick.spp.abs_diff(spp) <= 1, "{pick:?}");
        assert!(pick.error <= error * 1.001 && pick.bias == 0.0, "{pick:?}");
        let seconds = 1e4 * 1e-6 * f64::from(pick.spp);
        assert!((pick.seconds - seconds).abs() < 1e-9);
    }
    assert_eq!(choose(&report, goal(Quality::Final, 1e-9)), None);
}

#[test]
fn the_fastest_wins_and_among_equals_the_simplest() {
    let off = Dials {
        roulette: false,
        ..EXACT
    };
    for (speed, wins) in [(1.06, 0), (1.12, 1)] {
        let rows = vec![
            row(EXACT, 1e-6, 0.16, 1.0, 0.0),
            row(off, 1e-6 / speed, 0.16, 1.0, 0.0),
        ];
        let pick = choose(&report(rows), goal(Quality::Final, 0.02)).expect("there is one");
        assert_eq!(pick.row, wins);
    }
}

#[test]
fn bias_counts_and_has_its_share() {
    let few = Dials {
        bounces: 2,
        ..EXACT
    };
    let rows = vec![
        row(EXACT, 1e-6, 0.16, 1.0, 0.0),
        row(few, 0.5e-6, 0.16, 1.0, 0.03),
    ];
    let report = report(rows);
    let of = |quality, error| choose(&report, goal(quality, error)).expect("there is one");
    // 0.03 is more than a quarter of 0.1, not more than half of it, and all of 0.03.
    assert_eq!(of(Quality::Final, 0.1).row, 0);
    let preview = of(Quality::Preview, 0.1);
    assert_eq!((preview.row, preview.bias), (1, 0.03));
    // (0.1² − 0.03²) / 0.16 = 1 / 17.6
    assert_eq!(preview.spp, 18);
    assert_eq!(of(Quality::Draft, 0.03).row, 0);
}

#[test]
fn smaller_pictures_are_chosen_where_their_bias_allows() {
    let mut report = report(vec![row(EXACT, 1e-6, 0.16, 1.0, 0.0)]);
    report.shrunk = vec![Shrunk {
        divisor: 2,
        size: (50, 50),
        bias_squared: estimate(0.0064, 0.0001),
        variance: 0.5,
        time: 1.0,
    }];
    let draft = choose(&report, goal(Quality::Draft, 0.1)).expect("there is one");
    // 0.5 · 0.16 / (0.01 − 0.0065) = 22.9, of a quarter of the pixels.
    assert_eq!((draft.size, draft.spp), ((50, 50), 23));
    assert!((draft.error - 0.1).abs() < 0.001, "{draft:?}");
    let last = choose(&report, goal(Quality::Final, 0.1)).expect("there is one");
    assert_eq!((last.size, last.spp), ((100, 100), 16));
}

#[test]
fn variance_goes_on_as_it_fell_but_not_for_ever() {
    let smooth = row(EXACT, 1e-6, 1.0, 2.0, 0.0);
    let at = |n: f64| variance(&smooth.levels, n);
    assert!((at(8.0) * 64.0 - 1.0).abs() < 1e-9);
    assert!((at(128.0) / at(64.0) - pow(2.0, -1.25)).abs() < 1e-9);
}
