//! Textures in their place: texture coordinates by corner, of the closest hit, carried along by every transform; and
//! colours against an f64 look-up.

use crate::luxel_side::{Stage, options};
use crate::objs;
use crate::reference::{Image, Scene, Shape, Wrap, closest};
use glam::DVec2;
use luxel::trace::{TileSums, TraceOptions};
use std::fmt::Write;

/// Texture coordinates in f32, interpolated: a few roundings of numbers up to 4.
const UV_TOLERANCE: f64 = 2e-5;

/// Hits this close to a triangle's border (barycentric) may see its neighbour.
const BORDER: f64 = 1e-4;

/// No two texels alike, not square, no symmetry.
const WIDTH: u32 = 7;
const HEIGHT: u32 = 5;

fn coat() -> Vec<u8> {
    (0..WIDTH * HEIGHT * 3)
        .map(|k| (k * k * 31 + k * 89 + 17) as u8)
        .collect()
}

/// A tetrahedron whose faces share positions but not texture coordinates: every edge is a seam.
fn seamed() -> String {
    let mut text = String::from("v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\n");
    let faces = [[1, 3, 2], [1, 2, 4], [1, 4, 3], [2, 3, 4]];
    for (k, face) in faces.iter().enumerate() {
        let k = k as f64;
        let (u, v) = (0.37 * k - 0.4, 0.9 - 0.61 * k);
        writeln!(
            text,
            "vt {u} {v}\nvt {} {}\nvt {} {}",
            u + 0.9,
            v + 0.1,
            u + 0.2,
            v + 1.3
        )
        .expect("a string");
        let c = 3 * k as usize;
        writeln!(
            text,
            "f {}/{} {}/{} {}/{}",
            face[0],
            c + 1,
            face[1],
            c + 2,
            face[2],
            c + 3
        )
        .expect("a string");
    }
    text
}

fn ids() -> TraceOptions {
    TraceOptions {
        ids: true,
        ..options(0)
    }
}

/// uv, triangle and entity of every pixel against the reference, except at borders of triangles and of the picture's
/// shapes. Returns the number of pixels compared.
fn assert_uv(name: &str, sums: &TileSums, scene: &Scene, first_of_entity: &[usize]) -> usize {
    let camera = &scene.camera;
    let (mut compared, mut borders) = (0, 0);
    for y in 0..camera.height {
        for x in 0..camera.width {
            let i = (y * camera.width + x) as usize;
            let ray = camera.through(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let Some(hit) = closest(scene, &ray) else {
                assert!(
                    sums.prim[i] == u32::MAX || near_edge(scene, x, y),
                    "{name}: pixel {x}, {y} hits"
                );
                continue;
            };
            if hit.margin < BORDER {
                borders += 1;
                continue;
            }
            let entity = scene.surfaces[hit.surface].entity;
            assert_eq!(
                sums.entity[i], entity as u32,
                "{name}: entity of pixel {x}, {y}"
            );
            let prim = hit.surface - first_of_entity[entity];
            assert_eq!(
                sums.prim[i], prim as u32,
                "{name}: triangle of pixel {x}, {y}"
            );
            let found = DVec2::new(f64::from(sums.uv[i][0]), f64::from(sums.uv[i][1]));
            assert!(
                (found - hit.uv).abs().max_element() < UV_TOLERANCE,
                "{name}: pixel {x}, {y} has uv {found}, expected {}",
                hit.uv
            );
            compared += 1;
        }
    }
    println!("{name}: {compared} pixels compared, {borders} at borders");
    assert!(
        borders * 50 <= compared,
        "{name}: too many borders to mean much"
    );
    compared
}

/// Whether the reference hits something from close by: a silhouette.
fn near_edge(scene: &Scene, x: u32, y: u32) -> bool {
    let camera = &scene.camera;
    [(0.499, 0.5), (0.501, 0.5), (0.5, 0.499), (0.5, 0.501)]
        .into_iter()
        .any(|(dx, dy)| {
            closest(scene, &camera.through(f64::from(x) + dx, f64::from(y) + dy)).is_some()
        })
}

fn first_of_entity(scene: &Scene, entities: usize) -> Vec<usize> {
    (0..entities)
        .map(|e| {
            scene
                .surfaces
                .iter()
                .position(|s| s.entity == e)
                .unwrap_or(0)
        })
        .collect()
}

const VIEW: &str =
    "camera: (at: (0.3, 0.5, 6), look_at: (0, 0, 0), vfov_deg: 35), render: (size: (64, 48)),";
const COAT: &str = r#"materials: {"coat": Diffuse(color: Texture("coat.png"))},"#;

#[test]
fn texture_coordinates_turn_with_the_mesh() {
    for (k, rotate) in [
        "Euler(0, 0, 0)",
        "Euler(0, 45, 0)",
        "Euler(0, 90, 0)",
        "Euler(17, 200, -33)",
        "AxisAngle(axis: (1, 2, 3), deg: 251)",
        "Quat(0.3, -0.2, 0.9, 0.1)",
    ]
    .into_iter()
    .enumerate()
    {
        let stage = Stage::new(&format!("turned_{k}"))
            .file("seamed.obj", &seamed())
            .png("coat.png", &coat(), WIDTH, HEIGHT)
            .scene(&format!(
                r#"{VIEW} {COAT} entities: [(shape: Mesh("seamed.obj"), normals: Flat, material: "coat",
                    transform: (rotate: {rotate}))]"#
            ));
        let scene = stage.reference_scene(0);
        let sums = stage.sums(0, 1, &ids());
        assert!(assert_uv(rotate, &sums, &scene, &[0]) > 300);
    }
}

