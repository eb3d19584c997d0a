//! Each way of writing a mesh, a node and a material as a tiny file of our own.

mod looks;
mod places;
mod shapes;

use crate::asset::{AssetStore, Loader, Mesh, Model};
use crate::diag::Diagnostic;
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

/// A folder of files that goes when the test ends.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A file that is being written: one node with one mesh of one primitive, unless a test says otherwise.
struct Draft {
    root: Value,
    bytes: Vec<u8>,
    beside: Vec<(&'static str, Vec<u8>)>,
}

/// What a file gives.
struct Read {
    model: Model,
    store: AssetStore,
    warnings: Vec<Diagnostic>,
}

impl Read {
    /// The mesh with index 0.
    fn mesh(&self) -> &Mesh {
        self.store.mesh(self.model.meshes[0].expect("a mesh"))
    }

    fn codes(&self) -> Vec<&'static str> {
        self.warnings.iter().map(|warning| warning.code).collect()
    }
}

impl Draft {
    fn new() -> Draft {
        Draft {
            root: json!({
                "asset": { "version": "2.0" },
                "scene": 0,
                "scenes": [{ "nodes": [0] }],
                "nodes": [{ "mesh": 0 }],
                "meshes": [{ "primitives": [{ "attributes": {} }] }],
                "accessors": [],
                "bufferViews": [],
            }),
            bytes: Vec::new(),
            beside: Vec::new(),
        }
    }

    /// A triangle in the plane z = 0: (0, 0), (1, 0), (0, 1).
    fn triangle() -> Draft {
        let mut draft = Draft::new();
        draft.positions(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        draft
    }

    fn push(&mut self, list: &str, item: Value) -> usize {
        if self.root.get(list).is_none() {
            self.root[list] = json!([]);
        }
        let list = self.root[list].as_array_mut().expect("a list");
        list.push(item);
        list.len() - 1
    }

    /// A buffer view of these bytes.
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view =
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend(bytes);
        self.push("bufferViews", view)
    }

    /// An accessor of all of a new view.
    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let accessor =
            json!({ "bufferView": view, "type": kind, "componentType": component, "count": count });
        self.push("accessors", accessor)
    }

    fn floats<const N: usize>(&mut self, elements: &[[f32; N]]) -> usize {
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let bytes: Vec<u8> = elements
            .as_flattened()
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        self.accessor(kind, 5126, elements.len(), &bytes)
    }

    /// Positions of the primitive, with their bounds.
    fn positions(&mut self, points: &[[f32; 3]]) -> usize {
        let accessor = self.floats(points);
        let bound = |pick: fn(f32, f32) -> f32, k: usize| {
            points
                .iter()
                .map(|point| point[k])
                .reduce(pick)
                .expect("points")
        };
        let set = |pick| [bound(pick, 0), bound(pick, 1), bound(pick, 2)];
        self.root["accessors"][accessor]["min"] = json!(set(f32::min));
        self.root["accessors"][accessor]["max"] = json!(set(f32::max));
        self.attribute("POSITION", accessor);
        accessor
    }

    fn attribute(&mut self, name: &str, accessor: usize) {
        self.primitive()["attributes"][name] = accessor.into();
    }

    fn primitive(&mut self) -> &mut Value {
        &mut self.root["meshes"][0]["primitives"][0]
    }

    /// Indices of the primitive as 16-bit integers.
    fn indices(&mut self, indices: &[u16]) {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let accessor = self.accessor("SCALAR", 5123, indices.len(), &bytes);
        self.primitive()["indices"] = accessor.into();
    }

    /// The only material, which the primitive uses.
    fn material(&mut self, material: Value) {
        self.root["materials"] = json!([material]);
        self.primitive()["material"] = 0.into();
        let text = self.root["materials"].to_string();
        let known = [
            "KHR_texture_transform",
            "KHR_materials_unlit",
            "KHR_materials_ior",
        ];
        let more = [
            "KHR_materials_transmission",
            "KHR_materials_emissive_strength",
        ];
        let old = ["KHR_materials_pbrSpecularGlossiness"];
        let names = known.iter().chain(&more).chain(&old);
        let used: Vec<&&str> = names.filter(|name| text.contains(**name)).collect();
        if !used.is_empty() {
            self.root["extensionsUsed"] = json!(used);
        }
    }

    /// A texture of an image of 2 × 1 texels, red and blue; its index.
    fn texture(&mut self) -> usize {
        let png = png(2, 1, &[255, 0, 0, 0, 0, 255]);
        let view = self.view(&png);
        let image = json!({ "bufferView": view, "mimeType": "image/png" });
        let image = self.push("images", image);
        self.push("textures", json!({ "source": image }))
    }

    /// Reads the file as a GLB.
    fn read(&self) -> Result<Read, Vec<Diagnostic>> {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let unique = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("luxel-gltf-{}-{unique}", std::process::id());
        let folder = Folder(std::env::temp_dir().join(name));
        fs::create_dir_all(&folder.0).expect("a folder");
        for (name, bytes) in &self.beside {
            fs::write(folder.0.join(name), bytes).expect("a file");
        }
        let file = folder.0.join("a.glb");
        fs::write(&file, self.glb()).expect("a file");
        let mut loader = Loader::new();
        let id = loader.model(&file)?;
        let model = Model::clone(loader.loaded_model(id));
        let warnings = loader.warnings().to_vec();
        let store = loader.finish();
        Ok(Read {
            model,
            store,
            warnings,
        })
    }

    /// A file that loads without a word.
    fn clean(&self) -> Read {
        let read = self.read().expect("a model");
        assert_eq!(read.warnings, []);
        read
    }

    fn glb(&self) -> Vec<u8> {
        let mut root = self.root.clone();
        if !self.bytes.is_empty() {
            root["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        }
        for list in ["accessors", "bufferViews"] {
            if root[list] == json!([]) {
                root.as_object_mut().expect("an object").remove(list);
            }
        }
        let mut text = root.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bytes = self.bytes.clone();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let mut chunks = vec![(b"JSON", text)];
        if !bytes.is_empty() {
            chunks.push((b"BIN\0", bytes));
        }
        let length: usize = chunks.iter().map(|(_, bytes)| 8 + bytes.len()).sum();
        let mut glb = b"glTF".to_vec();
        glb.extend(2u32.to_le_bytes());
        glb.extend((12 + length as u32).to_le_bytes());
        for (kind, bytes) in chunks {
            glb.extend((bytes.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(bytes);
        }
        glb
    }
}

fn png(width: u32, height: u32, texels: &[u8]) -> Vec<u8> {
    use image::ImageEncoder;
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    let kind = image::ExtendedColorType::Rgb8;
    encoder
        .write_image(texels, width, height, kind)
        .expect("a PNG");
    bytes
}
