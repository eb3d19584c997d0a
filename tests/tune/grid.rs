//! Is what `tune` finds best? An exhaustive grid of settings, fixed here, says so on seeds that `tune` has not seen.
//!
//! The figure is **time at equal error**: the CPU time of build and tracing in which a setting reaches the error of the final
//! quality, bias and all, interpolated between its samples. `tune` may take 1.15 times as long as the best of the grid.

use luxel::asset::AssetStore;
use luxel::build::Quality as Tree;
use luxel::measure::tune::{Dials, Goal, Plan, Quality, choose, run};
use luxel::render::{Renderer, Settings};
use luxel::scene::SceneDesc;
use luxel::trace::{Fresnel, Sampler};
use nix::time::{ClockId, clock_gettime};
use std::path::Path;
use std::time::{Duration, Instant};

/// The samples of the grid: 64 times as many at its end.
const LADDER: [u32; 4] = [2, 8, 32, 128];

/// Seeds of the grid, those on which the best are judged, and those of the reference: `tune` has others.
const SEEDS: [std::ops::Range<u64>; 3] = [1000..1004, 2000..2012, 3000..3008];

/// Settings that are judged once more: the least of many noisy numbers is less than it should be.
const JUDGED: usize = 5;

/// 50 settings, 200 with their samples: all choices of the dials that bias nothing, with all bounces and with half of them;
/// the others on the defaults and on those without roulette.
fn grid(exact: &Dials) -> Vec<(Dials, u32)> {
    let mut all = Vec::new();
    for bounces in [exact.bounces, exact.bounces / 2] {
        for sampler in [Sampler::Sobol, Sampler::Independent] {
            for (nee, mis) in [(true, true), (true, false), (false, true)] {
                for roulette in [true, false] {
                    let dials = Dials {
                        bounces,
                        sampler,
                        nee,
                        mis,
                        roulette,
                        ..*exact
                    };
                    all.push((dials, 1));
                }
            }
        }
    }
    for roulette in [true, false] {
        for mis in [true, false] {
            let base = Dials {
                roulette,
                mis,
                ..*exact
            };
            for bounces in [1, exact.bounces * 3 / 4] {
                all.push((Dials { bounces, ..base }, 1));
            }
            for fresnel in [Fresnel::Schlick, Fresnel::Off] {
                all.push((Dials { fresnel, ..base }, 1));
            }
            let quality = Tree::Fast;
            all.push((Dials { quality, ..base }, 1));
            all.push((base, 2));
        }
    }
    let two = Dials {
        bounces: 2,
        ..*exact
    };
    all.extend([(*exact, 4), (two, 1)]);
    all
}

#[test]
fn the_grid_is_what_it_says() {
    let exact = Dials::of(&settings("hero").2);
    let all = grid(&exact);
    assert_eq!(all.len() * LADDER.len(), 200);
    for (k, one) in all.iter().enumerate() {
        assert!(!all[..k].contains(one), "{one:?} twice");
    }
    assert_eq!(LADDER[3], 64 * LADDER[0]);
}

fn settings(name: &str) -> (SceneDesc, luxel::world::Spawned, Settings) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let desc = luxel::scene::load(&folder.join(name).with_extension("ron")).unwrap();
    let desc = desc.desc;
    let spawned = luxel::world::spawn(&desc, luxel::asset::Loader::new()).unwrap();
    let settings = Settings {
        size: (36, 24),
        tile: 16,
        ..Settings::of_scene(&desc)
    };
    (desc, spawned, settings)
}

type Pixels = Vec<[f64; 3]>;

struct Judge {
    renderer: Renderer,
    desc: SceneDesc,
    assets: AssetStore,
    settings: Settings,
    /// Means of two halves of the reference: their noise is independent.
    truth: [Pixels; 2],
    power: f64,
}

