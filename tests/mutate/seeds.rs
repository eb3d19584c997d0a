//! Sound files to damage: those of the project, small ones made here, and with `LUXEL_DATA` the collection's.

use std::fs;
use std::path::{Path, PathBuf};

/// Kinds of file that are damaged, by their ending. A reader that is new adds its own here.
pub(crate) const SUFFIXES: [&str; 10] = [
    "obj", "mtl", "gltf", "glb", "png", "jpg", "jpeg", "hdr", "exr", "ron",
];

/// Larger files are left out: what they have that small ones have not is only more of the same.
const MAX_BYTES: u64 = 1 << 16;

/// Larger neighbours are left out, and then missing.
const MAX_NEIGHBOUR: u64 = 1 << 18;

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

/// The files that a glTF file names by relative paths below its folder, where they are small.
pub(crate) fn neighbours(seed: &Seed) -> Vec<(String, Vec<u8>)> {
    let Ok(json) = serde_json::from_slice::<serde_json::Value>(&seed.bytes) else {
        return Vec::new();
    };
    let listed = ["buffers", "images"].map(|name| json[name].as_array().cloned());
    let uris = listed.into_iter().flatten().flatten();
    let uris = uris.filter_map(|one| Some(one["uri"].as_str()?.replace("%20", " ")));
    let below = uris.filter(|uri| !uri.contains(':') && !uri.contains("..") && !uri.is_empty());
    let read = |uri: String| {
        let path = seed.folder.join(&uri);
        let small = fs::metadata(&path).is_ok_and(|meta| meta.len() <= MAX_NEIGHBOUR);
        Some((uri, small.then(|| fs::read(path).ok())??))
    };
    below.filter_map(read).collect()
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
        ("gltf", GLTF),
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
        .chain([seed("jpg", photo()), seed("glb", glb())])
        .chain([seed("hdr", hdr()), seed("exr", exr())])
}

