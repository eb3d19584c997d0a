//! The boxes that the build gives to instances: no ray that hits an instance in its own space misses its box.

use crate::luxel_side::{Stage, options};
use crate::objs;
use luxel::build::Accel;
use luxel::flat::FlatScene;
use luxel::trace::spawn::{instance_point, triangle_vertices};
use luxel::trace::{Hits, Isa, Rays, closest_hit};

/// Small things far from the middle, where what rounds is large beside them.
fn scattered() -> FlatScene {
    let place = |x: f64, y: f64, z: f64, deg: f64, scale: &str| {
        format!(
            r#"(shape: Mesh("ball.obj"), transform: (translate: ({x}, {y}, {z}),
                rotate: AxisAngle(axis: (1, {y}, 2), deg: {deg}), scale: ({scale}))),"#
        )
    };
    let entities = [
        place(31.0, 17.0, -23.0, 17.0, "0.01, 0.01, 0.01"),
        place(-29.0, 11.0, 13.0, 51.0, "0.03, -0.01, 0.02"),
        place(7.0, -31.0, 19.0, 111.0, "0.001, 0.001, 0.001"),
        place(-13.0, -19.0, -31.0, 200.0, "0.1, 0.001, 0.1"),
        place(0.0, 0.0, 0.0, 0.0, "9, 8, 7"),
    ];
    let stage = Stage::new("instance_boxes")
        .file("ball.obj", &objs::smooth_ball())
        .scene(&format!(
            r#"camera: (at: (0, 0, 40), look_at: (0, 0, 0)), render: (size: (1, 1)), entities: [{}]"#,
            entities.concat()
        ));
    stage.flat_by(0, &options(0), Accel::Brute)
}

/// Rays along the sides of the boxes, past the vertices that touch them.
fn grazing(scene: &FlatScene) -> Rays {
    let mut rays = Rays::default();
    for instance in &scene.instances {
        let local = &scene.local[instance.geometry as usize];
        let corners = (0..local.triangles.place.len() as u32)
            .flat_map(|prim| triangle_vertices(&local.triangles, prim))
            .map(|v| instance_point(instance, v));
        let corners: Vec<[f32; 3]> = corners.collect();
        for axis in 0..3 {
            let by_axis = |a: &&[f32; 3], b: &&[f32; 3]| a[axis].total_cmp(&b[axis]);
            let ends = [
                corners.iter().min_by(by_axis),
                corners.iter().max_by(by_axis),
            ];
            for end in ends.into_iter().flatten() {
                for k in 0..200u32 {
                    // Beside the vertex by up to three units in the last place.
                    let mut end = *end;
                    let ulp = end[axis].abs().next_up() - end[axis].abs();
                    end[axis] += ((k % 7) as f32 - 3.0) * ulp;
                    let turn = f64::from(k) * 0.618_034 * std::f64::consts::TAU;
                    let mut from = end;
                    from[(axis + 1) % 3] += 0.3 * turn.cos() as f32;
                    from[(axis + 2) % 3] += 0.3 * turn.sin() as f32;
                    let dir = [0, 1, 2].map(|i| end[i] - from[i]);
                    rays.push(from, dir, f32::MAX);
                }
            }
        }
    }
    rays
}

#[test]
fn boxes_of_instances_cull_no_hit() {
    let scene = scattered();
    assert_eq!(scene.instances.len(), 5);
    let rays = grazing(&scene);
    let mut open = scene.clone();
    for instance in &mut open.instances {
        instance.bounds = [[f32::MIN; 3], [f32::MAX; 3]];
    }
    let [mut boxed, mut free] = [(); 2].map(|()| Hits::default());
    closest_hit(&scene, Isa::best(), &rays, &mut boxed);
    closest_hit(&open, Isa::best(), &rays, &mut free);
    let hits = free.prim.iter().filter(|prim| **prim != Hits::NONE).count();
    let lost = (0..rays.len())
        .filter(|&i| (boxed.instance[i], boxed.prim[i]) != (free.instance[i], free.prim[i]));
    let lost = lost.count();
    println!("{} rays, {hits} hits, {lost} lost to boxes", rays.len());
    assert!(hits > rays.len() / 8 && hits < rays.len());
    assert_eq!(lost, 0);
}
