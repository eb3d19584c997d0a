//! Poses: M = parent · T(p) · Spin · T(−p) · T · R · S, a pure function of time.

use super::components::{Parent, Pose, Spin, Transform};
use crate::math::{DMat3, DVec3, axis_angle_deg};
use hecs::{Entity, World};
use std::collections::HashMap;

/// Writes the [`Pose`] of every entity at `t` seconds. Nothing accumulates: poses of two equal times are equal bits.
pub fn pose(world: &mut World, t: f64) {
    for (entity, pose) in poses(world, t) {
        // The entity was listed a moment ago, so the only error of this call, "no such entity", cannot happen.
        let _ = world.insert_one(entity, pose);
    }
}

/// The pose of every entity at `t` seconds, in no particular order.
///
/// A parent link that closes a cycle or whose parent is gone is ignored; scene files with either are refused.
#[must_use]
pub fn poses(world: &World, t: f64) -> Vec<(Entity, Pose)> {
    let locals: Vec<(Entity, Local)> = world
        .query::<(Entity, Option<&Transform>, Option<&Spin>, Option<&Parent>)>()
        .iter()
        .map(|(entity, transform, spin, parent)| {
            let transform = transform.copied().unwrap_or_default();
            (entity, Local::new(&transform, spin, parent.map(|p| p.0), t))
        })
        .collect();
    let place: HashMap<Entity, usize> = locals.iter().enumerate().map(|(i, l)| (l.0, i)).collect();
    let mut posed: Vec<Option<Pose>> = vec![None; locals.len()];
    let mut seen = vec![false; locals.len()];
    let mut chain = Vec::new();
    for start in 0..locals.len() {
        let mut next = Some(start);
        while let Some(i) = next.filter(|i| !seen[*i]) {
            seen[i] = true;
            chain.push(i);
            next = locals[i].1.parent.and_then(|p| place.get(&p).copied());
        }
        let mut parent = next.and_then(|i| posed[i]);
        while let Some(i) = chain.pop() {
            let pose = locals[i].1.under(parent.as_ref());
            posed[i] = Some(pose);
            parent = Some(pose);
        }
    }
    locals
        .into_iter()
        .zip(posed)
        .map(|((entity, _), pose)| (entity, pose.unwrap_or_default()))
        .collect()
}

/// An entity's own map into its parent's frame: x ↦ `linear` · x + `translate` + `swing`.
struct Local {
    linear: DMat3,
    translate: DVec3,
    /// (Spin − 1)(translate − pivot), which is 0 to the bit after a full turn.
    swing: DVec3,
    size: f64,
    parent: Option<Entity>,
}

impl Local {
    fn new(transform: &Transform, spin: Option<&Spin>, parent: Option<Entity>, t: f64) -> Local {
        let Transform {
            translate,
            rotate,
            scale,
        } = *transform;
        let turned = spin.map(|spin| {
            let turn = axis_angle_deg(spin.axis, spin.deg_per_s * t);
            let arm = translate - spin.pivot.unwrap_or(translate);
            (turn * rotate, (turn - DMat3::IDENTITY) * arm)
        });
        let (rotate, swing) = turned.unwrap_or((rotate, DVec3::ZERO));
        Local {
            linear: DMat3::from_cols(
                rotate.x_axis * scale.x,
                rotate.y_axis * scale.y,
                rotate.z_axis * scale.z,
            ),
            translate,
            swing,
            size: scale.x.abs(),
            parent,
        }
    }

    fn under(&self, parent: Option<&Pose>) -> Pose {
        match parent {
            None => Pose {
                linear: self.linear,
                offset: self.swing,
                anchor: self.translate,
                size: self.size,
            },
            Some(parent) => Pose {
                linear: parent.linear * self.linear,
                offset: parent.linear * (self.translate + self.swing) + parent.offset,
                anchor: parent.anchor,
                size: parent.size * self.size,
            },
        }
    }
}
