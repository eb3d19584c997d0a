//! The path loop: the stages of a bounce over a wave, from camera rays to sums.

use super::attributes::{Place, emitted};
use super::camera::image_direction;
use super::chain;
use super::light::{Seen, light_pdf, see, towards};
use super::opacity::{pass_paths, pass_shadows, random};
use super::sampler::pixel_key;
use super::scatter::{Bounce, mis_weight};
use super::stages::{compact, generate, roulette, sample_bsdf, sample_lights, surface};
use super::surface::{color_by_vertices, look_up, place};
use super::tally::{Laps, Stage};
use super::vector::{get, set};
use super::wave::{WAVE, Wave};
use super::{Hits, Rect, Tallies, TileSums, TraceOptions, closest_hit, cut, occluded};
use crate::flat::{FlatScene, Needs, Scatter, Spheres};
use crate::math::Vec3;
use std::ops::Range;

/// Roulette starts after this many scattering events.
const ROULETTE_START: u32 = 5;

/// A worker: it traces one tile after the other of a scene and keeps its working memory between them, so that tracing
/// allocates nothing in the steady state.
#[derive(Debug)]
pub struct Tracer<'a> {
    scene: &'a FlatScene,
    options: &'a TraceOptions,
    wave: Wave,
}

impl<'a> Tracer<'a> {
    /// A worker with empty buffers.
    #[must_use]
    pub fn new(scene: &'a FlatScene, options: &'a TraceOptions) -> Tracer<'a> {
        Tracer {
            scene,
            options,
            wave: Wave::new(scene),
        }
    }

    /// Adds the samples `samples` of every pixel of `rect` to `sums`, which are made here when they are empty.
    ///
    /// Sample s of a pixel is a pure function of (scene, frame, pixel, s, seed); a pixel's samples are added in f64 in
    /// the order of their index, whatever the rectangle and however the range is split.
    pub fn trace_tile(&mut self, rect: Rect, samples: Range<u32>, sums: &mut TileSums) {
        let Tracer {
            scene,
            options,
            wave,
        } = self;
        let pixels = rect.width as usize * rect.height as usize;
        if sums.rgb.is_empty() {
            *sums = TileSums::new(pixels, options);
            if options.ids {
                trace_ids(wave, scene, options, rect, sums);
            }
        }
        let mut laps = Laps::start();
        let group = (WAVE / samples.len().max(1)).clamp(1, WAVE);
        let step = WAVE / group.min(pixels.max(1));
        for first in (0..pixels).step_by(group) {
            let group = first..(first + group).min(pixels);
            for start in samples.clone().step_by(step) {
                let range = start..start.saturating_add(step as u32).min(samples.end);
                let samples = range.len();
                start_paths(wave, scene, options, rect, (group.clone(), range));
                let slots = wave.paths.len() as u64;
                laps.lap(Stage::Camera, slots);
                trace_paths(wave, scene, options, &mut laps);
                accumulate(wave, sums, group.clone(), samples, scene.rebase.scale);
                laps.lap(Stage::Film, slots);
            }
        }
        sums.cost = laps.tallies;
    }
}

impl TileSums {
    fn new(pixels: usize, options: &TraceOptions) -> TileSums {
        let features = if options.features { pixels } else { 0 };
        let ids = if options.ids { pixels } else { 0 };
        TileSums {
            rgb: vec![[0.0; 3]; pixels],
            rgb_squared: vec![[0.0; 3]; pixels],
            count: vec![0; pixels],
            non_finite: vec![0; pixels],
            lost: Vec::new(),
            hit_count: vec![0; features],
            albedo: vec![[0.0; 3]; features],
            normal: vec![[0.0; 3]; features],
            geonormal: vec![[0.0; 3]; features],
            depth: vec![0.0; features],
            uv: vec![[0.0; 2]; ids],
            prim: vec![u32::MAX; ids],
            entity: vec![u32::MAX; ids],
            cost: Tallies::default(),
        }
    }
}