impl Judge {
    /// A picture at full size, and CPU seconds of build and tracing.
    fn picture(&mut self, dials: &Dials, divisor: u32, spp: u32, seed: u64) -> (Pixels, f64) {
        let mut settings = self.settings.clone();
        dials.put(&mut settings);
        let full = settings.size;
        settings.size = (full.0 / divisor, full.1 / divisor);
        settings.spp = spp;
        settings.trace.seed = seed;
        self.renderer
            .change(&self.desc, &self.assets, settings.clone());
        let start = clock();
        let (scene, _) = self.renderer.build(0);
        let (film, _) = self.renderer.trace_built(&scene, &settings);
        let seconds = (clock() - start).as_secs_f64();
        let small = film.radiance();
        let at = |x: f64, y: f64| bilinear(&small, settings.size, x, y);
        let scale = f64::from(divisor);
        let center = |i: u32| (f64::from(i) + 0.5) / scale - 0.5;
        let rows = (0..full.1).flat_map(|y| (0..full.0).map(move |x| (x, y)));
        let pixels = rows.map(|(x, y)| at(center(x), center(y))).collect();
        (pixels, seconds)
    }

    /// Mean relative squared error over seeds, and the least CPU seconds, of settings in turns.
    fn judge(&mut self, all: &[(Dials, u32, u32)], seeds: std::ops::Range<u64>) -> Vec<[f64; 2]> {
        let mut found = vec![[0.0, f64::INFINITY]; all.len()];
        let count = (seeds.end - seeds.start) as f64;
        for seed in seeds {
            for ((dials, divisor, spp), found) in all.iter().zip(&mut found) {
                let (pixels, seconds) = self.picture(dials, *divisor, *spp, seed);
                let squared = |(i, x): (usize, &[f64; 3])| -> f64 {
                    let off = |half: usize, c: usize| x[c] - self.truth[half][i][c];
                    (0..3).map(|c| off(0, c) * off(1, c)).sum()
                };
                let sum: f64 = pixels.iter().enumerate().map(squared).sum();
                found[0] += sum / (3.0 * pixels.len() as f64 * self.power * count);
                found[1] = found[1].min(seconds);
            }
        }
        found
    }
}

fn clock() -> Duration {
    Duration::from(clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID).unwrap())
}

fn bilinear(pixels: &[[f32; 3]], size: (u32, u32), x: f64, y: f64) -> [f64; 3] {
    let clamp = |v: f64, n: u32| v.clamp(0.0, f64::from(n) - 1.0);
    let mut sum = [0.0; 3];
    for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let at = (x.floor() + dx, y.floor() + dy);
        let weight = (1.0 - (x - at.0).abs()) * (1.0 - (y - at.1).abs());
        let (i, j) = (clamp(at.0, size.0) as usize, clamp(at.1, size.1) as usize);
        let pixel = pixels[j * size.0 as usize + i];
        for c in 0..3 {
            sum[c] += weight * f64::from(pixel[c]);
        }
    }
    sum
}

/// Seconds at which a setting has the squared error, by powers between its samples; `None` if it never has.
fn at_equal_error(levels: &[[f64; 2]], squared: f64) -> Option<f64> {
    let ln = |x: f64| luxel::math::ln(x.max(1e-300));
    for pair in levels.windows(2) {
        let [[e0, t0], [e1, t1]] = [pair[0], pair[1]];
        if e0 >= squared && e1 <= squared {
            let part = (ln(e0) - ln(squared)) / (ln(e0) - ln(e1));
            return Some(t0 * luxel::math::pow(t1 / t0, part));
        }
    }
    None
}

