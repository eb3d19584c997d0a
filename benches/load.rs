//! A mesh of a million triangles, from its file to the flat arrays: what a person waits for before the tree is built.
//!
//! `cargo bench --bench load`. The files are written to a temporary folder and go with it. Processor time is that of all
//! threads, system included, as Linux counts it; elsewhere only the time on the wall is told.

use luxel::build::{Accel, BuildOptions, Quality, SceneBuilder};
use luxel::flat::{Fresnel, PixelFilter};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;
use std::{env, fs};

/// Quads around and from pole to pole: a million triangles.
const GRID: (usize, usize) = (1000, 500);

/// Ticks of a processor's clock in a second, in `/proc`: 100 on every Linux that Rust runs on.
const TICKS_PER_SECOND: f64 = 100.0;

/// Runs of each file, the fastest of which counts: what disturbs only adds.
const RUNS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    // One file and one run in a process of its own, so that its peak of memory is its own.
    if let Some(file) = env::var_os("LUXEL_LOAD") {
        return load(Path::new(&file));
    }
    let folder = env::temp_dir().join(format!("luxel-load-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let told = table(&folder);
    fs::remove_dir_all(&folder)?;
    told
}

/// A file of the planet.
enum Kind {
    Obj { quads: bool, attributes: bool },
    Glb,
}

fn table(folder: &Path) -> Result<(), Box<dyn Error>> {
    println!(
        "| file | MB | triangles | processor s | wall s | Mtriangles/s | peak MB |\n|---|---:|---:|---:|---:|---:|---:|"
    );
    for (name, kind) in [
        (
            "OBJ: triangles, uvs, normals",
            Kind::Obj {
                quads: false,
                attributes: true,
            },
        ),
        (
            "OBJ: quads, uvs, normals",
            Kind::Obj {
                quads: true,
                attributes: true,
            },
        ),
        (
            "OBJ: triangles, positions only",
            Kind::Obj {
                quads: false,
                attributes: false,
            },
        ),
        ("glb: triangles, uvs, normals", Kind::Glb),
    ] {
        let path = match kind {
            Kind::Obj { quads, attributes } => {
                let path = folder.join("mesh.obj");
                fs::write(&path, planet(GRID, quads, attributes))?;
                path
            }
            Kind::Glb => {
                let path = folder.join("mesh.glb");
                fs::write(&path, planet_glb(GRID))?;
                path
            }
        };
        let mut best: Option<[f64; 4]> = None;
        for _ in 0..RUNS {
            let run = child(&path)?;
            if best.is_none_or(|best| run[1] < best[1]) {
                best = Some(run);
            }
        }
        let [triangles, cpu, wall, peak] = best.unwrap_or_default();
        println!(
            "| {name} | {:.0} | {triangles} | {cpu:.2} | {wall:.2} | {:.2} | {peak:.0} |",
            fs::metadata(&path)?.len() as f64 / 1e6,
            1e-6 * triangles / cpu,
        );
    }
    Ok(())
}

/// Triangles, processor seconds, wall seconds, peak memory in MB of a run in its own process.
fn child(path: &Path) -> Result<[f64; 4], Box<dyn Error>> {
    let run = std::process::Command::new(env::current_exe()?)
        .env("LUXEL_LOAD", path)
        .output()?;
    let text = String::from_utf8(run.stdout)?;
    let numbers: Vec<f64> = text
        .split_whitespace()
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    numbers
        .try_into()
        .map_err(|_| String::from_utf8_lossy(&run.stderr).into_owned().into())
}

/// Loads a mesh as a scene does and prints what it took.
fn load(path: &Path) -> Result<(), Box<dyn Error>> {
    let name = path.file_name().unwrap_or_default();
    let entity = if path.extension().is_some_and(|suffix| suffix == "glb") {
        format!("gltf: {name:?}")
    } else {
        format!("shape: Mesh({name:?})")
    };
    let text = format!(
        "Scene(version: 1, camera: (at: (0, 0, 5), look_at: (0, 0, 0)), background: Linear(1, 1, 1),
         materials: {{ \"plain\": Diffuse() }}, entities: [({entity}, material: \"plain\")])"
    );
    let (cpu, start) = (processor_seconds(), Instant::now());
    let scene = luxel::scene::parse(&text, &path.with_file_name("load.ron"));
    let (desc, _) = scene.map_err(|found| found[0].to_string())?;
    let spawned = luxel::world::spawn(&desc, luxel::asset::Loader::new())
        .map_err(|found| found[0].to_string())?;
    let options = BuildOptions {
        // No tree: what is timed ends with the arrays that one is built over.
        accel: Accel::Brute,
        quality: Quality::Good,
        size: (64, 64),
        filter: PixelFilter::Box,
        background: [1.0; 3],
        uv_aov: true,
        fresnel: Fresnel::Exact,
        caustics: false,
    };
    let (scene, _) =
        SceneBuilder::new(&spawned.world, &spawned.assets, options).build(&spawned.world, 0);
    let (wall, cpu) = (start.elapsed().as_secs_f64(), processor_seconds() - cpu);
    let triangles = scene.world.shading.file_prim.len();
    println!("{triangles} {cpu} {wall} {}", peak_megabytes());
    Ok(())
}

/// A lumpy sphere as text, six decimals a number, as modellers write them.
fn planet((columns, rows): (usize, usize), quads: bool, attributes: bool) -> String {
    let mut text = String::from("# a planet\no planet\n");
    // Writing to a string does not fail.
    let mut line = |args: std::fmt::Arguments<'_>| {
        let _ = text.write_fmt(args);
    };
    let place = |column, row| place((columns, rows), column, row);
    for row in 0..=rows {
        for column in 0..=columns {
            let (_, _, up, radius) = place(column, row);
            let [x, y, z] = up.map(|c| c * radius);
            line(format_args!("v {x:.6} {y:.6} {z:.6}\n"));
        }
    }
    for row in (0..=rows).filter(|_| attributes) {
        for column in 0..=columns {
            let (u, v, [x, y, z], _) = place(column, row);
            line(format_args!("vt {u:.6} {v:.6}\nvn {x:.4} {y:.4} {z:.4}\n"));
        }
    }
    let corner = |column: usize, row: usize| {
        let i = row * (columns + 1) + column + 1;
        if attributes {
            format!("{i}/{i}/{i}")
        } else {
            i.to_string()
        }
    };
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] = [(0, 0), (1, 0), (1, 1), (0, 1)]
                .map(|(right, up)| corner(column + right, row + up));
            if quads {
                line(format_args!("f {a} {d} {c} {b}\n"));
            } else {
                line(format_args!("f {a} {c} {b}\nf {a} {d} {c}\n"));
            }
        }
    }
    text
}

