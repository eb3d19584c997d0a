//! Chains of transforms: what f64 composes must reach f32 with one rounding, however skewed it is; and transforms that are
//! none are refused or stay finite.

use crate::stage::{Stage, cube, obj, picture, points};
use crate::support::{Rng, Solid};
use luxel::flat::FlatScene;
use luxel::math::{DMat3, DVec3};
use luxel::trace::TraceOptions;
use luxel::trace::spawn::triangle_vertices;
use std::fmt::Write;

/// One level: q as x, y, z, w of any length, and a scale.
pub(crate) struct Level {
    q: [f64; 4],
    pub(crate) scale: DVec3,
    pub(crate) translate: DVec3,
}

impl Level {
    pub(crate) fn random(rng: &mut Rng, decades: f64) -> Level {
        let pick = |rng: &mut Rng| DVec3::from([(); 3].map(|()| rng.range(-1.0, 1.0)));
        let scale = [(); 3].map(|()| 10f64.powf(rng.range(-decades, decades)));
        Level {
            q: [(); 4].map(|()| rng.range(-1.0, 1.0)),
            scale: DVec3::from(scale),
            translate: pick(rng),
        }
    }

    /// T · R · S of a point, R by two cross products: p + 2 v × (v × p + w p), for a unit quaternion.
    pub(crate) fn apply(&self, p: DVec3) -> DVec3 {
        let p = p * self.scale;
        let [x, y, z, w] = self.q;
        let v = DVec3::new(x, y, z);
        let s = 2.0 / (v.length_squared() + w * w);
        p + s * v.cross(v.cross(p) + w * p) + self.translate
    }

    pub(crate) fn text(&self) -> String {
        let [t, s] = [self.translate, self.scale].map(|v| format!("{:?}", v.to_array()));
        let tuple = |s: String| s.replace('[', "(").replace(']', ")");
        let q = tuple(format!("{:?}", self.q));
        format!(
            "transform: (translate: {}, rotate: Quat{q}, scale: {})",
            tuple(t),
            tuple(s)
        )
    }
}

fn chain_scene(levels: &[Level]) -> String {
    let mut text = "camera: (at: (0, 0, 0), look_at: (0, 0, -1)), entities: [".to_owned();
    for (k, level) in levels.iter().enumerate() {
        let parent = match k {
            0 => String::new(),
            _ => format!("parent: \"l{}\",", k - 1),
        };
        let shape = match k + 1 == levels.len() {
            true => "shape: Mesh(\"mesh.obj\"), normals: Flat,",
            false => "",
        };
        writeln!(text, "(name: \"l{k}\", {parent} {shape} {}),", level.text()).unwrap();
    }
    text + "]"
}

/// The largest distance of a vertex from `exact`, in units of the last place of its vertex's largest coordinate.
fn worst(flat: &FlatScene, faces: &[[usize; 3]], exact: impl Fn(usize) -> DVec3) -> f64 {
    let (origin, scale) = (DVec3::from(flat.rebase.origin), flat.rebase.scale);
    let mut worst: f64 = 0.0;
    for (prim, face) in (0..).zip(faces) {
        // A chain that mirrors swaps two corners; none here does.
        let found = triangle_vertices(&flat.world.triangles, prim);
        for (found, corner) in found.iter().zip(face) {
            let wanted = (exact(*corner) - origin) * scale;
            let found = DVec3::from(found.map(f64::from));
            let size = wanted.abs().max_element() as f32;
            let ulp = f64::from(size.next_up()) - f64::from(size);
            worst = worst.max((found - wanted).abs().max_element() / ulp);
        }
    }
    worst
}

/// Ratio of the longest to the shortest axis of what the chain makes of a ball: by iterating MᵀM and its inverse.
fn condition(levels: &[Level]) -> f64 {
    let apply = |p| levels.iter().rev().fold(p, |p, level| level.apply(p));
    let o = apply(DVec3::ZERO);
    let m = DMat3::from_cols(
        apply(DVec3::X) - o,
        apply(DVec3::Y) - o,
        apply(DVec3::Z) - o,
    );
    let longest = |m: DMat3| {
        let mut v = DVec3::new(0.6, 0.5, 0.4);
        for _ in 0..200 {
            v = (m.transpose() * (m * v)).normalize();
        }
        (m * v).length()
    };
    longest(m) * longest(m.inverse())
}

#[test]
fn a_chain_of_eight_is_rounded_once() {
    let solid = Solid::icosphere(2);
    let (vertices, faces) = (points(&solid), &solid.faces);
    let stage = Stage::new("chains").file("mesh.obj", &obj(&vertices, faces));
    let mut rng = Rng(21);
    let (mut most, mut steepest): (f64, f64) = (0.0, 0.0);
    for _ in 0..60 {
        let levels: Vec<Level> = std::iter::repeat_with(|| {
            let levels: Vec<Level> = (0..8).map(|_| Level::random(&mut rng, 0.75)).collect();
            (condition(&levels), levels)
        })
        .find(|(condition, _)| (1e4..=1e6).contains(condition))
        .unwrap()
        .1;
        steepest = steepest.max(condition(&levels));
        let flat = stage.flat(&chain_scene(&levels));
        let exact = |i: usize| levels.iter().rev().fold(vertices[i], |p, l| l.apply(p));
        most = most.max(worst(&flat, faces, exact));
    }
    println!("condition numbers to {steepest:.1e}: at most {most:.4} units in the last place");
    assert!(steepest > 1e5, "{steepest}");
    // Half a unit is the one rounding; f64 adds what it loses to the condition number.
    assert!(most <= 0.51, "{most}");
}

