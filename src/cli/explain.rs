//! `luxel explain`: what a scene makes luxel do, and which entity asked for it.

use super::args::InspectArgs;
use super::failure::Failure;
use super::names::entity_name;
use super::{load, print_result};
use crate::build::{BufferBytes, BuildTimes, buffer_bytes};
use crate::flat::{
    ColorSource, FlatScene, Geometry, Material, MaterialId, ObjectId, Opacity, Scatter,
};
use crate::render::Settings;
use crate::scene::{BackgroundDesc, FilterDesc, NormalsDesc, SceneDesc, ShapeDesc};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::Arc;

/// Frame that is explained: the rest pose.
const FRAME: u32 = 0;

/// Builds the scene's first frame and describes it.
pub(crate) fn run(args: &InspectArgs) -> Result<(), Failure> {
    let (loaded, _) = load::scene(&args.scene, args.max_memory)?;
    let settings = Settings::of_scene(&loaded.desc);
    let desc = loaded.desc.clone();
    let mut renderer = loaded.renderer(settings)?;
    let (scene, times) = renderer.build(FRAME);
    let subject = Subject {
        desc: &desc,
        scene: &scene,
        times,
        hash: renderer.hash(),
        wearers: wearers(&scene),
    };
    let text = match args.json {
        true => format!("{:#}\n", subject.json()),
        false => subject.text(),
    };
    print_result(text.as_bytes())
}

/// What is explained.
struct Subject<'a> {
    desc: &'a SceneDesc,
    scene: &'a FlatScene,
    times: BuildTimes,
    hash: &'a str,
    /// Of each material, the first entity that has it.
    wearers: Vec<Option<ObjectId>>,
}

/// The first entity of each material. Meshes are looked at once, however many instances they have.
fn wearers(scene: &FlatScene) -> Vec<Option<ObjectId>> {
    let mut wearers: Vec<Option<ObjectId>> = vec![None; scene.materials.len()];
    let mut wear = |material: MaterialId, object: ObjectId| {
        let wearer = &mut wearers[material.0 as usize];
        *wearer = Some(wearer.map_or(object, |first| first.min(object)));
    };
    let spheres = scene.spheres.material.iter().zip(&scene.spheres.object);
    spheres.for_each(|(material, object)| wear(*material, *object));
    let shading = &scene.world.shading;
    let triangles = shading.material.iter().zip(&shading.object);
    triangles.for_each(|(material, object)| wear(MaterialId(*material), *object));
    let slots = |local: &Arc<Geometry>| local.shading.material.iter().copied().collect();
    let slots: Vec<BTreeSet<u32>> = scene.local.iter().map(slots).collect();
    for instance in &scene.instances {
        for slot in &slots[instance.geometry as usize] {
            let index = instance.materials + slot;
            wear(scene.instance_materials[index as usize], instance.object);
        }
    }
    wearers
}

