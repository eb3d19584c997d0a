//! A scene file to what the renderer takes: description, world, files.

use super::failure::Failure;
use crate::asset::{AssetStore, Loader};
use crate::check::{check, check_light, check_world};
use crate::diag::Diagnostic;
use crate::render::{Renderer, Settings};
use crate::scene::{self, LoadError, SceneDesc};
use crate::world::{self, Light};
use hecs::World;
use std::path::Path;

/// A scene with its world and files.
pub(crate) struct Loaded {
    /// The description.
    pub(crate) desc: SceneDesc,
    /// Its entities.
    world: World,
    /// Its files.
    assets: AssetStore,
}

/// Reads a scene and every file that it names. The warnings come with it, the errors instead of it.
pub(crate) fn scene(path: &Path) -> Result<(Loaded, Vec<Diagnostic>), Failure> {
    let read = scene::load(path).map_err(|e| refuse(path, e))?;
    let mut found = read.warnings;
    found.extend(check(&read.desc));
    match world::spawn(&read.desc, Loader::new()) {
        Ok(spawned) => {
            found.extend(check_world(&read.desc, &spawned.world, &spawned.assets));
            found.extend(spawned.warnings);
            let loaded = Loaded {
                desc: read.desc,
                world: spawned.world,
                assets: spawned.assets,
            };
            Ok((loaded, found))
        }
        Err(errors) => {
            found.extend(check_light(&read.desc));
            found.extend(errors);
            Err(Failure::scene(found))
        }
    }
}

/// Why a scene file named on the command line was not read.
fn refuse(path: &Path, error: LoadError) -> Failure {
    match error {
        LoadError::Missing(_) => Failure::no_input(path, &"no such file"),
        LoadError::Unreadable { source, .. } => Failure::no_input(path, &source),
        LoadError::Invalid(mut found, desc) => {
            // An error in the scene hides none in the files.
            if let Some(desc) = desc {
                found.extend(world::open_files(&desc, Loader::new()));
            }
            Failure::scene(found)
        }
    }
}

impl Loaded {
    /// Whether there are lights without extent, which no ray can hit.
    pub(crate) fn has_punctual_lights(&self) -> bool {
        self.world.query::<&Light>().iter().next().is_some()
    }

    /// Starts the renderer's threads.
    pub(crate) fn renderer(self, settings: Settings) -> Result<Renderer, Failure> {
        Renderer::new(&self.desc, self.world, &self.assets, settings)
            .map_err(|e| Failure::threads(&e))
    }
}