/// Fills the wave with the camera rays of some pixels and samples; slots are pixel by pixel, sample by sample.
pub(super) fn start_paths(
    wave: &mut Wave,
    scene: &FlatScene,
    options: &TraceOptions,
    rect: Rect,
    (pixels, samples): (Range<usize>, Range<u32>),
) {
    wave.paths.clear();
    wave.slots
        .reset(pixels.len() * samples.len(), options.features);
    for pixel in pixels {
        let x = rect.x + (pixel as u32 % rect.width);
        let y = rect.y + (pixel as u32 / rect.width);
        let key = pixel_key(options.seed, scene.frame, x, y);
        for sample in samples.clone() {
            wave.slots.push(sample, [x, y]);
            wave.paths.key.push(key);
            wave.paths.sample.push(sample);
        }
    }
    generate(options.isa, wave, &scene.camera, options.sampler);
    if chain::wanted(scene, options) {
        let n = wave.paths.len();
        wave.paths.record.start(n);
    }
}

/// The stages of every bounce, until no path is left.
fn trace_paths(wave: &mut Wave, scene: &FlatScene, options: &TraceOptions, laps: &mut Laps) {
    for index in 0..=options.max_bounces {
        if wave.paths.len() == 0 {
            return;
        }
        let bounce = Bounce {
            scene,
            options,
            index,
        };
        arrive(wave, bounce, laps);
        if index == options.max_bounces {
            return;
        }
        leave(wave, bounce, laps);
        let paths = wave.paths.len() as u64;
        compact(options.isa, wave);
        laps.lap(Stage::Compact, paths);
    }
}

/// The first half of a bounce: what the paths meet, and what it emits.
pub(super) fn arrive(wave: &mut Wave, bounce: Bounce, laps: &mut Laps) {
    let Bounce {
        scene,
        options,
        index,
    } = bounce;
    closest_hit(scene, options.isa, &wave.paths.rays, &mut wave.hits);
    let paths = wave.paths.len() as u64;
    laps.lap(Stage::ClosestHit, paths);
    if cut::OPACITY && scene.needs.opacity {
        let number = random(options.sampler, index);
        let passed = pass_paths(wave, scene, options.isa, number);
        laps.lap(Stage::Opacity, passed);
    }
    surface(options.isa, wave, scene);
    laps.lap(Stage::Surface, paths);
    let missed = wave.groups.missed.len() as u64;
    if cut::TEXTURES && scene.needs.textures {
        let textured = look_up(wave, scene);
        laps.lap(Stage::Textures, textured);
    }
    if cut::VERTEX_COLORS && scene.needs.vertex_colors {
        color_by_vertices(wave, scene);
        laps.lap(Stage::VertexColors, paths);
    }
    if index == 0 && options.features {
        record_features(wave, scene);
    }
    if scene.needs.background || scene.needs.environment {
        background(wave, bounce);
        laps.lap(Stage::Background, missed);
    }
    emission(wave, bounce);
    laps.lap(Stage::Emission, wave.groups.at_emitters.len() as u64);
}

/// The second half: what lights send there, and where the paths go on; `wave.alive` says which do.
pub(super) fn leave(wave: &mut Wave, bounce: Bounce, laps: &mut Laps) {
    let Bounce {
        scene,
        options,
        index,
    } = bounce;
    if options.nee && scene.needs.lights && (scene.needs.diffuse || scene.needs.plastic) {
        sample_lights(wave, bounce);
        let lit = [Scatter::Diffuse, Scatter::Plastic].map(|kind| wave.groups.count(kind));
        laps.lap(Stage::Lights, lit[0] + lit[1]);
        let rays = find_blocked(wave, scene, options);
        add_lights(wave);
        laps.lap(Stage::Occlusion, rays);
        if chain::wanted(scene, options) {
            let rays = chain::trace(wave, bounce);
            laps.lap(Stage::Caustics, rays);
        }
    }
    for (kind, stage) in kinds(&scene.needs) {
        sample_bsdf(wave, bounce, kind);
        laps.lap(stage, wave.groups.count(kind));
    }
    if options.roulette && index + 1 >= ROULETTE_START {
        roulette(wave, bounce);
        laps.lap(Stage::Roulette, wave.paths.len() as u64);
    }
}

/// Finds which shadow rays something blocks; returns how many rays that took.
fn find_blocked(wave: &mut Wave, scene: &FlatScene, options: &TraceOptions) -> u64 {
    if cut::OPACITY && scene.needs.opacity {
        return pass_shadows(wave, scene, options.isa);
    }
    let shadows = &mut wave.shadows;
    occluded(scene, options.isa, &shadows.rays, &mut shadows.blocked);
    shadows.rays.len() as u64
}

