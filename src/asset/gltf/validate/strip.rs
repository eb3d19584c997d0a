//! The JSON that the typed document is made of: what luxel reads, and only where it is right.
//!
//! The typed crate refuses a file for any flaw anywhere, and lacks quantised positions, textures without an image and
//! primitives without positions. So everything is left out that luxel does not read, or reads by itself: buffers,
//! buffer views, accessors (their number stays), images, animations, skins, morph targets, extras, other extensions;
//! and so is what the validator warned of, whose default will do.

use super::schema::{Care, Kind, Object};
use super::tables::ROOT;
use super::walk::is_of;
use crate::asset::gltf::layout::{items, natural};
use crate::asset::gltf::uses::is_read;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// The JSON without what the typed document should not see. Its needed parts are right: see [`super::check`].
pub(in crate::asset::gltf) fn strip(json: &Value) -> Value {
    let strip = Strip { json };
    let mut root = strip
        .value(json, &Kind::Object(&ROOT))
        .unwrap_or_else(|| json!({}));
    let count = |name: &str| items(json, name).len();
    root["accessors"] = vec![accessor(); count("accessors")].into();
    root["images"] = vec![json!({ "uri": "" }); count("images")].into();
    root["buffers"] = json!([{ "byteLength": 1 }]);
    root["bufferViews"] = json!([{ "buffer": 0, "byteLength": 1 }]);
    for name in ["extensionsRequired", "extensionsUsed"] {
        root.as_object_mut().map(|root| root.remove(name));
    }
    for scene in elements(&mut root, "scenes").filter(|scene| scene.get("nodes").is_none()) {
        scene["nodes"] = json!([]);
    }
    unknown_modes(json, &mut root);
    unusable_cameras(&mut root);
    unusable_lights(&mut root);
    root
}

/// Primitives of an unknown mode become points, which are not drawn either.
fn unknown_modes(json: &Value, root: &mut Value) {
    let meshes = items(json, "meshes").iter().zip(elements(root, "meshes"));
    for (written, mesh) in meshes {
        let primitives = items(written, "primitives").iter();
        for (written, primitive) in primitives.zip(elements(mesh, "primitives")) {
            if written.get("mode").is_some() && primitive.get("mode").is_none() {
                primitive["mode"] = 0.into();
            }
        }
    }
}

/// No node has a camera whose numbers are not there.
fn unusable_cameras(root: &mut Value) {
    let mut bad = BTreeSet::new();
    for (i, camera) in elements(root, "cameras").enumerate() {
        let kind = camera.get("type").and_then(Value::as_str);
        if kind.is_none_or(|kind| camera.get(kind).is_none()) {
            *camera =
                json!({ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 1.0 } });
            bad.insert(i);
        }
    }
    for node in elements(root, "nodes") {
        let camera = node.get("camera").and_then(natural);
        if camera.is_some_and(|camera| bad.contains(&camera)) {
            node.as_object_mut().map(|node| node.remove("camera"));
        }
    }
}

/// A light of no known type is dark, and a spot light without angles has the default ones.
fn unusable_lights(root: &mut Value) {
    let lights = root.pointer_mut("/extensions/KHR_lights_punctual/lights");
    for light in lights.and_then(Value::as_array_mut).into_iter().flatten() {
        match light.get("type").and_then(Value::as_str) {
            None => *light = json!({ "type": "point", "intensity": 0.0 }),
            Some("spot") if light.get("spot").is_none() => light["spot"] = json!({}),
            Some(_) => {}
        }
    }
}

/// A stand-in: accessors, like buffers and their views, are read from the JSON.
fn accessor() -> Value {
    let bound = [0.0; 3];
    json!({ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 1, "min": bound, "max": bound })
}

fn elements<'a>(object: &'a mut Value, name: &str) -> impl Iterator<Item = &'a mut Value> {
    let all = object.get_mut(name).and_then(Value::as_array_mut);
    all.into_iter().flatten()
}

struct Strip<'a> {
    json: &'a Value,
}

impl Strip<'_> {
    /// A value without what is not read or not right; `None` where it is not right itself.
    fn value(&self, value: &Value, kind: &Kind) -> Option<Value> {
        if !is_of(self.json, value, kind) {
            return None;
        }
        match (kind, value) {
            (Kind::Object(object), Value::Object(map)) => self.object(map, object),
            // Elements keep their indices: one that is not right stays as an empty object.
            (Kind::List(of) | Kind::Set(of), Value::Array(all)) => {
                let each = |value| self.value(value, of).unwrap_or_else(|| json!({}));
                Some(all.iter().map(each).collect())
            }
            (Kind::Attributes, Value::Object(map)) => {
                let read = map.iter().filter(|(name, _)| is_read(name));
                let whole =
                    |(name, index): (&String, &Value)| Some((name.clone(), natural(index)?.into()));
                Some(Value::Object(read.filter_map(whole).collect()))
            }
            (Kind::Code(_) | Kind::Integer(_) | Kind::Index(_) | Kind::IndexOf(..), _) => {
                natural(value).map(Value::from)
            }
            _ => Some(value.clone()),
        }
    }

    fn object(&self, map: &Map<String, Value>, object: &Object) -> Option<Value> {
        let mut kept = Map::new();
        for property in object.properties.iter().filter(|p| p.care != Care::Skip) {
            let value = map.get(property.name);
            match value.and_then(|value| self.value(value, &property.kind)) {
                Some(value) => {
                    kept.insert(property.name.into(), value);
                }
                None if property.required => return None,
                None => {}
            }
        }
        let extensions = map.get("extensions");
        let read = object.extensions.iter().filter_map(|(name, object)| {
            let value = self.value(extensions?.get(name)?, &Kind::Object(object))?;
            Some(((*name).to_owned(), value))
        });
        let read: Map<String, Value> = read.collect();
        if !read.is_empty() {
            kept.insert("extensions".into(), read.into());
        }
        Some(Value::Object(kept))
    }
}
