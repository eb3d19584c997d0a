//! `luxel explain`: what a scene makes luxel do, which entities asked for it, and what it costs.

mod asking;
mod needs;

use super::args::InspectArgs;
use super::failure::Failure;
use super::progress::words;
use super::{load, print_result, tracing};
use crate::build::{BufferBytes, BuildTimes, buffer_bytes};
use crate::flat::{BLOCK, FlatScene};
use crate::measure::cost::{Cost, ROUNDS, cost};
use crate::render::Settings;
use crate::scene::{BackgroundDesc, FilterDesc, SceneDesc};
use crate::trace::Visits;
use needs::{Need, needs};
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// Frame that is explained: the rest pose.
const FRAME: u32 = 0;

/// Builds the scene's first frame and describes it.
pub(crate) fn run(args: &InspectArgs) -> Result<(), Failure> {
    let (loaded, _) = load::scene(&args.scene, args.max_memory)?;
    let settings = Settings::of_scene(&loaded.desc);
    let desc = loaded.desc.clone();
    let mut renderer = loaded.renderer(settings)?;
    let (mut scene, times) = renderer.build(FRAME);
    let cost = cost(&mut scene, &renderer.settings().trace);
    let subject = Subject {
        desc: &desc,
        scene: &scene,
        times,
        hash: renderer.hash(),
        needs: needs(&desc, &scene, &cost),
        cost,
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
    needs: Vec<Need>,
    cost: Cost,
}

impl Subject<'_> {
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
            "stages": self.needs.iter().map(Need::json).collect::<Vec<_>>(),
            "cost": self.cost_json(),
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

    /// Nodes and primitives that a ray visits.
    fn visits_json(visits: &Visits) -> Value {
        json!({
            "rays": visits.rays,
            "nodes": per_ray(visits, visits.nodes),
            "primitives": per_ray(visits, visits.primitives),
            "instances": per_ray(visits, visits.instances),
        })
    }

    fn cost_json(&self) -> Value {
        let cost = &self.cost;
        json!({
            "waves": cost.waves,
            "samples": cost.samples,
            "seconds": cost.seconds,
            "seconds_of_all_samples": self.whole_seconds(),
            "tracing": tracing::json(&cost.tallies, cost.samples),
            "a_ray": {
                "closest": Self::visits_json(&cost.closest),
                "occlusion": Self::visits_json(&cost.occlusion),
                "spheres_outside_the_tree": self.looped(),
            },
        })
    }

    /// Seconds of one thread for all samples that the scene asks for, as the waves have it.
    fn whole_seconds(&self) -> f64 {
        let render = &self.desc.render;
        let samples = f64::from(render.size.0) * f64::from(render.size.1) * f64::from(render.spp);
        self.cost.seconds / self.cost.samples.max(1) as f64 * samples
    }

    /// Spheres outside the tree.
    fn looped(&self) -> usize {
        let used = |prims: &[u32; BLOCK]| prims.iter().filter(|&&prim| prim != u32::MAX).count();
        let blocks = self.scene.spheres.looped.iter();
        blocks.map(|block| used(&block.prim)).sum()
    }

    fn tell_needs(&self, text: &mut String) {
        text.push_str("What it needs, and the share of tracing's time that this costs\n");
        for need in &self.needs {
            if let Some(words) = need.words() {
                line(text, need.name, &words);
            }
        }
        let off = self.needs.iter().filter(|need| need.asked.is_none());
        let off: Vec<&str> = off.map(|need| need.name).collect();
        if !off.is_empty() {
            line(text, "not needed, costs nothing", &off.join(", "));
        }
    }

    fn tell_cost(&self, text: &mut String) {
        let cost = &self.cost;
        let (width, height) = self.desc.render.size;
        text.push_str("\nMeasured on\n");
        let waves = format!(
            "{} of this picture's waves, {} samples, {} of one thread, each stage the best of {ROUNDS}",
            cost.waves,
            cost.samples,
            words(Duration::from_secs_f64(cost.seconds)),
        );
        line(text, "waves", &waves);
        let whole = format!(
            "{width}×{height} at {} spp: about {} of one thread",
            self.desc.render.spp,
            words(Duration::from_secs_f64(self.whole_seconds())),
        );
        line(text, "so all of it", &whole);
        text.push_str("\nStages of tracing\n");
        text.push_str(&tracing::table(&cost.tallies, cost.samples));
        text.push_str("\nRays, one by one\n");
        for (name, visits) in [
            ("closest hit", &cost.closest),
            ("occlusion", &cost.occlusion),
        ] {
            let mut words = format!(
                "{:.1} nodes, {:.1} primitives",
                per_ray(visits, visits.nodes),
                per_ray(visits, visits.primitives),
            );
            if visits.instances > 0 {
                let instances = per_ray(visits, visits.instances);
                words.push_str(&format!(", {instances:.1} boxes of instances"));
            }
            words.push_str(&format!(" a ray, counted on {} rays", visits.rays));
            line(text, name, &words);
        }
        if self.looped() > 0 {
            line(
                text,
                "outside the tree",
                &format!("{} spheres", self.looped()),
            );
        }
    }

    fn text(&self) -> String {
        let mut text = format!("{}\n\n", self.desc.file.display());
        self.tell_needs(&mut text);
        self.tell_cost(&mut text);
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

fn per_ray(visits: &Visits, count: u64) -> f64 {
    count as f64 / visits.rays.max(1) as f64
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
