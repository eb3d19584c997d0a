//! Dials that may change the noise and not the mean: light samples, their weights, roulette, the sampler.

use crate::luxel_side::{Stage, options};
use crate::objs;
use crate::stats::{Mean, assert_mean};
use luxel::trace::{Sampler, TraceOptions};

/// Seeds per setting: their means give the error, which for a low-discrepancy sampler the samples do not.
const SEEDS: u64 = 16;

fn room() -> Stage {
    Stage::new("estimators")
        .file("cube.obj", &objs::cube(true))
        .file("fan.obj", &objs::fan(3, 0.5))
        .scene(
            r#"camera: (at: (0, 0, 0.95), look_at: (0, -0.1, 0), vfov_deg: 70), render: (size: (16, 16)),
            background: Linear(0, 0, 0),
            materials: {"wall": Diffuse(color: Linear(0.7, 0.6, 0.5)), "glass": Glass, "coat": Plastic(color: Linear(0.2, 0.5, 0.8)),
                "chrome": Mirror(color: Linear(0.9, 0.9, 0.9))},
            entities: [(shape: Mesh("cube.obj"), normals: Flat, material: "wall"),
                (shape: Sphere(radius: 0.35), transform: (translate: (-0.45, -0.65, -0.3)), material: "glass"),
                (shape: Sphere(radius: 0.35), transform: (translate: (0.45, -0.65, -0.3)), material: "coat"),
                (shape: Sphere(radius: 0.2), transform: (translate: (0, 0.2, -0.6)), material: "chrome"),
                (shape: Sphere(radius: 0.3), transform: (translate: (0.2, 0.6, 0.1)), emissive: (radiance: (4, 5, 6))),
                (shape: Mesh("fan.obj"), normals: Flat, transform: (translate: (-0.5, 0.9, 0), rotate: Euler(180, 0, 0)),
                    emissive: (radiance: (6, 5, 4)))]"#,
        )
}

fn means(stage: &Stage, spp: u32, options: &TraceOptions) -> Mean {
    let means: Vec<f64> = (0..SEEDS)
        .map(|seed| {
            let options = TraceOptions { seed, ..*options };
            let sums = stage.sums(0, spp, &options);
            let samples: u32 = sums.count.iter().sum();
            sums.rgb.iter().map(|rgb| rgb[0]).sum::<f64>() / f64::from(samples)
        })
        .collect();
    Mean::of(&means)
}

#[test]
fn no_dial_moves_the_mean() {
    let stage = room();
    let exact = TraceOptions {
        sampler: Sampler::Sobol,
        ..options(6)
    };
    let truth = means(&stage, 64, &exact);
    let dials = [
        (
            "independent",
            TraceOptions {
                sampler: Sampler::Independent,
                ..exact
            },
        ),
        (
            "no roulette",
            TraceOptions {
                roulette: false,
                ..exact
            },
        ),
        (
            "no mis",
            TraceOptions {
                mis: false,
                ..exact
            },
        ),
        (
            "caustics",
            TraceOptions {
                caustics: true,
                ..exact
            },
        ),
        (
            "no nee",
            TraceOptions {
                nee: false,
                ..exact
            },
        ),
        (
            "nothing",
            TraceOptions {
                nee: false,
                roulette: false,
                sampler: Sampler::Independent,
                ..exact
            },
        ),
    ];
    for (name, options) in dials {
        assert_eq!(stage.flat(0, &options).chains.is_empty(), !options.caustics);
        let spp = if options.nee { 64 } else { 192 };
        assert_mean(name, means(&stage, spp, &options), truth, 0.03);
    }
}
