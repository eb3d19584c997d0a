//! What entities are called.

use crate::flat::ObjectId;
use crate::scene::SceneDesc;

/// An entity by its name, or by its index where it has none.
pub(crate) fn entity_name(desc: &SceneDesc, ObjectId(entity): ObjectId) -> String {
    let named = desc.entities.get(entity as usize);
    match named.and_then(|e| e.value.name.as_ref()) {
        Some(name) => format!("\"{name}\""),
        None => format!("entity {entity}"),
    }
}
