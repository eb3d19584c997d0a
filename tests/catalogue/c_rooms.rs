//! C1: closed rooms turned at random, in which no path may be lost: walls that meet at 109°, 90°, 71° and 45° along edges that
//! are parallel to no axis. Other transforms are in `tests/world`.

use crate::book::{Outcome, items};
use crate::g_transport::{bare, camera, deviating, series};
use crate::luxel_side::Stage;
use crate::rooms;
use crate::support::Rng;

items! {
    c1_turned(5e4, 1e8): "C1", "samples of cubes, octahedra, tetrahedra and wedges of 45° that shine everywhere, turned at random, flattened and instanced: not equal to the bit";
}

/// Diffuse bounces of each path.
const BOUNCES: u32 = 20;

/// So many samples are taken of one room before it is turned anew.
const SAMPLES: u64 = 1 << 16;

fn c1_turned(trials: u64) -> Outcome {
    let mut rng = Rng(30);
    let mut outcome = Outcome::default();
    let mut lost = String::new();
    let options = bare(BOUNCES);
    let shapes = [
        ("cube", rooms::cube()),
        ("octahedron", rooms::octahedron()),
        ("tetrahedron", rooms::tetrahedron()),
        ("wedge", rooms::wedge()),
    ];
    for case in 0.. {
        if outcome.trials >= trials {
            break;
        }
        let (name, shape) = &shapes[case % shapes.len()];
        let [x, y, z] = rng.direction();
        let w = rng.range(-1.0, 1.0);
        let spin = ["", "spin: (axis: (1, 2, 3), deg_per_s: 10),"][case / shapes.len() % 2];
        let stage =
            Stage::new(&format!("catalogue_c1_{name}")).file("room.obj", &rooms::inward(shape));
        let stage = stage.scene(&format!(
            r#"{} background: Linear(1000, 1000, 1000),
            materials: {{"wall": Diffuse(color: Linear(0.9, 0.9, 0.9))}},
            entities: [(shape: Mesh("room.obj"), normals: Flat, material: "wall", emissive: (radiance: (1, 1, 1)), {spin}
                transform: (rotate: Quat({x}, {y}, {z}, {w})))]"#,
            camera()
        ));
        let spp = SAMPLES.min(trials / 8).div_ceil(64);
        let room = deviating(
            &stage.flat(case as u32, &options),
            &options,
            spp,
            series(0.9, BOUNCES),
        );
        if room.failures > 0 {
            lost += &format!("; {} in room {case}, a {name}", room.failures);
        }
        outcome.add(room);
    }
    outcome.saying(format!("{BOUNCES} bounces each{lost}"))
}
