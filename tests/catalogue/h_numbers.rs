//! H: numbers. Sums, what is not finite, and images with all of f32 in them. Damaged files are in `tests/mutate`, metrics in
//! `measure`'s own tests.

use crate::book::{Outcome, items};
use crate::luxel_side::{Stage, options};
use crate::objs;
use luxel::film::{Film, Metadata, Planes, Window, encode_exr, srgb::Encoder};
use luxel::flat::FlatScene;
use luxel::measure::Image;
use luxel::render::{Renderer, Settings};
use luxel::trace::{Rect, TileSums, TraceOptions, Tracer};
use std::path::{Path, PathBuf};

items! {
    h1_sums(1e6, 1.073_741_824e9): "H1", "equal samples added up in one pixel's sums: off by more than 1e-12";
    h2_not_finite(6e4, 1e9): "H2", "samples of the scenes of this repository and of a dozen hostile ones: not finite";
}

fn whole(scene: &FlatScene) -> Rect {
    Rect {
        x: 0,
        y: 0,
        width: scene.camera.width,
        height: scene.camera.height,
    }
}

fn h1_sums(trials: u64) -> Outcome {
    let mut worst = 0.0f64;
    let mut outcome = Outcome::default();
    // The numbers of f32 nearest to these have all 24 bits.
    let values = [0.1f32, 1.7e-5, 9.3e7];
    for (k, value) in values.into_iter().enumerate() {
        let stage = Stage::new(&format!("catalogue_h1_{k}")).scene(&format!(
            "camera: (at: (0, 0, 0), look_at: (0, 0, -1)), render: (size: (1, 1)), background: Linear({value:?}, {value:?}, {value:?}),
            entities: []"
        ));
        let options = options(0);
        let scene = stage.flat(0, &options);
        let (mut sums, mut tracer) = (TileSums::default(), Tracer::new(&scene, &options));
        let n = (trials / values.len() as u64) as u32;
        tracer.trace_tile(whole(&scene), 0..n, &mut sums);
        let exact = f64::from(scene.background[0]) * f64::from(n);
        let off = (sums.rgb[0][0] / exact - 1.0).abs();
        worst = worst.max(off);
        assert_eq!(sums.count[0], n);
        let failures = if off > 1e-12 { n } else { 0 };
        outcome.add(Outcome::new(n as usize, failures as usize));
    }
    outcome.saying(match worst {
        0.0 => "exact".to_string(),
        _ => format!("within {worst:.1e}"),
    })
}

/// Scenes that come with luxel, their pictures small.
fn shipped() -> Vec<(String, FlatScene)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files: Vec<PathBuf> = ["scenes", "tests/golden"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(root.join(folder)).expect("a folder"))
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "ron"))
        .collect();
    files.sort();
    let flat = |path: &PathBuf| {
        let desc = luxel::scene::load(path).expect("a scene").desc;
        let spawned = luxel::world::spawn(&desc, luxel::asset::Loader::new()).expect("its files");
        let mut settings = Settings::of_scene(&desc);
        settings.size = (16, 16);
        settings.threads = Some(1);
        let renderer = Renderer::new(&desc, spawned.world, &spawned.assets, settings);
        (
            path.display().to_string(),
            renderer.expect("a thread").build(7).0,
        )
    };
    files.iter().map(flat).collect()
}

/// Scenes in which something is at an end of its range.
fn hostile() -> Vec<(String, FlatScene)> {
    let lamp = |at: &str, radius: f64, radiance: f64| {
        format!(
            "(shape: Sphere(radius: {radius:?}), emissive: (radiance: ({radiance:?}, {radiance:?}, {radiance:?})), transform: (translate: {at})),"
        )
    };
    let ball = |material: &str, at: &str, radius: f64| {
        format!(
            r#"(shape: Sphere(radius: {radius:?}), material: "{material}", transform: (translate: {at})),"#
        )
    };
    let floor = r#"(shape: Mesh("square.obj"), normals: Flat, material: "white", transform: (rotate: Euler(-90, 0, 0), scale: 4)),"#;
    let thin =
        r#"(shape: Mesh("sliver.obj"), material: "white", transform: (translate: (0, 0.5, 0))),"#;
    let scenes = [
        (
            "touching lamp",
            format!("{floor} {}", lamp("(0, 0.5, 0)", 0.5, 1e8)),
        ),
        (
            "sunken lamp",
            format!("{floor} {}", lamp("(0, 0.1, 0)", 0.5, 10.0)),
        ),
        (
            "lamp of 1e-8 sr",
            format!("{floor} {}", lamp("(0, 1e4, 0)", 0.5, 1e8)),
        ),
        (
            "lamp of nothing",
            format!("{floor} {}", lamp("(0, 1, 0)", 1e-30, 1e18)),
        ),
        (
            "lamp around all",
            format!("{floor} {}", lamp("(0, 0, 0)", 1e6, 1.0)),
        ),
        (
            "dense glass",
            format!(
                "{floor} {} {}",
                ball("dense", "(0, 0.5, 0)", 0.5),
                lamp("(1, 2, 0)", 0.3, 10.0)
            ),
        ),
        (
            "light glass",
            format!(
                "{floor} {} {}",
                ball("thin", "(0, 0.5, 0)", 0.5),
                lamp("(1, 2, 0)", 0.3, 10.0)
            ),
        ),
        (
            "equal balls",
            format!(
                "{0} {0} {1} {2}",
                ball("glass", "(0, 1, 0)", 1.0),
                ball("coat", "(0, 1, 0)", 1.0),
                lamp("(2, 2, 0)", 0.3, 10.0)
            ),
        ),
        (
            "on the skin",
            format!(
                "{} {}",
                ball("glass", "(0, 1, 2)", 1.0),
                lamp("(1, 3, 0)", 0.3, 10.0)
            ),
        ),
        (
            "walls",
            format!(
                "{} {} {}",
                ball("white", "(0, -1e6, 0)", 1e6),
                ball("coat", "(0, 0, -1e8)", 1e8),
                lamp("(0, 2, 2)", 0.1, 100.0)
            ),
        ),
        (
            "slivers",
            format!("{thin} {}", lamp("(0, 2, 0)", 0.3, 10.0)),
        ),
        (
            "grazing sun",
            format!(
                r#"{floor} {} (light: Sun(irradiance: (1, 1, 1)), transform: (rotate: Euler(-0.000001, 0, 0))),"#,
                ball("coat", "(0, 0.5, 0)", 0.5)
            ),
        ),
    ];
    let all = scenes.into_iter().enumerate().map(|(k, (name, entities))| {
        let stage = Stage::new(&format!("catalogue_h2_{k}"))
            .file("square.obj", &objs::square(0.0, 1.0))
            .file("sliver.obj", SLIVERS)
            .scene(&format!(
                r#"camera: (at: (0, 1, 3), look_at: (0, 0.5, 0), vfov_deg: 60), render: (size: (16, 16)),
                background: Linear(1e-6, 0.5, 1), materials: {{"white": Diffuse(color: Linear(1, 1, 1)), "glass": Glass,
                "dense": Glass(ior: 99), "thin": Glass(ior: 0.011), "coat": Plastic(color: Linear(1, 0, 1), ior: 99)}},
                entities: [{entities}]"#
            ));
        (name.to_string(), stage.flat(0, &options(12)))
    });
    all.collect()
}

