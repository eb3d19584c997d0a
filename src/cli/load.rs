//! A scene file to what the renderer takes: description, world, files.

use super::failure::Failure;
use super::patience::Patience;
use crate::asset::{AssetStore, Limits, Loader};
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

/// Reads a scene alone.
pub(crate) fn description(path: &Path) -> Result<SceneDesc, Failure> {
    let memory = Limits::default().memory;
    let read = scene::load(path).map_err(|e| refuse(path, e, memory))?;
    Ok(read.desc)
}

/// Reads a scene and every file that it names, which may take `max_memory` bytes. The warnings come with it, the errors
/// instead of it.
pub(crate) fn scene(path: &Path, max_memory: u64) -> Result<(Loaded, Vec<Diagnostic>), Failure> {
    let read = scene::load(path).map_err(|e| refuse(path, e, max_memory))?;
    let mut found = read.warnings;
    found.extend(check(&read.desc));
    let (loader, patience) = loader(max_memory);
    let spawned = world::spawn(&read.desc, loader);
    drop(patience);
    match spawned {
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

/// A loader whose files may take `max_memory` bytes, and what tells of one that takes its time.
pub(crate) fn loader(max_memory: u64) -> (Loader, Patience) {
    let loader = Loader::with_limits(Limits { memory: max_memory });
    let patience = Patience::start(loader.reading());
    (loader, patience)
}

/// Why a scene file named on the command line was not read.
fn refuse(path: &Path, error: LoadError, max_memory: u64) -> Failure {
    match error {
        LoadError::Missing(_) => Failure::no_input(path, &"no such file"),
        LoadError::Unreadable { source, .. } => Failure::no_input(path, &source),
        LoadError::Invalid(mut found, desc) => {
            // An error in the scene hides none in the files.
            if let Some(desc) = desc {
                let (loader, _patience) = loader(max_memory);
                found.extend(world::open_files(&desc, loader));
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

    /// Bytes that its files take in memory.
    pub(crate) fn memory(&self) -> u64 {
        self.assets.memory()
    }

    /// What renderers are made of, for those who start several.
    pub(crate) fn into_parts(self) -> (SceneDesc, World, AssetStore) {
        (self.desc, self.world, self.assets)
    }

    /// Starts the renderer's threads.
    pub(crate) fn renderer(mut self, settings: Settings) -> Result<Renderer, Failure> {
        // The world has them now.
        self.desc.entities = Vec::new();
        Renderer::new(&self.desc, self.world, &self.assets, settings)
            .map_err(|e| Failure::threads(&e))
    }
}
