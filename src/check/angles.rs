//! Rotations in radians where degrees are meant, found in the text alone.

use super::{codes, warning};
use crate::diag::{Diagnostic, Lines};
use crate::scene::{LightDesc, RotateDesc, SceneDesc};
use std::f64::consts::PI;

/// How near a number must be to a fraction of π: people write 0.785 and 1.57.
const NEAR: f64 = 1e-3;

/// Multiples of π/12 that people turn by: 30°, 45°, 60°, 90°, 120°, 135°, 150°, 180°, 270°, 360°.
const TWELFTHS: [f64; 10] = [2.0, 3.0, 4.0, 6.0, 8.0, 9.0, 10.0, 12.0, 18.0, 24.0];

/// Angles that are fractions of π, in a scene where no angle is larger than a full turn of 2π: a scene that turns
/// something by 45 means degrees elsewhere too.
pub(super) fn radians(desc: &SceneDesc, lines: &Lines<'_>) -> Vec<Diagnostic> {
    let angles = |i: usize| -> Vec<f64> {
        let entity = &desc.entities[i].value;
        let mut all = match entity.transform.rotate {
            RotateDesc::Euler(deg) => deg.to_vec(),
            RotateDesc::AxisAngle { deg, .. } => vec![deg],
            RotateDesc::Quat(_) => Vec::new(),
        };
        all.retain(|deg| *deg != 0.0);
        all
    };
    let spot = |i: usize| match desc.entities[i].value.light.as_deref() {
        Some(LightDesc::Spot { outer_deg, .. }) => Some(*outer_deg),
        _ => None,
    };
    let count = desc.entities.len();
    let in_degrees = (0..count).any(|i| {
        let large = |deg: f64| deg.abs() > 2.0 * PI * (1.0 + NEAR);
        angles(i).into_iter().chain(spot(i)).any(large)
    });
    if in_degrees {
        return Vec::new();
    }
    let mut found = Vec::new();
    for i in 0..count {
        let turned = angles(i);
        if !turned.is_empty() && turned.iter().all(|deg| is_fraction_of_pi(*deg)) {
            found.push(told(desc, lines, i, "transform", "`rotate`", turned[0]));
        }
        if let Some(outer) = spot(i).filter(|deg| is_fraction_of_pi(*deg)) {
            found.push(told(desc, lines, i, "light", "`outer_deg`", outer));
        }
    }
    found
}

fn is_fraction_of_pi(x: f64) -> bool {
    let near = |twelfths: &f64| {
        let wanted = twelfths * PI / 12.0;
        (x.abs() - wanted).abs() <= NEAR * wanted
    };
    TWELFTHS.iter().any(near)
}

fn told(
    desc: &SceneDesc,
    lines: &Lines<'_>,
    entity: usize,
    component: &str,
    name: &str,
    angle: f64,
) -> Diagnostic {
    let says = format!("{name} is in degrees, and {angle} looks like radians");
    let deg = (angle * 180.0 / PI).round();
    let place = desc.place(entity, component);
    warning(desc, lines, codes::RADIANS, place, says)
        .hint(format!("{angle} radians are {deg} degrees"))
}
