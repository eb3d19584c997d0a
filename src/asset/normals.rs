//! Normals: of the file, and smoothed over faces.

use super::Mesh;
use crate::math::{self, DVec3};

/// The unit vector of a direction; `None` when it is zero or not finite. Scaled first, so that no length underflows.
pub(super) fn unit(direction: DVec3) -> Option<DVec3> {
    let size = direction.abs().max_element();
    if !(size > 0.0 && direction.is_finite()) {
        return None;
    }
    let scaled = direction / size;
    Some(scaled / scaled.length())
}

/// A corner of a face, as its point sees it.
#[derive(Clone, Copy)]
struct Fan {
    /// Unit normal of the face; zero where the face has no area.
    normal: DVec3,
    /// Angle of the face at the corner, radians.
    angle: f64,
}

/// Smooth unit normals of a mesh, one per corner: `3 * triangles`, in the order of [`Mesh::corners`].
///
/// Each is the mean of the normals of the faces that meet at the corner's position and turn less than `angle_deg` from
/// the corner's own face, weighted by their angles there (Thürmer and Wüthrich, "Computing vertex normals from
/// polygonal facets", 1998), so that cutting a flat face differently changes nothing. Faces meet where coordinates are
/// equal, not only indices: seams do not crease. Corners of faces without area get the mean of what meets there, or +z.
#[must_use]
pub fn smooth(mesh: &Mesh, angle_deg: f64) -> Vec<DVec3> {
    let fans = fans(mesh);
    let (starts, order) = corners_by_place(mesh);
    let limit = angle_deg.clamp(0.0, 180.0) * (std::f64::consts::PI / 180.0);
    let threshold = Threshold {
        cos: math::cos(limit),
        cos_half: math::cos(0.5 * limit),
    };
    let mut normals = vec![DVec3::Z; mesh.corners.len()];
    let mut around = Vec::new();
    for place in starts.windows(2) {
        let corners = &order[place[0] as usize..place[1] as usize];
        around.clear();
        around.extend(corners.iter().map(|&corner| fans[corner as usize]));
        smooth_place(&around, &threshold, |k, normal| {
            normals[corners[k] as usize] = normal
        });
    }
    normals
}

/// The angle within which faces are smooth together.
struct Threshold {
    cos: f64,
    cos_half: f64,
}

/// Gives the normal of each of the corners that meet at one place.
fn smooth_place(around: &[Fan], threshold: &Threshold, mut give: impl FnMut(usize, DVec3)) {
    let mean = |normals: &mut dyn Iterator<Item = &Fan>| {
        unit(normals.fold(DVec3::ZERO, |sum, fan| sum + fan.normal * fan.angle))
    };
    let all = mean(&mut around.iter());
    // Faces that all lie within half the angle of one direction lie within the angle of each other: one sum serves all,
    // which keeps the apex of a cone linear.
    if let Some(all) = all
        && around
            .iter()
            .all(|fan| fan.normal.dot(all) > threshold.cos_half)
    {
        (0..around.len()).for_each(|k| give(k, all));
        return;
    }
    for (k, own) in around.iter().enumerate() {
        if own.normal == DVec3::ZERO {
            give(k, all.unwrap_or(DVec3::Z));
            continue;
        }
        let near =
            |fan: &&Fan| fan.normal == own.normal || fan.normal.dot(own.normal) > threshold.cos;
        give(
            k,
            mean(&mut around.iter().filter(near)).unwrap_or(own.normal),
        );
    }
}

/// The face normal and angle of every corner.
fn fans(mesh: &Mesh) -> Vec<Fan> {
    let mut fans = Vec::with_capacity(mesh.corners.len());
    for triangle in mesh.corners.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
        let edges = [unit(b - a), unit(c - b), unit(a - c)];
        let [Some(ab), Some(bc), Some(ca)] = edges else {
            fans.extend(
                [Fan {
                    normal: DVec3::ZERO,
                    angle: 0.0,
                }; 3],
            );
            continue;
        };
        let normal = unit(ab.cross(-ca)).unwrap_or(DVec3::ZERO);
        let angles =
            [ab.dot(-ca), bc.dot(-ab), ca.dot(-bc)].map(|cos| math::acos(cos.clamp(-1.0, 1.0)));
        fans.extend(angles.map(|angle| Fan { normal, angle }));
    }
    fans
}