#[test]
fn texture_coordinates_turn_with_instances_and_spins() {
    let stage = Stage::new("spun")
        .file("seamed.obj", &seamed())
        .png("coat.png", &coat(), WIDTH, HEIGHT)
        .scene(&format!(
            r#"{VIEW} {COAT} entities: [
                (name: "hub", spin: (axis: (0, 1, 0), deg_per_s: 90)),
                (shape: Mesh("seamed.obj"), normals: Flat, material: "coat", parent: "hub",
                    transform: (translate: (1.1, 0, 0), scale: (0.7, 0.7, -0.7))),
                (shape: Mesh("seamed.obj"), normals: Flat, material: "coat", parent: "hub",
                    transform: (translate: (-0.9, 0.1, 0), rotate: Euler(30, 60, 90), scale: (0.9, 0.6, 0.7)))],
                animation: (fps: 24, frames: 0..96)"#
        ));
    for frame in [0, 5, 24, 71] {
        let scene = stage.reference_scene(frame);
        let sums = stage.sums(frame, 1, &ids());
        let first = first_of_entity(&scene, 3);
        assert!(assert_uv(&format!("frame {frame}"), &sums, &scene, &first) > 300);
    }
}

/// The camera turns with the mesh: the picture of uv must stay. No oracle is needed.
#[test]
fn turning_mesh_and_camera_together_changes_nothing() {
    let sums: Vec<TileSums> = [("0, 0, 6", 0.0), ("6, 0, 0", 90.0), ("0, 0, -6", 180.0)]
        .into_iter()
        .map(|(at, deg)| {
            Stage::new(&format!("together_{deg}"))
                .file("seamed.obj", &seamed())
                .scene(&format!(
                    r#"camera: (at: ({at}), look_at: (0, 0, 0), vfov_deg: 35), render: (size: (63, 49)),
                    entities: [(shape: Mesh("seamed.obj"), normals: Flat,
                    transform: (rotate: Euler(0, {deg}, 0)))]"#
                ))
                .sums(0, 1, &ids())
        })
        .collect();
    for turned in &sums[1..] {
        let apart = turned
            .uv
            .iter()
            .zip(&sums[0].uv)
            .filter(|(a, b)| (0..2).any(|k| f64::from((a[k] - b[k]).abs()) > UV_TOLERANCE))
            .count();
        // Rays through pixel centres meet the edges in the planes of symmetry exactly; either side may have them.
        println!("{apart} of {} pixels differ", sums[0].uv.len());
        assert!(apart <= 63 + 49);
    }
}

/// Quads in many layers, in no order of depth, each with its own uv: what shows is the nearest one's.
#[test]
fn attributes_are_those_of_the_closest_hit() {
    const LAYERS: usize = 40;
    let mut text = String::new();
    for k in 0..LAYERS {
        let z = (k * 17 % LAYERS) as f64 * 0.05;
        let (x, y) = ((k % 7) as f64 * 0.3 - 1.0, (k % 5) as f64 * 0.4 - 0.9);
        let size = 0.4 + 0.03 * (k % 11) as f64;
        for (dx, dy) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            writeln!(
                text,
                "v {} {} {z}\nvt {k} {}",
                x + dx * size,
                y + dy * size,
                dx + 2.0 * dy
            )
            .expect("a string");
        }
        let c = 4 * k + 1;
        writeln!(
            text,
            "f {c}/{c} {0}/{0} {1}/{1}\nf {c}/{c} {1}/{1} {2}/{2}",
            c + 1,
            c + 2,
            c + 3
        )
        .expect("a string");
    }
    let stage = Stage::new("layers")
        .file("layers.obj", &text)
        .scene(&format!(
            r#"{VIEW} entities: [(shape: Mesh("layers.obj"), normals: Flat)]"#
        ));
    let scene = stage.reference_scene(0);
    assert!(assert_uv("layers", &stage.sums(0, 1, &ids()), &scene, &[0]) > 300);
}

