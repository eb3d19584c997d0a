//! What the stages of tracing count, against the same paths replayed one by one.

use crate::luxel_side::{Stage as Scene, options, trace};
use crate::objs;
use luxel::trace::replay::Fate;
use luxel::trace::{Isa, Sampler, Stage, TraceOptions, replay};

const SPP: u32 = 4;

/// Every kind of scattering, a mesh, a texture and a sky that is the same everywhere.
fn scene() -> Scene {
    Scene::new("tallies")
        .file("square.obj", &objs::square(0.0, 1.0))
        .scene(
            r#"camera: (at: (0, 1, 6), look_at: (0, 0, 0), vfov_deg: 50), render: (size: (42, 27)),
            background: Linear(0.1, 0.2, 0.3),
            materials: {"white": Diffuse(color: Linear(0.9, 0.9, 0.9)), "glass": Glass(), "coat": Plastic(), "gold": Metal(color: Linear(0.9, 0.7, 0.3)), "mirror": Mirror},
            entities: [
                (shape: Mesh("square.obj"), material: "white", transform: (translate: (0, -1, 0), rotate: Euler(-90, 0, 0), scale: 9)),
                (shape: Sphere(radius: 0.6), material: "glass", transform: (translate: (-1.5, 0, 0))),
                (shape: Sphere(radius: 0.6), material: "coat", transform: (translate: (0, 0, 0))),
                (shape: Sphere(radius: 0.6), material: "gold", transform: (translate: (1.5, 0, 0))),
                (shape: Sphere(radius: 0.6), material: "mirror", transform: (translate: (0, 1.4, -1))),
                (shape: Sphere(radius: 0.5), emissive: (radiance: (9, 9, 9)), transform: (translate: (2, 4, 2)))]"#,
        )
}

#[test]
fn stages_count_what_paths_meet() {
    for roulette in [true, false] {
        let options = TraceOptions {
            roulette,
            sampler: Sampler::Sobol,
            ..options(8)
        };
        let flat = scene().flat(0, &options);
        let tallies = trace(&flat, SPP, &options).cost;
        let mut counts = [0; Stage::ALL.len()];
        let mut count = |stage: Stage, n: usize| counts[stage as usize] += n as u64;
        let (width, height) = (flat.camera.width, flat.camera.height);
        for pixel in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            for sample in 0..SPP {
                let path = replay(&flat, &options, pixel, sample).vertices;
                count(Stage::Camera, 1);
                count(Stage::Film, 1);
                count(Stage::ClosestHit, path.len());
                for vertex in &path {
                    count(Stage::Surface, 1);
                    count(Stage::Occlusion, usize::from(vertex.light.is_some()));
                    let Some(hit) = &vertex.hit else {
                        count(Stage::Background, 1);
                        continue;
                    };
                    let material = &flat.materials[hit.material.0 as usize];
                    count(Stage::Emission, usize::from(material.emission != [0.0; 3]));
                    use luxel::flat::Scatter;
                    let stage = match material.scatter {
                        _ if vertex.fate == Fate::Spent => continue,
                        Scatter::Nothing => continue,
                        Scatter::Diffuse => Stage::Diffuse,
                        Scatter::Mirror => Stage::Mirror,
                        Scatter::Glass => Stage::Glass,
                        Scatter::Plastic => Stage::Plastic,
                        Scatter::Metal => Stage::Metal,
                    };
                    count(stage, 1);
                    let lit = matches!(stage, Stage::Diffuse | Stage::Plastic);
                    count(Stage::Lights, usize::from(lit));
                }
            }
        }
        for stage in Stage::ALL {
            let found = tallies.of(stage).items;
            match stage {
                // Of whatever is there at a bounce, which a path by itself does not know.
                Stage::Roulette => assert_eq!(found > 0, roulette),
                Stage::Compact => assert!(found > 0),
                _ => assert_eq!(
                    found, counts[stage as usize],
                    "{stage:?}, roulette {roulette}"
                ),
            }
            assert!(found == 0 || tallies.of(stage).nanoseconds > 0, "{stage:?}");
        }
        for stage in [Stage::Glass, Stage::Plastic, Stage::Metal, Stage::Mirror] {
            assert!(tallies.of(stage).items > 20, "{stage:?}: {tallies:?}");
        }
    }
}

#[test]
fn instruction_sets_count_the_same() {
    let counted = |isa: Isa| {
        let options = TraceOptions { isa, ..options(8) };
        let cost = trace(&scene().flat(0, &options), SPP, &options).cost;
        Stage::ALL.map(|stage| cost.of(stage).items)
    };
    let truth = counted(Isa::SCALAR);
    for isa in Isa::all() {
        assert_eq!(counted(isa), truth, "{isa:?}");
    }
}
