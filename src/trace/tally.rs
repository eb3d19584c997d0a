//! What the stages of the wave cost: how many rays, vertices or samples went through each, and how long that took.
//!
//! A clock is read once after each stage of a wave, which is a thousand paths long; nothing of it reaches the image.

use std::ops::AddAssign;
use std::time::Instant;

/// A stage of the wave, or a part of one that has its own loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum Stage {
    /// Camera rays; of samples.
    Camera,
    /// What paths meet; of rays.
    ClosestHit,
    /// Rays that go on through surfaces that are not there; of those rays.
    Opacity,
    /// Places, normals, materials; of rays.
    Surface,
    /// Texture coordinates and textures; of hits on what has some.
    Textures,
    /// Colours at the corners of triangles; of rays.
    VertexColors,
    /// Background or sky; of rays that met nothing.
    Background,
    /// Surfaces that shine; of hits on them.
    Emission,
    /// Choosing points of lights, and what they would bring; of vertices.
    Lights,
    /// Whether something is in their way, and what they bring; of rays.
    Occlusion,
    /// Lamps through and by specular spheres; of rays.
    Caustics,
    /// The next direction at [`crate::flat::Scatter::Diffuse`]; of vertices, as the four that follow.
    Diffuse,
    /// At [`crate::flat::Scatter::Mirror`].
    Mirror,
    /// At [`crate::flat::Scatter::Glass`].
    Glass,
    /// At [`crate::flat::Scatter::Plastic`].
    Plastic,
    /// At [`crate::flat::Scatter::Metal`].
    Metal,
    /// Roulette; of paths.
    Roulette,
    /// Closing the ranks of the paths that go on; of paths before it.
    Compact,
    /// Sums of pixels; of samples.
    Film,
}

impl Stage {
    /// All, in the order in which a path meets them.
    pub const ALL: [Stage; 19] = [
        Stage::Camera,
        Stage::ClosestHit,
        Stage::Opacity,
        Stage::Surface,
        Stage::Textures,
        Stage::VertexColors,
        Stage::Background,
        Stage::Emission,
        Stage::Lights,
        Stage::Occlusion,
        Stage::Caustics,
        Stage::Diffuse,
        Stage::Mirror,
        Stage::Glass,
        Stage::Plastic,
        Stage::Metal,
        Stage::Roulette,
        Stage::Compact,
        Stage::Film,
    ];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Stage::Camera => "camera",
            Stage::ClosestHit => "closest hit",
            Stage::Opacity => "opacity",
            Stage::Surface => "surface",
            Stage::Textures => "textures",
            Stage::VertexColors => "vertex colours",
            Stage::Background => "background",
            Stage::Emission => "emission",
            Stage::Lights => "light sampling",
            Stage::Occlusion => "occlusion",
            Stage::Caustics => "caustics",
            Stage::Diffuse => "diffuse",
            Stage::Mirror => "mirror",
            Stage::Glass => "glass",
            Stage::Plastic => "plastic",
            Stage::Metal => "metal",
            Stage::Roulette => "roulette",
            Stage::Compact => "compact",
            Stage::Film => "film",
        }
    }

    /// What goes through it.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Stage::Camera | Stage::Film => "sample",
            Stage::Textures | Stage::Emission => "hit",
            Stage::ClosestHit
            | Stage::Opacity
            | Stage::Surface
            | Stage::VertexColors
            | Stage::Background
            | Stage::Occlusion
            | Stage::Caustics => "ray",
            Stage::Roulette | Stage::Compact => "path",
            _ => "vertex",
        }
    }
}

/// What one stage cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rays, vertices or samples, as [`Stage::unit`] says.
    pub items: u64,
    /// Nanoseconds of the threads that ran it, added up.
    pub nanoseconds: u64,
}

/// What all of them cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tallies([Tally; Stage::ALL.len()]);

impl Tallies {
    /// Of one stage.
    #[must_use]
    pub fn of(&self, stage: Stage) -> Tally {
        self.0[stage as usize]
    }

    /// Nanoseconds of all stages.
    #[must_use]
    pub fn nanoseconds(&self) -> u64 {
        self.0.iter().map(|tally| tally.nanoseconds).sum()
    }

    /// Part of the time that some stages take, 0 to 1; 0 where nothing took time.
    #[must_use]
    pub fn share(&self, stages: &[Stage]) -> f64 {
        let own: u64 = stages.iter().map(|&stage| self.of(stage).nanoseconds).sum();
        own as f64 / self.nanoseconds().max(1) as f64
    }

    /// Of the same work done twice: of each stage, the shorter time.
    #[must_use]
    pub fn least(mut self, other: Tallies) -> Tallies {
        for (own, other) in self.0.iter_mut().zip(other.0) {
            own.nanoseconds = own.nanoseconds.min(other.nanoseconds);
        }
        self
    }

    /// Rays that asked for their closest hit.
    #[must_use]
    pub fn closest_rays(&self) -> u64 {
        let stages = [Stage::ClosestHit, Stage::Opacity, Stage::Caustics];
        stages.iter().map(|&stage| self.of(stage).items).sum()
    }

    /// Rays that asked whether something is in their way.
    #[must_use]
    pub fn occlusion_rays(&self) -> u64 {
        self.of(Stage::Occlusion).items
    }
}

impl AddAssign for Tallies {
    fn add_assign(&mut self, other: Tallies) {
        for (sum, tally) in self.0.iter_mut().zip(other.0) {
            sum.items += tally.items;
            sum.nanoseconds += tally.nanoseconds;
        }
    }
}

/// A running clock.
pub(super) struct Laps {
    last: Instant,
    pub(super) tallies: Tallies,
}

impl Laps {
    pub(super) fn start() -> Laps {
        Laps {
            last: Instant::now(),
            tallies: Tallies::default(),
        }
    }

    /// Ends a stage. One through which nothing went is the next one's time.
    pub(super) fn lap(&mut self, stage: Stage, items: u64) {
        if items == 0 {
            return;
        }
        let now = Instant::now();
        let tally = &mut self.tallies.0[stage as usize];
        tally.items += items;
        tally.nanoseconds += now.duration_since(self.last).as_nanos() as u64;
        self.last = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_stand_at_their_place() {
        for (place, stage) in Stage::ALL.into_iter().enumerate() {
            assert_eq!(stage as usize, place, "{stage:?}");
        }
    }

    #[test]
    fn shares_are_parts_of_one() {
        let mut laps = Laps::start();
        for (k, stage) in Stage::ALL.into_iter().enumerate() {
            std::hint::black_box((0..1000 * k).sum::<usize>());
            laps.lap(stage, k as u64);
        }
        let tallies = laps.tallies;
        let shares: f64 = Stage::ALL
            .iter()
            .map(|&stage| tallies.share(&[stage]))
            .sum();
        assert!((shares - 1.0).abs() < 1e-12, "{shares}");
        assert!((tallies.share(&Stage::ALL) - 1.0).abs() < 1e-12);
        assert_eq!(Tallies::default().share(&Stage::ALL), 0.0);
        assert_eq!(tallies.of(Stage::Camera), Tally::default());
        let mut twice = tallies;
        twice += tallies;
        assert_eq!(twice.closest_rays(), 2 * (1 + 2 + 10));
        assert_eq!(twice.occlusion_rays(), 2 * 9);
        assert_eq!(twice.least(tallies).nanoseconds(), tallies.nanoseconds());
    }
}
