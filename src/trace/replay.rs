//! One sample again, vertex by vertex: the stages of the wave over a wave of one path, looked at between them.
//!
//! Each stage treats its paths one by one and a sample depends on nothing but itself, so that the bits are those that the
//! film took.

use super::path::{arrive, identity, leave, start_paths};
use super::scatter::Bounce;
use super::stages::compact;
use super::surface::place;
use super::tally::Laps;
use super::vector::get;
use super::wave::Wave;
use super::{Hits, Rect, TraceOptions};
use crate::flat::{FlatScene, MaterialId};
use crate::math::Vec3;

/// A sample's path.
#[derive(Clone, Debug, PartialEq)]
pub struct Replay {
    /// From the camera on; entry k belongs to bounce k.
    pub vertices: Vec<Vertex>,
    /// What the film takes, or leaves out if it is not finite.
    pub radiance: [f32; 3],
}

/// Where a path arrives, and what it does there. Lengths are in scene units.
#[derive(Clone, Debug, PartialEq)]
pub struct Vertex {
    /// Where the path last scattered, or the camera.
    pub from: [f32; 3],
    /// Unit direction from there.
    pub dir: [f32; 3],
    /// Solid-angle density of that direction; 0 where no light sample competes (camera rays, mirror-like lobes).
    pub pdf: f32,
    /// Product of the weights up to here.
    pub throughput: [f32; 3],
    /// What it meets; `None` is the background.
    pub hit: Option<HitPoint>,
    /// Radiance gathered so far, with what the surface or the background emits.
    pub emitted: [f32; 3],
    /// The light that was sampled here.
    pub light: Option<LightPoint>,
    /// What light that is sampled through or by a specular sphere brings; 0 where none is.
    pub caustic: [f32; 3],
    /// Radiance gathered so far, with that of the light sample and of the caustic.
    pub radiance: [f32; 3],
    /// What becomes of the path.
    pub fate: Fate,
}

/// A point of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct HitPoint {
    /// Where.
    pub position: [f32; 3],
    /// Unit geometric normal on the authored outside.
    pub ng: [f32; 3],
    /// Unit shading normal on the same side.
    pub ns: [f32; 3],
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// Distance from [`Vertex::from`].
    pub distance: f32,
    /// Bound on the position's error along the normal, by which rays leave.
    pub err: f32,
    /// Index of the entity in the scene file.
    pub entity: u32,
    /// Triangle index in its mesh file; 0 for a sphere.
    pub prim: u32,
    /// Its material.
    pub material: MaterialId,
    /// Its colour here.
    pub color: [f32; 3],
}

/// A light sample.
#[derive(Clone, Debug, PartialEq)]
pub struct LightPoint {
    /// Unit direction to the light.
    pub dir: [f32; 3],
    /// Where the shadow ray ends; [`f32::MAX`] for a light that is infinitely far.
    pub t_max: f32,
    /// What it adds if nothing is in the way.
    pub radiance: [f32; 3],
    /// Something is in the way.
    pub blocked: bool,
}

/// What becomes of a path at a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It has left the scene.
    Missed,
    /// It has scattered as often as it may.
    Spent,
    /// The surface reflects nothing.
    Absorbed,
    /// Roulette ended it.
    Roulette,
    /// It scatters: the next vertex says where to.
    Scattered,
}

impl Replay {
    /// The bounce at which the radiance ceased to be finite.
    #[must_use]
    pub fn lost_at(&self) -> Option<u32> {
        let lost = |v: &Vertex| !Vec3::from(v.radiance).is_finite();
        self.vertices.iter().position(lost).map(|k| k as u32)
    }
}

/// Traces sample `sample` of a pixel once more. Renders have no more than 2²⁴ samples; the last index of all is taken as the
/// one before it.
#[must_use]
pub fn replay(
    scene: &FlatScene,
    options: &TraceOptions,
    (x, y): (u32, u32),
    sample: u32,
) -> Replay {
    let mut wave = Wave::new(scene);
    let pixel = Rect {
        x,
        y,
        width: 1,
        height: 1,
    };
    let sample = sample.min(u32::MAX - 1);
    let samples = sample..sample + 1;
    start_paths(&mut wave, scene, options, pixel, (0..1, samples));
    let mut laps = Laps::start();
    let mut vertices = Vec::new();
    for index in 0..=options.max_bounces {
        if wave.paths.len() == 0 {
            break;
        }
        let bounce = Bounce {
            scene,
            options,
            index,
        };
        let [throughput, dir] =
            [&wave.paths.throughput, &wave.paths.rays.dir].map(|arrays| get(arrays, 0).to_array());
        let pdf = wave.paths.pdf[0];
        arrive(&mut wave, bounce, &mut laps);
        let (from, distance) = wave.leg(0);
        let mut vertex = Vertex {
            from: from.to_array(),
            dir,
            pdf,
            throughput,
            hit: hit_point(&wave, scene, distance),
            emitted: gathered(&wave),
            light: None,
            caustic: [0.0; 3],
            radiance: gathered(&wave),
            fate: Fate::Spent,
        };
        if index < options.max_bounces {
            let before = ray_bits(&wave);
            leave(&mut wave, bounce, &mut laps);
            vertex.light = light_point(&wave);
            if !wave.reached.radiance[0].is_empty() {
                vertex.caustic = get(&wave.reached.radiance, 0).to_array();
            }
            vertex.radiance = gathered(&wave);
            vertex.fate = fate(&wave, before);
            compact(options.isa, &mut wave);
        }
        vertices.push(vertex);
    }
    Replay {
        radiance: gathered(&wave),
        vertices,
    }
}

fn gathered(wave: &Wave) -> [f32; 3] {
    get(&wave.slots.radiance, 0).to_array()
}

fn hit_point(wave: &Wave, scene: &FlatScene, distance: f32) -> Option<HitPoint> {
    let (hits, surfaces) = (&wave.hits, &wave.surfaces);
    if hits.prim[0] == Hits::NONE {
        return None;
    }
    let (prim, entity) = identity(scene, hits.prim[0], hits.instance[0]);
    Some(HitPoint {
        position: get(&surfaces.position, 0).to_array(),
        ng: get(&surfaces.ng, 0).to_array(),
        ns: get(&surfaces.ns, 0).to_array(),
        uv: place(scene, &wave.paths.rays, hits, 0).uv,
        distance,
        err: hits.err[0],
        entity,
        prim,
        material: MaterialId(surfaces.material[0]),
        color: get(&surfaces.color, 0).to_array(),
    })
}

fn light_point(wave: &Wave) -> Option<LightPoint> {
    let shadows = &wave.shadows;
    let (t_max, blocked) = (*shadows.rays.t_max.first()?, *shadows.blocked.first()?);
    Some(LightPoint {
        dir: get(&shadows.rays.dir, 0).to_array(),
        t_max,
        radiance: get(&shadows.radiance, 0).to_array(),
        blocked,
    })
}

/// Origin and direction of the path's ray, to be told from another.
fn ray_bits(wave: &Wave) -> [[u32; 3]; 2] {
    let rays = &wave.paths.rays;
    [&rays.origin, &rays.dir].map(|arrays| get(arrays, 0).to_array().map(f32::to_bits))
}

/// A path that roulette ended has a new ray already, which nothing will trace.
fn fate(wave: &Wave, before: [[u32; 3]; 2]) -> Fate {
    match (wave.alive[0], wave.hits.prim[0]) {
        (true, _) => Fate::Scattered,
        (false, Hits::NONE) => Fate::Missed,
        (false, _) if ray_bits(wave) != before => Fate::Roulette,
        (false, _) => Fate::Absorbed,
    }
}
