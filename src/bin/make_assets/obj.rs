//! OBJ text: the shortest decimals at a fixed precision, so that equal meshes are equal files.

use crate::net::Mesh;
use crate::unwrap::Layout;
use luxel::math::DVec3;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Decimals of positions and texture coordinates: a hundredth of a cell, of a texel, and less.
const FINE: usize = 5;
/// Decimals of normals.
const COARSE: usize = 3;

/// A mesh with one normal per vertex and one texture coordinate per chart and vertex.
pub(crate) fn write(
    mesh: &Mesh,
    layout: &Layout,
    size: [usize; 2],
    normal: impl Fn(DVec3) -> DVec3,
) -> String {
    let mut text = String::from(
        "# A sitting cat for luxel, written by make_assets. Y up, facing +Z, on y = 0, about one unit tall.\n\
         mtllib cat.mtl\no cat\nusemtl fur\n",
    );
    for &p in &mesh.positions {
        line(&mut text, "v", &p.to_array(), FINE);
    }
    for &p in &mesh.positions {
        line(&mut text, "vn", &normal(p).to_array(), COARSE);
    }
    let mut faces = String::new();
    let mut numbers = BTreeMap::new();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        faces.push('f');
        for (k, &i) in triangle.iter().enumerate() {
            let next = numbers.len() + 1;
            let vt = *numbers.entry((layout.chart[t], i)).or_insert_with(|| {
                let q = layout.corners[t][k];
                line(
                    &mut text,
                    "vt",
                    &[q.x / size[0] as f64, 1.0 - q.y / size[1] as f64],
                    FINE,
                );
                next
            });
            // Writing into a String cannot fail.
            let _ = write!(faces, " {}/{vt}/{}", i + 1, i + 1);
        }
        faces.push('\n');
    }
    text + &faces
}

fn line(text: &mut String, key: &str, numbers: &[f64], decimals: usize) {
    text.push_str(key);
    for n in numbers {
        text.push(' ');
        text.push_str(&decimal(*n, decimals));
    }
    text.push('\n');
}

/// Without trailing zeros and without a negative zero.
fn decimal(n: f64, decimals: usize) -> String {
    let text = format!("{n:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}
