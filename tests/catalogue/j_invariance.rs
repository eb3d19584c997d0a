//! J, A13 and H1: what must not change a bit. The size and the place of a scene are in `tests/light/invariance.rs`.

use crate::book::{Outcome, items};
use crate::luxel_side::{Stage, options};
use crate::objs;
use crate::scenes::{rays_at, twenty};
use crate::stats::assert_agree;
use crate::support::shoot::best;
use luxel::build::{Accel, Quality};
use luxel::render::{Control, Renderer, Settings};
use luxel::trace::{Hits, Isa, Rect, TileSums, TraceOptions, Tracer};

items! {
    j2_mirror(4e4, 4e6): "J2", "twenty scenes and their mirror images: other bits";
    j7_parts(2e3, 2e5): "J7", "samples of a room in one go, one by one, and in parts of any length: other sums";
}

/// What can be said differently about one scene.
#[derive(Clone, Copy)]
struct Look<'a> {
    /// Every length times two to this.
    exponent: i32,
    /// All radiance times two to this.
    light: i32,
    /// Where red, green and blue are written.
    channels: [usize; 3],
    /// Entities at the end.
    more: &'a str,
    /// The faces of the room's cube.
    cube: &'a str,
}

const PLAIN: Look = Look {
    exponent: 0,
    light: 0,
    channels: [0, 1, 2],
    more: "",
    cube: "cube.obj",
};

const SPP: u32 = 16;

fn stage(name: &str, look: Look) -> Stage {
    let scale = 2f64.powi(look.exponent);
    let light = 2f64.powi(look.light);
    let at = |x: f64, y: f64, z: f64| {
        format!(
            "translate: ({:?}, {:?}, {:?})",
            x * scale,
            y * scale,
            z * scale
        )
    };
    let rgb = |c: [f64; 3]| {
        let [r, g, b] = look.channels.map(|k| c[k]);
        format!("({r:?}, {g:?}, {b:?})")
    };
    let color = |r: f64, g: f64, b: f64| format!("Linear{}", rgb([r, g, b]));
    let shining = |c: [f64; 3]| format!("emissive: (radiance: {})", rgb(c.map(|x| x * light)));
    let size = |x: f64| format!("{:?}", x * scale);
    Stage::new(&format!("catalogue_{name}"))
        .file("cube.obj", &objs::cube(true))
        .file("fine.obj", &split(&objs::cube(true)))
        .file("out.obj", &objs::cube(false))
        .file("ball.obj", &objs::smooth_ball())
.file("hidden.obj", &objs::smooth_ball())
        .scene(&format!(
            r#"camera: (at: ({e0}, {e1}, {e2}), look_at: (0, {l1}, 0), vfov_deg: 65), render: (size: (24, 16)),
            background: {sky}, materials: {{"wall": Diffuse(color: {wall}), "glass": Glass(ior: 1.5),
                "coat": Plastic(color: {coat}), "chrome": Mirror(color: {chrome}), "gold": Metal(color: {gold})}},
            entities: [
                (shape: Mesh("{cube}"), normals: Flat, material: "wall", transform: (scale: {four})),
                (shape: Sphere(radius: {one}), material: "coat", transform: ({a})),
                (shape: Sphere(radius: {one}), material: "glass", transform: ({b})),
                (shape: Sphere(radius: {half}), material: "gold", {shine}, transform: ({c})),
                (shape: Mesh("ball.obj"), material: "chrome", transform: ({d}, scale: {half})),
                (shape: Mesh("out.obj"), normals: Flat, material: "wall", transform: ({f}, scale: {half})),
                {more}
            ]"#,
            e0 = size(0.5),
            e1 = size(0.25),
            e2 = size(3.5),
            l1 = size(-0.5),
            sky = color(0.1 * light, 0.2 * light, 0.3 * light),
            wall = color(0.7, 0.6, 0.5),
            coat = color(0.2, 0.5, 0.8),
            chrome = color(0.9, 0.8, 0.7),
            gold = color(0.9, 0.6, 0.2),
            cube = look.cube,
            four = size(4.0),
            one = size(1.0),
            half = size(0.5),
            a = at(-1.75, -1.5, -1.0),
            b = at(1.5, -1.25, 0.5),
            c = at(-1.0, 1.5, -0.5),
            d = at(0.25, -1.0, -1.5),
            f = at(-0.5, -2.0, 1.0),
            shine = shining([6.0, 5.0, 4.0]),
            more = look.more,
        ))
}

