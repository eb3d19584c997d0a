//! What a scene's own paths cost, told by a few of its waves: stage by stage, ray by ray, and with what could be left out
//! left out.
//!
//! A built scene enters, a [`Cost`] leaves. The waves are those that a render of it traces first, spread over the picture, on
//! one thread. They are traced again and again, in turns with what is left out, and of each stage of each the shortest time
//! counts: what disturbs only ever adds. Nodes and primitives are counted apart from the timing, on rays of the same waves.
//!
//! Deliberately absent: words, and any claim about what a part is worth: [`super::tune`] measures errors.

mod places;

use super::bench::clock;
use crate::flat::{FlatScene, Spheres};
use crate::math::Aabb;
use crate::trace::{
    Hits, Rays, Rect, Tallies, TileSums, TraceOptions, Tracer, Visits, closest_hit, count_closest,
    count_occluded, occluded, own_rays,
};
use std::time::{Duration, Instant};

/// Samples of a pixel in a wave: as many as a render traces at once.
const SAMPLES: u32 = 8;

/// What all turns together may take, if a wave does not take longer.
const TIME: Duration = Duration::from_millis(600);

/// Waves at most.
const MOST: usize = 64;

/// How often each is timed.
pub const ROUNDS: u32 = 4;

/// Rays of either kind that are counted.
const COUNTED: usize = 1 << 14;

/// What the waves cost.
#[derive(Clone, Debug)]
pub struct Cost {
    /// How many there were.
    pub waves: usize,
    /// Samples in them.
    pub samples: u64,
    /// Seconds of tracing them once.
    pub seconds: f64,
    /// By stage.
    pub tallies: Tallies,
    /// What can be left out, if the scene needs it, with the share of `seconds` that the same waves then take less.
    pub without: Vec<(Part, f64)>,
    /// What rays that ask for their closest hit visit.
    pub closest: Visits,
    /// What rays that ask whether something is in their way visit.
    pub occlusion: Visits,
    /// Spheres outside the tree: their share of the time of both kinds of rays.
    pub looped: f64,
    /// What the counted rays hit.
    pub met: Met,
}

/// What can be left out without leaving out what it is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Interpolated normals; then surfaces are as flat as their triangles.
    SmoothNormals,
    /// The lens; then the camera is a pinhole.
    Lens,
}

impl Part {
    const ALL: [Part; 2] = [Part::SmoothNormals, Part::Lens];

    fn is_needed(self, scene: &FlatScene) -> bool {
        match self {
            Part::SmoothNormals => scene.needs.smooth_normals,
            Part::Lens => scene.needs.lens,
        }
    }

    fn leave_out(self, scene: &mut FlatScene) {
        match self {
            Part::SmoothNormals => scene.needs.smooth_normals = false,
            Part::Lens => scene.camera.aperture_radius = 0.0,
        }
    }
}

/// Hits by what they are on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Met {
    /// Triangles of the world.
    pub triangles: u64,
    /// Triangles of instances.
    pub instances: u64,
    /// Spheres in the tree.
    pub tree_spheres: u64,
    /// Spheres outside it.
    pub looped_spheres: u64,
}

/// Measures; the scene is as before when it returns.
#[must_use]
pub fn cost(scene: &mut FlatScene, options: &TraceOptions) -> Cost {
    let parts = Part::ALL.map(|part| part.is_needed(scene).then_some(part));
    let parts: Vec<Part> = parts.into_iter().flatten().collect();
    let turns = ROUNDS * (1 + parts.len() as u32);
    let rects = affordable(scene, options, TIME / turns);
    let mut shots = vec![vec![None::<Tallies>; rects.len()]; 1 + parts.len()];
    let (needs, aperture_radius) = (scene.needs, scene.camera.aperture_radius);
    for _ in 0..ROUNDS {
        for (k, shots) in shots.iter_mut().enumerate() {
            if let Some(part) = k.checked_sub(1) {
                parts[part].leave_out(scene);
            }
            let mut tracer = Tracer::new(scene, options);
            for (best, &rect) in shots.iter_mut().zip(&rects) {
                let shot = shoot(&mut tracer, rect);
                *best = Some(best.map_or(shot, |best| best.least(shot)));
            }
            (scene.needs, scene.camera.aperture_radius) = (needs, aperture_radius);
        }
    }
    let sum = |shots: &Vec<Option<Tallies>>| {
        let mut sum = Tallies::default();
        shots.iter().flatten().for_each(|shot| sum += *shot);
        sum
    };
    let tallies = sum(&shots[0]);
    let whole = tallies.nanoseconds() as f64;
    let saved = |shots| 1.0 - sum(shots).nanoseconds() as f64 / whole;
    let [closest_rays, occlusion_rays] = counted_rays(scene, options, &rects);
    let (mut hits, mut blocked) = (Hits::default(), Vec::new());
    let closest = count_closest(scene, &closest_rays, &mut hits);
    Cost {
        waves: rects.len(),
        samples: rects.iter().map(|rect| samples(*rect)).sum(),
        seconds: whole * 1e-9,
        tallies,
        without: parts
            .into_iter()
            .zip(shots[1..].iter().map(saved))
            .collect(),
        closest,
        occlusion: count_occluded(scene, &occlusion_rays, &mut blocked),
        looped: looped_share(scene, options, [&closest_rays, &occlusion_rays]),
        met: met(scene, &hits),
    }
}