/// The kinds of scattering that the scene has, with their stages.
fn kinds(needs: &Needs) -> impl Iterator<Item = (Scatter, Stage)> {
    [
        (needs.diffuse, Scatter::Diffuse, Stage::Diffuse),
        (cut::MIRROR && needs.mirror, Scatter::Mirror, Stage::Mirror),
        (cut::GLASS && needs.glass, Scatter::Glass, Stage::Glass),
        (
            cut::PLASTIC && needs.plastic,
            Scatter::Plastic,
            Stage::Plastic,
        ),
        (cut::METAL && needs.metal, Scatter::Metal, Stage::Metal),
    ]
    .into_iter()
    .filter_map(|(needed, kind, stage)| needed.then_some((kind, stage)))
}

/// Adds the background where nothing was hit.
fn background(wave: &mut Wave, bounce: Bounce) {
    let scene = bounce.scene;
    let background = Vec3::from(scene.background);
    if cut::BACKGROUND && scene.needs.background {
        for &i in &wave.groups.missed {
            let slot = wave.paths.slot[i as usize] as usize;
            let throughput = get(&wave.paths.throughput, i as usize);
            wave.slots.add(slot, throughput * background);
        }
    }
    if cut::ENVIRONMENT && scene.needs.environment {
        miss(wave, bounce);
    }
}

/// Adds what the hit surfaces emit.
fn emission(wave: &mut Wave, bounce: Bounce) {
    let Bounce { scene, options, .. } = bounce;
    for &i in &wave.groups.at_emitters {
        let i = i as usize;
        let slot = wave.paths.slot[i] as usize;
        let throughput = get(&wave.paths.throughput, i);
        let material = &scene.materials[wave.surfaces.material[i] as usize];
        let mean = Vec3::from(material.emission);
        let dir = get(&wave.paths.rays.dir, i);
        let ng = get(&wave.surfaces.ng, i);
        let (ng, mean) = match material.two_sided {
            true => (towards(ng, -dir), mean * 2.0),
            false => (ng, mean),
        };
        if dir.dot(ng) >= 0.0 {
            continue;
        }
        let uv = [wave.surfaces.uv[0][i], wave.surfaces.uv[1][i]];
        let emitted = emitted(scene, material, &Place::of_hit(&wave.hits, i, uv));
        let weight = share(options, wave.paths.pdf[i], || {
            let (from, t) = wave.leg(i);
            light_pdf(scene, from, (dir, t), (wave.hits.prim[i], ng), mean)
        });
        let weight = weight * chain::shared(scene, options, wave, i);
        wave.slots.add(slot, throughput * emitted * weight);
    }
}

/// What directions that met nothing see of the sky.
#[inline(never)]
fn miss(wave: &mut Wave, bounce: Bounce) {
    let Bounce { scene, options, .. } = bounce;
    for &i in &wave.groups.missed {
        let i = i as usize;
        let Seen { radiance, pdf } = see(scene, get(&wave.paths.rays.dir, i));
        let weight = share(options, wave.paths.pdf[i], || pdf);
        let throughput = get(&wave.paths.throughput, i);
        let slot = wave.paths.slot[i] as usize;
        wave.slots.add(slot, throughput * radiance * weight);
    }
}

/// The weight of light that a path found by itself, in a direction of density `pdf` (0 where no light sample competes),
/// and that a light sample would have found with the density `light`.
#[inline(always)]
fn share(options: &TraceOptions, pdf: f32, light: impl FnOnce() -> f32) -> f32 {
    if !options.nee || pdf <= 0.0 {
        return 1.0;
    }
    match (options.mis, light()) {
        (true, light) => mis_weight(pdf, light),
        (false, light) => f32::from(u8::from(light == 0.0)),
    }
}

/// Adds the light samples that nothing blocks.
fn add_lights(wave: &mut Wave) {
    let Wave { shadows, slots, .. } = wave;
    for i in 0..shadows.slot.len() {
        if !shadows.blocked[i] {
            slots.add(shadows.slot[i] as usize, get(&shadows.radiance, i));
        }
    }
}

