//! What spins and keys do: full turns to the bit, keys through chains of parents, frames that know no other frame.

use luxel::asset::{Limits, Loader};
use luxel::math::{DAffine3, DMat3, DQuat, DVec3};
use luxel::render::{Renderer, Settings};
use luxel::scene;
use luxel::world::{self, Name, Pose, Spawned, Time};
use std::path::Path;

pub(crate) fn spawn(text: &str) -> (scene::SceneDesc, Spawned) {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/test.ron");
    let (desc, _) = scene::parse(text, &here).expect("a scene");
    let spawned = world::spawn(&desc, Loader::with_limits(Limits::default())).expect("a world");
    (desc, spawned)
}

fn pose_of(world: &hecs::World, name: &str) -> DAffine3 {
    let mut rows = world.query::<(&Name, &Pose)>();
    let found = rows.iter().find(|(n, _)| n.0 == name);
    found.expect("an entity of this name").1.affine()
}

const SHAPES: &str = r#"
    (name: "lamp", parent: "car", shape: Sphere(radius: 1), emissive: (radiance: (9, 9, 9)),
        keys: [(t: 0, translate: (0, 2, 0)), (t: 1, translate: (0, 4, 0), scale: 1), (t: 2, scale: 2)]),
    (name: "car", transform: (translate: (9, 9, 9), scale: 3), ease: Smooth,
        keys: [(t: 0.5, translate: (-1, 0, 0), rotate: Euler(0, 0, 0)), (t: 1.5, translate: (1, 0.5, 0), rotate: Euler(0, 90, 0))]),
    (name: "rotor", parent: "car", shape: Mesh("../assets/plinth.obj"), transform: (translate: (0, 0, 1)),
        spin: (axis: (0, 0, 1), deg_per_s: 90, pivot: (0, 1, 1))),
    (name: "eye", parent: "rotor", camera: (vfov_deg: 40), transform: (translate: (0, 0, 8)),
        keys: [(t: 0, rotate: Quat(0, 0, 0, 1)), (t: 2, rotate: Quat(0, 1, 0, 1))]),
    (name: "bulb", parent: "rotor", light: Point(intensity: (5, 5, 5)), ease: Step,
        keys: [(t: 0, translate: (1, 0, 0)), (t: 1, translate: (2, 0, 0))]),
"#;

fn scene_of(entities: &str, more: &str) -> String {
    format!("Scene(version: 1, render: (size: (24, 16), spp: 1), entities: [{entities}], {more})")
}

/// The poses again, by hand, with another library's rotations.
#[test]
fn keys_move_all_that_has_a_place_through_its_parents() {
    let (_, mut spawned) = spawn(&scene_of(SHAPES, ""));
    for t in [-1.0, 0.0, 0.25, 0.5, 0.8, 1.0, 1.2, 1.5, 1.75, 2.0, 7.0] {
        let at = |from: f64, to: f64| ((t - from) / (to - from)).clamp(0.0, 1.0);
        let smooth = |u: f64| u * u * (3.0 - 2.0 * u);
        let mix = |a: DVec3, b: DVec3, u: f64| a + (b - a) * u;
        let about = |axis: DVec3, deg: f64| DQuat::from_axis_angle(axis, deg.to_radians());
        let map = DAffine3::from_scale_rotation_translation;
        let u = smooth(at(0.5, 1.5));
        let place = mix(DVec3::NEG_X, DVec3::new(1.0, 0.5, 0.0), u);
        let car = map(DVec3::splat(3.0), about(DVec3::Y, 90.0 * u), place);
        let lamp = car
            * map(
                DVec3::splat(1.0 + at(1.0, 2.0)),
                DQuat::IDENTITY,
                mix(DVec3::Y * 2.0, DVec3::Y * 4.0, at(0.0, 1.0)),
            );
        let pivot = DAffine3::from_translation(DVec3::new(0.0, 1.0, 1.0));
        let turn = DAffine3::from_quat(about(DVec3::Z, 90.0 * t));
        let rotor = car * pivot * turn * pivot.inverse() * DAffine3::from_translation(DVec3::Z);
        let eye = rotor
            * map(
                DVec3::ONE,
                about(DVec3::Y, 90.0 * at(0.0, 2.0)),
                DVec3::Z * 8.0,
            );
        let bulb = rotor * DAffine3::from_translation(DVec3::X * if t < 1.0 { 1.0 } else { 2.0 });
        world::pose(&mut spawned.world, t);
        for (name, wanted) in [
            ("car", car),
            ("lamp", lamp),
            ("rotor", rotor),
            ("eye", eye),
            ("bulb", bulb),
        ] {
            let found = pose_of(&spawned.world, name);
            let error = (found.matrix3 - wanted.matrix3).to_cols_array().into_iter();
            let error = error.chain((found.translation - wanted.translation).to_array());
            let error = error.fold(0.0f64, |m, x| m.max(x.abs()));
            assert!(error < 1e-13, "{name} at {t}: {error:e}");
        }
    }
}

