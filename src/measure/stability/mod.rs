//! Stability: the same scene at other sizes and in other places, and what goes wrong there.
//!
//! A scene enters, a [`Report`] leaves. At every [`Placing`] all lengths are multiplied and all places moved, camera and
//! lights included, so that nothing of the picture should change; then rays probe the geometry and a small picture is
//! rendered. What counts:
//!
//! - a **leak**: a ray that must hit and does not. Rays that are aimed at an edge that two triangles share, which lie on
//!   both sides of the ray, must hit one of them (or something before it). Rays that start on the inner side of a closed
//!   surface must not meet anything outside of its box before they meet the surface; closed is a solid sphere, and a
//!   part of a mesh all of whose edges are shared. Starts beside an edge, within what rounding moves them by, are not
//!   judged unless the whole part is smaller than a thousand such bounds. Where the walks below never leave the scene at home, it is a closed
//!   room: then a walk that leaves it elsewhere is a leak.
//! - a **self-hit**: a ray that leaves a surface by its error bound, as paths do, and hits the primitive that it left: the
//!   same triangle, or from outside the same sphere. Probed from points all over every shape, to both sides, and on
//!   random walks from the camera.
//! - **samples that are not finite** in the picture.
//! - the **difference** of the picture from that at home, in units of the noise: of what another seed changes. A path
//!   that passes an edge by less than the last bit may pass it on the other side, so that few pictures are equal to the
//!   bit; but no more than noise may change.
//!
//! The probes are the same at every placing: the same primitives, weights and random numbers. They tell what goes wrong
//! apart by entity.
//!
//! Deliberately absent: words and drawings on a terminal, and any judgement by time.

mod place;
mod probe;
pub mod report;
mod run;
mod topology;

pub use run::run;

use std::ops::AddAssign;

/// The same scene elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// What all lengths are multiplied by.
    pub scale: f64,
    /// How far it is moved along x, −y and z, in widths of the scene: each is a power of two, above what the scene
    /// without its walls is wide.
    pub offset: f64,
}

impl Placing {
    /// As authored.
    pub const HOME: Placing = Placing {
        scale: 1.0,
        offset: 0.0,
    };

    /// How far from home, in powers of ten.
    #[must_use]
    pub fn distance(&self) -> f64 {
        (crate::math::ln(self.scale).abs() + crate::math::ln(1.0 + self.offset))
            / std::f64::consts::LN_10
    }
}

/// What is tried.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Besides home, which comes first in any case.
    pub placings: Vec<Placing>,
    /// Rays of each kind of probe.
    pub rays: usize,
    /// Frame that is posed.
    pub frame: u32,
}

/// What went wrong with an entity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wrongs {
    /// Rays that must hit and did not.
    pub leaks: u64,
    /// Rays that hit what they left.
    pub self_hits: u64,
    /// Samples that were not finite where they met it; of a picture's first ones.
    pub non_finite: u64,
}

impl Wrongs {
    /// Of all kinds.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.leaks + self.self_hits + self.non_finite
    }
}

impl AddAssign for Wrongs {
    fn add_assign(&mut self, other: Wrongs) {
        self.leaks += other.leaks;
        self.self_hits += other.self_hits;
        self.non_finite += other.non_finite;
    }
}

/// A placing and what came of it.
#[derive(Clone, Debug)]
pub struct Row {
    /// Where.
    pub placing: Placing,
    /// Rays that were judged.
    pub rays: u64,
    /// All entities together; of the samples, all that were not finite.
    pub wrongs: Wrongs,
    /// By entity, indices of the scene file: those with any, the worst first.
    pub culprits: Vec<(u32, Wrongs)>,
    /// How the picture differs from that at home.
    pub picture: Difference,
}

/// How a picture differs from that at home.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Pixels that are not equal to the bit.
    pub pixels: usize,
    /// As of `luxel compare`.
    pub rmse: f64,
    /// As of `luxel compare`.
    pub relmse: f64,
    /// `rmse` over that of a picture at home with another seed.
    pub of_noise: f64,
    /// The entity whose pixels have most of the squared difference; `None` is the background.
    pub entity: Option<u32>,
}

impl Difference {
    /// Pictures of two seeds are 1 apart, give or take; one that is farther away is another picture.
    pub const MOST_OF_NOISE: f64 = 1.5;

    /// Whether it is more than noise.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.of_noise > Difference::MOST_OF_NOISE
    }
}

impl Row {
    /// Whether anything went wrong.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.wrongs.total() > 0 || self.picture.is_wrong()
    }

    /// The entity that most of it concerns; `None` where nothing is wrong or no entity is to blame.
    #[must_use]
    pub fn culprit(&self) -> Option<u32> {
        let worst = self.culprits.first().map(|(entity, _)| *entity);
        let seen = self.picture.entity.filter(|_| self.picture.is_wrong());
        worst.or(seen)
    }
}

/// All that was found.
#[derive(Clone, Debug)]
pub struct Report {
    /// Home first, then as planned.
    pub rows: Vec<Row>,
    /// Width and height of the pictures.
    pub size: (u32, u32),
    /// Samples per pixel of the pictures.
    pub spp: u32,
    /// RMSE of two pictures at home with different seeds.
    pub noise: f64,
    /// What the scene is wide without its walls, authored units, rounded up to a power of two.
    pub width: f64,
    /// Edges that two triangles share, of all meshes.
    pub edges: usize,
    /// Spheres, and parts of meshes without a hole.
    pub closed: usize,
    /// Parts of meshes with holes, whose inside is not judged.
    pub open: usize,
    /// Whether the camera stands in a room that walks never leave.
    pub room: bool,
}

impl Report {
    /// The placing nearest to home at which something goes wrong.
    #[must_use]
    pub fn first_wrong(&self) -> Option<&Row> {
        let wrong = self.rows.iter().filter(|row| row.is_wrong());
        wrong.min_by(|a, b| a.placing.distance().total_cmp(&b.placing.distance()))
    }
}
