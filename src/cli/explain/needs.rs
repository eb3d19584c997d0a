//! What a scene needs: which entities asked for it, and what it costs.

use super::asking::{Asked, Asking, reads};
use crate::flat::{FlatScene, Opacity, Scatter};
use crate::measure::cost::{Cost, Part};
use crate::scene::SceneDesc;
use crate::trace::Stage;
use serde_json::{Value, json};

/// A thing that costs something.
pub(super) struct Need {
    pub(super) name: &'static str,
    /// Who asked for it; `None` where the scene does not need it.
    pub(super) asked: Option<Asked>,
    /// What it costs, if it is needed.
    pub(super) price: Option<Price>,
}

/// What something costs, as a share of the time of tracing.
pub(super) struct Price {
    pub(super) share: f64,
    pub(super) way: Way,
    /// Share of the vertices of paths, where it has some.
    pub(super) of_vertices: Option<f64>,
}

/// How that was measured.
pub(super) enum Way {
    /// The time of these stages, nanoseconds for each item of the first.
    Stages(&'static [Stage], f64),
    /// In turns with the same waves without it.
    Without,
    /// That of all rays, with whatever else is in the tree.
    Tree,
    /// That of rays of which the tree was taken away.
    Loop,
}

/// All things that may cost something.
pub(super) fn needs(desc: &SceneDesc, scene: &FlatScene, cost: &Cost) -> Vec<Need> {
    let asking = Asking::new(desc, scene);
    let needs = &scene.needs;
    let sky = || Asked::Place("background");
    let stages = |stages| price_of_stages(cost, stages);
    let vertices = |stage: Stage| {
        let price = price_of_stages(cost, of_kind(stage));
        Price {
            of_vertices: Some(ratio(
                cost.tallies.of(stage).items,
                cost.tallies.of(Stage::Surface).items,
            )),
            ..price
        }
    };
    let without = |part: Part| {
        let found = cost.without.iter().find(|(own, _)| *own == part);
        Price {
            share: found.map_or(0.0, |(_, share)| *share),
            way: Way::Without,
            of_vertices: None,
        }
    };
    let traversal = cost
        .tallies
        .share(&[Stage::ClosestHit, Stage::Opacity, Stage::Occlusion]);
    let rays = cost.closest.rays;
    let tree = |hits: u64| Price {
        share: traversal * (1.0 - cost.looped),
        way: Way::Tree,
        of_vertices: Some(ratio(hits, rays)),
    };
    let met = &cost.met;
    let kind = |scatter: Scatter| asking.material(|m| m.scatter == scatter);
    let texture = || asking.material(|m| reads(m, &|_| true));
    let second = |texture: u32| scene.textures[texture as usize].uv_set == 1;
    let all = [
        (
            needs.triangles,
            "triangles",
            asking.triangles(),
            tree(met.triangles + met.instances),
        ),
        (
            needs.tree_spheres,
            "spheres in the tree",
            asking.spheres(&scene.spheres.blocks),
            tree(met.tree_spheres),
        ),
        (
            needs.looped_spheres,
            "spheres outside the tree",
            asking.spheres(&scene.spheres.looped),
            Price {
                share: traversal * cost.looped,
                way: Way::Loop,
                of_vertices: Some(ratio(met.looped_spheres, rays)),
            },
        ),
        (
            needs.instances,
            "instances",
            asking.instances(),
            tree(met.instances),
        ),
        (
            needs.smooth_normals,
            "smooth normals",
            asking.smooth(),
            without(Part::SmoothNormals),
        ),
        (
            needs.uvs,
            "texture coordinates",
            texture(),
            stages(&[Stage::Textures]),
        ),
        (
            needs.uvs1,
            "second texture coordinates",
            asking.material(|m| reads(m, &second)),
            stages(&[Stage::Textures]),
        ),
        (
            needs.vertex_colors,
            "vertex colours",
            asking.material(|m| m.vertex_colors),
            stages(&[Stage::VertexColors]),
        ),
        (
            needs.textures,
            "textures",
            texture(),
            stages(&[Stage::Textures]),
        ),
        (
            needs.opacity,
            "opacity",
            asking.material(|m| m.opacity != Opacity::Full),
            stages(&[Stage::Opacity]),
        ),
        (
            needs.lens,
            "lens",
            Asked::Place("camera"),
            without(Part::Lens),
        ),
        (
            needs.lights,
            "light sampling",
            asking.lights().unwrap_or_else(sky),
            stages(&[Stage::Lights, Stage::Occlusion]),
        ),
        (
            needs.punctual,
            "lights without extent",
            asking.punctual(),
            stages(&[Stage::Lights, Stage::Occlusion]),
        ),
        (
            needs.background,
            "background",
            sky(),
            stages(&[Stage::Background]),
        ),
        (
            needs.environment,
            "sky",
            sky(),
            stages(&[Stage::Background]),
        ),
        (
            needs.diffuse,
            "diffuse",
            kind(Scatter::Diffuse),
            vertices(Stage::Diffuse),
        ),
        (
            needs.mirror,
            "mirror",
            kind(Scatter::Mirror),
            vertices(Stage::Mirror),
        ),
        (
            needs.glass,
            "glass",
            kind(Scatter::Glass),
            vertices(Stage::Glass),
        ),
        (
            needs.plastic,
            "plastic",
            kind(Scatter::Plastic),
            vertices(Stage::Plastic),
        ),
        (
            needs.metal,
            "metal",
            kind(Scatter::Metal),
            vertices(Stage::Metal),
        ),
    ];
    let need = |(on, name, asked, price)| Need {
        name,
        asked: Option::filter(Some(asked), |_| on),
        price: Option::filter(Some(price), |_| on),
    };
    all.into_iter().map(need).collect()
}

fn of_kind(stage: Stage) -> &'static [Stage] {
    match stage {
        Stage::Mirror => &[Stage::Mirror],
        Stage::Glass => &[Stage::Glass],
        Stage::Plastic => &[Stage::Plastic],
        Stage::Metal => &[Stage::Metal],
        _ => &[Stage::Diffuse],
    }
}

