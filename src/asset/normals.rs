//! Normals: of the file, and smoothed over faces.

use super::{Mesh, PerCorner};
use crate::math::{self, DVec3};
use std::collections::HashMap;

/// The unit vector of a direction; `None` when it is zero or not finite. Scaled first, so that no length underflows.
pub(super) fn unit(direction: DVec3) -> Option<DVec3> {
    let size = direction.abs().max_element();
    if !(size > 0.0 && direction.is_finite()) {
        return None;
    }
    let scaled = direction / size;
    Some(scaled / scaled.length())
}

/// Faces at one place beyond which they are not compared with each other: a crease costs their number squared.
const MAX_CREASED: usize = 4096;

/// Smooth unit normals of a mesh.
///
/// Each is the mean of the normals of the faces that meet at the corner's position and turn less than `angle_deg` from
/// the corner's own face, weighted by their angles there (Thürmer and Wüthrich, "Computing vertex normals from
/// polygonal facets", 1998), so that cutting a flat face differently changes nothing. Faces meet where coordinates are
/// equal, not only indices: seams do not crease. Corners of faces without area get the mean of what meets there, or +z.
/// Where more than 4,096 creased faces meet, each keeps its own normal.
#[must_use]
pub fn smooth(mesh: &Mesh, angle_deg: f64) -> PerCorner<DVec3> {
    let limit = angle_deg.clamp(0.0, 180.0) * (std::f64::consts::PI / 180.0);
    let mut smoother = Smoother::new(mesh, math::cos(limit));
    let creased = smoother.creased(math::cos(0.5 * limit));
    smoother.crease(&creased);
    PerCorner {
        values: smoother.values,
        of: smoother.of,
    }
}

struct Smoother<'a> {
    mesh: &'a Mesh,
    /// Cosine of the angle within which faces are smooth together.
    cos: f64,
    /// Unit normal of each triangle; zero where it has no area.
    faces: Vec<DVec3>,
    /// First the mean of each place, then what creased corners have.
    values: Vec<DVec3>,
    /// Index into `values` of each corner: first its place.
    of: Vec<u32>,
}

