//! How the noise of one frame goes with that of the next, in numbers: not at all, anywhere near; or to the bit.

use crate::motion::spawn;
use luxel::render::{Control, Renderer, Settings};

const SIDE: usize = 48;
const FRAMES: u32 = 6;

/// Soft shadows on a floor: noise everywhere, and nothing that moves.
const STILL: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 3, 6), look_at: (0, 0, 0)),
    render: (size: (48, 48), spp: 2, max_bounces: 3),
    entities: [
        (shape: Sphere(radius: 2), transform: (translate: (2, 5, 2)), emissive: (radiance: (9, 9, 9))),
        (shape: Sphere(radius: 1)),
        (shape: Sphere(radius: 300), transform: (translate: (0, -301, 0))),
    ],
)"#;

/// Green of every pixel, by frames.
fn frames(settings: impl Fn(&mut Settings)) -> Vec<Vec<f64>> {
    let (desc, spawned) = spawn(STILL);
    let mut chosen = Settings::of_scene(&desc);
    settings(&mut chosen);
    let mut renderer =
        Renderer::new(&desc, spawned.world, &spawned.assets, chosen).expect("threads");
    let mut green = |frame| {
        let film = renderer.render(frame, &Control::default()).film;
        film.radiance()
            .iter()
            .map(|rgb| f64::from(rgb[1]))
            .collect()
    };
    (0..FRAMES).map(&mut green).collect()
}

/// Each pixel's deviation from the truth. Not in standard deviations of its own: measured by the same frames, these make those
/// alike that all miss what is rare.
fn noise(frames: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let truth = &frames_of_truth()[0];
    let deviation =
        |frame: &Vec<f64>| -> Vec<f64> { frame.iter().zip(truth).map(|(x, r)| x - r).collect() };
    frames.iter().map(deviation).collect()
}

fn frames_of_truth() -> Vec<Vec<f64>> {
    static TRUTH: std::sync::OnceLock<Vec<Vec<f64>>> = std::sync::OnceLock::new();
    let many = || {
        let (desc, spawned) = spawn(STILL);
        let settings = Settings {
            spp: 4096,
            trace: luxel::trace::TraceOptions {
                seed: 99,
                ..Settings::of_scene(&desc).trace
            },
            ..Settings::of_scene(&desc)
        };
        let mut renderer =
            Renderer::new(&desc, spawned.world, &spawned.assets, settings).expect("threads");
        let film = renderer.render(0, &Control::default()).film;
        vec![
            film.radiance()
                .iter()
                .map(|rgb| f64::from(rgb[1]))
                .collect(),
        ]
    };
    TRUTH.get_or_init(many).clone()
}

/// How the noise of a pixel goes with that of the pixel (dx, dy) away in the next frame, −1 to 1, and the standard deviation
/// of that if they are independent: products of mean 0, of which the largest few may be most.
fn correlation(noise: &[Vec<f64>], dx: usize, dy: usize) -> (f64, f64) {
    let (mut product, mut squares, mut square) = (0.0, 0.0, 0.0);
    for (now, next) in noise.iter().zip(&noise[1..]) {
        for y in 0..SIDE - dy {
            for x in 0..SIDE - dx {
                let (a, b) = (now[y * SIDE + x], next[(y + dy) * SIDE + x + dx]);
                product += a * b;
                squares += a * a * b * b;
                square += 0.5 * (a * a + b * b);
            }
        }
    }
    (product / square, f64::sqrt(squares) / square)
}

#[test]
fn noise_of_frames_is_independent_unless_it_is_fixed() {
    let own = noise(&frames(|_| ()));
    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2)] {
        let (found, deviation) = correlation(&own, dx, dy);
        assert!(
            found.abs() < 5.0 * deviation,
            "{dx}, {dy}: {found:.4}, of {deviation:.4}"
        );
    }
    let independent = noise(&frames(|s| {
        s.trace.sampler = luxel::trace::Sampler::Independent
    }));
    let (found, deviation) = correlation(&independent, 0, 0);
    assert!(
        found.abs() < 5.0 * deviation,
        "independent: {found:.4}, of {deviation:.4}"
    );

    let fixed = frames(|s| s.fixed_noise = true);
    assert!(
        fixed.windows(2).all(|two| two[0] == two[1]),
        "the same pixels in every frame"
    );
    let (found, _) = correlation(&noise(&fixed), 0, 0);
    assert!(
        (found - 1.0).abs() < 1e-12,
        "the measure sees what is fixed: {found}"
    );
}
