//! `luxel render --replay`: one sample's path in words.

use super::failure::Failure;
use super::load::Loaded;
use super::names::entity_name;
use super::print_result;
use super::replay_args::SampleName;
use crate::flat::{FlatScene, ObjectId, Scatter};
use crate::render::Settings;
use crate::scene::{SceneDesc, ShapeDesc};
use crate::trace::replay::{Fate, HitPoint, LightPoint, Replay, Vertex, replay};
use std::fmt::Write;

/// Traces the sample as a render with these settings does, and prints what happens.
pub(crate) fn run(loaded: Loaded, settings: Settings, named: SampleName) -> Result<(), Failure> {
    let ((x, y), (width, height)) = (named.pixel, settings.size);
    if x >= width || y >= height {
        return Err(Failure::usage(
            format!("there is no pixel ({x}, {y}) in an image of {width}x{height}"),
            "columns and rows count from 0, from the top left; --size as for the image",
        ));
    }
    let desc = loaded.desc.clone();
    let trace = settings.trace;
    let (scene, _) = loaded.renderer(settings)?.build(named.frame);
    let path = replay(&scene, &trace, named.pixel, named.sample);
    let told = Told {
        desc: &desc,
        scene: &scene,
    };
    print_result(told.path(named, &path).as_bytes())
}

/// What names things.
struct Told<'a> {
    desc: &'a SceneDesc,
    scene: &'a FlatScene,
}

impl Told<'_> {
    /// Writing to a string does not fail: the results are dropped here and below.
    fn path(&self, named: SampleName, path: &Replay) -> String {
        let (x, y) = named.pixel;
        let mut text = format!(
            "frame {}, pixel ({x}, {y}), sample {}: radiance {}\n",
            named.frame,
            named.sample,
            vector(path.radiance)
        );
        if let Some(bounce) = path.lost_at() {
            let _ = writeln!(
                text,
                "not finite from bounce {bounce} on: the film leaves it out"
            );
        }
        for (bounce, vertex) in path.vertices.iter().enumerate() {
            let _ = writeln!(text, "\nbounce {bounce}: {}", self.what(vertex));
            self.vertex(&mut text, vertex);
        }
        text
    }

    /// What a vertex lies on.
    fn what(&self, vertex: &Vertex) -> String {
        let Some(hit) = &vertex.hit else {
            return "the background".to_owned();
        };
        let name = entity_name(self.desc, ObjectId(hit.entity));
        let entity = self.desc.entities.get(hit.entity as usize);
        let entity = entity.map(|entity| &entity.value);
        let shape = match entity.and_then(|entity| entity.shape.as_ref()) {
            Some(ShapeDesc::Sphere { .. }) => "sphere".to_owned(),
            _ => format!("triangle {}", hit.prim),
        };
        let material = entity.and_then(|entity| self.desc.materials.get(entity.material?));
        let material = match material {
            Some(named) => format!("material {:?}", named.name),
            None => "no material of the scene".to_owned(),
        };
        let scatter = match self.scene.materials[hit.material.0 as usize].scatter {
            Scatter::Nothing => "reflects nothing",
            Scatter::Diffuse => "diffuse",
            Scatter::Mirror => "mirror",
            Scatter::Glass => "glass",
            Scatter::Plastic => "plastic",
            Scatter::Metal => "metal",
        };
        format!("{name}, {shape}, {material} ({scatter})")
    }

    fn vertex(&self, text: &mut String, vertex: &Vertex) {
        let mut line = |name: &str, words: String| {
            let _ = writeln!(text, "  {name:<12}{words}");
        };
        line("from", self.place(vertex.from));
        line("towards", vector(vertex.dir));
        line("throughput", vector(vertex.throughput));
        line("pdf", number(vertex.pdf));
        if let Some(hit) = &vertex.hit {
            self.hit(&mut line, hit);
        }
        line("so far", vector(vertex.emitted));
        if let Some(light) = &vertex.light {
            line("light", self.light(light));
        }
        if vertex.caustic != [0.0; 3] {
            line("caustic", format!("brings {}", vector(vertex.caustic)));
        }
        if vertex.radiance != vertex.emitted || vertex.light.is_some() {
            line("so far", vector(vertex.radiance));
        }
        let fate = match vertex.fate {
            Fate::Missed => "leaves the scene",
            Fate::Spent => "ends: no more bounces",
            Fate::Absorbed => "ends: nothing is reflected",
            Fate::Roulette => "ends: roulette",
            Fate::Scattered => "scatters",
        };
        line("then", fate.to_owned());
    }

    fn hit(&self, line: &mut impl FnMut(&str, String), hit: &HitPoint) {
        line("position", self.place(hit.position));
        let scale = self.scene.rebase.scale;
        let [distance, err] = [hit.distance, hit.err].map(|x| wide(f64::from(x) / scale));
        line("distance", format!("{distance}, surface within {err}"));
        line("normal", vector(hit.ng));
        if hit.ns != hit.ng {
            line("shading", vector(hit.ns));
        }
        line("colour", vector(hit.color));
    }

    fn light(&self, light: &LightPoint) -> String {
        let verdict = if light.blocked {
            "is blocked and does not bring"
        } else {
            "brings"
        };
        let [dir, radiance] = [light.dir, light.radiance].map(vector);
        format!("from {dir} {verdict} {radiance}")
    }

    /// A place in authored units.
    fn place(&self, p: [f32; 3]) -> String {
        let rebase = &self.scene.rebase;
        let authored = [0, 1, 2].map(|k| wide(f64::from(p[k]) / rebase.scale + rebase.origin[k]));
        format!("({})", authored.join(", "))
    }
}

/// The shortest text that reads back to the same bits.
fn number(x: f32) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() || (1e-4..1e7).contains(&size) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}

/// Likewise; as single precision where it is one.
fn wide(x: f64) -> String {
    let narrow = x as f32;
    if f64::from(narrow) == x || !x.is_finite() {
        return number(narrow);
    }
    match x.abs() {
        1e-4..1e7 => x.to_string(),
        _ => format!("{x:e}"),
    }
}

fn vector(v: [f32; 3]) -> String {
    format!("({})", v.map(number).join(", "))
}