impl<'a> Smoother<'a> {
    /// Gives every corner the mean of all faces at its place.
    fn new(mesh: &'a Mesh, cos: f64) -> Smoother<'a> {
        let places = places(mesh);
        let count = places.iter().max().map_or(0, |&last| last as usize + 1);
        let mut sums = vec![DVec3::ZERO; count];
        let mut faces = Vec::with_capacity(mesh.triangle_count());
        let of = mesh.corners.iter().map(|&c| places[c as usize]).collect();
        for triangle in mesh.corners.as_chunks::<3>().0 {
            let Fan { normal, angles } = Fan::of(mesh, triangle);
            for (corner, angle) in triangle.iter().zip(angles) {
                sums[places[*corner as usize] as usize] += normal * angle;
            }
            faces.push(normal);
        }
        for sum in &mut sums {
            *sum = unit(*sum).unwrap_or(DVec3::ZERO);
        }
        Smoother {
            mesh,
            cos,
            faces,
            values: sums,
            of,
        }
    }

    /// The corners at places where faces do not all lie within half the angle of their mean, sorted by place. Elsewhere
    /// faces lie within the angle of each other, and one sum serves all: this keeps the apex of a cone linear.
    fn creased(&self, cos_half: f64) -> Vec<u32> {
        let mut creased = vec![false; self.values.len()];
        for (corner, &place) in self.of.iter().enumerate() {
            let flat = self.faces[corner / 3].dot(self.values[place as usize]) > cos_half;
            creased[place as usize] |= !flat;
        }
        let of = &self.of;
        let corners = 0..of.len() as u32;
        let mut corners: Vec<u32> = corners
            .filter(|&c| creased[of[c as usize] as usize])
            .collect();
        // Stable: in file order within a place.
        corners.sort_by_key(|&corner| of[corner as usize]);
        corners
    }

    /// Gives creased corners the mean of the faces that are near their own.
    fn crease(&mut self, corners: &[u32]) {
        let place = |of: &[u32], corner: u32| of[corner as usize];
        let mut fans: Vec<(DVec3, DVec3)> = Vec::new();
        let mut rest = corners;
        while let Some(&first) = rest.first() {
            let here = place(&self.of, first);
            let same = rest
                .iter()
                .take_while(|&&c| place(&self.of, c) == here)
                .count();
            let (around, after) = rest.split_at(same);
            rest = after;
            fans.clear();
            fans.extend(around.iter().map(|&corner| self.fan(corner as usize)));
            self.crease_place(here, around, &fans);
        }
    }

    /// The normal of a corner's face, alone and weighted by the angle there.
    fn fan(&self, corner: usize) -> (DVec3, DVec3) {
        let normal = self.faces[corner / 3];
        let triangle = &self.mesh.corners.as_chunks::<3>().0[corner / 3];
        let Fan { angles, .. } = Fan::of(self.mesh, triangle);
        (normal, normal * angles[corner % 3])
    }

    fn crease_place(&mut self, place: u32, around: &[u32], fans: &[(DVec3, DVec3)]) {
        let all = self.values[place as usize];
        let all = if all == DVec3::ZERO { DVec3::Z } else { all };
        let few = fans.len() <= MAX_CREASED;
        let mut known: Vec<(DVec3, u32)> = Vec::new();
        for (&corner, &(own, _)) in around.iter().zip(fans) {
            let near = |normal: DVec3| normal == own || normal.dot(own) > self.cos;
            let index = match known.iter().find(|(normal, _)| few && *normal == own) {
                Some((_, index)) => *index,
                None => {
                    let normal = if own == DVec3::ZERO {
                        all
                    } else if !few {
                        own
                    } else {
                        let near = fans.iter().filter(|(normal, _)| near(*normal));
                        unit(near.map(|(_, weighted)| *weighted).sum()).unwrap_or(own)
                    };
                    self.values.push(normal);
                    known.push((own, self.values.len() as u32 - 1));
                    self.values.len() as u32 - 1
                }
            };
            self.of[corner as usize] = index;
        }
    }
}

/// A triangle as its corners see it.
struct Fan {
    /// Unit normal; zero where the triangle has no area.
    normal: DVec3,
    /// Angle at each corner, radians.
    angles: [f64; 3],
}

impl Fan {
    fn of(mesh: &Mesh, triangle: &[u32; 3]) -> Fan {
        let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
        let edges = [unit(b - a), unit(c - b), unit(a - c)];
        let [Some(ab), Some(bc), Some(ca)] = edges else {
            return Fan {
                normal: DVec3::ZERO,
                angles: [0.0; 3],
            };
        };
        let cosines = [ab.dot(-ca), bc.dot(-ab), ca.dot(-bc)];
        Fan {
            normal: unit(ab.cross(-ca)).unwrap_or(DVec3::ZERO),
            angles: cosines.map(|cos| math::acos(cos.clamp(-1.0, 1.0))),
        }
    }
}

/// A number for each position, in the order of first use; equal coordinates have equal numbers.
fn places(mesh: &Mesh) -> Vec<u32> {
    let mut known: HashMap<[u64; 3], u32> = HashMap::with_capacity(mesh.positions.len());
    let place = |position: &DVec3| {
        // Adding zero makes −0 and 0 one key.
        let key = (*position + DVec3::ZERO).to_array().map(f64::to_bits);
        let next = known.len() as u32;
        *known.entry(key).or_insert(next)
    };
    mesh.positions.iter().map(place).collect()
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

    fn all(mesh: &Mesh, angle_deg: f64) -> Vec<DVec3> {
        let normals = smooth(mesh, angle_deg);
        assert!(normals.all() && normals.len() == mesh.corners.len());
        normals.iter().flatten().collect()
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
        let sharp = all(&cube, 60.0);
        let round = all(&cube, 100.0);
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

    /// A low pyramid, smooth all around, with one of its four sides cut in two.
    #[test]
    fn cutting_a_face_of_a_smooth_place_changes_no_normal() {
        let pyramid = mesh(
            &[
                [0.0, 0.0, 0.1],
                [1.0, 1.0, 0.0],
                [-1.0, 1.0, 0.0],
                [-1.0, -1.0, 0.0],
                [1.0, -1.0, 0.0],
                [1.0, 0.25, 0.0],
            ],
            &[0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 1],
        );
        for angle in [60.0, 5.0] {
            let normals = all(&pyramid, angle);
            let straight = |k: usize| normals[3 * k].distance(DVec3::Z) < 1e-15;
            assert_eq!(
                (0..5).all(straight),
                angle == 60.0,
                "within {angle} degrees"
            );
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
        assert_eq!(all(&split, 100.0), all(&mirrored, 100.0));
    }

    #[test]
    fn faces_without_area_and_opposite_faces_have_unit_normals() {
        let flat = mesh(
            &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            &[0, 1, 2, 0, 2, 1, 0, 0, 1],
        );
        for angle in [0.0, 60.0, 180.0] {
            let normals = all(&flat, angle);
            assert!(normals.iter().all(|n| n.length() == 1.0), "{normals:?}");
            assert_eq!((normals[1], normals[4]), (DVec3::Z, -DVec3::Z));
        }
    }
}