fn compare(name: &str) -> f64 {
    let (desc, spawned, settings) = settings(name);
    let exact = Dials::of(&settings);
    let renderer = Renderer::new(&desc, spawned.world, &spawned.assets, settings.clone());
    let mut judge = Judge {
        renderer: renderer.unwrap(),
        desc,
        assets: spawned.assets,
        settings,
        truth: [Vec::new(), Vec::new()],
        power: 1.0,
    };
    judge.truth = reference(&mut judge, &exact);
    let product = |(a, b): (&[f64; 3], &[f64; 3])| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let [a, b] = &judge.truth;
    judge.power = a.iter().zip(b).map(product).sum::<f64>() / (3 * a.len()) as f64;
    // The final quality: the error of the defaults with 32 samples, amid the grid.
    let squared = judge.judge(&[(exact, 1, 32)], SEEDS[0].clone())[0][0];

    let plan = Plan {
        frame: 0,
        deadline: Instant::now() + Duration::from_secs(45),
        goals: vec![Goal {
            quality: Quality::Final,
            error: squared.sqrt(),
        }],
    };
    judge
        .renderer
        .change(&judge.desc, &judge.assets, judge.settings.clone());
    let found = run(
        &mut judge.renderer,
        &judge.desc,
        &judge.assets,
        &plan,
        |_| (),
    );
    let found = found.expect("45 s suffice");
    let pick = choose(&found, plan.goals[0]).expect("it can be reached");
    let picked = found.rows[pick.row].dials;

    let all = grid(&exact);
    let settings: Vec<_> = (all.iter())
        .flat_map(|(dials, divisor)| LADDER.map(|spp| (*dials, *divisor, spp)))
        .collect();
    let errors = judge.judge(&settings, SEEDS[0].clone());
    let mut best: Vec<(f64, usize)> = (errors.chunks(LADDER.len()).enumerate())
        .filter_map(|(k, levels)| Some((at_equal_error(levels, squared)?, k)))
        .collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    best.truncate(JUDGED);
    assert!(
        best.len() == JUDGED,
        "few settings reach the error: {errors:?}"
    );

    let mut again: Vec<_> = (best.iter())
        .flat_map(|(_, k)| LADDER.map(|spp| (all[*k].0, all[*k].1, spp)))
        .collect();
    again.push((picked, 1, pick.spp));
    let judged = judge.judge(&again, SEEDS[1].clone());
    let [error, seconds] = judged[again.len() - 1];
    println!("{name}: an error of {:.2} %", 100.0 * squared.sqrt());
    let mut least = f64::INFINITY;
    for ((_, k), levels) in best.iter().zip(judged.chunks(LADDER.len())) {
        let time = at_equal_error(levels, squared).unwrap_or(f64::INFINITY);
        least = least.min(time);
        println!("  {:.4} s  {}", time, all[*k].0.words(&exact));
    }
    // Near the goal the error falls about as that of random points.
    let equal = seconds * error / squared;
    println!(
        "  {equal:.4} s  tune's: --spp {} {}, an error of {:.2} %; {:.3} of the best",
        pick.spp,
        picked.words(&exact),
        100.0 * error.sqrt(),
        equal / least
    );
    assert!(
        (0.85..1.15).contains(&(error / squared).sqrt()),
        "the error is not the one asked for"
    );
    equal / least
}

fn reference(judge: &mut Judge, exact: &Dials) -> [Pixels; 2] {
    let pixels = (judge.settings.size.0 * judge.settings.size.1) as usize;
    let mut halves = [vec![[0.0; 3]; pixels], vec![[0.0; 3]; pixels]];
    let seeds = SEEDS[2].clone();
    let share = 2.0 / (seeds.end - seeds.start) as f64;
    for seed in seeds {
        let (picture, _) = judge.picture(exact, 1, 256, seed);
        for (sum, x) in halves[(seed % 2) as usize].iter_mut().zip(&picture) {
            *sum = [0, 1, 2].map(|c| sum[c] + share * x[c]);
        }
    }
    halves
}

#[test]
#[ignore = "a few minutes: cargo test --release --test tune -- --ignored --nocapture"]
fn final_is_near_the_best_of_the_grid() {
    for name in ["lights", "materials"] {
        let ratio = compare(name);
        assert!(ratio <= 1.15, "{name}: {ratio}");
    }
}
