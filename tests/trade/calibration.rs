//! Error bars against the errors.

use crate::stage::{Ask, Stage};
use crate::truth::Truth;
use luxel::film::{Blocks, Film, Planes, Window};

/// Most that a predicted error may be off, as a share of the error.
const OFF: f64 = 0.10;

/// What the 95 % intervals of pixels may cover.
const COVERED: std::ops::RangeInclusive<f64> = 0.93..=0.97;

/// How a scene's error bars did.
struct Score {
    /// Mean of predicted over true.
    mean: f64,
    /// Error bars that cover the error of their own film, and all.
    covering: [usize; 2],
    /// Share of pixels whose interval covers the truth.
    pixels: f64,
}

fn score(stage: &Stage, spp: u32, seeds: u64) -> Score {
    let truth = Truth::of(stage, Ask::new(spp, 0), seeds);
    let bars: Vec<_> = truth
        .films
        .iter()
        .map(|f| f.error().expect("samples"))
        .collect();
    let mean_of = |sum: f64| sum / bars.len() as f64;
    let mean = mean_of(bars.iter().map(|bar| bar.relative / truth.relative).sum());
    let covering = (0..bars.len())
        .filter(|&i| (truth.actual(i) - bars[i].relative).abs() <= bars[i].half_width)
        .count();
    let half = mean_of(bars.iter().map(|bar| bar.half_width / bar.relative).sum());
    let pixels = truth.coverage();
    println!(
        "{:18} {spp:4} spp  error {:6.3} %  predicted / true {mean:.3}  interval ± {:4.1} % covers {covering} of {}  \
         pixels' intervals cover {:.1} %",
        stage.name,
        100.0 * truth.relative,
        100.0 * half,
        bars.len(),
        100.0 * pixels,
    );
    Score {
        mean,
        covering: [covering, bars.len()],
        pixels,
    }
}

#[test]
fn errors_are_predicted() {
    for name in ["lens", "materials"] {
        let score = score(&Stage::shipped(name, 48), 64, 8);
        assert!((score.mean - 1.0).abs() <= OFF, "{name}: {}", score.mean);
        assert!(COVERED.contains(&score.pixels), "{name}: {}", score.pixels);
        let [covering, all] = score.covering;
        assert!(covering + 1 >= all, "{name}: {covering} of {all}");
    }
}

/// At other numbers of samples too: few, between powers of two, and many.
#[test]
fn pixels_are_covered_at_other_numbers_of_samples() {
    for name in ["lens", "cat_flat"] {
        for spp in [16, 48, 128] {
            let score = score(&Stage::shipped(name, 48), spp, 8);
            assert!(
                (score.mean - 1.0).abs() <= OFF,
                "{name} {spp}: {}",
                score.mean
            );
            assert!(
                COVERED.contains(&score.pixels),
                "{name} {spp}: {}",
                score.pixels
            );
        }
    }
}

/// Not one scene may be far off, and most must be within the bars.
#[test]
#[ignore = "long: two minutes; cargo test --release --test trade calibrated -- --ignored --nocapture"]
fn all_scenes_are_calibrated() {
    let (mut off, mut uncovered, mut covering, mut all) = (Vec::new(), Vec::new(), 0, 0);
    for stage in Stage::all_shipped(96) {
        let score = score(&stage, 64, 16);
        if (score.mean - 1.0).abs() > OFF {
            off.push(stage.name.clone());
        }
        if !COVERED.contains(&score.pixels) {
            uncovered.push(stage.name.clone());
        }
        covering += score.covering[0];
        all += score.covering[1];
    }
    println!(
        "off by more than 10 %: {off:?}; pixels not within 93 to 97 %: {uncovered:?}; {covering} of {all} intervals cover"
    );
    assert!(off.is_empty() && uncovered.is_empty());
    assert!(covering * 100 >= 93 * all);
}

