//! What is committed is what the generator writes, and the cat is a mesh that a renderer can be tested with.

use crate::net::{self, Mesh};
use crate::shape::Cat;
use crate::unwrap::{self, Layout};
use crate::{CAT_TEXTURE, CAT_TRIANGLES, assets, paint};
use std::collections::BTreeSet;
use std::path::Path;

fn cat() -> (Cat, Mesh, Layout) {
    let cat = Cat::sitting();
    let mesh = net::mesh(&cat, CAT_TRIANGLES).expect("a closed mesh");
    let layout = unwrap::unwrap(&cat, &mesh, CAT_TEXTURE);
    (cat, mesh, layout)
}

#[test]
fn the_committed_assets_are_what_the_generator_writes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    for (name, bytes) in assets(CAT_TRIANGLES).expect("assets") {
        let committed = std::fs::read(folder.join(name)).expect(name);
        assert!(
            committed == bytes,
            "{name} differs: run make_assets and look at the difference"
        );
    }
}

#[test]
fn the_cat_is_closed_outward_and_stands_on_the_ground() {
    for triangles in [4000, CAT_TRIANGLES] {
        let cat = Cat::sitting();
        let mesh = net::mesh(&cat, triangles).expect("a closed mesh");
        let made = mesh.triangles.len();
        assert!(
            made.abs_diff(triangles) * 8 < triangles,
            "{made} triangles instead of {triangles}"
        );

        let mut sides = BTreeSet::new();
        for t in &mesh.triangles {
            for k in 0..3 {
                assert!(
                    sides.insert((t[k], t[(k + 1) % 3])),
                    "a side is used twice the same way"
                );
            }
        }
        assert!(
            sides.iter().all(|&(a, b)| sides.contains(&(b, a))),
            "an open side"
        );

        let volume: f64 = mesh
            .triangles
            .iter()
            .map(|t| t.map(|i| mesh.positions[i]))
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        assert!(volume > 0.05 && volume < 0.15, "volume {volume}");
        assert!(
            mesh.positions.iter().all(|p| p.y >= 0.0) && mesh.positions.iter().any(|p| p.y == 0.0)
        );
    }
}

#[test]
fn every_face_looks_the_way_its_normals_do() {
    let (cat, mesh, _) = cat();
    let against = |t: &&[usize; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i]);
        let ng = (b - a).cross(c - a);
        t.iter()
            .any(|&i| ng.dot(cat.gradient(mesh.positions[i])) <= 0.0)
    };
    let wrong = mesh.triangles.iter().filter(against).count();
    // At the ears' rims the surface turns within one triangle.
    assert!(
        wrong * 200 < mesh.triangles.len(),
        "{wrong} of {} faces",
        mesh.triangles.len()
    );
}

#[test]
fn charts_neither_fold_nor_touch() {
    let (_, mesh, layout) = cat();
    let [width, height] = CAT_TEXTURE;
    assert_ne!(width, height);
    let mut owner: Vec<Option<usize>> = vec![None; width * height];
    let mut twice = 0;
    for (t, corners) in layout.corners.iter().enumerate() {
        let [a, b, c] = *corners;
        // y points down, so counter-clockwise triangles have a negative area: none is mirrored.
        assert!(
            (b - a).perp_dot(c - a) < 0.0,
            "triangle {t} of {} is mirrored",
            mesh.triangles.len()
        );
        paint::covered(corners, |x, y, weights| {
            let inside = weights.iter().all(|&w| w > 1e-6);
            let before = owner[y * width + x].replace(layout.chart[t]);
            twice += usize::from(inside && before.is_some());
            assert!(
                before.is_none_or(|other| other == layout.chart[t]),
                "charts overlap at {x}, {y}"
            );
        });
    }
    assert_eq!(twice, 0, "texels inside two triangles");
    let margin = unwrap::MARGIN as usize;
    for (y, row) in owner.chunks(width).enumerate() {
        for (x, chart) in row.iter().enumerate().filter(|(_, chart)| chart.is_some()) {
            assert!(x >= margin && y >= margin && x + margin < width && y + margin < height);
            let near = [
                (x + margin, y),
                (x, y + margin),
                (x + margin, y + margin),
                (x + margin, y - margin),
            ];
            let alone = near
                .iter()
                .map(|(x, y)| owner[y * width + x])
                .all(|other| other.is_none() || other == *chart);
            assert!(alone, "charts touch at {x}, {y}");
        }
    }
}

#[test]
fn the_obj_has_seams_and_the_files_are_small() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let text = std::fs::read_to_string(folder.join("cat.obj")).expect("cat.obj");
    let count = |key: &str| {
        text.lines()
            .filter(|l| l.split(' ').next() == Some(key))
            .count()
    };
    assert!(
        count("vt") > count("v") * 11 / 10,
        "{} uv for {} vertices",
        count("vt"),
        count("v")
    );
    assert_eq!(count("v"), count("vn"));
    let texture = std::fs::metadata(folder.join("cat.png")).expect("cat.png");
    assert!(text.len() < 700_000 && texture.len() < 400_000);
}
