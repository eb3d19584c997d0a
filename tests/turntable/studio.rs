//! From a mesh to the numbers of its turntable.

use luxel::asset::Loader;
use luxel::author::{Turntable, Up, points, turntable};
use luxel::film::Film;
use luxel::math::DVec3;
use luxel::render::{Control, Renderer, Settings};
use luxel::{scene, world};
use std::path::{Path, PathBuf};

/// Index of the mesh in the scene, as the `entity` channel says it.
pub(crate) const MESH: u32 = 3;

/// A folder of this test's own, gone when dropped.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Folder {
        let name = format!("luxel-turntable-{name}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).expect("a temporary folder");
        Folder(path)
    }

    pub(crate) fn file(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, text).expect("writable");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// What is rendered of a turn.
#[derive(Clone, Copy)]
pub(crate) struct Take {
    pub(crate) up: Up,
    pub(crate) side: u32,
    pub(crate) spp: u32,
    pub(crate) frames: u32,
}

/// A file that was read.
pub(crate) struct Read {
    loader: Loader,
    gltf: bool,
    pub(crate) points: Vec<DVec3>,
}

/// Reads a mesh, or says why it cannot be.
pub(crate) fn read(mesh: &Path) -> Result<Read, String> {
    let mut loader = Loader::new();
    let suffix = mesh.extension().and_then(|s| s.to_str());
    let gltf = suffix.is_some_and(|s| s == "gltf" || s == "glb");
    let points = if gltf {
        let id = loader.model(mesh).map_err(|e| e[0].to_string())?;
        points::of_model(loader.loaded_model(id), &loader)
    } else {
        let id = loader.mesh(mesh).map_err(|e| e[0].to_string())?;
        points::of_mesh(loader.loaded(id))
    };
    Ok(Read {
        loader,
        gltf,
        points,
    })
}

/// Every frame of a mesh's turn.
pub(crate) fn film(mesh: &Path, take: Take) -> Result<Vec<Film>, String> {
    let Read {
        loader,
        gltf,
        points,
    } = read(mesh)?;
    let name = mesh.file_name().and_then(|name| name.to_str());
    let wanted = Turntable {
        path: name.ok_or("a name")?.to_owned(),
        gltf,
        up: take.up,
        size: (take.side, take.side),
        spp: take.spp,
        frames: take.frames,
        seconds: 3.2,
    };
    let desc = turntable(&points, &wanted).map_err(|e| e.to_string())?;
    let text = scene::write(&desc);
    let place = mesh.with_file_name("turntable.ron");
    let (desc, warnings) = scene::parse(&text, &place).map_err(|e| format!("{text}\n{e:?}"))?;
    assert_eq!(warnings, [], "{text}");
    let spawned = world::spawn(&desc, loader).map_err(|e| format!("{e:?}"))?;
    let mut settings = Settings::of_scene(&desc);
    settings.trace.ids = true;
    let mut renderer = Renderer::new(&desc, spawned.world, &spawned.assets, settings)
        .map_err(|e| e.to_string())?;
    let frame = |k| renderer.render(k, &Control::default()).film;
    Ok((0..take.frames).map(frame).collect())
}

/// Which pixels show the mesh.
pub(crate) fn mask(film: &Film) -> Vec<bool> {
    film.planes().entity.iter().map(|&e| e == MESH).collect()
}

/// Share of the pixels that show the mesh.
pub(crate) fn coverage(film: &Film) -> f64 {
    let mask = mask(film);
    mask.iter().filter(|m| **m).count() as f64 / mask.len() as f64
}

/// Whether the mesh keeps off the border.
pub(crate) fn is_inside(film: &Film) -> bool {
    let (width, height) = (film.width() as usize, film.height() as usize);
    let mask = mask(film);
    let on_border = |i: usize| {
        let (x, y) = (i % width, i / width);
        x == 0 || y == 0 || x + 1 == width || y + 1 == height
    };
    !(0..mask.len()).any(|i| mask[i] && on_border(i))
}

/// Mean luminance of the frame, and share of the pixels that are beyond white.
pub(crate) fn exposure(film: &Film) -> (f64, f64) {
    let radiance = film.radiance();
    let luminance = |[r, g, b]: &[f32; 3]| f64::from(0.2126 * r + 0.7152 * g + 0.0722 * b);
    let sum: f64 = radiance.iter().map(luminance).sum();
    let burnt = radiance.iter().filter(|p| p.iter().any(|c| *c > 1.0));
    let pixels = radiance.len() as f64;
    (sum / pixels, burnt.count() as f64 / pixels)
}
