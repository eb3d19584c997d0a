//! What it costs to come from one frame to the next, without tracing: 10,000 instances of one mesh, all turning; a mesh that
//! turns, of 10,000 to 4,000,000 triangles; and one that stands while a small one turns.
//!
//! `cargo bench --bench update`, or `-- 1` for the meshes of up to so many million triangles. Meshes are written to a
//! temporary folder and read from there. Medians of 48 frames, in microseconds; the first frame, which builds the trees,
//! in milliseconds.

use luxel::asset::Loader;
use luxel::build::{BuildTimes, buffer_bytes};
use luxel::math::{DVec3, sin_cos_deg};
use luxel::render::{Renderer, Settings};
use luxel::scene::{self, SceneDesc};
use luxel::world::{self, AuthoringIndex, Pose, Shape, Spawned, Spin, Transform};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[path = "../tests/mutate/memory.rs"]
mod memory;

const FRAMES: u32 = 48;

/// Steps around a ball, and half as many from pole to pole: 10 k, 100 k, 1 M and 4 M triangles.
const BALLS: [u32; 4] = [102, 318, 1002, 2002];

/// Instances of one mesh, and steps around it.
const CROWD: u32 = 10_000;
const MEMBER: u32 = 60;

fn main() {
    let most = std::env::args()
        .filter_map(|a| a.parse::<f64>().ok())
        .next();
    let most = 1e6 * most.unwrap_or(f64::INFINITY);
    let folder = std::env::temp_dir().join(format!("luxel-update-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a temporary folder");
    println!("medians of {FRAMES} frames in µs; first frame in ms\n");
    println!(
        "{:22} {:>9} {:>8} {:>7} {:>8} {:>8} {:>7} {:>8}",
        "scene", "triangles", "first", "pose", "extract", "flatten", "tree", "all"
    );
    crowd(&folder);
    for steps in BALLS
        .into_iter()
        .filter(|&n| f64::from(triangles(n)) <= most)
    {
        fs::write(folder.join("ball.obj"), ball(steps)).expect("writable");
        fs::write(folder.join("small.obj"), ball(20)).expect("writable");
        let turns = "spin: (axis: (1, 2, 3), deg_per_s: 90)";
        let turning = format!("(shape: Mesh(\"ball.obj\"), {turns}),");
        row(
            "it turns",
            triangles(steps),
            &mut renderer(&folder, &turning),
        );
        let standing = format!(
            "(shape: Mesh(\"ball.obj\")), (shape: Mesh(\"small.obj\"), transform: (translate: (3, 0, 0)), {turns}),"
        );
        row(
            "it stands, one turns",
            triangles(steps),
            &mut renderer(&folder, &standing),
        );
    }
    fs::remove_dir_all(&folder).expect("ours");
}

/// Instances without number, all turning, and what each costs.
fn crowd(folder: &Path) {
    fs::write(folder.join("ball.obj"), ball(MEMBER)).expect("writable");
    let (one, alone) = memory::peak(|| instances(folder, 1));
    let (all, peak) = memory::peak(|| instances(folder, CROWD));
    let each = |of_all: usize, of_one: usize| of_all.saturating_sub(of_one) / CROWD as usize;
    println!("\n{CROWD} instances, each:");
    println!("{:6} bytes in the flat scene", each(all, one));
    println!(
        "{:6} bytes of the heap, world and build included, at its peak\n",
        each(peak, alone)
    );
}

/// Renders so many instances, and says how large their flat scene is. They are spawned as the world would spawn them,
/// without a text that the process would have to hold as well.
fn instances(folder: &Path, count: u32) -> usize {
    let turning = "(shape: Mesh(\"ball.obj\"), spin: (axis: (1, 2, 3), deg_per_s: 90)),";
    let (desc, mut spawned) = spawn(folder, turning);
    let mesh = |shape: &Shape| matches!(shape, Shape::Mesh { .. }).then_some(*shape);
    let shape = spawned.world.query::<&Shape>().iter().find_map(mesh);
    let shape = shape.expect("one");
    for i in 1..count {
        let (x, z) = (f64::from(3 * (i % 100)), f64::from(3 * (i / 100)));
        let transform = Transform {
            translate: DVec3::new(x, 0.0, z),
            ..Transform::default()
        };
        let spin = Spin {
            axis: DVec3::new(1.0, 2.0, f64::from(i)),
            deg_per_s: 90.0,
            pivot: None,
        };
        let index = AuthoringIndex {
            entity: i + 1,
            node: 0,
        };
        let rest = Pose::default();
        spawned.world.spawn((index, rest, shape, transform, spin));
    }
    let settings = Settings::of_scene(&desc);
    let renderer = Renderer::new(&desc, spawned.world, &spawned.assets, settings);
    let mut renderer = renderer.expect("threads");
    row(
        &format!("{count} turning"),
        triangles(MEMBER),
        &mut renderer,
    );
    bytes(&mut renderer)
}

fn bytes(renderer: &mut Renderer) -> usize {
    let (scene, _) = renderer.build(1);
    buffer_bytes(&scene).iter().map(|b| b.bytes).sum()
}

/// Prints what frames cost.
fn row(name: &str, triangles: u32, renderer: &mut Renderer) {
    let first = Instant::now();
    renderer.update(0);
    let first = first.elapsed();
    let mut frames = Vec::new();
    for frame in 1..=FRAMES {
        let start = Instant::now();
        let times = renderer.update(frame);
        frames.push((times, start.elapsed()));
    }
    let median = |of: &dyn Fn(&(BuildTimes, Duration)) -> Duration| {
        let mut all: Vec<Duration> = frames.iter().map(of).collect();
        all.sort_unstable();
        all[all.len() / 2].as_secs_f64() * 1e6
    };
    println!(
        "{name:22} {triangles:>9} {:>8.1} {:>7.1} {:>8.1} {:>8.1} {:>7.1} {:>8.1}",
        first.as_secs_f64() * 1e3,
        median(&|f| f.0.pose),
        median(&|f| f.0.extract),
        median(&|f| f.0.flatten),
        median(&|f| f.0.bvh),
        median(&|f| f.1),
    );
}

fn renderer(folder: &Path, entities: &str) -> Renderer {
    let (desc, spawned) = spawn(folder, entities);
    let settings = Settings::of_scene(&desc);
    Renderer::new(&desc, spawned.world, &spawned.assets, settings).expect("threads")
}

fn spawn(folder: &Path, entities: &str) -> (SceneDesc, Spawned) {
    let text = format!(
        "Scene(version: 1, camera: (at: (0, 0, 9), look_at: (0, 0, 0)), render: (size: (8, 8), spp: 1), entities: [
            (shape: Sphere(radius: 1), transform: (translate: (0, 9, 0)), emissive: (radiance: (9, 9, 9))), {entities}])"
    );
    let file: PathBuf = folder.join("scene.ron");
    let (desc, _) = scene::parse(&text, &file).expect("a scene");
    let spawned = world::spawn(&desc, Loader::new()).expect("a world");
    (desc, spawned)
}

