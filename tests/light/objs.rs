//! OBJ texts of the meshes that the tests need.

use std::f64::consts::TAU;
use std::fmt::Write;

/// A unit square in the plane z = 0, from −1 to 1, facing +z; its uv run from `low` to `high`.
pub(crate) fn square(low: f64, high: f64) -> String {
    format!(
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt {low} {low}\nvt {high} {low}\nvt {high} {high}\nvt {low} {high}\n\
         f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
    )
}

/// A cube from −1 to 1, normals outward, or inward.
pub(crate) fn cube(inward: bool) -> String {
    let mut text = String::new();
    for k in 0..8 {
        let side = |bit: u32| if k >> bit & 1 == 1 { 1 } else { -1 };
        writeln!(text, "v {} {} {}", side(0), side(1), side(2)).expect("a string");
    }
    let faces = [
        [1, 3, 4, 2],
        [5, 6, 8, 7],
        [1, 2, 6, 5],
        [3, 7, 8, 4],
        [1, 5, 7, 3],
        [2, 4, 8, 6],
    ];
    for [a, b, c, d] in faces {
        let (b, d) = if inward { (d, b) } else { (b, d) };
        writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").expect("a string");
    }
    text
}

/// A regular polygon of n sides around the origin in the plane y = 0, facing +y, with corners at distance r.
pub(crate) fn fan(n: u32, r: f64) -> String {
    let mut text = String::from("v 0 0 0\n");
    for k in 0..n {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
        writeln!(text, "v {} 0 {}", r * cos, r * sin).expect("a string");
    }
    for k in 0..n {
        writeln!(text, "f 1 {} {}", 2 + (k + 1) % n, 2 + k).expect("a string");
    }
    text
}

/// Radius to the corners of the regular polygon that has the area of the disc of radius r.
pub(crate) fn equal_area(n: u32, r: f64) -> f64 {
    let step = TAU / f64::from(n);
    r * (step / step.sin()).sqrt()
}

/// An octahedron split twice and pushed onto the unit sphere, with the sphere's normals.
pub(crate) fn smooth_ball() -> String {
    let mut text = String::new();
    let mut faces = Vec::new();
    for k in 0..8u32 {
        let side = |bit: u32| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let (x, y, z) = (
            [side(0), 0.0, 0.0],
            [0.0, side(1), 0.0],
            [0.0, 0.0, side(2)],
        );
        let even = side(0) * side(1) * side(2) > 0.0;
        faces.push(if even { [x, y, z] } else { [x, z, y] });
    }
    let middle = |a: [f64; 3], b: [f64; 3]| {
        let m = [0, 1, 2].map(|i| a[i] + b[i]);
        let length = m.iter().map(|c| c * c).sum::<f64>().sqrt();
        m.map(|c| c / length)
    };
    for _ in 0..2 {
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    for (i, face) in faces.iter().enumerate() {
        for [x, y, z] in face {
            writeln!(text, "v {x} {y} {z}\nvn {x} {y} {z}").expect("a string");
        }
        let k = 3 * i + 1;
        writeln!(text, "f {k}//{k} {}//{} {}//{}", k + 1, k + 1, k + 2, k + 2).expect("a string");
    }
    text
}
