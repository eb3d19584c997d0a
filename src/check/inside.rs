//! The camera inside of something solid.
//!
//! A mesh is asked by its generalized winding number (Jacobson, Kavan, Sorkine-Hornung 2013, "Robust inside-outside
//! segmentation using generalized winding numbers", ACM TOG 32(4)): the solid angles of its triangles over 4π, which is 1
//! inside of a closed mesh, 0 outside, and between where it has holes. Only counter-clockwise outsides count: a room
//! whose faces look inward is meant to be seen from within, and so is a shape that holds others besides the camera.

use super::codes;
use super::light::outward_sky;
use super::posed::{Form, Item, Posed};
use super::words::place;
use crate::asset::{Mesh, Scattering};
use crate::diag::Diagnostic;
use crate::math::{DVec3, atan2};
use std::f64::consts::PI;

/// Winding number above which a point counts as inside.
const INSIDE: f64 = 0.5;

/// So many shapes around the camera are looked at: each against all others.
const MAX_TOLD: usize = 100;

/// Every mesh and sphere that the camera should not be in.
pub(super) fn camera_inside(posed: &Posed) -> Vec<Diagnostic> {
    let around: Vec<&Item> = posed
        .items
        .iter()
        .filter(|item| item.bounds.contains(posed.view.eye))
        .take(MAX_TOLD)
        .collect();
    let inside = |item: &&&Item| match item.form {
        Form::Sphere { radius, .. } => {
            (item.to_world().translation - posed.view.eye).length() < radius
        }
        Form::Mesh(_) => winding_at(posed, item, posed.view.eye) > INSIDE,
    };
    let around: Vec<&Item> = around.iter().filter(inside).copied().collect();
    around
        .iter()
        .filter_map(|item| verdict(posed, item, &around))
        .collect()
}

fn verdict(posed: &Posed, item: &Item, around: &[&Item]) -> Option<Diagnostic> {
    let what = match item.form {
        Form::Mesh(_) if is_room(posed, item) => return None,
        Form::Mesh(_) => "the mesh",
        Form::Sphere { inverted: true, .. } => return None,
        Form::Sphere { .. } => {
            let outward = outward_sky(posed, item);
            if outward.is_some() {
                return outward;
            }
            if is_glass(item) {
                // In the bubble of a hollow ball it is in the air.
                let count = |wanted: bool| {
                    let is = |i: &&&Item| {
                        is_glass(i)
                            && matches!(i.form, Form::Sphere { inverted, .. } if inverted == wanted)
                    };
                    around.iter().filter(is).count()
                };
                if count(true) >= count(false) {
                    return None;
                }
            } else if is_room(posed, item) {
                return None;
            }
            "the sphere"
        }
    };
    let says = format!("the camera is inside {what} {}", posed.label(item));
    let hint = format!(
        "move the camera (`at`) out of it; it reaches from {} to {}",
        place(item.bounds.min),
        place(item.bounds.max)
    );
    let warning = posed.warn(item.entity(), item.component(), codes::CAMERA_INSIDE, says);
    Some(warning.hint(hint))
}

fn is_glass(item: &Item) -> bool {
    item.material
        .is_some_and(|m| matches!(m.scattering, Scattering::Glass { .. }))
}

/// Whether the shape holds others: then it is a room, and the camera is where it should be.
fn is_room(posed: &Posed, room: &Item) -> bool {
    let holds = |item: &Item| {
        room.bounds.contains(item.bounds.min)
            && room.bounds.contains(item.bounds.max)
            && item.size() < room.size()
    };
    let lamp = posed
        .lights
        .iter()
        .any(|lamp| room.bounds.contains(lamp.place));
    lamp || posed
        .items
        .iter()
        .any(|item| item.index != room.index && holds(item))
}

/// How often a posed mesh winds around a point: the point goes into the mesh's space, where a mirroring transform
/// changes nothing, as for the renderer.
pub(super) fn winding_at(posed: &Posed, item: &Item, p: DVec3) -> f64 {
    let inverse = item.to_world().inverse();
    let local = inverse.transform_point3(p);
    match posed.mesh(item) {
        Some(mesh) if local.is_finite() => winding(mesh, local),
        _ => 0.0,
    }
}

/// Sum of the solid angles of the triangles seen from `p`, over 4π.
fn winding(mesh: &Mesh, p: DVec3) -> f64 {
    let (triangles, _) = mesh.corners.as_chunks::<3>();
    let corner = |c: u32| mesh.positions.get(c as usize).map(|v| *v - p);
    let angles = triangles
        .iter()
        .filter_map(|&[a, b, c]| Some(solid_angle(corner(a)?, corner(b)?, corner(c)?)));
    angles.sum::<f64>() / (4.0 * PI)
}

/// Signed solid angle of a triangle seen from the origin, positive where it looks away (Van Oosterom and Strackee 1983,
/// "The solid angle of a plane triangle", eq. 8).
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let volume = a.dot(b.cross(c));
    let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * atan2(volume, denominator)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube from 0 to 1, counter-clockwise seen from outside; `faces` of its six.
    fn cube(faces: usize) -> Mesh {
        let quads = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        let corner =
            |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        Mesh {
            positions: (0..8).map(corner).collect(),
            corners: quads[..faces]
                .iter()
                .flat_map(|&[a, b, c, d]| [a, b, c, a, c, d])
                .collect(),
            ..Mesh::default()
        }
    }

    #[test]
    fn a_closed_cube_winds_once_around_what_is_inside() {
        for (p, wanted) in [
            (DVec3::splat(0.5), 1.0),
            (DVec3::new(0.9, 0.01, 0.3), 1.0),
            (DVec3::new(1.1, 0.5, 0.5), 0.0),
            (DVec3::splat(-7.0), 0.0),
        ] {
            let found = winding(&cube(6), p);
            assert!((found - wanted).abs() < 1e-12, "{p}: {found}");
        }
        // Each face of a cube is seen from its middle under a sixth of the sphere.
        let open = winding(&cube(5), DVec3::splat(0.5));
        assert!((open - 5.0 / 6.0).abs() < 1e-12, "{open}");
    }
}
