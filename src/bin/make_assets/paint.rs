//! Painting: a colour function of the surface, rasterised into the texture through the layout.
//!
//! Enters: mesh, layout, colour function. Leaves: 8-bit sRGB texels, row by row from the top. The colours of a chart
//! are carried on into its margin, so that bilinear filtering at a seam mixes the chart with itself only.

use crate::net::Mesh;
use crate::unwrap::{Layout, MARGIN};
use luxel::math::{DVec2, DVec3};

/// What fills the texture where no chart is near.
const GROUND: [f64; 3] = [0.86, 0.62, 0.38];
/// How far outside a triangle, in barycentric coordinates, a texel still counts as covered: rounding only.
const COVER_SLACK: f64 = 1e-9;

/// Paints; `colour` gives sRGB-encoded values in [0, 1] at a point of the surface.
pub(crate) fn paint(
    mesh: &Mesh,
    layout: &Layout,
    size: [usize; 2],
    colour: impl Fn(DVec3) -> [f64; 3],
) -> Vec<u8> {
    let [width, height] = size;
    let mut texels: Vec<Option<[f64; 3]>> = vec![None; width * height];
    for (triangle, corners) in mesh.triangles.iter().zip(&layout.corners) {
        let points = triangle.map(|i| mesh.positions[i]);
        covered(corners, |x, y, [a, b, c]| {
            texels[y * width + x] = Some(colour(points[0] * a + points[1] * b + points[2] * c));
        });
    }
    for _ in 0..MARGIN as usize {
        texels = dilate(&texels, width, height);
    }
    texels
        .iter()
        .flat_map(|t| {
            t.unwrap_or(GROUND)
                .map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
        })
        .collect()
}

/// Calls `each` for every texel whose centre lies in the triangle, with its barycentric coordinates.
pub(crate) fn covered(corners: &[DVec2; 3], mut each: impl FnMut(usize, usize, [f64; 3])) {
    let [a, b, c] = *corners;
    let area = (b - a).perp_dot(c - a);
    let (lo, hi) = (a.min(b).min(c), a.max(b).max(c));
    for y in lo.y as usize..=hi.y as usize {
        for x in lo.x as usize..=hi.x as usize {
            let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let weights = [
                (b - p).perp_dot(c - p),
                (c - p).perp_dot(a - p),
                (a - p).perp_dot(b - p),
            ]
            .map(|w| w / area);
            if weights.iter().all(|&w| w >= -COVER_SLACK) {
                each(x, y, weights);
            }
        }
    }
}

/// Gives every empty texel the mean of its filled neighbours.
fn dilate(texels: &[Option<[f64; 3]>], width: usize, height: usize) -> Vec<Option<[f64; 3]>> {
    let mut grown = texels.to_vec();
    for y in 0..height {
        for x in 0..width {
            if texels[y * width + x].is_some() {
                continue;
            }
            let (mut sum, mut count) = ([0.0; 3], 0.0);
            for ny in y.saturating_sub(1)..(y + 2).min(height) {
                for nx in x.saturating_sub(1)..(x + 2).min(width) {
                    if let Some(c) = texels[ny * width + nx] {
                        sum = [0, 1, 2].map(|k| sum[k] + c[k]);
                        count += 1.0;
                    }
                }
            }
            if count > 0.0 {
                grown[y * width + x] = Some(sum.map(|s| s / count));
            }
        }
    }
    grown
}
