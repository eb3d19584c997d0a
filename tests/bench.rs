//! The traversal benchmark: its subjects and rays, its arms and its command.

use luxel::build::bvh::{Accel, build};
use luxel::flat::FlatScene;
use luxel::measure::arms::{Layout, Tree};
use luxel::measure::bench::{LENGTH, Plan, RayKind, RaySets, Record, Source, Subject, meshes, run};
use luxel::measure::exactness;
use luxel::trace::{Hits, Isa, Rays, closest_hit};
use std::collections::BTreeMap;
use std::fs;
use std::process::{Command, Output};
use std::time::Duration;

fn scene(subject: &Subject) -> FlatScene {
    subject.scene(build(&subject.primitives(), Accel::Bvh))
}

/// Triangles of every generator, sizes small.
fn subjects() -> [(&'static str, Subject, usize); 4] {
    [
        ("ball", meshes::ball(7), 20 * 49 + 12),
        ("terrain", meshes::terrain(21), 2 * 441),
        ("soup", meshes::soup(20_000), 20_000),
        ("spheres", meshes::spheres(300), 300),
    ]
}

#[test]
fn subjects_have_the_promised_size() {
    for (name, subject, count) in subjects() {
        let found = subject.triangles.len() + subject.spheres.len();
        assert_eq!(found, count, "{name}");
        let extent = f64::from((subject.object.max - subject.object.min).max_element());
        assert!(
            (0.8..1.25).contains(&(extent / LENGTH)),
            "{name} is {extent} long"
        );
    }
    let triangles = meshes::BALL_SIZES.map(|n| 20 * n.pow(2));
    assert_eq!(triangles, [2_880, 69_620, 1_310_720, 4_195_280]);
    assert_eq!(2 * meshes::TERRAIN_SIDE.pow(2), 4_193_408);
}

#[test]
fn a_ball_is_closed() {
    let ball = meshes::ball(9);
    let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    // Adding 0 makes −0 and 0 the same bits.
    let bits = |v: luxel::math::Vec3| v.to_array().map(|x| (x + 0.0).to_bits());
    for t in &ball.triangles {
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let [a, b] = [bits(t[a]), bits(t[b])];
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    assert_eq!(edges.len(), 3 * ball.triangles.len() / 2);
    // Once in either direction: neighbours agree which side is out.
    assert!(edges.values().all(|&n| n == 0));
}

#[test]
fn soup_is_thin() {
    for t in meshes::soup(100).triangles {
        let base = t[1] - t[0];
        let height = (t[2] - t[0]).cross(base).length() / base.length();
        let ratio = base.length() / height;
        assert!((39.0..41.0).contains(&ratio), "{ratio}");
    }
}

fn bits(rays: &Rays) -> Vec<[u32; 7]> {
    (0..rays.len())
        .map(|i| {
            let [o, d] = [&rays.origin, &rays.dir];
            let ray = [
                o[0][i],
                o[1][i],
                o[2][i],
                d[0][i],
                d[1][i],
                d[2][i],
                rays.t_max[i],
            ];
            ray.map(f32::to_bits)
        })
        .collect()
}

#[test]
fn rays_are_those_promised() {
    const COUNT: usize = 3000;
    for (name, subject, _) in subjects() {
        let scene = scene(&subject);
        let sets = RaySets::new(&subject, &scene, COUNT);
        let again = RaySets::new(&subject, &scene, COUNT);
        for kind in RayKind::ALL {
            let rays = bits(sets.of(kind));
            assert_eq!(rays, bits(again.of(kind)), "{name}, {kind}");
            assert!(rays.len() > COUNT / 16, "{name}, {kind}: {}", rays.len());
            for r in &rays {
                let length: f32 = r[3..6].iter().map(|&x| f32::from_bits(x).powi(2)).sum();
                assert!((length - 1.0).abs() < 1e-6, "{name}, {kind}");
            }
        }
        assert_eq!(sets.of(RayKind::Primary).len(), COUNT);
        assert_eq!(sets.of(RayKind::Random).len(), COUNT);
        let [mut diffuse, mut shuffled] =
            [RayKind::Diffuse, RayKind::Shuffled].map(|kind| bits(sets.of(kind)));
        assert_ne!(diffuse, shuffled, "{name}");
        diffuse.sort_unstable();
        shuffled.sort_unstable();
        assert_eq!(diffuse, shuffled, "{name}");
    }
}

#[test]
fn no_ray_leaves_the_room() {
    let ball = meshes::ball(7);
    let scene = scene(&ball);
    let sets = RaySets::new(&ball, &scene, 2000);
    // Shadow rays end at the lamp.
    for kind in RayKind::ALL.into_iter().filter(|kind| !kind.occlusion()) {
        let mut hits = Hits::default();
        closest_hit(&scene, Isa::best(), sets.of(kind), &mut hits);
        let misses = hits.prim.iter().filter(|&&prim| prim == Hits::NONE);
        assert_eq!(misses.count(), 0, "{kind}");
    }
}

/// Everything on a small subject, as quickly as possible. Were an arm wrong, `run` would say so.
fn all_arms(name: &str, subject: Subject) -> Vec<Record> {
    let plan = Plan {
        sources: vec![Source::Given(name.to_owned(), Box::new(subject))],
        rays: RayKind::ALL.to_vec(),
        trees: Tree::ALL.to_vec(),
        layouts: Layout::ALL.to_vec(),
        isas: Isa::all().collect(),
        count: 200,
        time: Duration::ZERO,
    };
    run(plan, |_, _| ()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn all_arms_agree() {
    let rows = |layout: Layout, spheres: bool| {
        let trees = match (layout, spheres) {
            (Layout::Gathered | Layout::Fours, true) => 0,
            (Layout::Gathered | Layout::Fours | Layout::Luxel, _) => 3,
            (Layout::Blocks, false) => 5,
            _ => 4,
        };
        let isas = Isa::all().filter(|isa| layout.runs_on(isa.level())).count();
        trees * isas * RayKind::ALL.len()
    };
    for (name, subject) in [
        ("ball", meshes::ball(4)),
        ("terrain", meshes::terrain(13)),
        ("soup", meshes::soup(300)),
        ("spheres", meshes::spheres(100)),
    ] {
        let spheres = subject.triangles.is_empty();
        let records = all_arms(name, subject);
        let expected = Layout::ALL.into_iter().map(|layout| rows(layout, spheres));
        assert_eq!(records.len(), expected.sum::<usize>(), "{name}");
        for kind in RayKind::ALL {
            let same: Vec<&Record> = records.iter().filter(|r| r.rays == kind).collect();
            assert!(same.iter().all(|r| r.checksum == same[0].checksum));
        }
    }
}

#[test]
fn work_is_that_of_the_tree() {
    let records = all_arms("ball", meshes::ball(6));
    let work = |tree: Tree, layout: Layout| {
        let row = |r: &&Record| (r.tree, r.layout, r.rays) == (tree, layout, RayKind::Random);
        let row = records.iter().find(row).expect("a row");
        (row.work.expect("counted"), row.timed as u64)
    };
    let (brute, rays) = work(Tree::Brute, Layout::Arrays);
    let triangles = 20 * 36 + 12;
    // One node over the runs, each with the box of everything.
    assert_eq!([brute.nodes, brute.primitives], [rays, rays * triangles]);
    assert_eq!(brute.lanes, rays * triangles.next_multiple_of(8));
    let (wide, _) = work(Tree::Bvh8, Layout::Blocks);
    let (binary, _) = work(Tree::Bvh2, Layout::Blocks);
    let (structs, _) = work(Tree::Bvh8, Layout::Structs);
    let (fours, _) = work(Tree::Bvh8, Layout::Fours);
    let (bytes, _) = work(Tree::Bvh8q, Layout::Blocks);
    assert_eq!(
        (structs.nodes, structs.primitives),
        (wide.nodes, wide.primitives)
    );
    assert_eq!(structs.lanes, structs.primitives);
    assert!(wide.lanes > wide.primitives && wide.primitives < brute.primitives / 10);
    assert!(binary.nodes > 3 * wide.nodes / 2, "{binary:?} {wide:?}");
    assert_eq!(fours.primitives, wide.primitives);
    assert!(fours.lanes > fours.primitives && fours.lanes < wide.lanes);
    // Looser boxes are met more often, but not much.
    assert!(
        (wide.nodes..wide.nodes * 11 / 10).contains(&bytes.nodes),
        "{bytes:?} {wide:?}"
    );
    assert!(bytes.primitives >= wide.primitives);
}

#[test]
fn memory_is_that_of_the_format() {
    let soup = meshes::soup(5000);
    let nodes = scene(&soup).world.bvh.nodes.len();
    let records = all_arms("soup", soup);
    let bytes = |tree: Tree, layout: Layout| {
        let row = |r: &&Record| (r.tree, r.layout) == (tree, layout);
        5000.0 * records.iter().find(row).expect("a row").bytes
    };
    let wide = bytes(Tree::Bvh8, Layout::Blocks);
    let saved = wide - bytes(Tree::Bvh8q, Layout::Blocks);
    assert!(
        (saved - 128.0 * nodes as f64).abs() < 1.0,
        "{saved}, {nodes} nodes"
    );
    assert!(bytes(Tree::Bvh8, Layout::Fours) < wide);
}

/// Runs `luxel bench` in a folder that is gone afterwards, with a mesh of two triangles in it.
fn command(name: &str, args: &[&str]) -> (Output, Vec<(String, String)>) {
    let folder = std::env::temp_dir().join(format!("luxel-bench-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a temporary folder");
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 2 4 3\n";
    fs::write(folder.join("two.obj"), mesh).expect("writable");
    let mut luxel = Command::new(env!("CARGO_BIN_EXE_luxel"));
    let quick = ["bench", "--count", "300", "--time", "1ms"];
    let output = luxel.args(quick).args(args).current_dir(&folder).output();
    let entries = fs::read_dir(&folder).expect("there").flatten();
    let file = |entry: fs::DirEntry| {
        let text = fs::read_to_string(entry.path()).expect("text");
        (entry.file_name().to_string_lossy().into_owned(), text)
    };
    let mut files: Vec<_> = entries.map(file).filter(|(n, _)| n != "two.obj").collect();
    files.sort();
    fs::remove_dir_all(&folder).expect("gone");
    (output.expect("luxel runs"), files)
}

#[test]
fn a_run_prints_and_writes() {
    let args = [
        "--size",
        "spheres-100",
        "--mesh",
        "two.obj",
        "--room",
        "--rays",
        "random,shadow",
        "--accel",
        "bvh2,bvh8,bvh8q",
        "--layout",
        "structs,blocks,luxel",
        "--isa",
        "scalar",
        "--csv",
        "all.csv",
        "--svg",
        "all.svg",
    ];
    let (output, files) = command("files", &args);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let table = String::from_utf8(output.stdout).expect("text");
    for words in [
        "lane blocks over array of structs, scalar",
        "eight children over two",
        "boxes in floats over bytes",
        "luxel over the fastest rival",
        "spheres-100: 100 primitives",
        "two: 14 primitives",
        "bvh2  structs  scalar",
        "bvh8  nodes a ray",
    ] {
        assert!(table.contains(words), "no {words} in\n{table}");
    }
    let [(_, csv), (_, svg)] = &files[..] else {
        panic!("{files:?}");
    };
    let mut lines = csv.lines();
    assert_eq!(
        lines.next(),
        Some(
            "subject,primitives,rays,tree,layout,isa,timed_rays,passes,mrays_per_s,ns_per_ray,nodes_per_ray,\
             primitives_per_ray,lanes_per_ray,bytes_per_primitive,build_ms,checksum"
        )
    );
    // Two trees of two layouts and luxel's; bytes for boxes where there are triangles; two ray sets.
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), (5 + 6) * 2);
    for row in rows {
        assert_eq!(row.len(), 16, "{row:?}");
        let number = |i: usize| {
            row[i]
                .parse::<f64>()
                .unwrap_or_else(|e| panic!("{row:?}, {i}: {e}"))
        };
        assert!(
            number(8) > 0.0 && number(9) > 0.0 && number(13) > 0.0,
            "{row:?}"
        );
        assert_eq!(row[10].is_empty(), row[4] == "luxel", "{row:?}");
    }
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    assert_eq!(svg.matches("class=\"n\"").count(), 22);
}

/// What the product does is right on the hardest inputs, and its cheap twins are not: else there would be nothing to pay for.
#[test]
fn exactness_buys_right_answers() {
    let mut heard = Vec::new();
    let rows = exactness::run(20_000, Duration::ZERO, |choice| heard.push(choice));
    assert_eq!(heard, rows.iter().map(|r| r.choice).collect::<Vec<_>>());
    assert_eq!(rows.len(), 6);
    for row in &rows {
        assert!(
            row.judged > 0 && row.ns.iter().all(|&ns| ns > 0.0),
            "{row:?}"
        );
        let [exact, cheap] = row.wrong;
        assert!(exact == 0.0 && cheap > 0.0, "{row:?}");
    }
}

#[test]
fn exactness_is_printed_and_written() {
    let args = ["--exactness", "--csv", "exactness.csv"];
    let (output, files) = command("exactness", &args);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let table = String::from_utf8(output.stdout).expect("text");
    for words in ["watertight", "Möller–Trumbore", "Schlick", "epsilon 1e-4"] {
        assert!(table.contains(words), "no {words} in\n{table}");
    }
    let [(name, csv)] = &files[..] else {
        panic!("{files:?}");
    };
    assert_eq!(name, "exactness.csv");
    assert_eq!(csv.lines().count(), 7);
    assert!(csv.starts_with("choice,exact,cheap,unit,ns_exact,ns_cheap,"));
}

#[test]
fn json_is_for_scripts() {
    let args = [
        "--size",
        "spheres-100",
        "--rays",
        "primary",
        "--layout",
        "blocks",
        "--json",
    ];
    let (output, _) = command("json", &args);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let rows: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let rows = rows.as_array().expect("rows");
    assert!(!rows.is_empty());
    for row in rows {
        assert_eq!(row["subject"], "spheres-100");
        assert!(row["nodes_per_ray"].as_f64() > Some(0.0), "{row}");
    }
}

#[test]
fn mistakes_are_told() {
    for (args, code, word) in [
        (&["--size", "2k"][..], 2, "possible values"),
        (&["--room"], 2, "--mesh"),
        (&["--isa", "mmx"], 2, "scalar, sse2"),
        (&["--exactness", "--svg", "all.svg"], 2, "--svg"),
        (&["--mesh", "none.obj"], 66, "none.obj"),
        (&["--mesh", "two.stl"], 2, "two.stl"),
        (&["--csv", "none/all.csv"], 74, "none"),
        (
            &[
                "--size",
                "spheres-100",
                "--layout",
                "luxel",
                "--accel",
                "bvh2",
            ],
            2,
            "luxel",
        ),
    ] {
        let (output, files) = command("mistakes", args);
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{args:?}: {words}");
        assert!(words.contains(word), "{args:?}: {words}");
        assert!(files.is_empty());
    }
}
