//! The race: settings take turns, seed by seed.

use super::dials::Dials;
use super::lab::Lab;
use super::stack::Stack;
use super::{Level, Row};
use crate::flat::Needs;
use std::ops::Range;
use std::time::Instant;

/// Samples per pixel that every setting is measured with.
pub(super) const LADDER: [u32; 4] = [1, 4, 16, 64];

/// Seeds after which a setting may drop out.
const TRIAL: usize = 3;

/// A setting drops out that takes this many times as long as the best one for the same error.
const HOPELESS: f64 = 2.0;

/// A setting in the race.
struct Racer {
    dials: Dials,
    /// An unbiased setting that has run before; its pictures are kept.
    parent: Option<usize>,
    tracks: Vec<Track>,
    dropped: bool,
}

/// A setting with a number of samples.
#[derive(Default)]
struct Track {
    spp: u32,
    stack: Stack,
    /// Differences from the parent's picture of the same seed.
    differences: Stack,
    pictures: Vec<Vec<[f32; 3]>>,
    seconds: Vec<f64>,
}

/// All settings that were tried.
pub(super) struct Race<'a, 'b> {
    pub(super) lab: &'a mut Lab<'b>,
    size: (u32, u32),
    reference: Stack,
    racers: Vec<Racer>,
}

impl<'a, 'b> Race<'a, 'b> {
    /// Nobody runs yet.
    pub(super) fn new(lab: &'a mut Lab<'b>, size: (u32, u32), reference: Stack) -> Self {
        Race {
            lab,
            size,
            reference,
            racers: Vec::new(),
        }
    }

    /// Enters a setting, once, and returns its number.
    pub(super) fn enter(&mut self, dials: Dials, parent: Option<usize>) -> usize {
        let known = self.racers.iter().position(|r| r.dials == dials);
        known.unwrap_or_else(|| {
            self.racers.push(Racer {
                dials,
                parent,
                tracks: Vec::new(),
                dropped: false,
            });
            self.racers.len() - 1
        })
    }

    /// Renders the pictures of some seeds for some settings that have not dropped out, with every number of samples, as
    /// long as rounds are over in time.
    pub(super) fn run(&mut self, who: &[usize], spps: &[u32], seeds: Range<usize>, until: Instant) {
        for seed in seeds {
            let who: Vec<usize> = (who.iter().copied())
                .filter(|&w| !self.racers[w].dropped)
                .collect();
            let seconds: f64 = who.iter().map(|&w| self.expected(w, spps)).sum();
            if !self.lab.fits(seconds, until) {
                return;
            }
            for &w in &who {
                for &spp in spps {
                    self.shoot(w, spp, seed);
                }
            }
            if seed + 1 == TRIAL {
                self.drop_hopeless(&who, spps);
            }
        }
    }

    /// CPU seconds of a round, from the last pictures of the setting or else of any.
    fn expected(&self, who: usize, spps: &[u32]) -> f64 {
        let own = self.per_sample(&self.racers[who]);
        let any = || self.racers.iter().find_map(|r| self.per_sample(r));
        let samples = self.pixels() * f64::from(spps.iter().sum::<u32>());
        own.or_else(any).unwrap_or(0.0) * samples
    }

    fn pixels(&self) -> f64 {
        f64::from(self.size.0) * f64::from(self.size.1)
    }

    /// CPU seconds a sample: the least over the seeds with the most samples of the ladder, where what is paid for a
    /// picture, not for a sample, weighs least.
    fn per_sample(&self, racer: &Racer) -> Option<f64> {
        let tracks = racer.tracks.iter().filter(|t| !t.seconds.is_empty());
        let track = tracks.max_by_key(|t| t.spp)?;
        Some(least(&track.seconds) / (self.pixels() * f64::from(track.spp)))
    }

