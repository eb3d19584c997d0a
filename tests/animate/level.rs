//! `--noise` from frame to frame: the error stays, the samples do not.

use crate::folder::{files, folder};
use crate::motion::spawn;
use crate::support::text;
use luxel::film::Film;
use luxel::render::{Control, Ended, Renderer, Settings};
use luxel::scene::RenderDesc;
use luxel::trace::Sampler;

/// A floor in the shadow of a ball that is out of view: all penumbra under a wide lamp, and less so as that shrinks.
const SHRINKING: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 2, 5), look_at: (0, -1, 0)),
    render: (size: (40, 32), spp: 2, max_bounces: 1),
    background: Linear(0.05, 0.05, 0.05),
    entities: [
        (shape: Sphere(radius: 1), emissive: (radiance: (9, 9, 9)),
            keys: [(t: 0, translate: (1, 14, 0), scale: 4), (t: 2, translate: (1, 14, 0), scale: 0.5)]),
        (shape: Sphere(radius: 1.5), transform: (translate: (0, 6, 0))),
        (shape: Sphere(radius: 300), transform: (translate: (0, -301, 0))),
    ],
    animation: (fps: 1, frames: 0..3),
)"#;

/// Independent samples: their error falls by a rate that is known, so that the pilot's guess is good.
fn renderer(change: impl Fn(&mut Settings)) -> Renderer {
    let (desc, spawned) = spawn(SHRINKING);
    let mut settings = Settings::of_scene(&desc);
    settings.trace.sampler = Sampler::Independent;
    change(&mut settings);
    Renderer::new(&desc, spawned.world, &spawned.assets, settings).expect("threads")
}

/// RMSE over the root of the mean square of the truth.
fn apart(film: &Film, truth: &Film) -> f64 {
    let [film, truth] = [film, truth].map(Film::radiance);
    let values = |film: &[[f32; 3]]| film.concat().into_iter().map(f64::from).collect::<Vec<_>>();
    let (film, truth) = (values(&film), values(&truth));
    let off: f64 = film.iter().zip(&truth).map(|(x, r)| (x - r).powi(2)).sum();
    let light: f64 = truth.iter().map(|r| r * r).sum();
    (off / light).sqrt()
}

#[test]
fn frames_of_different_noise_are_equally_wrong() {
    const WANTED: f64 = 0.02;
    let mut asked = renderer(|s| (s.noise, s.spp) = (Some(WANTED), RenderDesc::MAX_SPP));
    let mut equal = renderer(|s| s.spp = 16);
    let mut exact =
        renderer(|s| (s.spp, s.trace.seed, s.trace.sampler) = (2048, 99, Sampler::Sobol));
    let (mut spp, mut errors, mut others) = (Vec::new(), Vec::new(), Vec::new());
    for frame in 0..3 {
        let control = Control::default();
        let truth = exact.render(frame, &control).film;
        let rendering = asked.render(frame, &control);
        assert_eq!(rendering.stats.ended, Ended::Noise);
        spp.push(rendering.stats.spp);
        errors.push(apart(&rendering.film, &truth) / WANTED);
        others.push(apart(&equal.render(frame, &control).film, &truth) / WANTED);
    }
    println!("{spp:?} spp: {errors:.2?} of what was asked for; 16 spp each: {others:.2?}");
    let ratio = |of: &[f64]| {
        let (least, most) = (
            of.iter().copied().reduce(f64::min),
            of.iter().copied().reduce(f64::max),
        );
        most.zip(least)
            .map_or(f64::NAN, |(most, least)| most / least)
    };
    assert!(
        spp.iter().max() > spp.iter().min().map(|n| 3 * n).as_ref(),
        "{spp:?}"
    );
    assert!(
        ratio(&others) > 2.0,
        "else there is nothing to even out: {others:?}"
    );
    assert!(errors.iter().all(|e| (0.9..=1.1).contains(e)), "{errors:?}");
}

#[test]
fn finished_frames_of_the_same_error_are_kept() {
    let folder = folder("level");
    let line = [
        "animate", "spin.ron", "--noise", "10%", "--frames", "0..3", "--gif", "a.gif",
    ];
    let with = |more: &[&'static str]| [&line[..6], more].concat();
    folder.expect(&line, 0, &["ended by --noise 10 %", "spp, ", " on average"]);
    let all = files(&folder);
    std::fs::remove_file(folder.0.join("spin_0001.png")).expect("ours");
    std::fs::remove_file(folder.0.join("a.gif")).expect("ours");
    let again = folder.expect(&line, 0, &["3 frames: 0–2; 2 of them are finished"]);
    assert_eq!(text(&again.stdout), "spin_0001.png\na.gif\n");
    assert_eq!(files(&folder), all);
    let alone = [
        "render",
        "spin.ron",
        "--noise",
        "0.1",
        "--frame",
        "2",
        "-o",
        "alone.png",
    ];
    folder.expect(&alone, 0, &[]);
    assert_eq!(files(&folder)["alone.png"], all["spin_0002.png"]);

    // Whatever would have made others is refused.
    folder.expect(
        &with(&["--spp", "500"]),
        2,
        &["made with error 0.1, not 0.1 or 500 spp"],
    );
    folder.expect(
        &["animate", "spin.ron", "--frames", "0..3", "--noise", "5%"],
        2,
        &["made with error 0.1, not 0.05"],
    );
    folder.expect(
        &["animate", "spin.ron", "--frames", "0..3"],
        2,
        &["made with", "not 2"],
    );
    let timed = [
        "render",
        "spin.ron",
        "--noise",
        "0.1",
        "--time",
        "1ms",
        "-o",
        "spin_0000.png",
    ];
    folder.expect(&timed, 0, &["ended by --time"]);
    folder.expect(&line, 2, &["spin_0000.png", "does not say its error"]);
}