/// [`GLTF`] with its buffer, and an image in it, as the binary chunk.
fn glb() -> Vec<u8> {
    let mut bytes = Vec::new();
    for number in [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5_f32] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend([0, 0, 1, 0, 2, 0, 0, 0]);
    let texels = image(png::ColorType::Rgba, png::BitDepth::Eight);
    let (at, len) = (bytes.len(), texels.len());
    bytes.extend(texels);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let whole = bytes.len();
    let (start, end) = GLTF.split_once("\"buffers\"").expect("buffers");
    let (_, end) = end.split_once("\"bufferViews\": [").expect("views");
    let end = end.replace(
        "\"uri\": \"t.png\"",
        "\"bufferView\": 2, \"mimeType\": \"image/png\"",
    );
    let mut json =
        format!("{start}\"buffers\": [{{\"byteLength\": {whole}}}], \"bufferViews\": [{end}",);
    json = json.replace(
        "\"byteLength\": 6}",
        &format!(
            "\"byteLength\": 6}}, {{\"buffer\": 0, \"byteOffset\": {at}, \"byteLength\": {len}}}"
        ),
    );
    while !json.len().is_multiple_of(4) {
        json.push(' ');
    }
    let chunk = |kind: &[u8; 4], body: &[u8]| {
        [&(body.len() as u32).to_le_bytes(), &kind[..], body].concat()
    };
    let chunks = [chunk(b"JSON", json.as_bytes()), chunk(b"BIN\0", &bytes)].concat();
    let length = 12 + chunks.len() as u32;
    [
        &b"glTF"[..],
        &2_u32.to_le_bytes(),
        &length.to_le_bytes(),
        &chunks,
    ]
    .concat()
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

fn hdr() -> Vec<u8> {
    let texels: Vec<_> = (0..128).map(|i| image::Rgb([i as f32, 0.5, 1.0])).collect();
    let mut bytes = Vec::new();
    let encoder = image::codecs::hdr::HdrEncoder::new(&mut bytes);
    encoder.encode(&texels, 16, 8).expect("an HDR image");
    bytes
}

fn exr() -> Vec<u8> {
    use exr::prelude::*;
    let texels =
        SpecificChannels::rgb(|at: Vec2<usize>| (at.x() as f32, 0.5f32, f16::from_f32(1.0)));
    let layer = Layer::new(
        (16, 8),
        LayerAttributes::named("sky"),
        Encoding::SMALL_LOSSLESS,
        texels,
    );
    let mut bytes = std::io::Cursor::new(Vec::new());
    let written = Image::from_layer(layer).write().to_buffered(&mut bytes);
    written.expect("an EXR image");
    bytes.into_inner()
}

pub(crate) const OBJ: &str = "mtllib m.mtl\no a\nv 0 0 0\nv 1 0 0.5\nv 1 1 0 1\nv 0 1 0 0.2 0.3 0.4\nv 0.5 0.5 2\nvt 0 0\nvt 1 0.5\n\
    vt 0.25\nvn 0 0 1\nvn 0 0.6 0.8\nusemtl a\nf 1/1/1 2/2/1 3/1/2\nf -5 -3 -2 # four\ng b c\ns 1\nusemtl b\n\
    f 1//1 4//2 \\\n5//1\nf 1/1 2/2 5/3\nl 1 2\n";

const POLYGONS: &str = "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nv 3 3 1\nv 2 -1 0\nf 1 2 3 4\nf 1 2 5 4\nf 1 6 2 5 4\n\
    f 6 5 4 3 2 1\nf 1 1 2\nf 2 3 1\n";

pub(crate) const MTL: &str = "newmtl a\nKd 0.5\nmap_Kd -s 1 1 1 t.png\nmap_d t.png\nd 0.9\nillum 2\nnewmtl b\nKd 0.1 0.2 0.3\n\
    Ke 1 2 3\nTr 0.5\nNs 10\nKs 0 0 0\n";

/// A textured triangle, a camera and a light under nodes.
const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2]}],
"extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 9, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}]}},
"nodes": [{"name": "a", "children": [1], "rotation": [0, 0.6, 0, 0.8], "scale": [1, 2, -1]},
{"mesh": 0, "translation": [0.5, 0, 1]},
{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 4, 1], "camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 1.5}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0, "mode": 4}]}],
"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 3]}}},
"metallicFactor": 0.5, "roughnessFactor": 0.2}, "alphaMode": "MASK", "alphaCutoff": 0.3, "emissiveFactor": [0.1, 0, 1]}],
"textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071, "magFilter": 9728}], "images": [{"uri": "t.png"}],
"buffers": [{"byteLength": 44, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAA/AAABAAIAAAA="}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0.5]},
{"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
{"componentType": 5126, "count": 3, "type": "VEC2", "sparse": {"count": 2, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}}]}"#;

const SCENE: &str = "Scene(version: 1, camera: (at: (0, 0, 5), look_at: (0, 0, 0), vfov_deg: 40, lens: (aperture_radius: 0.1, focus_distance: 4)),\n\
    render: (size: (8, 8), spp: 2, max_bounces: 4, filter: Gaussian(radius_px: 1.5)), background: Linear(0.1, 0.2, 0.3),\n\
    materials: { \"a\": Diffuse(color: Srgb(\"#c0ffee\")), \"b\": Glass(ior: 1.5), \"c\": Plastic(ior: 1.4), \"d\": Metal(), \"e\": Mirror },\n\
    entities: [(name: \"hub\", spin: (axis: (0, 1, 0), deg_per_s: 90, pivot: (1, 0, 0))),\n\
    (name: \"lamp\", shape: Sphere(radius: 1), transform: (translate: (0, 5, 0)), emissive: (radiance: (9, 8, 7))),\n\
    (name: \"ball\", parent: \"hub\", shape: Sphere(radius: 0.5, inverted: true), material: \"b\", transform: (rotate: Euler(10, 20, 30), scale: 2)),\n\
    (name: \"pot\", shape: Mesh(\"m.obj\"), material: \"a\", normals: Smooth(angle_deg: 40), transform: (rotate: AxisAngle(axis: (1, 1, 0), deg: 30), scale: (1, 2, 3)))],\n\
    animation: (fps: 24, frames: 0..48))";
