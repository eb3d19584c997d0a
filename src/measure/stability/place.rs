//! Putting a scene elsewhere: what has a length is multiplied, what has a place of its own is moved.

use super::Placing;
use crate::math::DVec3;
use crate::world::{Camera, Keys, Light, Parent, Spin, Transform};
use hecs::{Entity, World};

/// Where things stand as authored.
pub(super) struct Home {
    /// Of entities without a parent; the others follow.
    roots: Vec<(Entity, Transform, Option<Spin>, Option<Keys>)>,
    cameras: Vec<(Entity, Camera)>,
    lights: Vec<(Entity, Light)>,
}

impl Home {
    pub(super) fn of(world: &World) -> Home {
        let roots = world
            .query::<(
                Entity,
                Option<&Transform>,
                Option<&Spin>,
                Option<&Keys>,
                Option<&Parent>,
            )>()
            .iter()
            .filter(|row| row.4.is_none())
            .map(|(e, transform, spin, keys, _)| {
                let transform = transform.copied().unwrap_or_default();
                (e, transform, spin.copied(), keys.cloned())
            })
            .collect();
        let cameras = world.query::<(Entity, &Camera)>();
        let lights = world.query::<(Entity, &Light)>();
        Home {
            roots,
            cameras: { cameras }.iter().map(|(e, c)| (e, *c)).collect(),
            lights: { lights }.iter().map(|(e, l)| (e, *l)).collect(),
        }
    }

    /// Places the world anew. `width` is what an offset of 1 moves it by, as authored.
    pub(super) fn put(&self, world: &mut World, placing: Placing, width: f64) {
        let Placing { scale, offset } = placing;
        let shift = DVec3::new(1.0, -1.0, 1.0) * (offset * width * scale);
        // The entities were listed from this world: that there is "no such entity" cannot happen here and below.
        for (entity, transform, spin, keys) in &self.roots {
            let mut transform = *transform;
            transform.translate = transform.translate * scale + shift;
            transform.scale *= scale;
            let _ = world.insert_one(*entity, transform);
            if let Some(mut spin) = *spin {
                spin.pivot = spin.pivot.map(|pivot| pivot * scale + shift);
                let _ = world.insert_one(*entity, spin);
            }
            if let Some(keys) = keys {
                let _ = world.insert_one(*entity, keys.placed(scale, shift));
            }
        }
        // What a lens measures is in the world's units, whatever carries it.
        for (entity, mut camera) in self.cameras.iter().copied() {
            camera.aperture_radius *= scale;
            camera.focus_distance *= scale;
            let _ = world.insert_one(entity, camera);
        }
        for (entity, light) in self.lights.iter().copied() {
            let _ = world.insert_one(entity, stronger(light, scale * scale));
        }
    }
}

/// A light whose irradiance is the same at a distance that has grown: intensity counts by its square.
fn stronger(light: Light, by: f64) -> Light {
    let times = |c: [f64; 3]| c.map(|c| c * by);
    match light {
        Light::Point { intensity } => Light::Point {
            intensity: times(intensity),
        },
        Light::Spot {
            intensity,
            inner_deg,
            outer_deg,
        } => Light::Spot {
            intensity: times(intensity),
            inner_deg,
            outer_deg,
        },
        Light::Sun { irradiance } => Light::Sun { irradiance },
    }
}
