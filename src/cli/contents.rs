//! What is in a mesh file, in one line.

use crate::asset::{AssetStore, ModelId, ModelNode, NodeTransform};
use crate::check::short;
use crate::math::{DAffine3, DMat3, DVec3, quaternion};
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
        let Some(model) = model else {
            for id in 0..store.meshes.len() {
                contents.add(store, id, &DAffine3::IDENTITY);
            }
            return contents;
        };
        // Parents come before their children.
        let mut placed: Vec<DAffine3> = Vec::with_capacity(nodes.len());
        for node in nodes {
            let parent = node.parent.and_then(|p| placed.get(p).copied());
            let to_world = parent.unwrap_or(DAffine3::IDENTITY) * local(&node.transform);
            placed.push(to_world);
            let mesh = node.mesh.and_then(|m| *model.meshes.get(m)?);
            if let Some(mesh) = mesh {
                contents.add(store, mesh.0 as usize, &to_world);
            }
        }
        contents
    }

    fn add(&mut self, store: &AssetStore, mesh: usize, to_world: &DAffine3) {
        let mesh = &store.meshes[mesh];
        self.triangles += mesh.triangle_count();
        for corner in &mesh.corners {
            let Some(p) = mesh.positions.get(*corner as usize) else {
                continue;
            };
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

fn local(transform: &NodeTransform) -> DAffine3 {
    match *transform {
        NodeTransform::Parts {
            translate,
            rotate,
            scale,
        } => DAffine3 {
            matrix3: quaternion(rotate) * DMat3::from_diagonal(scale),
            translation: translate,
        },
        NodeTransform::Matrix(map) => map,
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