/// The same film with one sample in pixel `at` that is `radiance`, added to the last one.
fn with_a_firefly(film: &Film, at: usize, radiance: f64) -> Film {
    let mut planes: Planes = film.planes().clone();
    let n = planes.count[at];
    for c in 0..3 {
        planes.rgb[at][c] += radiance;
        planes.rgb_squared[at][c] += radiance * radiance;
        for (k, gains) in planes
            .gains
            .iter_mut()
            .enumerate()
            .filter(|(_, g)| !g.is_empty())
        {
            let pairs = f64::from(Blocks::pairs(n, k as u32));
            let half = 0.5 * radiance / f64::from(1u32 << k);
            gains[at][c] += (half * half / pairs) as f32;
        }
    }
    let (width, height) = (film.width(), film.height());
    let mut planted = Film::new(width, height);
    let all = Window {
        x: 0,
        y: 0,
        width,
        height,
    };
    planted.put(all, &planes);
    planted
}

#[test]
fn a_firefly_is_seen() {
    let film = Stage::shipped("lens", 48).film(Ask::new(64, 0));
    let bar = film.error().expect("samples");
    assert!(!bar.is_fragile(), "{bar:?}");
    let planted = with_a_firefly(&film, 700, 1e3).error().expect("samples");
    assert!(
        planted.is_fragile() && planted.relative > bar.relative,
        "{planted:?}"
    );
    // As dim as the rest, it is none.
    let planted = with_a_firefly(&film, 700, 1.0).error().expect("samples");
    assert!(!planted.is_fragile(), "{planted:?}");
}

/// Where light is found by accident alone, its share is not to be trusted; the same scene with light samples is.
#[test]
fn light_that_is_found_by_accident_is_not_trusted() {
    let bar = |spec: &str| {
        let body = format!(
            "camera: (at: (0, 3, 6), look_at: (0, 0, 0), vfov_deg: 40), render: (size: (32, 32), spp: 32, max_bounces: 3),
            materials: {{\"white\": Diffuse(color: Linear(0.7, 0.7, 0.7)), \"ball\": {spec}}},
            entities: [
                (name: \"floor\", shape: Sphere(radius: 500), transform: (translate: (0, -501, 0)), material: \"white\"),
                (name: \"ball\", shape: Sphere(radius: 1), material: \"ball\"),
                (name: \"lamp\", shape: Sphere(radius: 0.4), transform: (translate: (1, 6, 2)), emissive: (radiance: (225, 225, 225))),
            ]"
        );
        let stage = Stage::of("lamp", &body, (32, 32));
        stage.film(Ask::new(64, 0)).error().expect("samples")
    };
    assert!(!bar("Diffuse(color: Linear(0.7, 0.7, 0.7))").is_fragile());
    let caustic = bar("Mirror");
    assert!(caustic.is_fragile(), "{caustic:?}");
}

#[test]
#[ignore = "long: two minutes; cargo test --release --test trade fireflies -- --ignored --nocapture"]
fn at_most_one_scene_has_fireflies() {
    let fragile: Vec<String> = Stage::all_shipped(128)
        .into_iter()
        .filter(|stage| {
            let bar = stage
                .film(Ask::new(stage.spp(), 0))
                .error()
                .expect("samples");
            println!("{:18} {:.3}", stage.name, bar.fragile);
            bar.is_fragile()
        })
        .map(|stage| stage.name)
        .collect();
    assert!(fragile.len() <= 1, "{fragile:?}");
}

/// Independent samples have the textbook's error, and nothing is fitted.
#[test]
fn independent_samples_are_predicted_too() {
    let ask = Ask {
        sampler: luxel::trace::Sampler::Independent,
        ..Ask::new(48, 0)
    };
    let truth = Truth::of(&Stage::shipped("lens", 48), ask, 6);
    for film in &truth.films {
        let bar = film.error().expect("samples");
        assert!(
            (bar.relative / truth.relative - 1.0).abs() <= OFF,
            "{bar:?} {}",
            truth.relative
        );
    }
}

/// What the error bar says of other numbers of samples holds there: whole powers of two, and between.
#[test]
fn errors_of_other_numbers_of_samples_are_predicted() {
    let stage = Stage::shipped("lens", 48);
    let bar = stage.film(Ask::new(32, 99)).error().expect("samples");
    for spp in [16, 48, 100] {
        let truth = Truth::of(&stage, Ask::new(spp, 0), 6).relative;
        let ratio = bar.at(spp) / truth;
        assert!((ratio - 1.0).abs() <= 1.5 * OFF, "{spp} spp: {ratio}");
    }
}
