//! A folder with a scene, and the command in it.

use crate::support::Folder;
use std::collections::BTreeMap;

/// A cube that turns about a corner's axis beside a ball, under a lamp: a mesh, spheres, a full turn in 12 frames.
pub(crate) const SCENE: &str = r#"Scene(
    version: 1,
    camera: (at: (0, 2, 7), look_at: (0, 0, 0)),
    render: (size: (40, 24), spp: 2, max_bounces: 2),
    entities: [
        (name: "lamp", shape: Sphere(radius: 1), transform: (translate: (0, 5, 2)), emissive: (radiance: (9, 9, 9))),
        (name: "ball", shape: Sphere(radius: 1), transform: (translate: (-2, 0, 0))),
        (name: "cube", shape: Mesh("cube.obj"), transform: (translate: (1, 0, 0)), spin: (axis: (0, 1, 0.5), deg_per_s: 720)),
    ],
    animation: (fps: 24, frames: 0..12),
)
"#;

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4\nf 2 3 7 6\n";

/// A folder of a test's own, with `spin.ron` in it.
pub(crate) fn folder(name: &str) -> Folder {
    Folder::new(name, &[("spin.ron", SCENE), ("cube.obj", CUBE)])
}

/// Every file with its bytes, but for the scene and its mesh; folders have none.
pub(crate) fn files(folder: &Folder) -> BTreeMap<String, Vec<u8>> {
    let bytes = |name: &String| std::fs::read(folder.path(name)).unwrap_or_default();
    let names = names(folder).into_iter();
    names.map(|name| (name.clone(), bytes(&name))).collect()
}

pub(crate) fn names(folder: &Folder) -> Vec<String> {
    let mut names = folder.names();
    names.retain(|name| name != "spin.ron" && name != "cube.obj");
    names
}
