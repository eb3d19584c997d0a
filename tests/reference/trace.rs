//! The estimator.

use super::shape::{Hit, Ray, closest};
use super::{Bulb, Random, Scene};
use crate::stats::Picture;
use glam::DVec3;

/// What is estimated, and how.
#[derive(Clone, Copy)]
pub(crate) struct Estimator {
    /// Scattering events on a path.
    pub(crate) max_bounces: u32,
    /// Next-event estimation by area.
    pub(crate) lamps: bool,
}

/// Lamps: one is chosen uniformly.
struct Lamps(Vec<usize>);

/// Batches of samples of a pixel: each batch is one estimate of a picture's statistics.
const BATCHES: u32 = 16;

/// Renders `spp` samples of every pixel, stratified within batches.
pub(crate) fn render(scene: &Scene, estimator: Estimator, spp: u32, seed: u64) -> Picture {
    let lamps = Lamps(
        scene
            .surfaces
            .iter()
            .enumerate()
            .filter(|(_, s)| estimator.lamps && s.shines())
            .map(|(i, _)| i)
            .collect(),
    );
    let camera = &scene.camera;
    let mut picture = Picture::new(camera.width as usize, camera.height as usize);
    let mut random = Random::new(seed);
    for y in 0..camera.height {
        for x in 0..camera.width {
            for _ in 0..BATCHES {
                let samples = spp / BATCHES;
                random.batch(samples as usize);
                let mut sum = DVec3::ZERO;
                for i in 0..samples {
                    random.sample(i as usize);
                    let ray = camera.ray(x, y, &mut random);
                    sum += radiance(scene, &lamps, ray, estimator.max_bounces, &mut random);
                }
                picture.add(
                    x as usize,
                    y as usize,
                    (sum / f64::from(samples)).to_array(),
                );
            }
        }
    }
    picture
}

fn radiance(
    scene: &Scene,
    lamps: &Lamps,
    mut ray: Ray,
    max_bounces: u32,
    random: &mut Random,
) -> DVec3 {
    let mut sum = DVec3::ZERO;
    let mut throughput = DVec3::ONE;
    // Whether the lamps on the way were already counted by a light sample.
    let mut counted = false;
    for bounce in 0..=max_bounces {
        let hit = loop {
            let Some(hit) = closest(scene, &ray) else {
                return sum + throughput * scene.background.at(ray.dir);
            };
            let presence = scene.surfaces[hit.surface].presence(&hit);
            if presence == 1.0 || random.unit() < presence {
                break hit;
            }
            ray = past(&ray, &hit);
        };
        let surface = &scene.surfaces[hit.surface];
        let wo = -ray.dir;
        if !counted && (surface.two_sided || wo.dot(hit.ng) > 0.0) {
            sum += throughput * surface.emitted(&hit);
        }
        if bounce == max_bounces {
            break;
        }
        let here = |wi| surface.material.smooth(&hit, wo, wi) * wi.dot(hit.ns).abs();
        let from = (hit.position, hit.surface);
        for bulb in &scene.bulbs {
            sum += throughput * light_of(scene, bulb, from, here);
        }
        if !lamps.0.is_empty() {
            sum += throughput * lamps.light(scene, from, here, random);
        }
        let Some(next) = surface.material.scatter(&hit, wo, random) else {
            break;
        };
        throughput *= next.weight;
        if throughput == DVec3::ZERO {
            break;
        }
        counted = !lamps.0.is_empty() && !next.specular;
        ray = Ray {
            origin: hit.position,
            dir: next.dir,
            from: Some(hit.surface),
        };
    }
    sum
}

/// The ray beyond what it hit.
fn past(ray: &Ray, hit: &Hit) -> Ray {
    Ray {
        origin: hit.position,
        dir: ray.dir,
        from: Some(hit.surface),
    }
}

/// Share of light that comes from as far as `distance`.
fn clear(scene: &Scene, mut ray: Ray, mut distance: f64) -> f64 {
    let mut share = 1.0;
    while share > 0.0
        && let Some(hit) = closest(scene, &ray)
        && hit.t < distance
    {
        share *= 1.0 - scene.surfaces[hit.surface].presence(&hit);
        ray = past(&ray, &hit);
        distance -= hit.t;
    }
    share
}

/// All that comes from a bulb: f cos(here) · irradiance.
fn light_of(
    scene: &Scene,
    bulb: &Bulb,
    (origin, from): (DVec3, usize),
    here: impl Fn(DVec3) -> DVec3,
) -> DVec3 {
    let (dir, distance, irradiance) = bulb.from(origin);
    let f_cos = here(dir);
    if f_cos * irradiance == DVec3::ZERO {
        return DVec3::ZERO;
    }
    let ray = Ray {
        origin,
        dir,
        from: Some(from),
    };
    f_cos * irradiance * clear(scene, ray, distance)
}

impl Lamps {
    /// One light sample: f cos(here) · Le cos(there) / r² · area · number of lamps.
    fn light(
        &self,
        scene: &Scene,
        (position, from): (DVec3, usize),
        here: impl Fn(DVec3) -> DVec3,
        random: &mut Random,
    ) -> DVec3 {
        let k = (random.unit() * self.0.len() as f64) as usize;
        let lamp = self.0[k];
        let (there, normal, area) = scene.surfaces[lamp].shape.sample_area(position, random);
        let way = there - position;
        let r2 = way.length_squared();
        let dir = way / r2.sqrt();
        let mut cos_there = -dir.dot(normal);
        if scene.surfaces[lamp].two_sided {
            cos_there = cos_there.abs();
        }
        let f_cos = here(dir);
        if cos_there <= 0.0 || f_cos == DVec3::ZERO {
            return DVec3::ZERO;
        }
        let ray = Ray {
            origin: position,
            dir,
            from: Some(from),
        };
        // The lamp is what the ray meets behind what lets it pass, or something else is in the way.
        let (mut ray, mut share, mut way) = (ray, 1.0, 0.0);
        loop {
            let Some(hit) = closest(scene, &ray).filter(|_| share > 0.0) else {
                return DVec3::ZERO;
            };
            way += hit.t;
            let surface = &scene.surfaces[hit.surface];
            let presence = surface.presence(&hit);
            if hit.surface == lamp && (way * way / r2 - 1.0).abs() < 1e-6 {
                let emitted = surface.emitted(&hit) * (presence * share);
                return f_cos * emitted * (cos_there / r2 * area * self.0.len() as f64);
            }
            share *= 1.0 - presence;
            ray = past(&ray, &hit);
        }
    }
}