/// A thing that costs something: its name, whether this scene needs it, and who asked first.
type Stage = (&'static str, bool, Option<String>);

impl Subject<'_> {
    fn stages(&self) -> Vec<Stage> {
        let needs = &self.scene.needs;
        let desc = self.desc;
        let shape = |wanted: fn(&ShapeDesc) -> bool| {
            self.entity(|i| desc.entities[i].value.shape.as_ref().is_some_and(wanted))
        };
        let sphere = shape(|s| matches!(s, ShapeDesc::Sphere { .. }));
        let instance = self.scene.instances.first().map(|i| self.name(i.object));
        let smooth = self.entity(|i| {
            let entity = &desc.entities[i].value;
            matches!(entity.shape, Some(ShapeDesc::Mesh { .. }))
                && entity.normals != Some(NormalsDesc::Flat)
        });
        let scatter = |wanted: Scatter| self.material(|m| m.scatter == wanted);
        let reads = |m: &Material, wanted: &dyn Fn(u32) -> bool| {
            let of = |source: ColorSource| match source {
                ColorSource::Texture { texture, .. } => wanted(texture),
                ColorSource::Constant(_) => false,
            };
            let coverage = match m.opacity {
                Opacity::Full => None,
                Opacity::Mask { coverage, .. } | Opacity::Blend(coverage) => coverage.texture,
            };
            of(m.color) || m.emission_source.is_some_and(of) || coverage.is_some_and(wanted)
        };
        let texture = self.material(|m| reads(m, &|_| true));
        let second = |texture: u32| self.scene.textures[texture as usize].uv_set == 1;
        let second = self.material(|m| reads(m, &second));
        let punctual = self.entity(|i| {
            let entity = &desc.entities[i].value;
            entity.light.is_some() || entity.gltf.is_some()
        });
        let light = self.material(|m| m.emission != [0.0; 3]);
        let sky = needs.environment.then(|| "background".to_owned());
        let light = light.or_else(|| punctual.clone()).or(sky);
        let triangles = shape(|s| matches!(s, ShapeDesc::Mesh { .. }));
        let place = |what: &str| Some(what.to_owned());
        vec![
            ("triangles", needs.triangles, triangles),
            ("spheres in the tree", needs.tree_spheres, sphere.clone()),
            ("spheres outside the tree", needs.looped_spheres, sphere),
            ("instances", needs.instances, instance),
            ("smooth normals", needs.smooth_normals, smooth),
            ("texture coordinates", needs.uvs, texture.clone()),
            ("second texture coordinates", needs.uvs1, second),
            (
                "vertex colours",
                needs.vertex_colors,
                self.material(|m| m.vertex_colors),
            ),
            ("textures", needs.textures, texture),
            (
                "opacity",
                needs.opacity,
                self.material(|m| m.opacity != Opacity::Full),
            ),
            ("lens", needs.lens, place("camera")),
            ("light sampling", needs.lights, light),
            ("lights without extent", needs.punctual, punctual),
            ("background", needs.background, place("background")),
            ("sky", needs.environment, place("background")),
            ("diffuse", needs.diffuse, scatter(Scatter::Diffuse)),
            ("mirror", needs.mirror, scatter(Scatter::Mirror)),
            ("glass", needs.glass, scatter(Scatter::Glass)),
            ("plastic", needs.plastic, scatter(Scatter::Plastic)),
            ("metal", needs.metal, scatter(Scatter::Metal)),
        ]
    }

    /// The first entity, in the order of the file, of which `wanted` holds.
    fn entity(&self, wanted: impl Fn(usize) -> bool) -> Option<String> {
        let first = (0..self.desc.entities.len()).find(|&i| wanted(i))?;
        Some(self.name(ObjectId(first as u32)))
    }

    /// The first entity with a material, its own or its file's, of which `wanted` holds.
    fn material(&self, wanted: impl Fn(&Material) -> bool) -> Option<String> {
        let wearers = self.scene.materials.iter().zip(&self.wearers);
        let first = wearers.filter(|(material, _)| wanted(material));
        let first = first.filter_map(|(_, wearer)| *wearer).min()?;
        Some(self.name(first))
    }

    fn name(&self, object: ObjectId) -> String {
        entity_name(self.desc, object)
    }

    fn background(&self) -> String {
        match &self.desc.background {
            BackgroundDesc::Linear(_) => format!("{:?}", self.scene.background),
            BackgroundDesc::Hdr(hdr) => format!(
                "Hdr(path: {:?}, rotate_deg: {}, strength: {}, filter: {:?})",
                hdr.path.value, hdr.rotate_deg, hdr.strength, hdr.filter
            ),
        }
    }

    /// Settings in force, whether written or by default.
    fn settings(&self) -> Vec<(&'static str, String)> {
        let render = &self.desc.render;
        let animation = &self.desc.animation;
        let frames = &animation.frames;
        let filter = match render.filter {
            FilterDesc::Box => "Box".to_owned(),
            FilterDesc::Gaussian { radius_px } => format!("Gaussian(radius_px: {radius_px})"),
        };
        vec![
            ("size", format!("{}x{}", render.size.0, render.size.1)),
            ("spp", render.spp.to_string()),
            ("max_bounces", render.max_bounces.to_string()),
            ("filter", filter),
            ("background", self.background()),
            ("fps", animation.fps.to_string()),
            ("frames", format!("{}..{}", frames.start, frames.end)),
            (
                "sampling",
                "sobol, nee on, mis on, roulette on, fresnel exact".to_owned(),
            ),
        ]
    }

    fn json(&self) -> Value {
        let stage = |(name, on, by): Stage| json!({ "name": name, "on": on, "asked_by": by.filter(|_| on) });
        let buffer = |b: &BufferBytes| json!({ "name": b.name, "len": b.len, "bytes": b.bytes });
        let settings: serde_json::Map<String, Value> = self
            .settings()
            .into_iter()
            .map(|(name, value)| (name.to_owned(), Value::from(value)))
            .collect();
        let bvh = &self.scene.world.bvh;
        let rebase = &self.scene.rebase;
        json!({
            "scene": self.desc.file.to_string_lossy(),
            "hash": self.hash,
            "stages": self.stages().into_iter().map(stage).collect::<Vec<_>>(),
            "buffers": buffer_bytes(self.scene).iter().map(buffer).collect::<Vec<_>>(),
            "bytes": self.times.bytes,
            "tree": {
                "nodes": bvh.nodes.len(),
                "depth": bvh.depth,
                "cost": self.times.cost,
                "local_trees": self.scene.local.len(),
            },
            "rebase": { "origin": rebase.origin, "scale": rebase.scale },
            "settings": settings,
            "seconds": {
                "extract": self.times.extract.as_secs_f64(),
                "flatten": self.times.flatten.as_secs_f64(),
                "bvh": self.times.bvh.as_secs_f64(),
            },
        })
    }

    fn text(&self) -> String {
        let mut text = format!("{}\n\nStages\n", self.desc.file.display());
        let (on, off): (Vec<Stage>, Vec<Stage>) = self.stages().into_iter().partition(|s| s.1);
        for (name, _, by) in on {
            let by = by.map_or(String::new(), |by| format!("asked for by {by}"));
            line(&mut text, name, &by);
        }
        let off: Vec<&str> = off.iter().map(|s| s.0).collect();
        if !off.is_empty() {
            line(&mut text, "not needed", &off.join(", "));
        }
        text.push_str("\nBuffers\n");
        for b in buffer_bytes(self.scene) {
            line(
                &mut text,
                b.name,
                &format!(
                    "{} × {} B = {}",
                    b.len,
                    b.bytes / b.len.max(1),
                    size(b.bytes)
                ),
            );
        }
        line(&mut text, "together", &size(self.times.bytes));
        let bvh = &self.scene.world.bvh;
        text.push_str("\nTree\n");
        line(&mut text, "nodes", &bvh.nodes.len().to_string());
        line(&mut text, "depth", &bvh.depth.to_string());
        line(
            &mut text,
            "expected block tests",
            &format!("{:.2}", self.times.cost),
        );
        line(
            &mut text,
            "trees of meshes",
            &self.scene.local.len().to_string(),
        );
        let rebase = &self.scene.rebase;
        text.push_str("\nScene units = (authored - origin) * scale\n");
        line(&mut text, "origin", &format!("{:?}", rebase.origin));
        line(&mut text, "scale", &rebase.scale.to_string());
        text.push_str("\nSettings in force\n");
        for (name, value) in self.settings() {
            line(&mut text, name, &value);
        }
        text
    }
}

fn line(text: &mut String, name: &str, value: &str) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "  {name:<28}{value}");
}

/// `812 B`, `3.4 kB`, `12.0 MB`.
fn size(bytes: usize) -> String {
    let bytes = bytes as f64;
    if bytes < 1e3 {
        format!("{bytes} B")
    } else if bytes < 1e6 {
        format!("{:.1} kB", bytes / 1e3)
    } else {
        format!("{:.1} MB", bytes / 1e6)
    }
}
