//! Screens right in front of lamps: a shadow ray must reach as far as they stand.

use crate::luxel_side::{Stage, options};
use crate::objs;
use luxel::trace::TraceOptions;

/// Lamps two above the floor, of every kind, with what hides them at a hundred-thousandth of their distance.
const HIDDEN: [(&str, &str); 3] = [
    (
        "square",
        r#"(shape: Mesh("square.obj"), normals: Flat, transform: (translate: (0, 2, 0), rotate: Euler(90, 0, 0), scale: 0.5),
            emissive: (radiance: (9, 9, 9))),
        (shape: Mesh("square.obj"), normals: Flat, transform: (translate: (0, 1.99998, 0), rotate: Euler(90, 0, 0), scale: 0.6),
            material: "black")"#,
    ),
    (
        "ball",
        r#"(shape: Sphere(radius: 0.5), transform: (translate: (0, 2, 0)), emissive: (radiance: (9, 9, 9))),
        (shape: Sphere(radius: 0.50001), transform: (translate: (0, 2, 0)), material: "black")"#,
    ),
    (
        "point",
        r#"(light: Point(intensity: (9, 9, 9)), transform: (translate: (0, 2, 0))),
        (shape: Sphere(radius: 0.00002), transform: (translate: (0, 2, 0)), material: "black")"#,
    ),
];

#[test]
fn a_screen_right_in_front_of_a_lamp_leaves_the_dark() {
    for (name, lamp) in HIDDEN {
        for mis in [true, false] {
            let stage = Stage::new(&format!("screen_{name}_{mis}"))
                .file("square.obj", &objs::square(0.0, 1.0))
                .scene(&format!(
                    r#"camera: (at: (0, 0.4, 1.5), look_at: (0, 0, 0), vfov_deg: 30), render: (size: (16, 16), filter: Box),
                        materials: {{"black": Diffuse(color: Linear(0, 0, 0))}},
                        entities: [(shape: Mesh("square.obj"), normals: Flat, transform: (rotate: Euler(-90, 0, 0), scale: 4)),
                            {lamp}]"#
                ));
            let options = TraceOptions { mis, ..options(1) };
            let sums = stage.sums(0, 64, &options);
            let lit = sums.rgb.iter().filter(|rgb| rgb[0] > 0.0).count();
            assert_eq!(lit, 0, "{name}, mis {mis}: light passes the screen");
        }
    }
}
