//! A million small rotations: by frames, which do not add up, and by parents, which do.

use crate::stage::Stage;
use luxel::math::{DMat3, DVec3, axis_angle_deg};
use luxel::world::{self, Name, Parent, Pose, Transform};

const TURNS: u32 = 1_000_000;
const RADIANS: f64 = 1e-3;

/// A matrix that turns about z: how far off its angle is, and how far from 1 MᵀM is.
fn errors(m: DMat3, radians: f64) -> [f64; 2] {
    let (sin, cos) = radians.sin_cos();
    // The sine of the difference.
    let angle = (m.x_axis.y * cos - m.x_axis.x * sin).abs();
    let off = m.transpose() * m - DMat3::IDENTITY;
    let columns = [off.x_axis, off.y_axis, off.z_axis];
    let largest = columns
        .map(|c| c.abs().max_element())
        .into_iter()
        .fold(0.0, f64::max);
    [angle, largest]
}

/// Frame a million of an animation that turns by a thousandth of a radian each.
#[test]
fn the_millionth_frame_is_where_it_should_be() {
    let body = format!(
        "camera: (at: (0, 0, 5), look_at: (0, 0, 0)), entities: [(name: \"hub\",
         spin: (axis: (0, 0, 1), deg_per_s: {:?}))]",
        RADIANS.to_degrees() * 1000.0
    );
    let mut spawned = Stage::new("small_turns").spawn(&body).unwrap();
    world::pose(&mut spawned.world, f64::from(TURNS) / 1000.0);
    let mut query = spawned.world.query::<(&Name, &Pose)>();
    let (_, pose) = query.iter().find(|(name, _)| name.0 == "hub").unwrap();
    let [angle, orthogonal] = errors(pose.linear, f64::from(TURNS) * RADIANS);
    println!("angle off by {angle:.1e}, orthogonal to {orthogonal:.1e}");
    assert!(angle <= 1e-9 && orthogonal <= 1e-14, "{angle} {orthogonal}");
}

/// A million entities, each the parent of the next and turned by a thousandth of a radian: f64 products, no recursion.
#[test]
fn a_million_parents_add_up() {
    let mut world = hecs::World::new();
    let turn = Transform {
        rotate: axis_angle_deg(DVec3::Z, RADIANS.to_degrees()),
        ..Transform::default()
    };
    let mut last = world.spawn((turn,));
    for _ in 1..TURNS {
        last = world.spawn((turn, Parent(last)));
    }
    let poses = world::poses(&world, 0.0);
    let pose = poses.of(last);
    let [angle, orthogonal] = errors(pose.linear, f64::from(TURNS) * RADIANS);
    println!("angle off by {angle:.1e}, orthogonal to {orthogonal:.1e}");
    assert!(angle <= 1e-9 && orthogonal <= 1e-9, "{angle} {orthogonal}");
}
