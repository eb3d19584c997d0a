//! Animations of glTF files: channels of every interpolation against their formulas, and what cannot be read.

use crate::folder::folder;
use crate::support::Folder;
use luxel::asset::Loader;
use luxel::math::{DAffine3, DQuat, DVec3};
use luxel::scene;
use luxel::world::{self, Name, Pose, Spawned};
use std::fs;
use std::path::Path;

/// RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |three: &[u8]| -> String {
        let bits = (0..3).fold(0u32, |bits, i| {
            bits << 8 | u32::from(three.get(i).copied().unwrap_or(0))
        });
        let sign = |i: usize| match i <= three.len() {
            true => char::from(SIGNS[(bits >> (18 - 6 * i)) as usize & 63]),
            false => '=',
        };
        (0..4).map(sign).collect()
    };
    bytes.chunks(3).map(group).collect()
}

/// A triangle that moves: its accessors are the triangle, times 0, 1, 2, and one for the output of each channel. A channel is
/// (node, path, interpolation, output).
fn file(channels: &[(usize, &str, &str, &[f32])]) -> String {
    let mut runs: Vec<(&str, Vec<f32>)> = vec![
        ("VEC3", vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
        ("SCALAR", vec![0.0, 1.0, 2.0]),
    ];
    let (mut samplers, mut aims) = (Vec::new(), Vec::new());
    for (node, path, interpolation, output) in channels {
        let output_at = runs.len();
        runs.push((
            if *path == "rotation" { "VEC4" } else { "VEC3" },
            output.to_vec(),
        ));
        aims.push(format!(
            r#"{{"sampler": {}, "target": {{"node": {node}, "path": "{path}"}}}}"#,
            samplers.len()
        ));
        samplers.push(format!(
            r#"{{"input": 1, "output": {output_at}, "interpolation": "{interpolation}"}}"#
        ));
    }
    let (mut bytes, mut views, mut accessors) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (shape, numbers)) in runs.iter().enumerate() {
        let width = match *shape {
            "SCALAR" => 1,
            "VEC3" => 3,
            _ => 4,
        };
        views.push(format!(
            r#"{{"buffer": 0, "byteOffset": {}, "byteLength": {}}}"#,
            bytes.len(),
            4 * numbers.len()
        ));
        let bounds = match i {
            0 => r#", "min": [0, 0, 0], "max": [1, 1, 0]"#,
            1 => r#", "min": [0], "max": [2]"#,
            _ => "",
        };
        accessors.push(format!(
            r#"{{"bufferView": {i}, "componentType": 5126, "count": {}, "type": "{shape}"{bounds}}}"#,
            numbers.len() / width
        ));
        bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    }
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"name": "arm", "children": [1], "translation": [0, 5, 0]}}, {{"name": "hand", "mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "animations": [{{"samplers": [{}], "channels": [{}]}}],
        "buffers": [{{"byteLength": {}, "uri": "data:application/octet-stream;base64,{}"}}],
        "bufferViews": [{}], "accessors": [{}]}}"#,
        samplers.join(", "),
        aims.join(", "),
        bytes.len(),
        base64(&bytes),
        views.join(", "),
        accessors.join(", ")
    )
}

fn spawn(folder: &Folder, channels: &[(usize, &str, &str, &[f32])]) -> Spawned {
    fs::write(folder.0.join("arm.gltf"), file(channels)).expect("writable");
    let text = r#"Scene(version: 1, camera: (at: (0, 0, 9), look_at: (0, 0, 0)), background: Linear(1, 1, 1),
        entities: [(gltf: "arm.gltf")])"#;
    let (desc, _) = scene::parse(text, &folder.0.join("s.ron")).expect("a scene");
    world::spawn(&desc, Loader::new()).unwrap_or_else(|told| panic!("{told:?}"))
}

fn assert_pose(spawned: &mut Spawned, t: f64, name: &str, wanted: DAffine3) {
    world::pose(&mut spawned.world, t);
    let mut rows = spawned.world.query::<(&Name, &Pose)>();
    let found = rows
        .iter()
        .find(|(n, _)| n.0 == name)
        .expect(name)
        .1
        .affine();
    let error = (found.matrix3 - wanted.matrix3).to_cols_array().into_iter();
    let error = error.chain((found.translation - wanted.translation).to_array());
    let error = error.fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(error < 1e-6, "{name} at {t}: {error:e}");
}

