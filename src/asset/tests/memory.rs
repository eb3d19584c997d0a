//! What is kept of a file, in what order, and how much memory it may take.

use super::super::*;
use super::{Folder, clean, png, points};
use crate::diag::Diagnostic;

#[test]
fn what_no_face_uses_is_not_kept() {
    let mesh = clean(
        "v 9 9 9\nv 0 0 0\nv nan 0 0\nv 1 0 0\nv 0 1 0\nv -1e99 0 0\nvt 7 7\nvt 1 0\nvn 1 0 0\nvn 0 0 1\nf 2/2/2 4/2/2 5/2/2",
    );
    let used = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(
        mesh.positions
            .iter()
            .map(|p| p.to_array())
            .collect::<Vec<_>>(),
        used
    );
    assert_eq!(
        (mesh.uvs.values().len(), mesh.normals.values()),
        (1, &[DVec3::Z][..])
    );
    assert_eq!(points(&mesh), used);
}

#[test]
fn blocks_of_lines_and_polygons_of_all_sizes_keep_their_order() {
    // More vertices than one block of lines has, in a polygon of every size.
    let mut text = String::new();
    let (mut expect, mut first) = (Vec::new(), 0);
    for corners in 3..120 {
        let at = |k: usize| {
            let turn = std::f64::consts::TAU * k as f64 / corners as f64;
            [turn.cos() + first as f64, turn.sin(), 0.0]
        };
        let line = |[x, y, z]: [f64; 3]| format!("v {x} {y} {z}\n");
        text.extend((0..corners).map(|k| line(at(k))));
        let face = |k: usize| format!(" {}", first + k + 1);
        text.push_str(&format!(
            "f{}\n",
            (0..corners).map(face).collect::<String>()
        ));
        expect.extend((1..corners - 1).flat_map(|k| [at(0), at(k), at(k + 1)]));
        first += corners;
    }
    assert!(first > 4096);
    assert_eq!(points(&clean(text)), expect);
}

#[test]
fn files_take_no_more_memory_than_they_may() {
    let rows = |n: usize| "v 0 0 0\nv 1 0 0\nv 0 1 0\n".repeat(n) + &"f 1 2 3\n".repeat(n);
    let small = rows(1);
    let large = rows(5000);
    let image = png(png::ColorType::Rgb, png::BitDepth::Eight, 64, &[0; 192]);
    let folder = Folder::of(&[
        ("small.obj", small.as_bytes()),
        ("large.obj", large.as_bytes()),
        ("t.png", &image),
    ]);
    let load = |memory| {
        let mut loader = Loader::with_limits(Limits { memory });
        let code = |found: Option<&Diagnostic>| found.map_or("", |error| error.code);
        let codes = ["small.obj", "large.obj"].map(|name| {
            let loaded = loader.mesh(&folder.0.join(name));
            code(loaded.err().as_ref().and_then(|found| found.first()))
        });
        let image = loader.texture(&folder.0.join("t.png"));
        (codes, code(image.err().as_ref()), loader.finish().memory())
    };
    let mesh = |rows: u64| rows * (3 * 24 + 3 * 3 * 4 + 8);
    assert_eq!(load(1 << 20), (["", ""], "", mesh(5001) + 192));
    // The file fits, and what it decodes to does not.
    assert_eq!(load(large.len() as u64).0, ["", "E111"]);
    assert_eq!(load(10), (["E111", "E111"], "E111", 0));
}

#[test]
fn a_file_that_failed_takes_nothing() {
    let good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let folder = Folder::of(&[
        ("index.obj", format!("{good}f 1 2 9\n").as_bytes()),
        ("flat.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
        ("good.obj", good.as_bytes()),
    ]);
    let mut loader = Loader::new();
    for bad in ["index.obj", "flat.obj"] {
        assert!(loader.mesh(&folder.0.join(bad)).is_err());
    }
    assert!(loader.mesh(&folder.0.join("good.obj")).is_ok());
    assert_eq!(loader.finish().memory(), 3 * 24 + 3 * 3 * 4 + 8);
}

#[test]
fn a_file_counts_while_it_is_read() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let folder = Folder::of(&[("a.obj", text.as_bytes())]);
    let fits = |memory: usize| {
        let limits = Limits {
            memory: memory as u64,
        };
        let mut loader = Loader::with_limits(limits);
        loader.mesh(&folder.0.join("a.obj")).is_ok()
    };
    let both = text.len() + 3 * 24 + 3 * 3 * 4 + 8;
    assert_eq!((fits(both), fits(both - 1)), (true, false));
}
