//! What luxel is meant to reach: its rays in a second over those of the better of Embree's kernels.

use luxel::measure::bench::{RayKind, Subject};

/// Against Embree's default mode: up to so many triangles, the bars in the order of [`RayKind::ALL`].
const MESHES: [(usize, [f64; 5]); 3] = [
    (300_000, [1.15, 1.1, 1.0, 1.1, 1.0]),
    (2_000_000, [1.1, 1.15, 1.4, 1.1, 1.4]),
    (usize::MAX, [1.1, 1.2, 1.8, 1.3, 1.8]),
];

/// Against Embree's robust mode, which is watertight like luxel.
const ROBUST: f64 = 1.3;

/// A soup of thin triangles, where boxes tell little.
const SOUP: f64 = 0.9;

/// Spheres, against Embree's.
const SPHERES: f64 = 1.0;

/// The bar of a set of rays.
pub(crate) fn bar(name: &str, subject: &Subject, kind: RayKind, robust: bool) -> f64 {
    if subject.triangles.is_empty() {
        return SPHERES;
    }
    if robust {
        return ROBUST;
    }
    if name == "soup" {
        return SOUP;
    }
    let count = subject.triangles.len();
    let sized = MESHES.iter().find(|(most, _)| count <= *most);
    sized.map_or(0.0, |(_, bars)| bars[kind as usize])
}