fn price_of_stages(cost: &Cost, stages: &'static [Stage]) -> Price {
    let time = |&stage: &Stage| cost.tallies.of(stage).nanoseconds;
    let items = stages
        .first()
        .map_or(0, |&first| cost.tallies.of(first).items);
    Price {
        share: cost.tallies.share(stages),
        way: Way::Stages(stages, ratio(stages.iter().map(time).sum(), items)),
        of_vertices: None,
    }
}

fn ratio(part: u64, whole: u64) -> f64 {
    part as f64 / whole.max(1) as f64
}

impl Price {
    /// `12.3 %, 8.1 ns a vertex, 61.0 % of vertices`; stages are named where they are not just what is needed.
    fn words(&self, name: &str) -> String {
        let share = percent(self.share);
        let mut words = match &self.way {
            Way::Stages(stages, nanoseconds) => {
                let unit = stages.first().map_or("item", |stage| stage.unit());
                let names: Vec<&str> = stages.iter().map(|stage| stage.name()).collect();
                let told = match names.as_slice() {
                    [only] if *only == name => String::new(),
                    names => format!(" in {}", names.join(" and ")),
                };
                format!("{share}{told}, {nanoseconds:.1} ns a {unit}")
            }
            // Differences of two times that are known to a percent.
            Way::Without if self.share < 0.01 => "less than 1 %, with and without".to_owned(),
            Way::Without => format!("{share}, with and without"),
            Way::Tree => format!("{share}, all of the tree"),
            Way::Loop => format!("{share}, without the tree"),
        };
        match (&self.way, self.of_vertices) {
            (Way::Tree | Way::Loop, Some(part)) => {
                words.push_str(&format!(", {} of rays end there", percent(part)))
            }
            (_, Some(part)) => words.push_str(&format!(", {} of vertices", percent(part))),
            (_, None) => {}
        }
        words
    }
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

impl Need {
    /// What it costs and who asked for it; `None` if nobody did.
    pub(super) fn words(&self) -> Option<String> {
        let (asked, price) = (self.asked.as_ref()?, self.price.as_ref()?);
        let price = price.words(self.name);
        Some(format!("{price:<64}asked for by {}", asked.words()))
    }

    /// As a script reads it.
    pub(super) fn json(&self) -> Value {
        let (first, more) = match &self.asked {
            None => (None, 0),
            Some(Asked::Place(place)) => (Some((*place).to_owned()), 0),
            Some(Asked::Entities(first, more)) => (Some(first.clone()), *more),
        };
        let price = self.price.as_ref().map(|price| {
            let way = match price.way {
                Way::Stages(..) => "stages",
                Way::Without => "with and without",
                Way::Tree => "tree",
                Way::Loop => "without the tree",
            };
            json!({ "share": price.share, "measured": way, "of_vertices": price.of_vertices })
        });
        json!({
            "name": self.name,
            "on": self.asked.is_some(),
            "asked_by": first,
            "more": more,
            "cost": price,
        })
    }
}