/// Keeps albedo, normals and depth of the first hits.
fn record_features(wave: &mut Wave, scene: &FlatScene) {
    let forward = Vec3::from(scene.camera.forward);
    for i in 0..wave.paths.len() {
        if wave.hits.prim[i] == Hits::NONE {
            continue;
        }
        let slot = wave.paths.slot[i] as usize;
        let scatter = scene.materials[wave.surfaces.material[i] as usize].scatter;
        let albedo = match scatter {
            Scatter::Glass | Scatter::Mirror => Vec3::ONE,
            _ => get(&wave.surfaces.color, i),
        };
        let [albedos, normals, geonormals] = &mut wave.slots.features;
        set(albedos, slot, albedo);
        set(normals, slot, get(&wave.surfaces.ns, i));
        set(geonormals, slot, get(&wave.surfaces.ng, i));
        let (_, t) = wave.leg(i);
        wave.slots.depth[slot] = t * get(&wave.paths.rays.dir, i).dot(forward);
    }
}

/// Adds the wave's samples to the sums, per pixel in the order of the sample index. A sample that is not finite is
/// counted and left out.
fn accumulate(wave: &Wave, sums: &mut TileSums, pixels: Range<usize>, samples: usize, scale: f64) {
    let slots = &wave.slots;
    for (slot, pixel) in pixels
        .flat_map(|p| std::iter::repeat_n(p, samples))
        .enumerate()
    {
        let radiance = get(&slots.radiance, slot);
        if radiance.is_finite() {
            sums.count[pixel] += 1;
            for (k, c) in radiance.as_dvec3().to_array().into_iter().enumerate() {
                sums.rgb[pixel][k] += c;
                sums.rgb_squared[pixel][k] += c * c;
            }
        } else {
            sums.lose(pixel, slots.sample[slot]);
        }
        if !slots.depth.is_empty() && slots.depth[slot].is_finite() {
            sums.hit_count[pixel] += 1;
            sums.depth[pixel] += f64::from(slots.depth[slot]) / scale;
            let targets = [&mut sums.albedo, &mut sums.normal, &mut sums.geonormal];
            for (target, feature) in targets.into_iter().zip(&slots.features) {
                for k in 0..3 {
                    target[pixel][k] += f64::from(feature[k][slot]);
                }
            }
        }
    }
}

/// What the rays through the pixels' centres hit: texture coordinates, triangle and entity.
fn trace_ids(
    wave: &mut Wave,
    scene: &FlatScene,
    options: &TraceOptions,
    rect: Rect,
    sums: &mut TileSums,
) {
    wave.paths.clear();
    for pixel in 0..sums.uv.len() as u32 {
        let (x, y) = (rect.x + pixel % rect.width, rect.y + pixel / rect.width);
        let dir = image_direction(&scene.camera, x as f32 + 0.5, y as f32 + 0.5);
        wave.paths.push(Vec3::from(scene.camera.origin), dir, pixel);
    }
    closest_hit(scene, options.isa, &wave.paths.rays, &mut wave.hits);
    if cut::OPACITY && scene.needs.opacity {
        // Half of it is enough to be there.
        pass_paths(wave, scene, options.isa, |_, _, _| 0.5);
    }
    for i in 0..sums.uv.len() {
        let (prim, instance) = (wave.hits.prim[i], wave.hits.instance[i]);
        if prim == Hits::NONE {
            continue;
        }
        sums.uv[i] = place(scene, &wave.paths.rays, &wave.hits, i).uv;
        (sums.prim[i], sums.entity[i]) = identity(scene, prim, instance);
    }
}

/// Triangle index in its file (0 for a sphere) and index of the entity of what was hit.
#[must_use]
pub fn identity(scene: &FlatScene, prim: u32, instance: u32) -> (u32, u32) {
    if prim & Spheres::TAG != 0 {
        return (0, scene.spheres.object[(prim & !Spheres::TAG) as usize].0);
    }
    let p = prim as usize;
    if instance == Hits::WORLD {
        return (
            scene.world.shading.file_prim[p],
            scene.world.shading.object[p].0,
        );
    }
    let instance = &scene.instances[instance as usize];
    (
        scene.local[instance.geometry as usize].shading.file_prim[p],
        instance.object.0,
    )
}