    fn shoot(&mut self, who: usize, spp: u32, seed: usize) {
        let racer = &mut self.racers[who];
        let known = racer.tracks.iter().position(|t| t.spp == spp);
        let which = known.unwrap_or_else(|| {
            racer.tracks.push(Track {
                spp,
                ..Track::default()
            });
            racer.tracks.len() - 1
        });
        // A seed once more would be the same picture.
        if racer.tracks[which].pictures.len() != seed {
            return;
        }
        let shot = self.lab.shoot(&racer.dials, self.size, spp, seed as u64);
        let parent = racer.parent.map(|p| &self.racers[p].tracks);
        let theirs = parent.and_then(|tracks| tracks.iter().find(|t| t.spp == spp));
        let theirs = theirs.and_then(|t| t.pictures.get(seed)).cloned();
        let track = &mut self.racers[who].tracks[which];
        track
            .stack
            .add(shot.pixels.iter().map(|p| p.map(f64::from)));
        if let Some(theirs) = theirs {
            let pairs = shot.pixels.iter().zip(&theirs);
            let off = pairs.map(|(a, b)| [0, 1, 2].map(|c| f64::from(a[c]) - f64::from(b[c])));
            track.differences.add(off);
        }
        track.pictures.push(shot.pixels);
        track.seconds.push(shot.seconds);
    }

    fn drop_hopeless(&mut self, who: &[usize], spps: &[u32]) {
        let ends = [spps.first(), spps.last()];
        let costs = |w: usize| {
            ends.map(|spp| {
                let tracks = self.racers[w].tracks.iter();
                let track = tracks.into_iter().find(|t| Some(&t.spp) == spp);
                track.map_or(f64::INFINITY, |t| {
                    let squared = t.stack.against(&self.reference).squared.value;
                    least(&t.seconds) * squared
                })
            })
        };
        let all: Vec<[f64; 2]> = who.iter().map(|&w| costs(w)).collect();
        let best = [0, 1].map(|end| least(&all.iter().map(|c| c[end]).collect::<Vec<_>>()));
        let hopeless = |cost: &[f64; 2]| (0..2).all(|end| cost[end] > HOPELESS * best[end]);
        for (&w, cost) in who.iter().zip(&all) {
            // The exact dials are what all others are compared with.
            self.racers[w].dropped = w != 0 && hopeless(cost);
        }
    }

    /// What is known of every setting with two seeds at least.
    pub(super) fn rows(&self, needs: &Needs) -> Vec<Row> {
        let exact = self.racers[0].dials;
        let row = |racer: &Racer| self.row(racer, &exact, needs);
        self.racers.iter().filter_map(row).collect()
    }

    fn row(&self, racer: &Racer, exact: &Dials, needs: &Needs) -> Option<Row> {
        let mut tracks: Vec<&Track> = racer.tracks.iter().collect();
        tracks.retain(|t| t.stack.seeds() >= 2);
        tracks.sort_by_key(|t| t.spp);
        let level = |t: &&Track| Level {
            spp: t.spp,
            seeds: t.stack.seeds(),
            seconds: [least(&t.seconds), median(&t.seconds)],
            differences: t.stack.against(&self.reference),
        };
        let levels: Vec<Level> = tracks.iter().map(level).collect();
        // With few samples what is rare may not occur at all, and would seem to make no difference.
        let last = tracks.last()?;
        let direct = last.stack.against(&self.reference).bias_squared;
        let biases = racer.dials.biases(exact, needs);
        let paired = (biases > 0 && last.differences.seeds() >= 2)
            .then(|| last.differences.squared_mean(self.reference.power()))
            .filter(|paired| 0.0 < paired.half_width && paired.half_width < direct.half_width);
        Some(Row {
            dials: racer.dials,
            biases,
            turned: racer.dials.arguments(exact).len(),
            build: self.lab.build_seconds(self.size, &racer.dials),
            per_sample: self.per_sample(racer)?,
            bias_squared: paired.unwrap_or(direct),
            levels,
            dropped: racer.dropped,
        })
    }
}

fn least(x: &[f64]) -> f64 {
    x.iter().copied().fold(f64::INFINITY, f64::min)
}

fn median(x: &[f64]) -> f64 {
    let mut sorted = x.to_vec();
    sorted.sort_by(f64::total_cmp);
    0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2])
}