/// Every triangle in four, by the middles of its sides.
fn split(obj: &str) -> String {
    use std::fmt::Write;
    let numbers = |line: &str| -> Vec<f64> {
        line.split_whitespace()
            .skip(1)
            .map(|x| x.parse().expect("a number"))
            .collect()
    };
    let lines = |key: &str| {
        obj.lines()
            .filter(move |l| l.starts_with(key))
            .map(numbers)
            .collect::<Vec<_>>()
    };
    let (vertices, faces) = (lines("v "), lines("f "));
    let (mut text, mut n) = (String::new(), 0);
    for face in faces {
        let v = [0, 1, 2].map(|k| vertices[face[k] as usize - 1].clone());
        let middle = |a: &[f64], b: &[f64]| [0, 1, 2].map(|k| 0.5 * (a[k] + b[k])).to_vec();
        let m = [
            middle(&v[0], &v[1]),
            middle(&v[1], &v[2]),
            middle(&v[2], &v[0]),
        ];
        for corner in v.iter().chain(&m) {
            writeln!(text, "v {} {} {}", corner[0], corner[1], corner[2]).expect("a string");
        }
        for [a, b, c] in [[1, 4, 6], [4, 2, 5], [6, 5, 3], [4, 5, 6]] {
            writeln!(text, "f {} {} {}", n + a, n + b, n + c).expect("a string");
        }
        n += 6;
    }
    text
}

fn sums(stage: &Stage) -> TileSums {
    stage.sums(0, SPP, &options(6))
}

/// A13: scales at which f32 itself ends.
#[test]
fn scenes_of_any_size_give_the_same_bits() {
    let truth = sums(&stage("a13", PLAIN));
    assert!(truth.rgb.iter().filter(|rgb| rgb[0] > 0.0).count() > 300);
    for exponent in [-100, -60, 60, 100] {
        let look = Look { exponent, ..PLAIN };
        assert!(sums(&stage("a13", look)).rgb == truth.rgb, "2^{exponent}");
    }
}

/// J6.
#[test]
fn light_scales_and_channels_swap_to_the_bit() {
    let truth = sums(&stage("j6", PLAIN));
    for light in [-40, -1, 1, 40] {
        let found = sums(&stage("j6", Look { light, ..PLAIN }));
        let scale = 2f64.powi(light);
        let apart = found
            .rgb
            .iter()
            .zip(&truth.rgb)
            .filter(|(a, b)| a.map(|x| x / scale) != **b);
        assert_eq!(apart.count(), 0, "2^{light}");
    }
    for channels in [[1, 2, 0], [2, 1, 0]] {
        let found = sums(&stage("j6", Look { channels, ..PLAIN }));
        let swapped = truth.rgb.iter().map(|rgb| channels.map(|k| rgb[k]));
        assert!(found.rgb.iter().copied().eq(swapped), "{channels:?}");
    }
}

/// J8, one half: inside the closed box in the room.
#[test]
fn what_no_ray_sees_changes_no_bit() {
    let truth = sums(&stage("j8", PLAIN));
    let more = r#"(shape: Sphere(radius: 0.25), material: "gold", transform: (translate: (-0.5, -2.0, 1.0))),
        (shape: Mesh("hidden.obj"), material: "glass", transform: (translate: (-0.5, -2.0, 1.0), scale: 0.3)),"#;
    let found = sums(&stage("j8", Look { more, ..PLAIN }));
    assert!(found.rgb == truth.rgb);
}

/// J8, the other half: the same surface, cut otherwise.
#[test]
fn triangles_cut_in_four_look_the_same() {
    let picture = |cube: &str| {
        let stage = stage("j8_cut", Look { cube, ..PLAIN });
        stage.luxel(0, 256, &options(6))
    };
    let (truth, found) = (picture("cube.obj"), picture("fine.obj"));
    assert_agree("cut in four", &found, &truth, 0.03);
}