/// Triangles as thin as f32 lets them be, with normals of all kinds.
const SLIVERS: &str = "v -1 0 0\nv 1 0 0\nv 0 1e-7 0\nv 0 1 0\nv 1e-30 1 1e-30\nv 0 0 1\nvn 0 0 1\nvn 0 0 -1\nvn 1e-30 0 0\nvn 1 0 0\n\
    f 1//1 2//2 3//1\nf 1//3 2//3 4//3\nf 4//1 5//1 6//4\nf 1//1 2//1 6//2\n";

fn h2_not_finite(trials: u64) -> Outcome {
    let mut scenes = shipped();
    scenes.extend(hostile());
    let mut outcome = Outcome::default();
    let mut brightest = 0.0f64;
    let each = trials / scenes.len() as u64;
    for (name, scene) in &scenes {
        let dials = [
            TraceOptions {
                max_bounces: 12,
                ..TraceOptions::default()
            },
            TraceOptions {
                nee: false,
                ..options(12)
            },
        ];
        let mut lost = 0u64;
        for dial in dials {
            let mut tracer = Tracer::new(scene, &dial);
            let spp = (each / 2).div_ceil(256) as u32;
            for start in (0..spp).step_by(256) {
                let mut sums = TileSums::default();
                tracer.trace_tile(whole(scene), start..(start + 256).min(spp), &mut sums);
                let counted: u64 = sums.count.iter().map(|n| u64::from(*n)).sum();
                let not_finite: u64 = sums.non_finite.iter().map(|n| u64::from(*n)).sum();
                brightest = sums.rgb.iter().flatten().fold(brightest, |m, c| m.max(*c));
                outcome.add(Outcome::new(
                    (counted + not_finite) as usize,
                    not_finite as usize,
                ));
                lost += not_finite;
            }
        }
        if lost > 0 {
            println!("{name}: {lost} not finite");
        }
    }
    assert!(brightest > 0.0);
    outcome.saying(format!(
        "{} scenes, with light samples and without",
        scenes.len()
    ))
}

/// H5: radiance of 1e-38 to 1e38 in one picture comes back from its file to the bit, and grey levels never fall.
#[test]
fn all_of_f32_fits_into_a_picture() {
    let values: Vec<f32> = (-380..=380).map(|k| 10f32.powf(k as f32 / 10.0)).collect();
    let width = values.len() as u32;
    let mut film = Film::new(width, 1);
    let window = Window {
        x: 0,
        y: 0,
        width,
        height: 1,
    };
    let planes = Planes {
        rgb: values
            .iter()
            .map(|&v| [v, -v, 0.5 * v].map(f64::from))
            .collect(),
        count: vec![1; values.len()],
        rgb_squared: vec![[0.0; 3]; values.len()],
        non_finite: vec![0; values.len()],
        ..Planes::default()
    };
    film.put(window, &planes);
    let bytes = encode_exr(&film, &[], &Metadata::default()).expect("a small picture");
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("catalogue_h5.exr");
    std::fs::write(&path, bytes).expect("a file");
    let image = Image::read(&path).expect("the picture");
    for (&v, read) in values.iter().zip(image.pixels()) {
        assert_eq!(read.map(f32::to_bits), [v, -v, 0.5 * v].map(f32::to_bits));
    }
    let encoder = Encoder::new();
    let levels: Vec<u8> = values
        .iter()
        .map(|&v| encoder.encode(f64::from(v)))
        .collect();
    assert!(levels.is_sorted() && levels[0] == 0 && levels[levels.len() - 1] == 255);
}
