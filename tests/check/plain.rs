//! Plain files give no false alarm, and many entities take no time.

use crate::expect;
use crate::support::Folder;
use luxel::asset::Loader;
use luxel::math::DVec3;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Each mesh of the given data before a camera that fits: nothing is said of the scene as a whole.
#[test]
fn plain_files_give_no_false_alarm() {
    let Some(data) = std::env::var_os("LUXEL_DATA").map(PathBuf::from) else {
        println!("skipped: LUXEL_DATA does not say where the data is");
        return;
    };
    let mut checked = 0;
    for path in meshes(&data.join("zoo/obj")) {
        let mut loader = Loader::new();
        let Ok(id) = loader.mesh(&path) else {
            continue;
        };
        let mesh = loader.loaded(id);
        let used = mesh.corners.iter().map(|c| mesh.positions[*c as usize]);
        let (min, max) = used.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| {
            (a.min(p), b.max(p))
        });
        let (center, size) = (0.5 * (min + max), (max - min).length());
        let eye = center + DVec3::new(0.3, 0.4, 1.2) * size;
        let text = format!(
            "(version: 1, camera: (at: ({:?}, {:?}, {:?}), look_at: ({:?}, {:?}, {:?})),
             background: Linear(1, 1, 1), entities: [(shape: Mesh({:?}))])",
            eye.x,
            eye.y,
            eye.z,
            center.x,
            center.y,
            center.z,
            path.display().to_string()
        );
        let (desc, _) = luxel::scene::parse(&text, &data.join("s.ron")).expect("the scene reads");
        let spawned = luxel::world::spawn(&desc, Loader::new()).expect("the file loads");
        let found = luxel::check::check_world(&desc, &spawned.world, &spawned.assets);
        assert!(found.is_empty(), "{}: {found:#?}", path.display());
        checked += 1;
    }
    assert!(checked >= 50, "{checked}");
}

/// OBJ files below a folder.
fn meshes(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(meshes(&path));
        } else if path.extension().is_some_and(|e| e == "obj") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Release only: what these bounds tell apart is a second and more than a minute.
#[test]
#[cfg_attr(debug_assertions, ignore = "times of the release build")]
fn many_entities_and_many_errors_take_no_time() {
    let entity = |i: usize, wrong: &str| {
        let at = format!(
            "({}, {}, {})",
            i % 100,
            i / 100 % 100,
            -((i / 10_000) as i32)
        );
        format!(
            "(name: \"ball {i}\", shape: Sphere(radius: 0.3), transform: (translate: {at}){wrong}),\n"
        )
    };
    let scene = |entities: String| {
        let camera =
            "camera: (at: (50, 50, 150), look_at: (50, 50, 0)), background: Linear(1, 1, 1)";
        format!("(version: 1, {camera}, entities: [\n{entities}])")
    };
    let many = scene((0..100_000).map(|i| entity(i, "")).collect());
    let wrong = |i: usize| entity(i, &format!(", parent: \"bull {i}\""));
    let wrong = scene((0..20_000).map(wrong).collect());
    let line = wrong.replace('\n', " ");
    let folder = Folder::new(
        "many",
        &[
            ("many.ron", &many),
            ("wrong.ron", &wrong),
            ("line.ron", &line),
        ],
    );
    for (name, code, limit) in [
        ("many.ron", 0, 10),
        ("wrong.ron", 65, 5),
        ("line.ron", 65, 10),
    ] {
        let start = Instant::now();
        let output = folder.run(&["check", name]);
        let took = start.elapsed();
        println!("{name}: {took:?}");
        assert_eq!(output.status.code(), Some(code), "{name}");
        assert!(took < Duration::from_secs(limit), "{name}: {took:?}");
        if code != 0 {
            expect(&output, code, &["and 19,980 more of E012", "20000 errors"]);
        }
    }
}
