//! What must not change a bit: the size of a scene, its place, and a lens without an aperture.

use crate::luxel_side::{Stage, options, trace};
use crate::objs;
use luxel::trace::{Sampler, TileSums, TraceOptions};

const SPP: u32 = 16;

/// One scene with everything in it, scaled by `2^k` and then moved by `shift`. All lengths are multiples of 1/64, so that
/// they are exact at every size and in every place. `test` names the folder: tests run side by side.
fn scene(test: &str, k: i32, shift: [f64; 3], lens: &str) -> Stage {
    let scale = 2f64.powi(k);
    let at = |[x, y, z]: [f64; 3]| {
        let [x, y, z] = [
            x * scale + shift[0],
            y * scale + shift[1],
            z * scale + shift[2],
        ];
        format!("({x}, {y}, {z})")
    };
    let size = |x: f64| x * scale;
    let rgb: Vec<u8> = (0..7 * 5 * 3).map(|k| (k * 89 % 256) as u8).collect();
    Stage::new(&format!("invariant_{test}"))
        .file("room.obj", &objs::cube(true))
        .file("cube.obj", &objs::cube(false))
        .file("ball.obj", &objs::smooth_ball())
        .file("fan.obj", &objs::fan(5, 0.5))
        .png("coat.png", &rgb, 7, 5)
        .scene(&format!(
            r#"camera: (at: {eye}, look_at: {target}, vfov_deg: 65, {lens}), render: (size: (24, 16)),
            background: Linear(0.1, 0.2, 0.3),
            materials: {{"wall": Diffuse(color: Linear(0.7, 0.6, 0.5)), "glass": Glass(ior: 1.5),
                "coat": Plastic(color: Texture("coat.png")), "chrome": Mirror(color: Linear(0.9, 0.9, 0.9)),
                "gold": Metal(color: Linear(0.9, 0.6, 0.2))}},
            entities: [
                (shape: Mesh("room.obj"), normals: Flat, material: "wall", transform: (translate: {origin}, scale: {four})),
                (shape: Sphere(radius: {far}), material: "wall", transform: (translate: {below})),
                (shape: Sphere(radius: {one}), material: "coat", transform: (translate: {a}, rotate: Euler(10, 20, 30))),
                (shape: Sphere(radius: {one}), material: "glass", transform: (translate: {b})),
                (shape: Sphere(radius: {half}), material: "gold", emissive: (radiance: (3, 2, 1)), transform: (translate: {c})),
                (shape: Mesh("fan.obj"), normals: Flat, emissive: (radiance: (6, 7, 8)),
                    transform: (translate: {d}, rotate: Euler(170, 0, 20), scale: {one})),
                (name: "hub", transform: (translate: {e}, rotate: Euler(5, 40, 0))),
                (shape: Mesh("ball.obj"), material: "chrome", parent: "hub", transform: (translate: ({half}, 0, 0), scale: {half})),
                (shape: Mesh("cube.obj"), normals: Flat, material: "wall", transform: (translate: {f}, scale: {half})),
                (shape: Mesh("cube.obj"), normals: Flat, material: "glass", transform: (translate: {g}, scale: {half},
                    rotate: Euler(0, 30, 0))),
            ]"#,
            eye = at([0.5, 0.25, 3.5]),
            target = at([0.0, -0.5, 0.0]),
            origin = at([0.0; 3]),
            below = at([0.0, -(1024.0 + 3.5), 0.0]),
            far = size(1024.0),
            a = at([-1.75, -1.5, -1.0]),
            b = at([1.5, -1.25, 0.5]),
            c = at([-1.0, 1.5, -0.5]),
            d = at([1.0, 3.0, 0.0]),
            e = at([0.25, -1.0, -1.5]),
            f = at([-0.5, -2.0, 1.0]),
            g = at([0.5, -2.25, 1.25]),
            one = size(1.0),
            half = size(0.5),
            four = size(4.0),
        ))
}

fn picture(stage: &Stage) -> TileSums {
    let options = TraceOptions {
        sampler: Sampler::Sobol,
        ..options(6)
    };
    trace(&stage.flat(0, &options), SPP, &options)
}

fn assert_same(name: &str, found: &TileSums, truth: &TileSums) {
    let apart = found
        .rgb
        .iter()
        .zip(&truth.rgb)
        .filter(|(a, b)| a != b)
        .count();
    assert_eq!(
        apart,
        0,
        "{name}: pixels that differ, of {}",
        truth.rgb.len()
    );
}

#[test]
fn powers_of_two_scale_a_scene_to_the_bit() {
    let truth = picture(&scene("size", 0, [0.0; 3], ""));
    let dark = truth.rgb.iter().filter(|rgb| rgb[0] == 0.0).count();
    assert!(
        dark < truth.rgb.len() / 10,
        "{dark} dark pixels say nothing"
    );
    for k in [-20, -10, 10, 20] {
        assert_same(
            &format!("2^{k}"),
            &picture(&scene("size", k, [0.0; 3], "")),
            &truth,
        );
    }
}

#[test]
fn steps_of_the_grid_move_a_scene_to_the_bit() {
    let truth = picture(&scene("place", 0, [0.0; 3], ""));
    for shift in [[1.0, -2.0, 0.5], [4096.0, 1e6, -77.25], [-1e9, 3e8, 2e9]] {
        assert_same(
            &format!("{shift:?}"),
            &picture(&scene("place", 0, shift, "")),
            &truth,
        );
    }
    let [k, shift] = [10, 3];
    let moved = picture(&scene("place", k, [f64::from(shift << k); 3], ""));
    assert_same("scaled and moved", &moved, &truth);
}

#[test]
fn a_lens_without_an_aperture_is_a_pinhole_to_the_bit() {
    let truth = picture(&scene("lens", 0, [0.0; 3], ""));
    let lens = "lens: (aperture_radius: 0, focus_distance: 2.5)";
    assert_same(
        "aperture 0",
        &picture(&scene("lens", 0, [0.0; 3], lens)),
        &truth,
    );
    let open = picture(&scene(
        "lens",
        0,
        [0.0; 3],
        "lens: (aperture_radius: 0.125, focus_distance: 2.5)",
    ));
    assert!(open.rgb != truth.rgb, "an open lens changes the picture");
}