/// Texture coordinates, direction and radius at a crossing of the grid.
fn place((columns, rows): (usize, usize), column: usize, row: usize) -> (f64, f64, [f64; 3], f64) {
    let (u, v) = (column as f64 / columns as f64, row as f64 / rows as f64);
    let (longitude, latitude) = (std::f64::consts::TAU * u, std::f64::consts::PI * (v - 0.5));
    let up = [
        latitude.cos() * longitude.cos(),
        latitude.sin(),
        latitude.cos() * longitude.sin(),
    ];
    let radius = 1.0 + 0.05 * (9.0 * longitude).sin() * (7.0 * latitude).cos();
    (u, v, up, radius)
}

/// The same as triangles of a glb file: f32, with indices of four bytes.
fn planet_glb((columns, rows): (usize, usize)) -> Vec<u8> {
    let crossings = || (0..=rows).flat_map(|row| (0..=columns).map(move |column| (column, row)));
    let count = (columns + 1) * (rows + 1);
    let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for (column, row) in crossings() {
        let (_, _, up, radius) = place((columns, rows), column, row);
        let point = up.map(|c| (c * radius) as f32);
        bounds[0] = [0, 1, 2].map(|axis| bounds[0][axis].min(point[axis]));
        bounds[1] = [0, 1, 2].map(|axis| bounds[1][axis].max(point[axis]));
    }
    let [min, max] = bounds;
    let mut binary = Vec::new();
    let mut write = |number: f64| binary.extend((number as f32).to_le_bytes());
    for (column, row) in crossings() {
        let (_, _, up, radius) = place((columns, rows), column, row);
        up.into_iter().for_each(|c| write(c * radius));
    }
    for (column, row) in crossings() {
        let (_, _, up, _) = place((columns, rows), column, row);
        up.into_iter().for_each(&mut write);
    }
    for (column, row) in crossings() {
        let (u, v, ..) = place((columns, rows), column, row);
        [u, 1.0 - v].into_iter().for_each(&mut write);
    }
    for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
        let [a, b, c, d] = [(0, 0), (1, 0), (1, 1), (0, 1)]
            .map(|(right, up)| ((row + up) * (columns + 1) + column + right) as u32);
        binary.extend([a, c, b, a, d, c].map(u32::to_le_bytes).as_flattened());
    }
    let indices = 6 * columns * rows;
    let views = [12 * count, 12 * count, 8 * count, 4 * indices];
    let mut offset = 0;
    let views = views.map(|length| {
        let view = format!("{{\"buffer\":0,\"byteOffset\":{offset},\"byteLength\":{length}}}");
        offset += length;
        view
    });
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":{count},"type":"VEC3","min":{min:?},"max":{max:?}}},
{{"bufferView":1,"componentType":5126,"count":{count},"type":"VEC3"}},
{{"bufferView":2,"componentType":5126,"count":{count},"type":"VEC2"}},
{{"bufferView":3,"componentType":5125,"count":{indices},"type":"SCALAR"}}],
"bufferViews":[{}],"buffers":[{{"byteLength":{offset}}}]}}"#,
        views.join(",")
    );
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    let chunk = |kind: &[u8; 4], content: &[u8]| {
        [&(content.len() as u32).to_le_bytes()[..], kind, content].concat()
    };
    let chunks = [chunk(b"JSON", json.as_bytes()), chunk(b"BIN\0", &binary)].concat();
    let length = 12 + chunks.len() as u32;
    [
        &b"glTF"[..],
        &2u32.to_le_bytes(),
        &length.to_le_bytes(),
        &chunks,
    ]
    .concat()
}

/// User and system time of this process so far; 0 where there is no `/proc`.
fn processor_seconds() -> f64 {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name, in parentheses, may have spaces; the times are the 12th and 13th field behind it.
    let fields = stat
        .rsplit(')')
        .next()
        .unwrap_or_default()
        .split_whitespace();
    let ticks = fields
        .skip(11)
        .take(2)
        .filter_map(|t| t.parse::<f64>().ok());
    ticks.sum::<f64>() / TICKS_PER_SECOND
}

/// Most memory that this process ever held; 0 where there is no `/proc`.
fn peak_megabytes() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes =
        line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok());
    kibibytes.unwrap_or_default() * 1024.0 / 1e6
}
