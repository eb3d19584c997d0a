//! Each defect of files in the wild, and of the parser, as a tiny file.

mod damage;
mod images;
mod materials;
mod memory;
mod skies;

use super::*;
use crate::diag::Diagnostic;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

/// A folder of files that goes when the test ends.
struct Folder(PathBuf);

impl Folder {
    fn of(files: &[(&str, &[u8])]) -> Folder {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let unique = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("luxel-asset-{}-{unique}", std::process::id());
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).expect("a folder");
        for (name, bytes) in files {
            fs::write(path.join(name), bytes).expect("a file");
        }
        Folder(path)
    }

    fn load(&self, name: &str) -> (Result<Mesh, Vec<Diagnostic>>, Vec<Diagnostic>) {
        let mut loader = Loader::new();
        let id = loader.mesh(&self.0.join(name));
        let warnings = loader.warnings().to_vec();
        let store = loader.finish();
        (id.map(|id| Mesh::clone(store.mesh(id))), warnings)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn load(obj: impl AsRef<[u8]>) -> (Result<Mesh, Vec<Diagnostic>>, Vec<Diagnostic>) {
    Folder::of(&[("a.obj", obj.as_ref())]).load("a.obj")
}

/// A mesh that loads without a word.
fn clean(obj: impl AsRef<[u8]>) -> Mesh {
    let (mesh, warnings) = load(obj);
    assert_eq!(warnings, []);
    mesh.expect("a mesh")
}

/// The only error: code, line, message.
fn error(obj: impl AsRef<[u8]>) -> (&'static str, u32, String) {
    let (mesh, _) = load(obj);
    let errors = mesh.expect_err("an error");
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert!(
        errors[0]
            .file
            .as_ref()
            .is_some_and(|file| file.ends_with("a.obj"))
    );
    let line = errors[0].span.as_ref().map_or(0, |span| span.line);
    (errors[0].code, line, errors[0].message.clone())
}

fn codes_and_lines(found: &[Diagnostic]) -> Vec<(&'static str, u32)> {
    found
        .iter()
        .map(|one| (one.code, one.span.as_ref().map_or(0, |span| span.line)))
        .collect()
}

fn points(mesh: &Mesh) -> Vec<[f64; 3]> {
    mesh.corners
        .iter()
        .map(|&c| mesh.positions[c as usize].to_array())
        .collect()
}

/// The value of every corner.
fn each<T: Copy>(attribute: &PerCorner<T>) -> Vec<Option<T>> {
    attribute.iter().collect()
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// A PNG of one row.
fn png(color: png::ColorType, depth: png::BitDepth, width: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(data).expect("data");
    writer.finish().expect("an end");
    bytes
}

#[test]
fn numbers_keep_all_their_bits() {
    let mesh = clean("v 0.1 +.5 2.\nv 1e-3 1E3 -0\nv 3 4 0.3333333333333333\nf 1 2 3");
    assert_eq!(
        points(&mesh),
        [
            [0.1, 0.5, 2.0],
            [1e-3, 1e3, 0.0],
            [3.0, 4.0, 0.3333333333333333]
        ]
    );
}

#[test]
fn layout_does_not_matter() {
    let plain = points(&clean(format!("{TRIANGLE}f 1 2 3\n")));
    for text in [
        format!(
            "\u{feff}# head\r\n{}f\t1  2 3 \r\n",
            TRIANGLE.replace('\n', "\r\n")
        ),
        format!("{TRIANGLE}f 1 2 3 # comment"),
        format!("{TRIANGLE}f 1 2 \\\n3"),
        format!("o a\n{TRIANGLE}g b c\ns 1\nl 1 2\np 1\nvp 0\nf 1 2 3"),
        format!("{TRIANGLE}f -3 -2 -1"),
        format!("f 1 2 3\n{TRIANGLE}"),
        TRIANGLE.replace("0\n", "0 1\n") + "f 1 2 3",
        TRIANGLE.replace("0\n", "0 0.5 nan 1\n") + "f 1 2 3",
        format!("v nan inf x\n{TRIANGLE}f 2 3 4"),
    ] {
        assert_eq!(points(&clean(&text)), plain, "{text}");
    }
    let returns = format!("# head\r{TRIANGLE}f 1 2 \\\r3").replace('\n', "\r");
    assert_eq!(points(&clean(&returns)), plain, "carriage returns alone");
    assert_eq!(
        error(format!("{returns}\rf 1 2 0").replace("\\\r", "")).1,
        6
    );
    for (mark, unit) in [
        ("\u{feff}", u16::to_le_bytes as fn(u16) -> [u8; 2]),
        ("\u{feff}", u16::to_be_bytes),
        ("", u16::to_le_bytes),
        ("", u16::to_be_bytes),
    ] {
        let text = format!("{mark}# caf\u{e9} \u{1f431}\n{TRIANGLE}f 1 2 3");
        let wide: Vec<u8> = text.encode_utf16().flat_map(unit).collect();
        assert_eq!(points(&clean(&wide)), plain);
        assert_eq!(
            points(&clean([&wide[..], b"\n"].concat())),
            plain,
            "an odd byte"
        );
    }
    let latin: Vec<u8> = [b"# caf\xE9\n", TRIANGLE.as_bytes(), b"f 1 2 3"].concat();
    assert_eq!(points(&clean(latin)), plain);
    assert_eq!(
        points(&clean(format!(
            "#{}\n{TRIANGLE}f 1 2 3",
            "x".repeat(1 << 20)
        ))),
        plain
    );
}

#[test]
fn a_seam_keeps_both_uvs_exactly() {
    let mesh = clean(format!(
        "{SQUARE}vt 0.1 0.2\nvt 0.3 0.4\nvt 0.5 0.6\nvt 7 8\nvt -9 10\nvt 0.7\nf 1/1 2/2 3/3\nf 1/4 3/5 4/6\n"
    ));
    let uv = |u, v| Some(DVec2::new(u, v));
    assert_eq!(
        each(&mesh.uvs),
        [
            uv(0.1, 0.2),
            uv(0.3, 0.4),
            uv(0.5, 0.6),
            uv(7.0, 8.0),
            uv(-9.0, 10.0),
            uv(0.7, 0.0)
        ]
    );
    assert_eq!(mesh.corners[0], mesh.corners[3], "one position, two uvs");
}

#[test]
fn mixed_faces_keep_their_own_attributes_in_any_order() {
    let head = format!("{SQUARE}v 2 0 0\nvt 0.1 0.2\nvt 0.3 0.4\nvt 0.5 0.6\nvn 0 0 2\nvn 0 3 0\n");
    let faces = [
        "f 1 2 3",
        "f 1/3 5/2 3/1",
        "f 4//2 1//1 2//2",
        "f 2/2/2 3/3/1 4/1/2",
        "f 3/2/1 4/1/2 1/3/1",
    ];
    let uvs = |list: [usize; 3]| {
        list.map(|i| Some(DVec2::new([0.1, 0.3, 0.5][i - 1], [0.2, 0.4, 0.6][i - 1])))
    };
    let normals = |list: [usize; 3]| list.map(|i| Some([DVec3::Z, DVec3::Y][i - 1]));
    let none = (None, None);
    let own = [
        ([1, 2, 3], none),
        ([1, 5, 3], (Some([3, 2, 1]), None)),
        ([4, 1, 2], (None, Some([2, 1, 2]))),
        ([2, 3, 4], (Some([2, 3, 1]), Some([2, 1, 2]))),
        ([3, 4, 1], (Some([2, 1, 3]), Some([1, 2, 1]))),
    ];
    let square = points(&clean(
        format!("{SQUARE}f 1 2 3\nf 4 4 4\nf 1 3 4").replace("f 4 4 4\n", ""),
    ));
    let place = [square[0], square[1], square[2], square[5], [2.0, 0.0, 0.0]];
    for turn in 0..faces.len() {
        let order: Vec<usize> = (0..faces.len()).map(|i| (i + turn) % faces.len()).collect();
        let text: Vec<&str> = order.iter().map(|&i| faces[i]).collect();
        let mesh = clean(format!("{head}{}", text.join("\n")));
        for (t, &i) in order.iter().enumerate() {
            let (at, (uv, normal)) = own[i];
            let corners = 3 * t..3 * t + 3;
            assert_eq!(
                points(&mesh)[corners.clone()],
                at.map(|v| place[v - 1]),
                "{text:?}"
            );
            assert_eq!(
                each(&mesh.uvs)[corners.clone()],
                uv.map_or([None; 3], uvs),
                "{text:?}"
            );
            assert_eq!(
                each(&mesh.normals)[corners],
                normal.map_or([None; 3], normals),
                "{text:?}"
            );
        }
    }
}

#[test]
fn a_concave_face_is_cut_with_all_that_its_corners_have() {
    // A fan from the first corner would cover what is outside. A square and a triangle without area stand around it.
    let arrow = [[0.0, 4.0], [1.0, 1.0], [4.0, 0.0], [3.0, 3.0], [4.0, 4.0]];
    let mut text = format!("{SQUARE}vt 9 9\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf 1 1 2\n");
    for [x, y] in arrow {
        text += &format!("v {x} {y} 0\nvt {} {}\nvn {x} {y} 5\n", 0.1 * x, 0.1 * y);
    }
    text += "f -5/-5/-5 -4/-4/-4 -3/-3/-3 -2/-2/-2 -1/-1/-1\nf 1/1/1 2/1/1 4/1/1\n";
    let (mesh, warnings) = load(text);
    assert_eq!(codes_and_lines(&warnings), [("W105", 8)]);
    let mesh = mesh.expect("a mesh");
    assert_eq!(mesh.triangle_count(), 2 + 3 + 1);
    let mut area = 0.0;
    for triangle in 2..5 {
        let corner = |k: usize| {
            let corner = 3 * triangle + k;
            let p = mesh.positions[mesh.corners[corner] as usize];
            assert_eq!(mesh.uvs.get(corner), Some(0.1 * p.truncate()));
            let normal = mesh.normals.get(corner).expect("a normal");
            assert!(normal.distance(DVec3::new(p.x, p.y, 5.0).normalize()) < 1e-15);
            p.truncate()
        };
        let [a, b, c] = [0, 1, 2].map(corner);
        area += 0.5 * (b - a).perp_dot(c - a);
    }
    // By the shoelace formula.
    let around = (0..5).map(|i| (DVec2::from(arrow[i]), DVec2::from(arrow[(i + 1) % 5])));
    let expect: f64 = around.map(|(a, b)| 0.5 * a.perp_dot(b)).sum();
    assert!((area - expect).abs() < 1e-12, "{area}, not {expect}");
    assert!(mesh.uvs.get(3 * 5) == Some(DVec2::splat(9.0)));
}

/// Cutting ears takes the square of the corners.
#[test]
fn a_concave_face_of_very_many_corners_is_refused() {
    let corners = 5_000;
    let mut obj = String::new();
    for corner in 0..corners {
        let (x, tooth) = (corner / 2, corner % 2);
        obj.push_str(&format!("v {x} {} 0\n", tooth * (2 + corner % 3)));
    }
    obj.push_str(&format!("v {corners} -1 0\nv 0 -1 0\nf"));
    for corner in 1..=corners + 2 {
        obj.push_str(&format!(" {corner}"));
    }
    let (code, line, says) = error(&obj);
    assert_eq!((code, line), ("E109", corners + 3));
    assert!(says.contains("5002 corners"), "{says}");
}

#[test]
fn attributes_that_cannot_be_used_are_told_of_and_absent() {
    let (mesh, warnings) = load(format!(
        "{TRIANGLE}vt 0 0\nf 1/1 2 3\nf 1 2\nf 1 2 2\nf 3 2 1"
    ));
    assert_eq!(
        codes_and_lines(&warnings),
        [("W108", 6), ("W109", 5), ("W105", 7), ("W116", 8)]
    );
    let mesh = mesh.expect("a mesh");
    assert_eq!((mesh.triangle_count(), mesh.uvs.len()), (2, 0));
    let (mesh, warnings) = load(format!(
        "{TRIANGLE}vt nan 0\nvn 0 0 0\nvn 0 0 1e-200\nf 1/1/1 2/1/2 3/1/1"
    ));
    assert_eq!(codes_and_lines(&warnings), [("W107", 7), ("W106", 7)]);
    let mesh = mesh.expect("a mesh");
    assert_eq!(each(&mesh.uvs), [None; 3]);
    assert_eq!(each(&mesh.normals), [None, Some(DVec3::Z), None]);
    let (mesh, warnings) = load(format!("{TRIANGLE}f 1/1 2/2 3/3"));
    assert_eq!(codes_and_lines(&warnings), [("W115", 4)]);
    assert!(mesh.expect("a mesh").uvs.is_empty());
}

#[test]
fn errors_name_their_line() {
    let at = |obj: String| error(obj);
    let says = |code, line, message: &str| (code, line, message.to_owned());
    assert_eq!(
        at(format!("{TRIANGLE}f 1 2 0")),
        says("E103", 4, "`v` indices start at 1, and this face uses 0")
    );
    assert_eq!(
        at(format!("{TRIANGLE}f 1 2 7")),
        says("E103", 4, "the face uses `v` 7, but the file has 3")
    );
    assert_eq!(at(format!("{TRIANGLE}vt 0 0\nf 1/1 2/1 3/2")).1, 5);
    assert_eq!(
        at(format!("{TRIANGLE}f 1/9 2/9 9/9")).2,
        "the face uses `v` 9, but the file has 3"
    );
    assert_eq!(at(format!("f -1 -2 -3\n{TRIANGLE}")).1, 1);
    assert_eq!(at(format!("{TRIANGLE}f 1 2 -9223372036854775808")).1, 4);
    assert_eq!(
        at(format!("{TRIANGLE}f 1 2 99999999999999999999")).2,
        "`99999999999999999999` is not a `v` index"
    );
    assert_eq!(at(format!("{TRIANGLE}f 1 2 x")).2, "`x` is not a `v` index");
    assert_eq!(at(format!("{TRIANGLE}f 1 2 /1")).2, "`/1` names no vertex");
    assert_eq!(at(format!("{TRIANGLE}f 1 2 3/1/1/1")).0, "E103");
    assert_eq!(
        at(format!("v 1 2\n{TRIANGLE}f 1 2 3")),
        says("E104", 1, "`v` needs 3 numbers, not 2")
    );
    let bad = |v: &str| at(format!("{TRIANGLE}{v}\nf 1 2 3\nf 1 2 -1"));
    assert_eq!(
        bad("v 0 nan 0"),
        says(
            "E105",
            4,
            "the vertex is not finite, and the face in line 6 uses it"
        )
    );
    assert_eq!(bad("v 0 1e999 0").1, 4);
    assert_eq!(
        bad("v 0 1e200 0").2,
        "the vertex is beyond 1e100, and the face in line 6 uses it"
    );
    assert_eq!(
        bad("v 0 1,5 0").2,
        "`1,5` is not a number, and the face in line 6 uses it"
    );
    assert_eq!(
        bad("v 0 1 0 0").2,
        "the vertex is not finite, and the face in line 6 uses it"
    );
    for empty in ["", "# nothing", "v 0 0 0\nl 1 1", "\0\u{1}\u{fffd}"] {
        assert_eq!(error(empty), says("E102", 0, "the file has no faces"));
    }
    assert_eq!(
        error(format!("{TRIANGLE}f 1 1 2")).2,
        "no face of the file has an area"
    );
}

#[test]
fn files_that_are_not_there_name_themselves() {
    let folder = Folder::of(&[("cat.obj", TRIANGLE.as_bytes())]);
    let errors = Loader::new()
        .mesh(&folder.0.join("Cta.obj"))
        .expect_err("an error");
    assert_eq!(errors[0].code, "E101");
    assert_eq!(errors[0].hint.as_deref(), Some("did you mean \"cat.obj\"?"));
    assert_eq!(
        Loader::new().mesh(&folder.0).expect_err("an error")[0].message,
        "this is not a file"
    );
    let missing = Loader::new()
        .texture(Path::new("nowhere/x.png"))
        .expect_err("an error");
    assert_eq!(missing.file.as_deref(), Some(Path::new("nowhere/x.png")));
}

#[test]
fn a_file_is_read_once_and_the_hash_knows_content_and_order_only() {
    let obj = format!("{TRIANGLE}f 1 2 3");
    let other = format!("{TRIANGLE}f 3 2 1");
    let hash = |files: [(&str, &str); 2]| {
        let folder = Folder::of(&files.map(|(name, text)| (name, text.as_bytes())));
        let mut loader = Loader::new();
        let a = loader.mesh(&folder.0.join(files[0].0)).expect("a mesh");
        let b = loader.mesh(&folder.0.join(files[1].0)).expect("a mesh");
        assert_eq!(loader.mesh(&folder.0.join(".").join(files[0].0)), Ok(a));
        let store = loader.finish();
        assert_eq!((a, b, store.meshes.len()), (MeshId(0), MeshId(1), 2));
        assert_eq!(store.bytes(), (obj.len() + other.len()) as u64);
        store.hash()
    };
    let first = hash([("a.obj", &obj), ("b.obj", &other)]);
    assert_eq!(first, hash([("c.obj", &obj), ("d.obj", &other)]));
    assert_ne!(first, hash([("a.obj", &other), ("b.obj", &obj)]));
    assert_ne!(AssetStore::default().hash(), first);
}