/// The corners sorted by the place of their position, in file order within a place, and where each place starts.
fn corners_by_place(mesh: &Mesh) -> (Vec<u32>, Vec<u32>) {
    let place_of = places(mesh);
    let count = place_of.iter().max().map_or(0, |&last| last as usize + 1);
    let mut starts = vec![0u32; count + 1];
    let place = |corner: usize| place_of[mesh.corners[corner] as usize] as usize;
    for corner in 0..mesh.corners.len() {
        starts[place(corner) + 1] += 1;
    }
    for i in 0..count {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    let mut order = vec![0u32; mesh.corners.len()];
    for corner in 0..mesh.corners.len() {
        let slot = &mut next[place(corner)];
        order[*slot as usize] = corner as u32;
        *slot += 1;
    }
    (starts, order)
}

/// A number for each position; equal coordinates have equal numbers.
fn places(mesh: &Mesh) -> Vec<u32> {
    // Adding zero makes −0 and 0 one key.
    let key = |index: u32| (mesh.positions[index as usize] + DVec3::ZERO).to_array();
    let compare = |a: &u32, b: &u32| {
        let (a, b) = (key(*a), key(*b));
        a[0].total_cmp(&b[0])
            .then(a[1].total_cmp(&b[1]))
            .then(a[2].total_cmp(&b[2]))
    };
    let mut sorted: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    sorted.sort_unstable_by(|a, b| compare(a, b).then(a.cmp(b)));
    let mut places = vec![0; sorted.len()];
    let mut place = 0;
    for pair in sorted.windows(2) {
        if compare(&pair[0], &pair[1]).is_ne() {
            place += 1;
        }
        places[pair[1] as usize] = place;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(positions: &[[f64; 3]], corners: &[u32]) -> Mesh {
        Mesh {
            positions: positions.iter().map(|&p| DVec3::from_array(p)).collect(),
            corners: corners.to_vec(),
            ..Mesh::default()
        }
    }

    /// A cube of 12 triangles; corner index = x + 2y + 4z.
    fn cube() -> Mesh {
        let at = |i: usize| [i & 1, (i >> 1) & 1, i >> 2].map(|c| c as f64);
        let positions: Vec<_> = (0..8).map(at).collect();
        let quads = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let corners: Vec<u32> = quads
            .iter()
            .flat_map(|&[a, b, c, d]| [a, b, c, a, c, d])
            .collect();
        mesh(&positions, &corners)
    }

    #[test]
    fn a_cube_is_sharp_below_its_angle_and_diagonal_above() {
        let cube = cube();
        let sharp = smooth(&cube, 60.0);
        let round = smooth(&cube, 100.0);
        for (t, corners) in cube.corners.as_chunks::<3>().0.iter().enumerate() {
            let [a, b, c] = corners.map(|i| cube.positions[i as usize]);
            let face = (b - a).cross(c - a);
            for k in 0..3 {
                assert_eq!(sharp[3 * t + k], face);
                // However the sides are cut, each weighs its right angle.
                let outward = (cube.positions[corners[k] as usize] - 0.5).normalize();
                assert!(round[3 * t + k].distance(outward) < 1e-15);
            }
        }
    }

    #[test]
    fn positions_that_are_equal_share_their_normals_whatever_their_index() {
        let joined = cube();
        let split = mesh(&[], &(0..36).collect::<Vec<_>>());
        let positions = joined
            .corners
            .iter()
            .map(|&i| joined.positions[i as usize] * -1.0 + 0.0);
        let negative = |p: DVec3| DVec3::new(if p.x == 0.0 { -0.0 } else { p.x }, p.y, p.z);
        let split = Mesh {
            positions: positions
                .enumerate()
                .map(|(i, p)| if i % 2 == 0 { negative(p) } else { p })
                .collect(),
            ..split
        };
        let mirrored = Mesh {
            positions: joined.positions.iter().map(|&p| p * -1.0 + 0.0).collect(),
            ..joined
        };
        assert_eq!(smooth(&split, 100.0), smooth(&mirrored, 100.0));
    }

    #[test]
    fn faces_without_area_and_opposite_faces_have_unit_normals() {
        let flat = mesh(
            &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            &[0, 1, 2, 0, 2, 1, 0, 0, 1],
        );
        for angle in [0.0, 60.0, 180.0] {
            let normals = smooth(&flat, angle);
            assert!(normals.iter().all(|n| n.length() == 1.0), "{normals:?}");
            assert_eq!((normals[1], normals[4]), (DVec3::Z, -DVec3::Z));
        }
    }
}
