//! Places and units: a scene in a file's own far coordinates, or in micrometres or kilometres, renders as itself.

use crate::stage::{Stage, cube, obj, picture, points, relmse, triple};
use crate::support::Solid;
use luxel::math::DVec3;
use luxel::trace::{TileSums, TraceOptions};

const SPP: u32 = 16;

/// How a scene is written: every length times `scale`, the vertices of its files moved by `in_file`, everything moved by
/// `shift`. Home is all multiples of 1/64.
#[derive(Clone, Copy)]
struct Written {
    scale: f64,
    in_file: [f64; 3],
    shift: [f64; 3],
    /// Irradiance by the sun.
    sun: f64,
    seed: u64,
}

const HOME: Written = Written {
    scale: 1.0,
    in_file: [0.0; 3],
    shift: [0.0; 3],
    sun: 0.5,
    seed: 0,
};

/// Lamps of every kind, a lens, instances that move, a mesh under a parent.
fn render(name: &str, w: Written, t: f64) -> TileSums {
    let file = |solid: &(Vec<DVec3>, Vec<[usize; 3]>)| {
        let moved = |v: &DVec3| *v * w.scale + DVec3::from(w.in_file);
        obj(&solid.0.iter().map(moved).collect::<Vec<_>>(), &solid.1)
    };
    let mut ball = Solid::icosphere(1);
    for v in &mut ball.vertices {
        *v = (*v * 64.0).round() / 64.0;
    }
    let stage = Stage::new(name)
        .file("cube.obj", &file(&cube()))
        .file("ball.obj", &file(&(points(&ball), ball.faces.clone())));
    // Roots are moved, and put where their file has not moved them to; what hangs under a root is only put back.
    let at = |x: [f64; 3]| triple([0, 1, 2].map(|k| x[k] * w.scale + w.shift[k]));
    let root = |x: [f64; 3], s: f64| {
        triple([0, 1, 2].map(|k| x[k] * w.scale + w.shift[k] - s * w.in_file[k]))
    };
    let child = |x: [f64; 3], s: f64| triple([0, 1, 2].map(|k| x[k] * w.scale - s * w.in_file[k]));
    let size = |x: f64| x * w.scale;
    let bright = |x: f64| x * w.scale * w.scale;
    let body = format!(
        r#"camera: (at: {eye}, look_at: {target}, vfov_deg: 60,
            lens: (aperture_radius: {aperture:?}, focus_distance: {focus:?})),
        materials: {{"wall": Diffuse(color: Linear(0.7, 0.6, 0.5)), "glass": Glass(ior: 1.5),
            "coat": Plastic(color: Linear(0.2, 0.5, 0.3)), "chrome": Mirror(color: Linear(0.9, 0.9, 0.9))}},
        entities: [
            (shape: Mesh("cube.obj"), normals: Flat, material: "wall", transform: (translate: {floor}, scale: 4)),
            (shape: Sphere(radius: {far:?}), material: "wall", transform: (translate: {below})),
            (shape: Sphere(radius: {one:?}), material: "coat", transform: (translate: {a})),
            (shape: Sphere(radius: {half:?}), emissive: (radiance: (6, 5, 4)), transform: (translate: {b})),
            (shape: Mesh("ball.obj"), material: "glass", transform: (translate: {c}, scale: 1)),
            (name: "hub", transform: (translate: {d}), spin: (axis: (0, 1, 0), deg_per_s: 30, pivot: {pivot})),
            (shape: Mesh("ball.obj"), material: "chrome", normals: Smooth(angle_deg: 80), parent: "hub",
                transform: (translate: {e}, scale: 0.5)),
            (light: Point(intensity: ({p:?}, {p:?}, {p:?})), transform: (translate: {f})),
            (light: Spot(intensity: ({q:?}, {q:?}, {p:?}), inner_deg: 20, outer_deg: 45),
                transform: (translate: {g}, rotate: Euler(-60, 20, 0))),
            (light: Sun(irradiance: ({sun:?}, {sun:?}, {sun:?})), transform: (rotate: Euler(-50, 10, 0))),
        ]"#,
        eye = at([0.5, 0.25, 5.5]),
        target = at([0.0, -0.5, 0.0]),
        aperture = size(0.0625),
        focus = size(5.0),
        floor = root([0.0, -6.5, 0.0], 4.0),
        far = size(1024.0),
        below = at([0.0, -1028.0, 0.0]),
        one = size(1.0),
        half = size(0.5),
        a = at([-1.75, -1.5, -1.0]),
        b = at([-1.0, 1.5, -0.5]),
        c = root([1.5, -1.25, 0.5], 1.0),
        d = at([0.25, -1.0, -1.5]),
        pivot = at([0.25, -1.0, -1.5]),
        e = child([0.5, 0.0, 0.0], 0.5),
        p = bright(8.0),
        q = bright(16.0),
        f = at([2.0, 2.0, 2.0]),
        g = at([-2.0, 3.0, 1.0]),
        sun = w.sun,
    );
    let options = TraceOptions {
        max_bounces: 6,
        seed: w.seed,
        ..TraceOptions::default()
    };
    picture(&stage.flat_at(&body, t), SPP, &options)
}