/// Of a ball of so many steps around.
fn triangles(steps: u32) -> u32 {
    steps * (steps / 2 - 1) * 2
}

/// A ball of radius 1 as OBJ text: quads between meridians and parallels, triangles at the poles.
fn ball(steps: u32) -> String {
    let rows = steps / 2;
    let mut text = String::from("v 0 1 0\nv 0 -1 0\n");
    for j in 1..rows {
        let (s, c) = sin_cos_deg(180.0 * f64::from(j) / f64::from(rows));
        for i in 0..steps {
            let (sin, cos) = sin_cos_deg(360.0 * f64::from(i) / f64::from(steps));
            // Writing into a String cannot fail, here and below.
            let _ = writeln!(text, "v {} {c} {}", s * cos, -s * sin);
        }
    }
    let at = |j: u32, i: u32| 3 + (j - 1) * steps + i % steps;
    for i in 0..steps {
        let _ = writeln!(text, "f 1 {} {}", at(1, i), at(1, i + 1));
        let _ = writeln!(text, "f 2 {} {}", at(rows - 1, i + 1), at(rows - 1, i));
    }
    for j in 1..rows - 1 {
        for i in 0..steps {
            let (a, b) = (at(j, i), at(j, i + 1));
            let (c, d) = (at(j + 1, i), at(j + 1, i + 1));
            let _ = writeln!(text, "f {a} {c} {d}\nf {a} {d} {b}");
        }
    }
    text
}
