//! The subjects that can be asked for by name.

use super::Subject;
use super::meshes::{self, BALL_SIZES, SOUP_SIZE, TERRAIN_SIDE};
use std::fmt;

/// A generated subject.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Generator {
    /// A [`meshes::ball`] of 2,880 triangles: all of it in the nearest caches.
    Ball3k,
    /// One of 69,620: about the second-level cache.
    Ball70k,
    /// One of 1,310,720: beyond the caches of most machines.
    Ball1m,
    /// One of 4,195,280.
    Ball4m,
    /// [`meshes::terrain`] of 4,193,408 triangles.
    Terrain,
    /// [`meshes::soup`] of 200,000 triangles.
    Soup,
    /// 100 [`meshes::spheres`].
    Spheres100,
    /// 1,000.
    Spheres1k,
    /// 10,000.
    Spheres10k,
    /// 100,000.
    Spheres100k,
}

impl Generator {
    /// All, triangles before spheres, small to large.
    pub const ALL: [Generator; 10] = [
        Generator::Ball3k,
        Generator::Ball70k,
        Generator::Ball1m,
        Generator::Ball4m,
        Generator::Terrain,
        Generator::Soup,
        Generator::Spheres100,
        Generator::Spheres1k,
        Generator::Spheres10k,
        Generator::Spheres100k,
    ];

    /// Makes it.
    #[must_use]
    pub fn make(self) -> Subject {
        match self {
            Generator::Ball3k => meshes::ball(BALL_SIZES[0]),
            Generator::Ball70k => meshes::ball(BALL_SIZES[1]),
            Generator::Ball1m => meshes::ball(BALL_SIZES[2]),
            Generator::Ball4m => meshes::ball(BALL_SIZES[3]),
            Generator::Terrain => meshes::terrain(TERRAIN_SIDE),
            Generator::Soup => meshes::soup(SOUP_SIZE),
            Generator::Spheres100 => meshes::spheres(100),
            Generator::Spheres1k => meshes::spheres(1_000),
            Generator::Spheres10k => meshes::spheres(10_000),
            Generator::Spheres100k => meshes::spheres(100_000),
        }
    }

    /// Its name in tables and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Generator::Ball3k => "3k",
            Generator::Ball70k => "70k",
            Generator::Ball1m => "1m",
            Generator::Ball4m => "4m",
            Generator::Terrain => "terrain",
            Generator::Soup => "soup",
            Generator::Spheres100 => "spheres-100",
            Generator::Spheres1k => "spheres-1k",
            Generator::Spheres10k => "spheres-10k",
            Generator::Spheres100k => "spheres-100k",
        }
    }
}

impl fmt::Display for Generator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
