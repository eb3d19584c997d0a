//! What the default scene of a file uses: only that must be there and right.
//!
//! Works on the JSON, before anything is known to be right.

use super::layout::{Layouts, items, natural};
use serde_json::Value;
use std::collections::BTreeSet;

/// Vertex attributes that luxel reads, and how it names the sets of those that have several.
pub(super) fn is_read(attribute: &str) -> bool {
    let set = |prefix| attribute.strip_prefix(prefix).is_some_and(is_set);
    matches!(attribute, "POSITION" | "NORMAL") || set("TEXCOORD_") || set("COLOR_")
}

/// The number of a set of attributes, as the format writes it: without a sign or leading zeros.
pub(super) fn is_set(number: &str) -> bool {
    number.parse::<u32>().is_ok_and(|n| n.to_string() == number)
}

/// Indices of what the default scene uses.
#[derive(Debug, Default)]
pub(super) struct Uses {
    pub(super) nodes: BTreeSet<usize>,
    pub(super) meshes: BTreeSet<usize>,
    pub(super) materials: BTreeSet<usize>,
    pub(super) textures: BTreeSet<usize>,
    pub(super) images: BTreeSet<usize>,
    /// Those of indices and of attributes that luxel reads.
    pub(super) accessors: BTreeSet<usize>,
    /// Those of used accessors and images.
    pub(super) views: BTreeSet<usize>,
    /// Those of used views.
    pub(super) buffers: BTreeSet<usize>,
}

impl Uses {
    /// What the default scene uses: the scene that the file names, else its first, else every root node.
    pub(super) fn of(json: &Value, layouts: &Layouts) -> Uses {
        let mut uses = Uses::default();
        uses.walk(json, roots(json));
        let mut materials = BTreeSet::new();
        for &mesh in &uses.meshes {
            for primitive in
                element(json, "meshes", mesh).map_or(&[][..], |mesh| items(mesh, "primitives"))
            {
                materials.extend(index(primitive, "material"));
                uses.accessors.extend(accessors(primitive));
            }
        }
        for &material in &materials {
            let infos = element(json, "materials", material).map_or(vec![], texture_infos);
            uses.textures
                .extend(infos.into_iter().map(|(_, texture)| texture));
        }
        uses.materials = materials;
        let source =
            |&texture: &usize| element(json, "textures", texture).and_then(|t| index(t, "source"));
        uses.images = uses.textures.iter().filter_map(source).collect();
        let of_image =
            |&image: &usize| element(json, "images", image).and_then(|i| index(i, "bufferView"));
        let of_images = uses.images.iter().filter_map(of_image);
        let of_accessors = uses.accessors.iter().filter_map(|&i| layouts.accessor(i));
        uses.views = of_accessors
            .flat_map(|a| a.views())
            .chain(of_images)
            .collect();
        let buffer = |&view: &usize| layouts.view(view).map(|view| view.buffer);
        uses.buffers = uses.views.iter().filter_map(buffer).collect();
        uses
    }

    fn walk(&mut self, json: &Value, mut open: Vec<usize>) {
        while let Some(at) = open.pop() {
            let Some(node) = element(json, "nodes", at).filter(|_| self.nodes.insert(at)) else {
                continue;
            };
            self.meshes.extend(index(node, "mesh"));
            open.extend(items(node, "children").iter().filter_map(natural));
        }
    }
}

/// The root nodes of the default scene.
fn roots(json: &Value) -> Vec<usize> {
    let scenes = items(json, "scenes");
    let Some(first) = scenes.first() else {
        let children = |node| items(node, "children").iter().filter_map(natural);
        let below: BTreeSet<usize> = items(json, "nodes").iter().flat_map(children).collect();
        let all = 0..items(json, "nodes").len();
        return all.filter(|node| !below.contains(node)).collect();
    };
    let named = index(json, "scene").and_then(|scene| scenes.get(scene));
    let nodes = items(named.unwrap_or(first), "nodes");
    nodes.iter().filter_map(natural).collect()
}

/// An element of a top-level array.
pub(super) fn element<'a>(json: &'a Value, array: &str, index: usize) -> Option<&'a Value> {
    items(json, array).get(index)
}

/// The index that a property holds.
pub(super) fn index(object: &Value, name: &str) -> Option<usize> {
    object.get(name).and_then(natural)
}

/// The accessors of a primitive that luxel reads.
pub(super) fn accessors(primitive: &Value) -> Vec<usize> {
    let attributes = primitive.get("attributes").and_then(Value::as_object);
    let read = attributes
        .into_iter()
        .flatten()
        .filter(|(name, _)| is_read(name));
    let read = read.filter_map(|(_, accessor)| natural(accessor));
    read.chain(index(primitive, "indices")).collect()
}

/// The textures that a material needs luxel to read, with the place of each in the material.
pub(super) fn texture_infos(material: &Value) -> Vec<(&'static str, usize)> {
    const PLACES: &[&str] = &[
        "/pbrMetallicRoughness/baseColorTexture",
        "/pbrMetallicRoughness/metallicRoughnessTexture",
        "/emissiveTexture",
        "/extensions/KHR_materials_transmission/transmissionTexture",
        "/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
    ];
    let at = |place: &&'static str| Some((*place, index(material.pointer(place)?, "index")?));
    PLACES.iter().filter_map(at).collect()
}
