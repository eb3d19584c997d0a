//! A tiny OBJ reader for the tests' own meshes: `v`, `vt`, `vn` and `f` with convex faces, fanned.

use glam::{DVec2, DVec3};
use std::path::Path;

/// A triangle as it stands in the file.
pub(crate) struct Face {
    pub(crate) p: [DVec3; 3],
    pub(crate) uv: [DVec2; 3],
    pub(crate) n: Option<[DVec3; 3]>,
}

pub(crate) fn read(path: &Path) -> Vec<Face> {
    let text = std::fs::read_to_string(path).expect("the mesh of a test");
    let (mut v, mut vt, mut vn, mut faces) = (vec![], vec![], vec![], vec![]);
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |k: usize| words[k].parse::<f64>().expect("a number");
        match words.first() {
            Some(&"v") => v.push(DVec3::new(number(1), number(2), number(3))),
            Some(&"vt") => vt.push(DVec2::new(number(1), number(2))),
            Some(&"vn") => vn.push(DVec3::new(number(1), number(2), number(3)).normalize()),
            Some(&"f") => {
                let corner = |w: &str| -> [Option<usize>; 3] {
                    let mut parts = w.split('/');
                    [0; 3].map(|_| parts.next().and_then(|i| i.parse().ok()))
                };
                let corners: Vec<_> = words[1..].iter().map(|w| corner(w)).collect();
                for k in 1..corners.len() - 1 {
                    let c = [corners[0], corners[k], corners[k + 1]];
                    faces.push(Face {
                        p: c.map(|c| v[c[0].expect("a position") - 1]),
                        uv: c.map(|c| c[1].map_or(DVec2::ZERO, |i| vt[i - 1])),
                        n: c[2][2].map(|_| c.map(|c| vn[c[2].expect("a normal") - 1])),
                    });
                }
            }
            _ => {}
        }
    }
    faces
}
