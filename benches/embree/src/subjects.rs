//! What is traced: the generated subjects by name, or a mesh of a file.

use luxel::asset::Loader;
use luxel::measure::bench::{Subject, meshes};
use std::error::Error;
use std::path::Path;

/// A name, and what makes the subject when its turn comes.
pub(crate) type Maker = (String, Box<dyn FnOnce() -> Subject>);

/// Makes a subject.
type Generator = fn() -> Subject;

/// Spheres of the subject of spheres.
const SPHERES: u32 = 100_000;

/// Names as in `luxel bench`, and generators; small ones first.
const ALL: [(&str, Generator); 7] = [
    ("3k", || meshes::ball(meshes::BALL_SIZES[0])),
    ("70k", || meshes::ball(meshes::BALL_SIZES[1])),
    ("1m", || meshes::ball(meshes::BALL_SIZES[2])),
    ("4m", || meshes::ball(meshes::BALL_SIZES[3])),
    ("terrain", || meshes::terrain(meshes::TERRAIN_SIDE)),
    ("soup", || meshes::soup(meshes::SOUP_SIZE)),
    ("spheres-100k", || meshes::spheres(SPHERES)),
];

/// The subjects of these names, or all.
pub(crate) fn named(names: &[String]) -> Result<Vec<Maker>, String> {
    let known = ALL.map(|(name, _)| name);
    if let Some(name) = names.iter().find(|n| !known.contains(&n.as_str())) {
        return Err(format!("no subject \"{name}\": {}", known.join(", ")));
    }
    let wanted = |name: &str| names.is_empty() || names.iter().any(|n| n == name);
    let chosen = ALL.into_iter().filter(|(name, _)| wanted(name));
    Ok(chosen
        .map(|(name, make)| -> Maker { (name.to_owned(), Box::new(make)) })
        .collect())
}

/// The mesh of an OBJ file, in a closed room.
pub(crate) fn of_file(path: &Path) -> Result<Maker, Box<dyn Error>> {
    let mut loader = Loader::new();
    let mesh = loader.mesh(path).map_err(|told| match told.first() {
        Some(first) => first.message.clone(),
        None => "it cannot be read".to_owned(),
    })?;
    let subject = Subject::of_meshes(&[(loader.loaded(mesh), luxel::math::DAffine3::IDENTITY)])
        .ok_or("the mesh has no extent")?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    Ok((name.into_owned(), Box::new(|| subject.in_room())))
}

/// What Linux calls this processor.
pub(crate) fn cpu() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text
        .lines()
        .find_map(|line| line.strip_prefix("model name"));
    let name = model.map(|rest| rest.trim_start_matches([' ', '\t', ':']));
    name.unwrap_or("unknown processor").to_owned()
}