/// One quad per pixel with one uv each: a pixel's radiance under a white sky is its texel, to the last rounding.
#[test]
fn colors_are_those_of_the_texture() {
    const SIDE: usize = 24;
    let mut text = String::new();
    let mut wanted = Vec::new();
    for row in 0..SIDE {
        for column in 0..SIDE {
            let i = row * SIDE + column;
            // Multiples of 1/64 around whole numbers and texel borders from −2 to 3, exact in f32, none on a border.
            let uv = [i * 37 % 320, i * 53 % 320].map(|k| (k as f64 + 0.3125) / 64.0 - 2.0);
            let middle = |k: usize| (k as f64 + 0.5) - SIDE as f64 / 2.0;
            let (x, y) = (middle(column), -middle(row));
            for (dx, dy) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
                writeln!(text, "v {} {} 0", x + dx, y + dy).expect("a string");
            }
            writeln!(text, "vt {} {}", uv[0], uv[1]).expect("a string");
            let (c, t) = (4 * i + 1, i + 1);
            writeln!(
                text,
                "f {c}/{t} {}/{t} {}/{t}\nf {c}/{t} {}/{t} {}/{t}",
                c + 1,
                c + 2,
                c + 2,
                c + 3
            )
            .expect("a string");
            wanted.push(DVec2::new(uv[0], uv[1]));
        }
    }
    // Pixels are quads at distance 24 / 2 / tan(vfov / 2).
    let distance = 20.0 * SIDE as f64;
    let vfov = 2.0 * (0.5 * SIDE as f64 / distance).atan().to_degrees();
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        for bilinear in [true, false] {
            let filter = if bilinear { "Bilinear" } else { "Nearest" };
            let stage = Stage::new(&format!("texels_{wrap:?}_{filter}"))
                .file("quads.obj", &text)
                .png("coat.png", &coat(), WIDTH, HEIGHT)
                .scene(&format!(
                    r#"camera: (at: (0, 0, {distance}), look_at: (0, 0, 0), vfov_deg: {vfov}),
                    render: (size: ({SIDE}, {SIDE}), filter: Box), background: Linear(1, 1, 1),
                    materials: {{"coat": Diffuse(color: Image(path: "coat.png", wrap: {wrap:?}, filter: {filter}))}},
                    entities: [(shape: Mesh("quads.obj"), normals: Flat, material: "coat")]"#
                ));
            let sums = stage.sums(0, 1, &options(1));
            let image = Image {
                wrap: [wrap; 2],
                bilinear,
                ..Image::from_srgb(&coat(), WIDTH as usize, HEIGHT as usize)
            };
            for (i, uv) in wanted.iter().enumerate() {
                let truth = image.look_up(*uv).to_array();
                for c in 0..3 {
                    assert!(
                        (sums.rgb[i][c] - truth[c]).abs() < 2e-5,
                        "{wrap:?} {filter}: uv {uv} is {:?}, expected {truth:?}",
                        sums.rgb[i]
                    );
                }
            }
        }
    }
}

/// The top of an image is v = 1: the upper half of an upright square shows the upper half of the picture.
#[test]
fn v_points_up() {
    let rgb = [255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255];
    let sums = Stage::new("v_up")
        .file("square.obj", &objs::square(0.0, 1.0))
        .png("four.png", &rgb, 2, 2)
        .scene(
            r#"camera: (at: (0, 0, 9), look_at: (0, 0, 0), vfov_deg: 6), render: (size: (2, 2), filter: Box),
            background: Linear(1, 1, 1), materials: {"four": Diffuse(color: Image(path: "four.png", filter: Nearest))},
            entities: [(shape: Mesh("square.obj"), normals: Flat, material: "four")]"#,
        )
        .sums(0, 1, &options(1));
    let expected = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
    ];
    assert_eq!(sums.rgb, expected);
}

#[test]
fn the_oracle_places_shapes_as_written() {
    let scene = Stage::new("placed")
        .file("square.obj", &objs::square(0.0, 1.0))
        .scene(&format!(
            r#"{VIEW} entities: [(shape: Mesh("square.obj"), normals: Flat,
            transform: (translate: (1, 2, 3), rotate: Euler(0, 90, 0), scale: (2, 3, 1)))]"#
        ))
        .reference_scene(0);
    let Shape::Triangle { p, .. } = &scene.surfaces[0].shape else {
        panic!("a triangle")
    };
    let expected = [[1.0, -1.0, 5.0], [1.0, -1.0, 1.0], [1.0, 5.0, 1.0]];
    for (found, expected) in p.iter().zip(expected) {
        assert!(
            (*found - glam::DVec3::from(expected)).length() < 1e-12,
            "{found}"
        );
    }
}
