//! Sound files to damage: those of the project, small ones made here, and with `LUXEL_DATA` the collection's.

use std::fs;
use std::path::{Path, PathBuf};

/// Kinds of file that are damaged, by their ending. A reader that is new adds its own here.
pub(crate) const SUFFIXES: [&str; 6] = ["obj", "mtl", "png", "jpg", "jpeg", "ron"];

/// Larger files are left out: what they have that small ones have not is only more of the same.
const MAX_BYTES: u64 = 1 << 16;

/// A sound file.
pub(crate) struct Seed {
    pub(crate) suffix: &'static str,
    pub(crate) bytes: Vec<u8>,
    /// The folder whose other files it names.
    pub(crate) folder: PathBuf,
}

/// Every seed, in an order that does not change.
pub(crate) fn seeds() -> Vec<Seed> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = vec![project.join("assets"), project.join("scenes")];
    match std::env::var_os("LUXEL_DATA") {
        Some(data) => folders.push(PathBuf::from(data).join("zoo")),
        None => eprintln!("LUXEL_DATA is not set: only the project's own files are damaged"),
    }
    let mut seeds: Vec<Seed> = small().collect();
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        for path in paths {
            if path.is_dir() {
                folders.push(path);
            } else {
                seeds.extend(seed(&path, &folder));
            }
        }
    }
    seeds
}

fn seed(path: &Path, folder: &Path) -> Option<Seed> {
    let ending = path.extension()?.to_str()?.to_lowercase();
    let suffix = SUFFIXES.into_iter().find(|suffix| *suffix == ending)?;
    let small = fs::metadata(path).is_ok_and(|meta| meta.len() <= MAX_BYTES);
    let bytes = small.then(|| fs::read(path).ok())??;
    Some(Seed {
        suffix,
        bytes,
        folder: folder.to_owned(),
    })
}

/// What each format can say, in a few lines.
fn small() -> impl Iterator<Item = Seed> {
    let seed = |suffix, bytes: Vec<u8>| Seed {
        suffix,
        bytes,
        folder: PathBuf::new(),
    };
    let texts = [
        ("obj", OBJ),
        ("obj", POLYGONS),
        ("mtl", MTL),
        ("ron", SCENE),
    ];
    let texts = texts.map(|(suffix, text)| seed(suffix, text.into()));
    let (rgba, grey) = (png::ColorType::Rgba, png::ColorType::Grayscale);
    let images = [
        image(rgba, png::BitDepth::Eight),
        image(grey, png::BitDepth::Sixteen),
    ];
    texts
        .into_iter()
        .chain(images.map(|bytes| seed("png", bytes)))
        .chain([seed("jpg", photo())])
}

pub(crate) fn image(color: png::ColorType, depth: png::BitDepth) -> Vec<u8> {
    const SIDE: u32 = 9;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIDE, SIDE);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let size = (SIDE * SIDE) as usize
        * color.samples()
        * if depth == png::BitDepth::Sixteen {
            2
        } else {
            1
        };
    let texels: Vec<u8> = (0..size).map(|i| (i * 37) as u8).collect();
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&texels).expect("texels");
    writer.finish().expect("an end");
    bytes
}

fn photo() -> Vec<u8> {
    const SIDE: u32 = 24;
    let texels: Vec<u8> = (0..SIDE * SIDE * 3).map(|i| (i * 5) as u8).collect();
    let mut bytes = Vec::new();
    let mut encoder = image::codecs::jpeg::JpegEncoder::new(&mut bytes);
    let color = image::ExtendedColorType::Rgb8;
    encoder.encode(&texels, SIDE, SIDE, color).expect("a JPEG");
    bytes
}

pub(crate) const OBJ: &str = "mtllib m.mtl\no a\nv 0 0 0\nv 1 0 0.5\nv 1 1 0 1\nv 0 1 0 0.2 0.3 0.4\nv 0.5 0.5 2\nvt 0 0\nvt 1 0.5\n\
    vt 0.25\nvn 0 0 1\nvn 0 0.6 0.8\nusemtl a\nf 1/1/1 2/2/1 3/1/2\nf -5 -3 -2 # four\ng b c\ns 1\nusemtl b\n\
    f 1//1 4//2 \\\n5//1\nf 1/1 2/2 5/3\nl 1 2\n";

const POLYGONS: &str = "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nv 3 3 1\nv 2 -1 0\nf 1 2 3 4\nf 1 2 5 4\nf 1 6 2 5 4\n\
    f 6 5 4 3 2 1\nf 1 1 2\nf 2 3 1\n";

pub(crate) const MTL: &str = "newmtl a\nKd 0.5\nmap_Kd -s 1 1 1 t.png\nmap_d t.png\nd 0.9\nillum 2\nnewmtl b\nKd 0.1 0.2 0.3\n\
    Ke 1 2 3\nTr 0.5\nNs 10\nKs 0 0 0\n";

const SCENE: &str = "Scene(version: 1, camera: (at: (0, 0, 5), look_at: (0, 0, 0), vfov_deg: 40, lens: (aperture_radius: 0.1, focus_distance: 4)),\n\
    render: (size: (8, 8), spp: 2, max_bounces: 4, filter: Gaussian(radius_px: 1.5)), background: Linear(0.1, 0.2, 0.3),\n\
    materials: { \"a\": Diffuse(color: Srgb(\"#c0ffee\")), \"b\": Glass(ior: 1.5), \"c\": Plastic(ior: 1.4), \"d\": Metal(), \"e\": Mirror },\n\
    entities: [(name: \"hub\", spin: (axis: (0, 1, 0), deg_per_s: 90, pivot: (1, 0, 0))),\n\
    (name: \"lamp\", shape: Sphere(radius: 1), transform: (translate: (0, 5, 0)), emissive: (radiance: (9, 8, 7))),\n\
    (name: \"ball\", parent: \"hub\", shape: Sphere(radius: 0.5, inverted: true), material: \"b\", transform: (rotate: Euler(10, 20, 30), scale: 2)),\n\
    (name: \"pot\", shape: Mesh(\"m.obj\"), material: \"a\", normals: Smooth(angle_deg: 40), transform: (rotate: AxisAngle(axis: (1, 1, 0), deg: 30), scale: (1, 2, 3)))],\n\
    animation: (fps: 24, frames: 0..48))";
