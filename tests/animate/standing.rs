//! What stands keeps its tree, with one over what moves above it: the same pictures, to the bit, as without any tree.

use crate::motion::spawn;
use luxel::build::Accel;
use luxel::render::{Control, Renderer, Settings};

/// More spheres than are tested one after the other, standing and moving; meshes flattened and instanced, likewise; lights
/// of triangles that stand and that move.
fn crowd() -> String {
    let ball = |i: u32| {
        let (x, z) = (i % 6, i / 6);
        let spin = if i.is_multiple_of(3) {
            ", spin: (axis: (0, 1, 0), deg_per_s: 90, pivot: (2, 0, 2))"
        } else {
            ""
        };
        format!("(shape: Sphere(radius: 0.3), transform: (translate: ({x}, 0, {z})){spin}),\n")
    };
    let balls: String = (0..36).map(ball).collect();
    format!(
        r#"Scene(version: 1, camera: (at: (3, 6, 12), look_at: (2, 0, 2)), render: (size: (40, 28), spp: 2, max_bounces: 3),
        background: Linear(0.2, 0.2, 0.3), entities: [
        (shape: Mesh("../assets/plinth.obj"), transform: (translate: (2, -2, 2), scale: 2)),
        (shape: Mesh("../assets/gear_12.obj"), transform: (translate: (0, 2, -3), scale: 0.2)),
        (shape: Mesh("../assets/gear_12.obj"), transform: (translate: (5, 2, -3), scale: 0.2)),
        (shape: Mesh("../assets/gear_12.obj"), transform: (translate: (3, 2, -3), scale: 0.2), spin: (axis: (0, 1, 1), deg_per_s: 90)),
        (shape: Mesh("../assets/seam_cube.obj"), transform: (translate: (-2, 1, 3), scale: 0.5), emissive: (radiance: (4, 3, 2))),
        (shape: Mesh("../assets/cat.obj"), transform: (translate: (7, -1, 1), scale: 3), emissive: (radiance: (1, 2, 3)),
            keys: [(t: 0, translate: (7, -1, 1)), (t: 1, translate: (5, -1, 1))]),
        {balls}], animation: (fps: 4, frames: 0..4))"#
    )
}

fn pictures(accel: Accel, text: &str) -> Vec<Vec<[f32; 3]>> {
    let (desc, spawned) = spawn(text);
    let settings = Settings {
        accel,
        ..Settings::of_scene(&desc)
    };
    let mut renderer =
        Renderer::new(&desc, spawned.world, &spawned.assets, settings).expect("threads");
    let mut picture = |frame| renderer.render(frame, &Control::default()).film.radiance();
    [0, 1, 3, 2].map(&mut picture).to_vec()
}

#[test]
fn pictures_are_those_without_a_tree() {
    let text = crowd();
    let [trees, none] = [Accel::Bvh, Accel::Brute].map(|accel| pictures(accel, &text));
    assert!(trees == none, "other bits");
    assert_ne!(trees[0], trees[1]);
}

/// Every mix of what stands and what moves, each of few things and of none.
#[test]
fn any_mix_stands_and_moves() {
    let mesh = r#"(shape: Mesh("../assets/plinth.obj"), transform: (translate: (0, 0, -2), rotate: Euler(30, 0, 0))),"#;
    let twin = r#"(shape: Mesh("../assets/seam_cube.obj"), transform: (translate: (TWIN, 1, 0), scale: 0.4)),"#;
    let turning = r#"(shape: Mesh("../assets/seam_cube.obj"), transform: (translate: (-1, -1, 0), scale: 0.4), spin: (axis: (1, 1, 0), deg_per_s: 50)),"#;
    let ball = |moves: bool| {
        let spin = if moves {
            ", spin: (axis: (0, 0, 1), deg_per_s: 80, pivot: (0, 0, 0))"
        } else {
            ""
        };
        (0..20)
            .map(|i| {
                format!(
                    "(shape: Sphere(radius: 0.1), transform: (translate: (0.2, {}, 1)){spin}),",
                    f64::from(i) * 0.2 - 2.0
                )
            })
            .collect::<String>()
    };
    let parts = [
        mesh.to_owned(),
        twin.replace("TWIN", "1") + &twin.replace("TWIN", "2"),
        turning.to_owned(),
        ball(false),
        ball(true),
    ];
    for mix in 0..1 << parts.len() {
        let chosen = parts.iter().enumerate().filter(|(i, _)| mix >> i & 1 == 1);
        let entities: String = chosen.map(|(_, part)| part.as_str()).collect();
        let text = format!(
            "Scene(version: 1, camera: (at: (0, 0, 7), look_at: (0, 0, 0)), render: (size: (16, 16), spp: 1, max_bounces: 2),
            background: Linear(1, 1, 1), entities: [{entities}], animation: (fps: 4))"
        );
        let [trees, none] = [Accel::Bvh, Accel::Brute].map(|accel| pictures(accel, &text));
        assert!(trees == none, "mix {mix:05b}: other bits");
    }
}
