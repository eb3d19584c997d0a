//! A run, stage by stage, within its budget.

use super::choose::{choose, pick_of};
use super::dials::{Dials, unbiased, variants};
use super::lab::Lab;
use super::race::{LADDER, Race};
use super::size::{self, Full};
use super::stack::Stack;
use super::{Goal, Plan, Quality, Report, Row, Stage};
use crate::asset::AssetStore;
use crate::flat::Needs;
use crate::render::Renderer;
use crate::scene::SceneDesc;
use std::time::{Duration, Instant};

/// Pixels of the first pictures, which tell how fast this machine is.
const PILOT: f64 = 2048.0;

/// Fewest and most pixels of the pictures that are measured: with fewer, intervals are wide; more tell nothing new.
const PIXELS: [f64; 2] = [256.0, 16384.0];

/// Samples per pixel that a run takes in all, about, with which the size of the pictures is chosen: the reference, twelve
/// settings for three seeds, half of them for eight, eight turned ones, and the confirmation.
const SAMPLES: f64 = 20_000.0;

/// Seeds of every setting that stays in the race.
const SEEDS: usize = 8;

/// First seed of the reference.
const REFERENCE_SEED: u64 = 1 << 32;

/// Samples of each of the reference's pictures, and their number at least and at most.
const REFERENCE: (u32, usize, usize) = (64, 4, 32);

/// Parts of the time at whose end a stage is over.
const SIZES_UNTIL: f64 = 0.10;
const REFERENCE_UNTIL: f64 = 0.30;
const RACE_UNTIL: f64 = 0.55;
const TURNING_UNTIL: f64 = 0.85;

/// Settings that are measured with all samples of the final quality.
const CONFIRMED: usize = 3;

/// Measures the scene of a renderer whose settings are the exact ones. `None` if the time does not suffice for two
/// pictures with the exact dials.
#[must_use]
pub fn run(
    renderer: &mut Renderer,
    desc: &SceneDesc,
    store: &AssetStore,
    plan: &Plan,
    mut tell: impl FnMut(Stage),
) -> Option<Report> {
    let start = Instant::now();
    let time = plan.deadline.saturating_duration_since(start);
    let until = |part: f64| start + Duration::from_secs_f64(part * time.as_secs_f64());
    let (exact, full) = (Dials::of(renderer.settings()), renderer.settings().size);
    let threads = renderer.threads();
    let mut lab = Lab::new(renderer, desc, store, plan.frame);
    let (needs, primitives, per_sample) = pilot(&mut lab, &exact, full);

    tell(Stage::Sizes);
    let seconds = lab.seconds_until(until(SIZES_UNTIL));
    let of_full = size::measure(&mut lab, &exact, full, per_sample, seconds);
    let samples = lab.seconds_until(plan.deadline) / per_sample;
    let size = shrink(full, (samples / SAMPLES).clamp(PIXELS[0], PIXELS[1]));

    tell(Stage::Reference);
    let pixels = f64::from(size.0) * f64::from(size.1);
    let reference = reference(
        &mut lab,
        &exact,
        size,
        until(REFERENCE_UNTIL),
        per_sample * pixels,
    )?;
    let seeds = reference.seeds();
    let mut race = Race::new(&mut lab, size, reference);
    let mut sprint = Sprint {
        race: &mut race,
        needs,
        plan,
        report: Report {
            rows: Vec::new(),
            full,
            size,
            scale: None,
            shrunk: Vec::new(),
            reference: (seeds, REFERENCE.0),
            threads,
        },
        of_full,
    };
    tell(Stage::Race);
    let all = unbiased(&exact, &needs);
    let all: Vec<usize> = all.iter().map(|d| sprint.race.enter(*d, None)).collect();
    // Without two seeds nothing is known.
    sprint.race.run(&all, &LADDER, 0..2, plan.deadline);
    sprint.race.run(&all, &LADDER, 2..SEEDS, until(RACE_UNTIL));
    let best = sprint.winner(&all)?;
    tell(Stage::Turning);
    let turned = variants(&sprint.report.rows[best].dials, &needs, primitives);
    sprint.turn(best, turned, until(TURNING_UNTIL));
    let together = sprint.together(best);
    sprint.turn(best, together, plan.deadline);
    tell(Stage::Confirming);
    sprint.confirm();
    Some(sprint.report)
}

/// What the scene needs, its primitives, and CPU seconds of a sample with the exact dials.
fn pilot(lab: &mut Lab<'_>, exact: &Dials, full: (u32, u32)) -> (Needs, usize, f64) {
    let size = shrink(full, PILOT);
    let (needs, primitives) = lab.needs(size, exact);
    // The first one warms up.
    let shots = [1, 4].map(|spp| lab.shoot(exact, size, spp, REFERENCE_SEED - 1).seconds);
    lab.forget(size);
    let pixels = f64::from(size.0) * f64::from(size.1);
    (needs, primitives, shots[1] / (4.0 * pixels))
}

/// A size of about so many pixels in the same shape, if that is smaller.
fn shrink(full: (u32, u32), pixels: f64) -> (u32, u32) {
    let by = (pixels / (f64::from(full.0) * f64::from(full.1))).sqrt();
    let side = |length: u32| (f64::from(length) * by).round().max(1.0) as u32;
    match by < 1.0 {
        true => (side(full.0), side(full.1)),
        false => full,
    }
}

