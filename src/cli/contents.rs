//! What is in a mesh file, in one line.

use crate::asset::{AssetStore, Mesh, MeshId, ModelId, ModelNode};
use crate::check::short;
use crate::math::{DAffine3, DVec3};
use serde_json::{Value, json};
use std::fmt;

/// Counts and bounds.
pub(crate) struct Contents {
    triangles: usize,
    materials: usize,
    /// Width and height of each.
    textures: Vec<(u32, u32)>,
    nodes: usize,
    cameras: usize,
    lights: usize,
    /// Least and greatest coordinates of the vertices that triangles use, in the file's units.
    bounds: Option<(DVec3, DVec3)>,
}

impl Contents {
    /// Of a store that holds one OBJ file, or the files of one glTF file.
    pub(crate) fn of(store: &AssetStore, model: Option<ModelId>) -> Contents {
        let model = model.map(|id| store.model(id));
        let nodes: &[ModelNode] = model.map_or(&[], |model| &model.nodes);
        let mut contents = Contents {
            triangles: 0,
            materials: store.meshes.iter().map(|mesh| mesh.materials.len()).sum(),
            textures: store.textures.iter().map(|t| (t.width, t.height)).collect(),
            nodes: nodes.len(),
            cameras: nodes.iter().filter(|n| n.camera_vfov_deg.is_some()).count(),
            lights: nodes.iter().filter(|n| n.light.is_some()).count(),
            bounds: None,
        };
        let alone = |id: usize| (MeshId(id as u32), DAffine3::IDENTITY);
        let placed = match model {
            Some(model) => model.placed(),
            None => (0..store.meshes.len()).map(alone).collect(),
        };
        for (mesh, to_world) in placed {
            contents.add(store.mesh(mesh), &to_world);
        }
        contents
    }

    fn add(&mut self, mesh: &Mesh, to_world: &DAffine3) {
        self.triangles += mesh.triangle_count();
        for p in &mesh.positions {
            let p = to_world.transform_point3(*p);
            let (min, max) = self.bounds.unwrap_or((p, p));
            self.bounds = Some((min.min(p), max.max(p)));
        }
    }

    /// The same for programs.
    pub(crate) fn json(&self) -> Value {
        json!({
            "triangles": self.triangles,
            "materials": self.materials,
            "textures": self.textures,
            "nodes": self.nodes,
            "cameras": self.cameras,
            "lights": self.lights,
            "min": self.bounds.map(|(min, _)| min.to_array()),
            "max": self.bounds.map(|(_, max)| max.to_array()),
        })
    }
}

impl fmt::Display for Contents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = |n: usize, one: &str| match n {
            1 => format!("1 {one}"),
            n => format!("{n} {one}s"),
        };
        let mut parts = vec![
            count(self.triangles, "triangle"),
            count(self.materials, "material"),
        ];
        let sizes: Vec<String> = self
            .textures
            .iter()
            .map(|(w, h)| format!("{w}x{h}"))
            .collect();
        parts.push(match sizes.as_slice() {
            [] => "no textures".to_owned(),
            sizes => format!("{} ({})", count(sizes.len(), "texture"), sizes.join(", ")),
        });
        for (n, one) in [
            (self.nodes, "node"),
            (self.cameras, "camera"),
            (self.lights, "light"),
        ] {
            parts.extend((n > 0).then(|| count(n, one)));
        }
        if let Some((min, max)) = self.bounds {
            let size = max - min;
            let three = |p: DVec3| [p.x, p.y, p.z].map(short);
            parts.push(format!(
                "{} wide, from ({}) to ({})",
                three(size).join(" x "),
                three(min).join(", "),
                three(max).join(", ")
            ));
        }
        f.write_str(&parts.join(", "))
    }
}