/// As many waves as can be traced in a time, but one at least.
fn affordable(scene: &FlatScene, options: &TraceOptions, time: Duration) -> Vec<Rect> {
    let start = Instant::now();
    let mut tracer = Tracer::new(scene, options);
    let mut rects = Vec::new();
    for rect in places::spread(&scene.camera).take(MOST) {
        shoot(&mut tracer, rect);
        rects.push(rect);
        if start.elapsed() > time {
            break;
        }
    }
    rects
}

fn shoot(tracer: &mut Tracer<'_>, rect: Rect) -> Tallies {
    let mut sums = TileSums::default();
    tracer.trace_tile(rect, 0..SAMPLES, &mut sums);
    sums.cost
}

fn samples(rect: Rect) -> u64 {
    u64::from(rect.width) * u64::from(rect.height) * u64::from(SAMPLES)
}

/// Rays of the first waves, whole waves of either kind.
fn counted_rays(scene: &FlatScene, options: &TraceOptions, rects: &[Rect]) -> [Rays; 2] {
    let mut all = [Rays::default(), Rays::default()];
    for &rect in rects {
        for (all, own) in all
            .iter_mut()
            .zip(own_rays(scene, options, rect, 0..SAMPLES))
        {
            if all.len() < COUNTED {
                all.append(&own);
            }
        }
    }
    all
}

/// The share of rays' time that spheres outside the tree take: that of the same rays in a scene whose tree is empty.
fn looped_share(
    scene: &mut FlatScene,
    options: &TraceOptions,
    [closest, occlusion]: [&Rays; 2],
) -> f64 {
    if scene.spheres.looped.is_empty() || scene.world.bvh.bounds.is_empty() {
        return if scene.spheres.looped.is_empty() {
            0.0
        } else {
            1.0
        };
    }
    let (mut hits, mut blocked) = (Hits::default(), Vec::new());
    let mut time = |scene: &FlatScene| {
        let start = clock::now();
        closest_hit(scene, options.isa, closest, &mut hits);
        occluded(scene, options.isa, occlusion, &mut blocked);
        clock::now().saturating_sub(start).as_secs_f64()
    };
    let bounds = scene.world.bvh.bounds;
    let [mut alone, mut whole] = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        whole = time(scene).min(whole);
        scene.world.bvh.bounds = Aabb::EMPTY;
        alone = time(scene).min(alone);
        scene.world.bvh.bounds = bounds;
    }
    (alone / whole.max(f64::MIN_POSITIVE)).min(1.0)
}

fn met(scene: &FlatScene, hits: &Hits) -> Met {
    let mut looped = vec![false; scene.spheres.placed.len()];
    let prims = scene.spheres.looped.iter().flat_map(|block| block.prim);
    for prim in prims.filter(|&prim| prim != u32::MAX) {
        looped[prim as usize] = true;
    }
    let mut met = Met::default();
    for (&prim, &instance) in hits.prim.iter().zip(&hits.instance) {
        let count = match prim {
            Hits::NONE => continue,
            _ if instance != Hits::WORLD => &mut met.instances,
            _ if prim & Spheres::TAG == 0 => &mut met.triangles,
            _ if looped[(prim & !Spheres::TAG) as usize] => &mut met.looped_spheres,
            _ => &mut met.tree_spheres,
        };
        *count += 1;
    }
    met
}
