//! The command from outside: exit codes, messages, files written whole or not at all.

mod compare;
mod ended;
mod render;
#[path = "../support/folder.rs"]
mod support;
mod usage;

use support::Folder;

const SCENE: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 0, 5), look_at: (0, 0, 0)),
    render: (size: (40, 24), spp: 3, max_bounces: 3),
    materials: { "chalk": Diffuse(color: Linear(0.8, 0.6, 0.4)) },
    entities: [
        (name: "lamp", shape: Sphere(radius: 1), transform: (translate: (0, 4, 2)), emissive: (radiance: (9, 9, 9))),
        (name: "ball", shape: Sphere(radius: 1), material: "chalk"),
    ],
)
"#;

/// A folder of a test's own, with `scene.ron` in it.
fn folder(name: &str) -> Folder {
    Folder::new(name, &[("scene.ron", SCENE)])
}