#[track_caller]
fn assert_same(found: &TileSums, truth: &TileSums) {
    let pairs = found.rgb.iter().zip(&truth.rgb);
    let differ = pairs.filter(|(a, b)| a != b).count();
    assert_eq!(differ, 0, "pixels of {} differ", truth.rgb.len());
}

/// 2^±20 is 1e±6: metres for micrometres and for thousands of kilometres.
#[test]
fn every_power_of_two_gives_the_same_bits() {
    let truth = render("units", HOME, 0.0);
    let dark = truth.rgb.iter().filter(|rgb| rgb[0] == 0.0).count();
    assert!(
        dark < truth.rgb.len() / 10,
        "{dark} dark pixels say nothing"
    );
    for k in -20..=20 {
        let scale = 2f64.powi(k);
        assert_same(&render("units", Written { scale, ..HOME }, 0.0), &truth);
    }
}

#[test]
fn a_turned_frame_has_the_same_bits_in_any_place_and_size() {
    let truth = render("frames", HOME, 1.25);
    assert!(truth.rgb != render("frames", HOME, 0.0).rgb, "it turns");
    for (k, shift) in [
        (0, [4096.0, 1e6, -77.25]),
        (14, [1e7; 3]),
        (-7, [0.5, -3.0, 2.0]),
    ] {
        let written = Written {
            scale: 2f64.powi(k),
            shift,
            ..HOME
        };
        assert_same(&render("frames", written, 1.25), &truth);
    }
}

/// The offset stands in the files' vertices, as scans and maps have it, and is taken back by the transforms, or not.
#[test]
fn far_coordinates_in_a_file_cost_no_bit() {
    let truth = render("in_file", HOME, 0.0);
    for far in [[1e3; 3], [1e5, -3e5, 77.25], [1e7, -1e7, 5e6]] {
        let taken_back = Written {
            in_file: far,
            ..HOME
        };
        assert_same(&render("in_file", taken_back, 0.0), &truth);
        let left = Written {
            shift: far,
            ..taken_back
        };
        assert_same(&render("in_file", left, 0.0), &truth);
    }
}

/// Where the grid is not met, the last bits of authored coordinates are lost in f64.
#[test]
fn other_places_change_next_to_nothing() {
    let truth = render("between", HOME, 0.0);
    for far in [1234.567, 1e5 / 3.0, 1e7 / 3.0] {
        let written = Written {
            shift: [far, -0.7 * far, 0.3 * far],
            ..HOME
        };
        let found = relmse(&render("between", written, 0.0), &truth);
        println!("moved by {far}: relMSE {found:.1e}");
        assert!(found <= 1e-6, "{far}: {found}");
    }
}

/// In decimal units every coordinate rounds otherwise: a few paths pass an edge on the other side, and the rest stays. Not
/// so with a sun, whose share of the light samples goes by how wide a scene is between powers of two.
#[test]
fn decimal_units_change_a_few_paths() {
    let home = Written { sun: 0.0, ..HOME };
    let truth = render("decimal", home, 0.0);
    let noise = relmse(&render("decimal", Written { seed: 1, ..home }, 0.0), &truth);
    for (name, scale) in [
        ("micrometres", 1e6),
        ("millimetres", 1e3),
        ("kilometres", 1e-3),
        ("megametres", 1e-6),
    ] {
        let found = render("decimal", Written { scale, ..home }, 0.0);
        let changed =
            |(x, r): &(&[f64; 3], &[f64; 3])| (0..3).any(|k| (x[k] - r[k]).abs() > 1e-4 * r[k]);
        let pixels = found.rgb.iter().zip(&truth.rgb).filter(changed).count();
        let share = relmse(&found, &truth) / noise;
        println!(
            "{name}: {pixels} of {} pixels changed, {share:.4} of the noise",
            truth.rgb.len()
        );
        assert!(
            pixels * 50 <= truth.rgb.len() && share <= 0.1,
            "{name}: {pixels} {share}"
        );
    }
}