#[test]
fn quaternions_have_any_length() {
    let solid = Solid::icosphere(1);
    let (vertices, faces) = (points(&solid), &solid.faces);
    let stage = Stage::new("quaternions").file("mesh.obj", &obj(&vertices, faces));
    let mut rng = Rng(22);
    for _ in 0..10 {
        let mut level = Level::random(&mut rng, 0.0);
        let unit = level.q;
        let bits = |level: &Level| {
            let flat = stage.flat(&chain_scene(std::slice::from_ref(level)));
            let worst = worst(&flat, faces, |i| level.apply(vertices[i]));
            let vertices =
                (0..faces.len() as u32).map(|i| triangle_vertices(&flat.world.triangles, i));
            (worst, vertices.collect::<Vec<_>>())
        };
        let (error, home) = bits(&level);
        assert!(error <= 0.51, "{error}");
        for k in [-66, -20, 20, 66] {
            level.q = unit.map(|c| c * 2f64.powi(k));
            assert!(bits(&level).1 == home, "2^{k}");
        }
        for size in [1e-20, 1e-7, 1e7, 1e20] {
            level.q = unit.map(|c| c * size);
            let (error, _) = bits(&level);
            assert!(error <= 0.51, "{size}: {error}");
        }
    }
}

#[test]
fn rotations_that_are_none_are_refused_by_name() {
    let stage = Stage::new("no_rotation").file("mesh.obj", &obj(&cube().0, &cube().1));
    let scene = |transform: &str| {
        let body = format!(
            "camera: (at: (0, 0, 5), look_at: (0, 0, 0)), entities: [
             (name: \"fine\", shape: Sphere(radius: 1)),
             (name: \"broken\", shape: Mesh(\"mesh.obj\"), transform: ({transform}))]"
        );
        stage.spawn(&body).map(|_| ())
    };
    for (transform, code) in [
        ("rotate: Quat(0, 0, 0, 0)", "E016"),
        ("rotate: Quat(0, NaN, 0, 1)", "E010"),
        ("rotate: Quat(0, inf, 0, 1)", "E010"),
        ("rotate: AxisAngle(axis: (0, 0, 0), deg: 3)", "E016"),
        ("scale: (1, 0, 1)", "E022"),
        ("scale: 0", "E022"),
    ] {
        let told = scene(transform).unwrap_err();
        // The place is that of the entity: its line is the third of the text.
        assert!(
            told.contains(code) && told.contains(":3:"),
            "{transform}: {told}"
        );
    }
    assert!(scene("rotate: Quat(0, 1e-20, 0, 1e-20)").is_ok());
}

/// Flat to the last bit of what f32 can hold, once and as instances: rendered as a sheet, and nothing is lost.
#[test]
fn flattened_meshes_stay_finite() {
    let (vertices, faces) = cube();
    let stage = Stage::new("flattened").file("cube.obj", &obj(&vertices, &faces));
    let scene = |thickness: f64, more: &str| {
        format!(
            r#"camera: (at: (0, 2, 5), look_at: (0, 0, 0), vfov_deg: 40),
            materials: {{"wall": Diffuse(color: Linear(0.7, 0.6, 0.5)), "glass": Glass(ior: 1.5)}},
            entities: [(shape: Mesh("cube.obj"), normals: Flat, material: "wall", {more}
                transform: (rotate: Euler(10, 20, 30), scale: (1, {thickness:?}, 1))),
            (shape: Mesh("cube.obj"), normals: Flat, material: "glass", {more}
                transform: (translate: (0, 1, 0), rotate: Euler(40, 0, 10), scale: (1, 1, {thickness:?})))]"#
        )
    };
    let spin = "spin: (axis: (0, 1, 0), deg_per_s: 10),";
    let sheet = picture(&stage.flat(&scene(1e-9, "")), 16, &TraceOptions::default());
    for thickness in [1e-12, 1e-40, 1e-100] {
        for more in ["", spin] {
            let flat = stage.flat(&scene(thickness, more));
            let found = picture(&flat, 16, &TraceOptions::default());
            let mean = |sums: &luxel::trace::TileSums| {
                sums.rgb.iter().map(|rgb| rgb[1]).sum::<f64>() / sums.rgb.len() as f64 / 16.0
            };
            let (found, wanted) = (mean(&found), mean(&sheet));
            assert!(
                (found / wanted - 1.0).abs() < 0.02,
                "{thickness} {more}: {found} {wanted}"
            );
        }
    }
}