#[test]
fn channels_move_nodes_as_their_interpolation_says() {
    let folder = folder("gltf");
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // Quarter turns about z; jumps; a spline through 0, 1, 0 that is left and reached with slope 2, 0, −2.
    let turns = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half, 0.0, 0.0, 1.0, 0.0];
    let jumps = [1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0];
    let key = |x: f32, slope: f32| [[slope, 0.0, 0.0], [x, 0.0, 0.0], [slope, 0.0, 0.0]].concat();
    let spline = [key(0.0, 2.0), key(1.0, 0.0), key(0.0, -2.0)].concat();
    let channels: [(usize, &str, &str, &[f32]); 3] = [
        (0, "rotation", "LINEAR", &turns),
        (1, "scale", "STEP", &jumps),
        (1, "translation", "CUBICSPLINE", &spline),
    ];
    let mut spawned = spawn(&folder, &channels);
    assert!(spawned.warnings.is_empty(), "{:?}", spawned.warnings);
    for t in [0.0, 0.25, 0.5, 1.0, 1.75, 2.0, 9.0f64] {
        let u = t.min(2.0);
        let arm = DAffine3::from_translation(DVec3::Y * 5.0)
            * DAffine3::from_quat(DQuat::from_rotation_z(u * std::f64::consts::FRAC_PI_2));
        // The cubic with these ends and slopes is 2u − u², both ways.
        let x = 2.0 * u - u * u;
        let hand = DAffine3::from_scale_rotation_translation(
            DVec3::splat(1.0 + u.floor()),
            DQuat::IDENTITY,
            DVec3::X * x,
        );
        assert_pose(&mut spawned, t, "arm", arm);
        assert_pose(&mut spawned, t, "hand", arm * hand);
    }
}

#[test]
fn what_cannot_be_read_stays_at_rest_and_is_told() {
    let folder = folder("gltf-bad");
    let nan = [0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0, 1.0, 0.0, 0.0];
    let cases: [(usize, &str, &str, &[f32]); 4] = [
        (0, "translation", "LINEAR", &nan),
        (0, "translation", "LINEAR", &[1.0, 2.0, 3.0]),
        (0, "translation", "CUBICSPLINE", &[0.0; 9]),
        (0, "translation", "WOBBLE", &[0.0; 9]),
    ];
    for case in cases {
        let mut spawned = spawn(&folder, &[case]);
        let told = spawned
            .warnings
            .iter()
            .any(|w| w.code == "W138" && w.message.contains("channels"));
        assert!(told, "{case:?}: {:?}", spawned.warnings);
        assert_pose(
            &mut spawned,
            1.0,
            "arm",
            DAffine3::from_translation(DVec3::Y * 5.0),
        );
    }
}

/// A scene that `convert` writes moves as its file does, where both go straight.
#[test]
fn convert_writes_keys() {
    let folder = folder("gltf-convert");
    let moves: &[f32] = &[0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 0.5, 0.0, 0.0];
    let turns: &[f32] = &[0.0, 0.0, 0.0, 1.0, 0.0, 0.6, 0.0, 0.8, 0.0, 0.0, 1.0, 0.0];
    let mut spawned = spawn(
        &folder,
        &[
            (0, "translation", "LINEAR", moves),
            (1, "rotation", "LINEAR", turns),
        ],
    );
    folder.expect(&["convert", "arm.gltf", "-o", "arm.ron"], 0, &[]);
    let text = fs::read_to_string(folder.0.join("arm.ron")).expect("written");
    assert!(
        text.contains("keys: [(t: 0, translate: (0, 0, 0)"),
        "{text}"
    );
    assert!(text.contains("frames: 0..48"), "{text}");
    let path: &Path = &folder.0.join("arm.ron");
    let (desc, _) = scene::parse(&text, path).expect("a scene");
    let mut written = world::spawn(&desc, Loader::new()).expect("a world");
    for t in [0.0, 0.3, 1.0, 1.6, 5.0] {
        world::pose(&mut spawned.world, t);
        for name in ["arm", "hand"] {
            let mut rows = spawned.world.query::<(&Name, &Pose)>();
            let wanted = rows
                .iter()
                .find(|(n, _)| n.0 == name)
                .expect(name)
                .1
                .affine();
            drop(rows);
            assert_pose(&mut written, t, name, wanted);
        }
    }
}
