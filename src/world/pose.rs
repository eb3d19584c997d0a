//! Poses: M = parent · T(p) · Spin · T(−p) · T · R · S, a pure function of time.

use super::components::{Keys, Parent, Pose, Spin, Transform};
use crate::math::{DMat3, DVec3, axis_angle_deg};
use hecs::{Entity, Without, World};

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
    let time = time.into();
    let bare: Vec<Entity> = world
        .query_mut::<Without<Entity, &Pose>>()
        .into_iter()
        .collect();
    for entity in bare {
        // The entity was listed a moment ago, so the only error of this call, "no such entity", cannot happen.
        let _ = world.insert_one(entity, Pose::default());
    }
    if world.query_mut::<&Parent>().into_iter().next().is_none() {
        // Nobody needs another's: without a list of all.
        for (pose, own) in world.query_mut::<(&mut Pose, Own)>() {
            *pose = at(own, time);
        }
        return;
    }
    let poses = poses(world, time);
    for (entity, pose) in world.query_mut::<(Entity, &mut Pose)>() {
        *pose = *poses.of(entity);
    }
}

/// What places an entity in its parent's frame.
type Own<'a> = (Option<&'a Transform>, Option<&'a Keys>, Option<&'a Spin>);

/// The pose of an entity in its parent's frame.
fn at((transform, keys, spin): Own, time: Time) -> Pose {
    let transform = transform.copied().unwrap_or_default();
    Placed::at(&transform, keys, time.seconds()).turned(spin, time)
}

/// The poses of all entities of a world at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Poses {
    /// By the number of the entity.
    all: Vec<Pose>,
}

impl Poses {
    /// Where an entity of that world is.
    #[must_use]
    pub fn of(&self, entity: Entity) -> &Pose {
        let pose = self.all.get(entity.id() as usize);
        pose.unwrap_or(&Pose::IDENTITY)
    }
}

/// The pose of every entity at a time.
///
/// A parent link that closes a cycle or whose parent is gone is ignored; scene files with either are refused.
#[must_use]
pub fn poses(world: &World, time: impl Into<Time>) -> Poses {
    let time = time.into();
    let mut all = Vec::with_capacity(world.len() as usize);
    let mut children = Vec::new();
    let mut rows = world.query::<(Entity, Own, Option<&Parent>)>();
    for (entity, from, parent) in rows.iter() {
        let own = entity.id() as usize;
        if own >= all.len() {
            all.resize(own + 1, Pose::default());
        }
        all[own] = at(from, time);
        if let Some(Parent(parent)) = parent.filter(|parent| world.contains(parent.0)) {
            children.push((own, parent.id() as usize));
        }
    }
    hang(&mut all, &children);
    Poses { all }
}

/// Puts children, each with its parent, from their parents' frames into the world's, parents first.
fn hang(all: &mut [Pose], children: &[(usize, usize)]) {
    if children.is_empty() {
        return;
    }
    let mut above = vec![None; all.len()];
    for &(child, parent) in children {
        above[child] = Some(parent);
    }
    // On the way up a chain, and when it is in the world.
    let mut seen = vec![false; all.len()];
    let mut placed = vec![false; all.len()];
    let mut chain = Vec::new();
    for &(start, _) in children {
        let mut next = Some(start);
        while let Some(i) = next.filter(|i| !seen[*i]) {
            seen[i] = true;
            chain.push(i);
            next = above[i];
        }
        // Of a cycle, nothing is in its place yet.
        let mut parent = next.filter(|i| placed[*i]).map(|i| all[i]);
        while let Some(i) = chain.pop() {
            if let Some(parent) = &parent {
                all[i] = under(parent, &all[i]);
            }
            placed[i] = true;
            parent = Some(all[i]);
        }
    }
}

/// The pose of what is at `own` in the frame of `parent`.
fn under(parent: &Pose, own: &Pose) -> Pose {
    Pose {
        linear: parent.linear * own.linear,
        offset: parent.linear * (own.anchor + own.offset) + parent.offset,
        anchor: parent.anchor,
        size: parent.size * own.size,
    }
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

    /// The pose in the parent's frame. Its offset is what keys have moved it by, and (Spin − 1)(translate − pivot), which
    /// is 0 to the bit after a full turn.
    fn turned(self, spin: Option<&Spin>, time: Time) -> Pose {
        let Placed {
            translate,
            moved,
            rotate,
            scale,
        } = self;
        let turned = spin.map(|spin| {
            let turn = axis_angle_deg(spin.axis, time.of_rate(spin.deg_per_s));
            let arm = spin
                .pivot
                .map_or(DVec3::ZERO, |pivot| translate - pivot + moved);
            (turn * rotate, moved + (turn - DMat3::IDENTITY) * arm)
        });
        let (rotate, swing) = turned.unwrap_or((rotate, moved));
        Pose {
            linear: DMat3::from_cols(
                rotate.x_axis * scale.x,
                rotate.y_axis * scale.y,
                rotate.z_axis * scale.z,
            ),
            offset: swing,
            anchor: translate,
            size: scale.x.abs(),
        }
    }
}
