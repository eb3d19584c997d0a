//! The camera of a frame: an orthonormal basis in f64, rounded once.

use super::BuildOptions;
use super::rebase::to_scene;
use crate::flat::{self, Rebase};
use crate::math::{DVec3, sin_cos_deg, unit};
use crate::world::{Camera, Pose};

/// The flat camera. Scale and mirroring of its entity do not concern it: right is always right.
pub(crate) fn camera(
    pose: &Pose,
    camera: &Camera,
    rebase: &Rebase,
    options: &BuildOptions,
) -> flat::Camera {
    let forward = unit(pose.linear * DVec3::NEG_Z).unwrap_or(DVec3::NEG_Z);
    let up = unit(pose.linear * DVec3::Y).unwrap_or(DVec3::Y);
    let right = unit(forward.cross(up)).unwrap_or(DVec3::X);
    let down = forward.cross(right);
    let (sin, cos) = sin_cos_deg(0.5 * camera.vfov_deg);
    let (width, height) = options.size;
    flat::Camera {
        origin: to_scene(pose, rebase).translation.as_vec3().to_array(),
        right: right.as_vec3().to_array(),
        down: down.as_vec3().to_array(),
        forward: forward.as_vec3().to_array(),
        pixel: (2.0 * (sin / cos) / f64::from(height)) as f32,
        aperture_radius: finite(camera.aperture_radius * rebase.scale),
        // Never 0: the lens divides by it.
        focus_distance: finite(camera.focus_distance * rebase.scale).max(f32::MIN_POSITIVE),
        width,
        height,
        filter: options.filter,
    }
}

/// A length in scene units; beyond the range of f32 the farthest there is.
fn finite(length: f64) -> f32 {
    (length as f32).min(f32::MAX)
}