#[test]
fn keys_at_their_times_are_exact() {
    let (_, mut spawned) = spawn(&scene_of(SHAPES, ""));
    world::pose(&mut spawned.world, 1.5);
    let car = pose_of(&spawned.world, "car");
    assert_eq!(
        car.matrix3,
        DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X) * 3.0
    );
    assert_eq!(car.translation, DVec3::new(1.0, 0.5, 0.0));
}

/// Any rate in whole degrees at any whole number of frames a second: after the frames of whole turns, frame 0's poses.
#[test]
fn a_full_turn_in_whole_frames_is_frame_0_to_the_bit() {
    let mut turns = 0;
    for rate in [
        36, 45, 50, 70, 90, 100, 110, 120, 144, 180, 216, 252, 270, 330, 360, 450, 720, 777,
    ] {
        let entities = format!(
            r#"(name: "hub", spin: (axis: (1, 2, 3), deg_per_s: {rate}, pivot: (3, 1, 0.1))),
               (name: "cog", parent: "hub", transform: (translate: (1, 0.7, 0.3)), spin: (axis: (0, 1, 0.2), deg_per_s: -{rate})),
               (name: "eye", parent: "cog", camera: ())"#
        );
        let (_, spawned) = spawn(&scene_of(&entities, ""));
        let at = |frame: u32, fps: u32| {
            let poses = world::poses(&spawned.world, Time::of_frame(frame, f64::from(fps)));
            format!("{poses:?}")
        };
        for fps in [1, 12, 23, 24, 25, 29, 30, 48, 50, 59, 60, 90, 120, 144] {
            let whole = |frame: &u32| (rate * frame).is_multiple_of(360 * fps);
            if let Some(frame) = (1..5000).find(whole) {
                assert_eq!(
                    at(frame, fps),
                    at(0, fps),
                    "{rate} degrees a second, frame {frame} at {fps}"
                );
                turns += 1;
            }
        }
    }
    assert!(turns > 200, "{turns}");
}

/// A renderer that has built other frames builds the same as one that has built none.
#[test]
fn frames_know_no_other_frame() {
    let floor = r#"(name: "floor", shape: Mesh("../assets/plinth.obj"), transform: (translate: (0, -3, 0), scale: 4)),
        (name: "twin", shape: Mesh("../assets/plinth.obj"), transform: (translate: (0, -9, 0), scale: 2)),
        (name: "wall", shape: Sphere(radius: 100), transform: (translate: (0, -110, 0))),"#;
    let text = scene_of(
        &format!("{floor}{SHAPES}"),
        "animation: (fps: 8, frames: 0..16)",
    );
    let renderer = || {
        let (desc, spawned) = spawn(&text);
        let settings = Settings::of_scene(&desc);
        Renderer::new(&desc, spawned.world, &spawned.assets, settings).expect("threads")
    };
    let build = |renderer: &mut Renderer, frame| format!("{:?}", renderer.build(frame).0);
    let mut used = renderer();
    for frame in [5, 0, 3, 16, 3, 9] {
        assert_eq!(
            build(&mut used, frame),
            build(&mut renderer(), frame),
            "frame {frame}"
        );
    }
    assert_ne!(build(&mut used, 3), build(&mut used, 4));
}
