//! Tiny and huge meshes: a smooth ball under one light has no dark specks, and looks as it does at its natural size.

use crate::luxel_side::{Stage, options};
use std::fmt::Write;

const SIZE: usize = 64;

/// A ball of diameter `size` on the floor of its own file, by longitude and latitude, with normals.
fn ball(size: f64) -> String {
    const AROUND: usize = 48;
    const DOWN: usize = 24;
    let mut text = String::new();
    for j in 0..=DOWN {
        let (sin, cos) = (std::f64::consts::PI * j as f64 / DOWN as f64).sin_cos();
        for i in 0..AROUND {
            let (x, z) = (std::f64::consts::TAU * i as f64 / AROUND as f64).sin_cos();
            let n = [x * sin, cos, z * sin];
            let p = n.map(|c| 0.5 * size * c);
            writeln!(text, "v {} {} {}", p[0], p[1] + 0.5 * size, p[2]).expect("text");
            writeln!(text, "vn {} {} {}", n[0], n[1], n[2]).expect("text");
        }
    }
    for j in 0..DOWN {
        for i in 0..AROUND {
            let at = |i: usize, j: usize| {
                let vertex = j * AROUND + i % AROUND + 1;
                format!("{vertex}//{vertex}")
            };
            let corners = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            // At the poles two corners of a square are one.
            let [a, b, c, d] = corners;
            if j > 0 {
                writeln!(text, "f {a} {b} {d}").expect("text");
            }
            if j + 1 < DOWN {
                writeln!(text, "f {b} {c} {d}").expect("text");
            }
        }
    }
    text
}

/// Its upper half, large in the frame, lit by a point from the side of the camera; a middling colour at every size.
fn picture(size: f64, test: &str) -> Vec<f64> {
    const SPP: u32 = 16;
    let at = |x: f64| x * size;
    let stage = Stage::new(&format!("acne_{test}_{size}")).file("ball.obj", &ball(size)).scene(&format!(
        r#"camera: (at: (0, {}, {}), look_at: (0, {}, 0), vfov_deg: 16), render: (size: ({SIZE}, {SIZE}), filter: Box),
        entities: [(shape: Mesh("ball.obj")),
            (light: Point(intensity: ({e}, {e}, {e})), transform: (translate: ({}, {}, {})))]"#,
        at(1.5),
        at(3.0),
        at(0.7),
        at(-2.0),
        at(3.0),
        at(2.5),
        e = 20.0 * size * size,
    ));
    let sums = stage.sums(0, SPP, &options(2));
    sums.rgb.iter().map(|c| c[1] / f64::from(SPP)).collect()
}

/// Pixels that are much darker than the mean of their eight neighbours, all of which are lit.
fn specks(picture: &[f64]) -> (usize, usize) {
    let brightest = picture.iter().fold(0.0, |most: f64, c| most.max(*c));
    let (mut lit, mut specks) = (0, 0);
    for y in 1..SIZE - 1 {
        for x in 1..SIZE - 1 {
            let around = (0..9).filter(|k| *k != 4);
            let around = around.map(|k| picture[(y + k / 3 - 1) * SIZE + x + k % 3 - 1]);
            let least = around.clone().fold(f64::INFINITY, f64::min);
            if least < 0.3 * brightest {
                continue;
            }
            lit += 1;
            specks += usize::from(picture[y * SIZE + x] < 0.9 * around.sum::<f64>() / 8.0);
        }
    }
    (lit, specks)
}

#[test]
fn tiny_and_huge_balls_have_no_acne() {
    let natural = picture(1.0, "sizes");
    for size in [1.0, 0.02, 0.0203, 1000.0, 1017.3] {
        let found = picture(size, "sizes");
        let (lit, specks) = specks(&found);
        assert!(
            lit > SIZE * SIZE / 3,
            "size {size}: only {lit} pixels are lit"
        );
        assert_eq!(specks, 0, "size {size}");
        // A sample at a silhouette may fall on the other side of it.
        let strays = found
            .iter()
            .zip(&natural)
            .filter(|(a, b)| (*a - *b).abs() > 1e-4);
        let strays = strays.count();
        assert!(strays <= 8, "size {size}: {strays} pixels differ");
    }
}

/// The count of specks sees them.
#[test]
fn specks_are_seen() {
    let mut found = picture(1.0, "specks");
    let brightest = (0..found.len()).max_by(|a, b| found[*a].total_cmp(&found[*b]));
    found[brightest.expect("pixels")] *= 0.5;
    assert_eq!(specks(&found).1, 1);
}
