//! Poses: M = parent · T(p) · Spin · T(−p) · T · R · S, a pure function of time.

use super::components::{Keys, Parent, Pose, Spin, Transform};
use crate::math::{DMat3, DVec3, axis_angle_deg};
use hecs::{Entity, World};
use std::collections::HashMap;

/// A time, as a frame and the frames in a second: what a turn takes in whole frames is a full turn to the bit, though a
/// frame's time in seconds is rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time {
    frame: f64,
    fps: f64,
}

impl Time {
    /// The time of a frame.
    #[must_use]
    pub fn of_frame(frame: u32, fps: f64) -> Time {
        Time {
            frame: f64::from(frame),
            fps,
        }
    }

    fn seconds(self) -> f64 {
        self.frame / self.fps
    }

    /// What grows by `rate` a second from 0: rounded at most twice.
    fn of_rate(self, rate: f64) -> f64 {
        let grown = rate * self.frame / self.fps;
        if grown.is_finite() {
            grown
        } else {
            // Where nobody can tell one turn from another.
            (rate % 360.0) * self.seconds()
        }
    }
}

/// Seconds.
impl From<f64> for Time {
    fn from(seconds: f64) -> Time {
        Time {
            frame: seconds,
            fps: 1.0,
        }
    }
}

/// Writes the [`Pose`] of every entity at a time. Nothing accumulates: poses of two equal times are equal bits.
pub fn pose(world: &mut World, time: impl Into<Time>) {
    for (entity, pose) in poses(world, time) {
        // The entity was listed a moment ago, so the only error of this call, "no such entity", cannot happen.
        let _ = world.insert_one(entity, pose);
    }
}

/// The pose of every entity at a time, in no particular order.
///
/// A parent link that closes a cycle or whose parent is gone is ignored; scene files with either are refused.
#[must_use]
pub fn poses(world: &World, time: impl Into<Time>) -> Vec<(Entity, Pose)> {
    let time = time.into();
    let mut rows = world.query::<(
        Entity,
        Option<&Transform>,
        Option<&Keys>,
        Option<&Spin>,
        Option<&Parent>,
    )>();
    let local = |(entity, transform, keys, spin, parent): (
        _,
        Option<&Transform>,
        _,
        _,
        Option<&Parent>,
    )| {
        let transform = transform.copied().unwrap_or_default();
        let placed = Placed::at(&transform, keys, time.seconds());
        (entity, Local::new(&placed, spin, parent.map(|p| p.0), time))
    };
    let locals: Vec<(Entity, Local)> = rows.iter().map(local).collect();
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

/// A transform with its keys at a time.
struct Placed {
    /// As authored: the transform's or the first key's.
    translate: DVec3,
    /// By how much the keys have moved it since.
    moved: DVec3,
    rotate: DMat3,
    scale: DVec3,
}

impl Placed {
    fn at(transform: &Transform, keys: Option<&Keys>, t: f64) -> Placed {
        let translate = keys.and_then(|keys| keys.translate.since_first(t));
        let (moved, translate) = translate.unwrap_or((DVec3::ZERO, transform.translate));
        let rotate = keys.and_then(|keys| keys.rotate.at(t));
        let scale = keys.and_then(|keys| keys.scale.at(t));
        Placed {
            translate,
            moved,
            rotate: rotate.unwrap_or(transform.rotate),
            scale: scale.unwrap_or(transform.scale),
        }
    }
}

/// An entity's own map into its parent's frame: x ↦ `linear` · x + `translate` + `swing`.
struct Local {
    linear: DMat3,
    translate: DVec3,
    /// What keys have moved it by, and (Spin − 1)(translate − pivot), which is 0 to the bit after a full turn.
    swing: DVec3,
    size: f64,
    parent: Option<Entity>,
}

impl Local {
    fn new(placed: &Placed, spin: Option<&Spin>, parent: Option<Entity>, time: Time) -> Local {
        let Placed {
            translate,
            moved,
            rotate,
            scale,
        } = *placed;
        let turned = spin.map(|spin| {
            let turn = axis_angle_deg(spin.axis, time.of_rate(spin.deg_per_s));
            let arm = spin
                .pivot
                .map_or(DVec3::ZERO, |pivot| translate - pivot + moved);
            (turn * rotate, moved + (turn - DMat3::IDENTITY) * arm)
        });
        let (rotate, swing) = turned.unwrap_or((rotate, moved));
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