/// Pictures with the exact dials until then, but some in any case. `None` if the time is too short for two.
fn reference(
    lab: &mut Lab<'_>,
    exact: &Dials,
    size: (u32, u32),
    until: Instant,
    per_spp: f64,
) -> Option<Stack> {
    let (spp, fewest, most) = REFERENCE;
    let mut stack = Stack::default();
    while stack.seeds() < most
        && (stack.seeds() < fewest || lab.fits(per_spp * f64::from(spp), until))
    {
        if stack.seeds() < fewest && Instant::now() >= until {
            break;
        }
        let seed = REFERENCE_SEED + stack.seeds() as u64;
        let shot = lab.shoot(exact, size, spp, seed);
        stack.add(shot.pixels.iter().map(|p| p.map(f64::from)));
    }
    (stack.seeds() >= 2).then_some(stack)
}

/// The stages that know each other.
struct Sprint<'a, 'b, 'c> {
    race: &'a mut Race<'b, 'c>,
    needs: Needs,
    plan: &'a Plan,
    report: Report,
    of_full: Option<Full>,
}

impl Sprint<'_, '_, '_> {
    /// Takes over what the race knows. `None` if that is not even the exact dials.
    fn note(&mut self) -> Option<()> {
        let rows = self.race.rows(&self.needs);
        let exact = rows.first().filter(|row| row.turned == 0)?;
        if let Some(full) = &self.of_full {
            let level = exact.levels.iter().find(|l| l.spp == full.spp);
            let small = self.report.size != self.report.full;
            self.report.scale = level.filter(|_| small).map(|l| {
                let variance = full.variance / l.differences.variance.value.max(f64::MIN_POSITIVE);
                [variance, full.per_sample / exact.per_sample]
            });
            self.report.shrunk.clone_from(&full.shrunk);
        }
        self.report.rows = rows;
        Some(())
    }

    /// The finest goal.
    fn finest(&self) -> Goal {
        let none = Goal {
            quality: Quality::Final,
            error: 0.01,
        };
        let finest = |a: Goal, b: Goal| if b.error < a.error { b } else { a };
        let goals = self.plan.goals.iter().copied();
        goals.reduce(finest).unwrap_or(none)
    }

    /// The row of those that reaches the finest goal first.
    fn winner(&mut self, all: &[usize]) -> Option<usize> {
        self.note()?;
        let seconds = |row: usize| {
            let pick = pick_of(&self.report, row, self.finest());
            pick.map_or(f64::INFINITY, |pick| pick.seconds)
        };
        let rows = 0..all.len().min(self.report.rows.len());
        rows.min_by(|&a, &b| seconds(a).total_cmp(&seconds(b)))
    }

    /// Races children of a row.
    fn turn(&mut self, parent: usize, dials: Vec<Dials>, until: Instant) {
        let Some(parent) = self.report.rows.get(parent).map(|row| row.dials) else {
            return;
        };
        let parent = self.race.enter(parent, None);
        let enter = |d: &Dials| self.race.enter(*d, Some(parent));
        let who: Vec<usize> = dials.iter().map(enter).collect();
        self.race.run(&who, &LADDER, 0..2, self.plan.deadline);
        self.race.run(&who, &LADDER, 2..SEEDS, until);
        self.note();
    }

    /// For every goal, all dials together that were a gain each by itself.
    fn together(&self, parent: usize) -> Vec<Dials> {
        let rows = &self.report.rows;
        let base = rows[parent].dials;
        let families: [fn(&mut Dials, &Dials); 3] = [
            |to, from| to.bounces = from.bounces,
            |to, from| to.fresnel = from.fresnel,
            |to, from| (to.accel, to.quality) = (from.accel, from.quality),
        ];
        let mut all = Vec::new();
        for goal in &self.plan.goals {
            let seconds = |row: usize| pick_of(&self.report, row, *goal).map(|p| p.seconds);
            let before = seconds(parent).unwrap_or(f64::INFINITY);
            let mut dials = base;
            for family in families {
                let turned = |row: &Row| {
                    let mut only = base;
                    family(&mut only, &row.dials);
                    only == row.dials && only != base
                };
                let own = (0..rows.len()).filter(|&k| turned(&rows[k]));
                let timed = own.filter_map(|k| Some((k, seconds(k)?)));
                let best = timed.min_by(|a, b| a.1.total_cmp(&b.1));
                if let Some((k, after)) = best
                    && after < before
                {
                    family(&mut dials, &rows[k].dials);
                }
            }
            if !all.contains(&dials) && rows.iter().all(|row| row.dials != dials) {
                all.push(dials);
            }
        }
        all
    }

    /// Measures the best settings of the finest goal with all their samples, as far as time allows.
    fn confirm(&mut self) {
        let goal = self.finest();
        let rows = 0..self.report.rows.len();
        let mut picks: Vec<_> = rows
            .filter_map(|row| pick_of(&self.report, row, goal))
            .collect();
        picks.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let Some(chosen) = choose(&self.report, goal) else {
            return;
        };
        picks.truncate(CONFIRMED);
        let who: Vec<usize> = (picks.iter().map(|pick| pick.row))
            .chain([chosen.row])
            .map(|row| self.report.rows[row].dials)
            .map(|dials| self.race.enter(dials, None))
            .collect();
        if LADDER
            .iter()
            .any(|spp| 2 * spp >= chosen.spp && *spp <= 2 * chosen.spp)
        {
            return;
        }
        self.race
            .run(&who, &[chosen.spp], 0..SEEDS, self.plan.deadline);
        self.note();
    }
}
