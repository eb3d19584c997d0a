//! What the auxiliary images hold, where it is known exactly.

use crate::luxel_side::{Stage, options};
use crate::objs;
use luxel::trace::{TileSums, TraceOptions};

const SPP: u32 = 8;

/// A square whose normals all lean towards +x, by 3 : 4.
const LEANING: &str =
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn 0.6 0 0.8\nf 1//1 2//1 3//1 4//1\n";

fn features(stage: &Stage) -> TileSums {
    let options = TraceOptions {
        features: true,
        ..options(0)
    };
    stage.sums(0, SPP, &options)
}

/// Depth is measured along the view axis: a plane across it has one depth, to the corners of a wide picture.
#[test]
fn a_plane_across_the_view_has_one_depth() {
    let stage = Stage::new("one_depth")
        .file("square.obj", &objs::square(0.0, 1.0))
        .scene(
            r#"camera: (at: (0, 0, 3), look_at: (0, 0, 0), vfov_deg: 100), render: (size: (8, 8), filter: Box),
                entities: [(shape: Mesh("square.obj"), normals: Flat, transform: (scale: 9))]"#,
        );
    let sums = features(&stage);
    for (i, (depth, n)) in sums.depth.iter().zip(&sums.hit_count).enumerate() {
        assert_eq!(*n, SPP, "hits of pixel {i}");
        let depth = depth / f64::from(*n);
        assert!((depth - 3.0).abs() < 3e-6, "depth {depth} of pixel {i}");
    }
}

/// The shading normal is that of the file by the inverse transpose, the geometric one that of the triangle; both stay
/// outside where the mesh is mirrored, flattened (alone) or an instance (twice).
#[test]
fn both_normals_are_those_of_the_mesh() {
    for (x, lean) in [(1.0, 0.6), (2.0, 0.3), (-2.0, -0.3), (-0.5, -1.2)] {
        for again in [
            "",
            r#", (shape: Mesh("leaning.obj"), transform: (translate: (0, 0, -9)))"#,
        ] {
            let name = format!("leaning_{x}_{}", again.len());
            let stage = Stage::new(&name).file("leaning.obj", LEANING).scene(&format!(
                r#"camera: (at: (0, 0, 3), look_at: (0, 0, 0), vfov_deg: 9), render: (size: (2, 2), filter: Box),
                    entities: [(shape: Mesh("leaning.obj"), normals: File, transform: (scale: ({x}, 1, 1))){again}]"#
            ));
            let sums = features(&stage);
            let length = (lean * lean + 0.64f64).sqrt();
            for i in 0..sums.normal.len() {
                let n = f64::from(sums.hit_count[i]);
                let [normal, geonormal] =
                    [sums.normal[i], sums.geonormal[i]].map(|s| s.map(|c| c / n));
                let want = [lean / length, 0.0, 0.8 / length];
                let across = geonormal.into_iter().zip([0.0, 0.0, 1.0]);
                for (found, want) in normal.into_iter().zip(want).chain(across) {
                    assert!(
                        (found - want).abs() < 4e-7,
                        "{name}: {normal:?}, {geonormal:?}"
                    );
                }
            }
        }
    }
}
