//! A run: placing after placing.

use super::place::Home;
use super::probe::{Findings, probe};
use super::topology::Topology;
use super::{Difference, Placing, Plan, Report, Row, Wrongs};
use crate::film::Film;
use crate::flat::FlatScene;
use crate::measure::{Image, Pair, Selection, errors};
use crate::render::{Control, Renderer, Rendering};
use crate::trace::{TraceOptions, replay};
use hecs::World;

/// Measures `world`. `start` makes a renderer of a world that is placed, with the settings of the pictures, ids among
/// them, and the seed that it is given; `tell` hears of every placing before it is tried.
///
/// # Errors
/// What `start` says.
pub fn run<E>(
    world: World,
    plan: &Plan,
    mut start: impl FnMut(World, u64) -> Result<Renderer, E>,
    mut tell: impl FnMut(usize, Placing),
) -> Result<Report, E> {
    let home = Home::of(&world);
    tell(0, Placing::HOME);
    let mut renderer = start(world, 1)?;
    let other_seed = renderer.render(plan.frame, &Control::default());
    let mut renderer = start(renderer.into_world(), 0)?;
    let (flat, _) = renderer.build(plan.frame);
    let topology = Topology::of(&flat);
    let truth = renderer.render(plan.frame, &Control::default());
    let noise = difference(&other_seed.film, &truth.film, 1.0).rmse;
    let found = probe(&flat, &topology, plan.rays);
    let width = 1.0 / flat.rebase.scale;
    let [edges, closed, open] = topology.count(&flat);
    let room = found.escapes.is_empty();
    let mut report = Report {
        rows: vec![row(Placing::HOME, found, Difference::default(), false)],
        size: (truth.film.width(), truth.film.height()),
        spp: truth.stats.spp,
        noise,
        width,
        edges,
        closed,
        open,
        room,
    };
    let options = renderer.settings().trace;
    count_lost(&mut report.rows[0], &truth, &flat, &options);
    let mut world = renderer.into_world();
    for (k, placing) in plan.placings.iter().enumerate() {
        tell(k + 1, *placing);
        home.put(&mut world, *placing, width);
        let mut renderer = start(world, 0)?;
        let (flat, _) = renderer.build(plan.frame);
        let found = probe(&flat, &topology, plan.rays);
        let rendering = renderer.render(plan.frame, &Control::default());
        let picture = difference(&rendering.film, &truth.film, noise);
        let mut row = row(*placing, found, picture, room);
        count_lost(&mut row, &rendering, &flat, &options);
        report.rows.push(row);
        world = renderer.into_world();
    }
    Ok(report)
}

/// Sums up what the probes found; walks that leave a room are leaks.
fn row(placing: Placing, found: Findings, picture: Difference, room: bool) -> Row {
    let mut by_entity = found.by_entity;
    if room {
        for (entity, escapes) in found.escapes {
            by_entity.entry(entity).or_default().leaks += escapes;
        }
    }
    let mut wrongs = Wrongs::default();
    by_entity.values().for_each(|found| wrongs += *found);
    let mut culprits: Vec<_> = by_entity.into_iter().collect();
    worst_first(&mut culprits);
    Row {
        placing,
        rays: found.rays,
        wrongs,
        culprits,
        picture,
    }
}

fn worst_first(culprits: &mut [(u32, Wrongs)]) {
    culprits.sort_by_key(|(entity, wrongs)| (std::cmp::Reverse(wrongs.total()), *entity));
}

/// Adds the samples that were not finite, at the entity that each was at.
fn count_lost(row: &mut Row, rendering: &Rendering, flat: &FlatScene, options: &TraceOptions) {
    row.wrongs.non_finite = rendering.film.total_non_finite();
    for lost in &rendering.non_finite {
        let path = replay(flat, options, lost.pixel, lost.sample);
        let vertex = path.vertices.get(lost.bounce as usize);
        let Some(hit) = vertex.and_then(|vertex| vertex.hit.as_ref()) else {
            continue;
        };
        let known = row.culprits.iter().position(|c| c.0 == hit.entity);
        let at = known.unwrap_or_else(|| {
            row.culprits.push((hit.entity, Wrongs::default()));
            row.culprits.len() - 1
        });
        row.culprits[at].1.non_finite += 1;
    }
    worst_first(&mut row.culprits);
}

/// What a picture differs by from the one at home, whose entities share the blame.
fn difference(film: &Film, home: &Film, noise: f64) -> Difference {
    let width = home.width() as usize;
    let [x, r] = [film, home].map(Film::radiance);
    let differs = |(x, r): (&[f32; 3], &[f32; 3])| x != r;
    let pixels = x.iter().zip(&r).filter(|pair| differs(*pair)).count();
    let mut by_entity = std::collections::BTreeMap::new();
    for ((x, r), entity) in x.iter().zip(&r).zip(&home.planes().entity) {
        let squared: f64 = (0..3)
            .map(|k| square(f64::from(x[k]) - f64::from(r[k])))
            .sum();
        *by_entity.entry(*entity).or_insert(0.0) += squared;
    }
    let worst = by_entity.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let mut difference = Difference {
        pixels,
        entity: worst.and_then(|(entity, _)| (entity != u32::MAX).then_some(entity)),
        ..Difference::default()
    };
    let images = [x, r].map(|pixels| Image::new(width, pixels));
    if let [Some(x), Some(r)] = &images
        && let Ok(pair) = Pair::new(x, r, Selection::All)
    {
        let errors = errors(&pair);
        difference.rmse = errors.rmse;
        difference.relmse = errors.relmse;
        difference.of_noise = match errors.rmse {
            0.0 => 0.0,
            rmse => rmse / noise,
        };
    }
    difference
}

fn square(x: f64) -> f64 {
    x * x
}
