//! `--noise`: the error that is asked for is the error that there is, and asking does not change the light.

use crate::stage::{Ask, Stage};
use crate::truth::Truth;
use luxel::film::Film;

/// Most that the error may be off the one asked for, as a share of it.
const OFF: f64 = 0.10;

/// Most samples that a test waits for.
const MOST: u32 = 1024;

/// How many of `seeds` renders to an error of `wanted` are within the bar, and how many samples they took.
fn within(stage: &Stage, wanted: f64, seeds: u64) -> u64 {
    let ask = Ask {
        noise: Some(wanted),
        ..Ask::new(MOST, 0)
    };
    let truth = Truth::of(stage, ask, seeds);
    let ratios: Vec<f64> = (0..truth.films.len())
        .map(|i| truth.actual(i) / wanted)
        .collect();
    let mean = |film: &Film| film.total_samples() / film.pixels() as u64;
    let spp: Vec<u64> = truth.films.iter().map(mean).collect();
    println!(
        "{} to {wanted}: {spp:?} spp, actual / asked {ratios:.3?}",
        stage.name
    );
    ratios
        .iter()
        .filter(|ratio| (*ratio - 1.0).abs() <= OFF)
        .count() as u64
}

#[test]
fn the_error_is_the_one_asked_for() {
    for (name, wanted) in [("lens", 0.12), ("lens", 0.09)] {
        let stage = Stage::shipped(name, 48);
        assert!(within(&stage, wanted, 6) >= 5, "{name}");
    }
}

#[test]
#[ignore = "long: ten minutes; cargo test --release --test trade hundred -- --ignored --nocapture"]
fn of_a_hundred_renders_ninety_five_are_as_wrong_as_asked() {
    const SEEDS: u64 = 10;
    let asked = [
        ("cat_flat", 0.02),
        ("cat_room", 0.06),
        ("cat_smooth", 0.02),
        ("cat_spin", 0.03),
        ("cat_textured", 0.02),
        ("cat_turned", 0.02),
        ("hero", 0.06),
        ("lattice", 0.02),
        ("lens", 0.06),
        ("materials", 0.08),
    ];
    let good: u64 = asked
        .iter()
        .map(|&(name, wanted)| within(&Stage::shipped(name, 96), wanted, SEEDS))
        .sum();
    println!("{good} of {} within 10 %", SEEDS * asked.len() as u64);
    assert!(good * 100 >= 95 * SEEDS * asked.len() as u64);
}

/// Where samples go where the error is, an error takes fewer of them on average than where all pixels have the same number: the
/// gain of each scene is printed.
#[test]
#[ignore = "long: minutes; cargo test --release --test trade where_the_error_is -- --ignored --nocapture"]
fn samples_that_go_where_the_error_is_are_fewer() {
    let asked = [
        ("diffuse_room", 0.01),
        ("cat_room", 0.015),
        ("hero", 0.04),
        ("lights", 0.04),
        ("materials", 0.05),
        ("sky", 0.015),
    ];
    let mut gains = 1.0;
    for (name, wanted) in asked {
        let stage = Stage::shipped(name, 128);
        let cost = |adaptive| {
            let ask = Ask {
                noise: Some(wanted),
                adaptive,
                ..Ask::new(1 << 14, 3)
            };
            let stats = stage.render(ask).stats;
            f64::from(stats.spp + stats.pilot)
        };
        let gain = cost(false) / cost(true);
        println!("{name} to {wanted}: {gain:.2} times fewer samples, pilots included");
        gains *= gain;
    }
    let mean = f64::powf(gains, 1.0 / asked.len() as f64);
    println!("{mean:.2} times fewer on average");
    assert!(mean > 1.2, "{mean}");
}

#[test]
fn neither_threads_nor_tiles_choose_the_number_of_samples() {
    let stage = Stage::shipped("lens", 40);
    let render = |adaptive, tile, threads| {
        let ask = Ask {
            noise: Some(0.15),
            adaptive,
            tile,
            threads,
            ..Ask::new(MOST, 5)
        };
        stage.render(ask)
    };
    for adaptive in [true, false] {
        let one = render(adaptive, 64, 1);
        assert!(
            one.stats.spp > 4 && one.stats.pilot >= 16,
            "{:?}",
            one.stats
        );
        for (tile, threads) in [(7, 1), (16, 3)] {
            let other = render(adaptive, tile, threads);
            assert_eq!(other.stats.spp, one.stats.spp);
            assert_eq!(other.stats.cells, one.stats.cells);
            assert_eq!(other.film.planes(), one.film.planes());
            assert_eq!(other.film.error(), one.film.error());
        }
    }
    // The same bits as when that number is asked for.
    let one = render(false, 64, 1);
    let plain = stage.render(Ask::new(one.stats.spp, 5));
    assert_eq!(plain.film.planes(), one.film.planes());
    let but_error = |rendering: &luxel::render::Rendering| {
        let all = rendering
            .metadata
            .entries()
            .filter(|(key, _)| !["error", "adaptive"].contains(key));
        all.map(|(key, value)| format!("{key}: {value}"))
            .collect::<Vec<_>>()
    };
    assert_eq!(but_error(&plain), but_error(&one));
}

/// A pixel that is bright by accident: one bounce, and a lamp that one path of fourteen or so finds. Its light is the mean over
/// many seeds, whatever number of samples each takes; a render that looks at its own samples stops while it is dark.
#[test]
fn asking_does_not_change_the_light() {
    const SEEDS: u64 = 400;
    const WANTED: f64 = 0.4;
    let body = "camera: (at: (0, 0, 5), look_at: (0, 0, 0), vfov_deg: 5), render: (size: (1, 1), spp: 4, max_bounces: 1),
        materials: {\"white\": Diffuse(color: Linear(1, 1, 1))},
        entities: [
            (name: \"wall\", shape: Sphere(radius: 300), transform: (translate: (0, 0, -300)), material: \"white\"),
            (name: \"lamp\", shape: Sphere(radius: 1.5), transform: (translate: (3, 0, 4)), emissive: (radiance: (9, 9, 9))),
        ]";
    let stage = Stage::of("accident", body, (1, 1)).without_light_samples();
    let light = |ask: Ask| f64::from(stage.film(ask).radiance()[0][0]);
    let truth = light(Ask::new(1 << 16, 12_345));
    let mean = |of: &dyn Fn(u64) -> f64| {
        let values: Vec<f64> = (0..SEEDS).map(of).collect();
        let mean = values.iter().sum::<f64>() / SEEDS as f64;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let error = (squares / (SEEDS - 1) as f64 / SEEDS as f64).sqrt();
        (mean / truth, (mean - truth) / error)
    };
    let asked = |seed| {
        light(Ask {
            noise: Some(WANTED),
            ..Ask::new(MOST, seed)
        })
    };
    let naive = |seed| {
        let mut spp = 4;
        loop {
            let film = stage.film(Ask::new(spp, seed));
            if spp >= MOST || film.error().expect("samples").relative <= WANTED {
                return f64::from(film.radiance()[0][0]);
            }
            spp *= 2;
        }
    };
    let (share, z) = mean(&asked);
    println!("asked: {share:.3} of the light, z = {z:.1}");
    assert!(z.abs() < 4.0, "{share} of the light, z = {z}");
    let (share, z) = mean(&naive);
    println!("naive: {share:.3} of the light, z = {z:.1}");
    assert!(
        z < -6.0,
        "the naive rule would pass: {share} of the light, z = {z}"
    );
}
