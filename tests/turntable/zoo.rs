//! Every mesh of a collection of real files makes a sensible turntable.
//!
//! Runs where `LUXEL_DATA` names a folder with `zoo/`; says that it skips elsewhere.

use crate::studio::{Take, coverage, exposure, film, is_inside, read};
use luxel::author::Up;
use std::path::{Path, PathBuf};

/// What covers less of its frame than others: needles of triangles, one long triangle that stands on its edge, a row of
/// small tiles.
const THIN: [&str; 6] = [
    "gltf/blender-io/14_emission_strength/14_emission_strength.gltf",
    "obj/tinyobj/issue-92.obj",
    "obj/tinyobj/issue-95.obj",
    "obj/tinyobj/leading-decimal-dot-issue-201.obj",
    "obj/tinyobj/mtllib-multiple-files-issue-112.obj",
    "obj/tinyobj/norm-texopt.obj",
];

/// What shines by itself, brighter than white.
const SHINES: [&str; 1] = ["gltf/blender-io/14_emission_strength/14_emission_strength.gltf"];

const TAKE: Take = Take {
    up: Up::Y,
    side: 48,
    spp: 3,
    frames: 8,
};

#[test]
fn every_mesh_of_the_zoo_turns() {
    let Some(data) = std::env::var_os("LUXEL_DATA").map(PathBuf::from) else {
        eprintln!("skipped: LUXEL_DATA is not set");
        return;
    };
    let zoo = data.join("zoo");
    let mut files = Vec::new();
    for folder in ["obj", "gltf", "scenes"] {
        collect(&zoo.join(folder), &mut files);
    }
    files.sort();
    let mut wrong = Vec::new();
    let mut turned = 0;
    for file in &files {
        // Whether it should load is another test's question, and some files hold no triangle.
        let Some(_) = read(file).ok().filter(|read| !read.points.is_empty()) else {
            continue;
        };
        turned += 1;
        let name = file.strip_prefix(&zoo).unwrap_or(file).to_string_lossy();
        let told = match film(file, TAKE) {
            Ok(frames) => judge(&name, &frames),
            Err(says) => vec![says],
        };
        wrong.extend(told.into_iter().map(|says| format!("{name}: {says}")));
    }
    eprintln!("{turned} of {} files turned", files.len());
    assert!(turned >= 50, "only {turned} meshes");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn judge(name: &str, frames: &[luxel::film::Film]) -> Vec<String> {
    let mut wrong = Vec::new();
    let least = if THIN.contains(&name) { 0.01 } else { 0.04 };
    let covers = coverage(&frames[0]);
    if !(least..=0.6).contains(&covers) {
        wrong.push(format!("covers {:.1} %", 100.0 * covers));
    }
    for (k, frame) in frames.iter().enumerate() {
        if !is_inside(frame) {
            wrong.push(format!("leaves frame {k}"));
        }
        if frame.total_non_finite() > 0 {
            wrong.push(format!("frame {k} is not finite"));
        }
    }
    let (mean, burnt) = exposure(&frames[0]);
    if !(0.15..=0.6).contains(&mean) {
        wrong.push(format!("mean luminance {mean:.2}"));
    }
    if burnt > 0.02 && !SHINES.contains(&name) {
        wrong.push(format!("{:.1} % burnt", 100.0 * burnt));
    }
    wrong
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let suffix = path.extension().and_then(|s| s.to_str());
        if path.is_dir() {
            collect(&path, files);
        } else if suffix.is_some_and(|s| ["obj", "gltf", "glb"].contains(&s)) {
            files.push(path);
        }
    }
}