/// J3: all that may differ from run to run.
#[test]
fn threads_tiles_trees_and_instruction_sets_change_no_bit() {
    let stage = stage("j3", PLAIN);
    let desc = stage.describe();
    let film = |change: &dyn Fn(&mut Settings)| {
        let spawned = luxel::world::spawn(&desc, luxel::asset::Loader::new()).expect("its files");
        let mut settings = Settings::of_scene(&desc);
        settings.spp = 4;
        change(&mut settings);
        let renderer = Renderer::new(&desc, spawned.world, &spawned.assets, settings);
        renderer
            .expect("threads")
            .render(0, &Control::default())
            .film
            .radiance()
    };
    let truth = film(&|s| s.threads = Some(1));
    assert!(truth.iter().filter(|rgb| rgb[0] > 0.0).count() > 300);
    for threads in [2, 3, 7] {
        for tile in [1, 5, 8, 64] {
            let found = film(&|s| (s.threads, s.tile) = (Some(threads), tile));
            assert!(found == truth, "{threads} threads, tiles of {tile}");
        }
    }
    for isa in Isa::all() {
        for accel in [Accel::Brute, Accel::Box, Accel::Bvh] {
            for quality in [Quality::Good, Quality::Fast] {
                let found = film(&|s| (s.trace.isa, s.accel, s.quality) = (isa, accel, quality));
                assert!(found == truth, "{isa:?} {accel:?} {quality:?}");
            }
        }
    }
}

fn j2_mirror(trials: u64) -> Outcome {
    let mut rng = crate::support::Rng(61);
    let mut outcome = Outcome::default();
    for (_, mut parts) in twenty() {
        // Transforms are rounded each by itself; their mirror images are not those of the rounded ones.
        parts.instances.clear();
        let each = trials as usize / 20;
        let rays = rays_at(&parts, each, &mut rng);
        let truth = best(&parts.scene(Accel::Bvh), &rays);
        let axis = rng.below(3);
        let mut mirrored = parts.clone();
        mirrored
            .triangles
            .iter_mut()
            .flatten()
            .for_each(|v| v[axis] = -v[axis]);
        let spheres = mirrored.tree_spheres.iter_mut().chain(&mut mirrored.looped);
        spheres.for_each(|s| s.0[axis] = -s.0[axis]);
        let mut other = rays.clone();
        other.origin[axis]
            .iter_mut()
            .chain(&mut other.dir[axis])
            .for_each(|x| *x = -*x);
        let found = best(&mirrored.scene(Accel::Bvh), &other);
        // The sign of a weight of zero is nobody's.
        let bits = |h: &Hits, i: usize| {
            let numbers = [h.t[i], h.u[i] + 0.0, h.v[i] + 0.0, h.err[i]];
            (numbers.map(f32::to_bits), h.prim[i])
        };
        let differ = (0..each)
            .filter(|&i| bits(&truth, i) != bits(&found, i))
            .count();
        outcome.add(Outcome::new(each, differ));
    }
    outcome
}

fn j7_parts(trials: u64) -> Outcome {
    let options = options(6);
    let flat = stage("j7", PLAIN).flat(0, &options);
    let rect = Rect {
        x: 0,
        y: 0,
        width: flat.camera.width,
        height: flat.camera.height,
    };
    let pixels = u64::from(rect.width * rect.height);
    let spp = (trials / pixels).max(64) as u32;
    let by = |parts: &dyn Fn(u32) -> u32, options: &TraceOptions| {
        let mut sums = TileSums::default();
        let (mut tracer, mut start) = (Tracer::new(&flat, options), 0);
        while start < spp {
            let end = (start + parts(start)).min(spp);
            tracer.trace_tile(rect, start..end, &mut sums);
            start = end;
        }
        (sums.rgb, sums.rgb_squared)
    };
    let truth = by(&|_| spp, &options);
    let mut outcome = Outcome::default();
    let ways: [&dyn Fn(u32) -> u32; 4] = [&|_| 1, &|_| 8, &|s| 1 + s % 7, &|s| s.max(1)];
    for parts in ways {
        let same = by(parts, &options) == truth;
        outcome.add(Outcome::new(
            (u64::from(spp) * pixels) as usize,
            usize::from(!same),
        ));
    }
    outcome
}
