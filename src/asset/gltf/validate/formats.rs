//! Formats that accessors may have, by what uses them (specification, sections 3.7.2.1, 3.7.3.1 and 3.11;
//! KHR_mesh_quantization).

use crate::asset::gltf::layout::{Accessor, Component};
use crate::asset::gltf::uses::is_set;
use Component::{F32, I8, I16, U8, U16, U32};

/// Shapes and components, each of the components with whether it must be normalised; `None` where both will do.
#[derive(Clone, Copy)]
pub(super) struct Formats {
    pub(super) shapes: &'static [&'static str],
    components: &'static [(Component, Option<bool>)],
}

const fn formats(
    shapes: &'static [&'static str],
    components: &'static [(Component, Option<bool>)],
) -> Formats {
    Formats { shapes, components }
}

type Components = &'static [(Component, Option<bool>)];

const PLAIN: Components = &[(F32, Some(false))];
const SHARES: Components = &[(F32, Some(false)), (U8, Some(true)), (U16, Some(true))];
const SIGNED_SHARES: Components = &[(F32, Some(false)), (I8, Some(true)), (I16, Some(true))];
const ANY_SHARES: Components = &[
    (F32, Some(false)),
    (I8, Some(true)),
    (U8, Some(true)),
    (I16, Some(true)),
    (U16, Some(true)),
];
const QUANTIZED: Components = &[
    (F32, Some(false)),
    (I8, None),
    (U8, None),
    (I16, None),
    (U16, None),
];

pub(super) const INDICES: Formats = formats(
    &["SCALAR"],
    &[(U8, Some(false)), (U16, Some(false)), (U32, Some(false))],
);
pub(super) const INVERSE_BIND_MATRICES: Formats = formats(&["MAT4"], PLAIN);
pub(super) const KEY_TIMES: Formats = formats(&["SCALAR"], PLAIN);

impl Formats {
    pub(super) fn allow(self, accessor: &Accessor) -> bool {
        let component = |(component, normalized): &(Component, Option<bool>)| {
            *component == accessor.component && normalized.is_none_or(|n| n == accessor.normalized)
        };
        self.allow_shape(accessor) && self.components.iter().any(component)
    }

    /// Whether at least the number of components is right.
    pub(super) fn allow_shape(self, accessor: &Accessor) -> bool {
        self.shapes.contains(&accessor.shape.name)
    }

    /// `VEC3 of FLOAT or UNSIGNED_BYTE normalized`, for messages.
    pub(super) fn names(self) -> String {
        let component = |(component, normalized): &(Component, Option<bool>)| match normalized {
            Some(true) => format!("{} normalized", component.name()),
            _ => component.name().to_owned(),
        };
        let components: Vec<String> = self.components.iter().map(component).collect();
        format!(
            "{} of {}",
            self.shapes.join(" or "),
            components.join(" or ")
        )
    }
}

/// The formats of a vertex attribute by name; `None` for one that the format does not know.
pub(super) fn of_attribute(name: &str, quantized: bool) -> Option<Formats> {
    Some(match semantic(name)? {
        "POSITION" if quantized => formats(&["VEC3"], QUANTIZED),
        "POSITION" => formats(&["VEC3"], PLAIN),
        "NORMAL" if quantized => formats(&["VEC3"], SIGNED_SHARES),
        "NORMAL" => formats(&["VEC3"], PLAIN),
        "TANGENT" if quantized => formats(&["VEC4"], SIGNED_SHARES),
        "TANGENT" => formats(&["VEC4"], PLAIN),
        "TEXCOORD" if quantized => formats(&["VEC2"], QUANTIZED),
        "TEXCOORD" => formats(&["VEC2"], SHARES),
        "COLOR" => formats(&["VEC3", "VEC4"], SHARES),
        "JOINTS" => formats(&["VEC4"], &[(U8, Some(false)), (U16, Some(false))]),
        _ => formats(&["VEC4"], SHARES),
    })
}

/// The formats of a morph target's attribute by name (section 3.7.2.2).
pub(super) fn of_target(name: &str, quantized: bool) -> Option<Formats> {
    Some(match semantic(name)? {
        "POSITION" | "NORMAL" | "TANGENT" if quantized => formats(&["VEC3"], QUANTIZED),
        "POSITION" | "NORMAL" | "TANGENT" => formats(&["VEC3"], PLAIN),
        "TEXCOORD" => formats(&["VEC2"], if quantized { QUANTIZED } else { ANY_SHARES }),
        "COLOR" => formats(&["VEC3", "VEC4"], ANY_SHARES),
        _ => return None,
    })
}

/// The formats of what an animation channel of a path moves.
pub(super) fn of_path(path: &str) -> Option<Formats> {
    Some(match path {
        "translation" | "scale" => formats(&["VEC3"], PLAIN),
        "rotation" => formats(&["VEC4"], ANY_SHARES),
        "weights" => formats(&["SCALAR"], ANY_SHARES),
        _ => return None,
    })
}

/// Names of vertex attributes that come in numbered sets.
pub(super) const SETS: [&str; 4] = ["TEXCOORD", "COLOR", "JOINTS", "WEIGHTS"];

/// The semantic of an attribute, without the number of its set; `None` for one that the format does not know.
pub(super) fn semantic(name: &str) -> Option<&'static str> {
    let single = ["POSITION", "NORMAL", "TANGENT"]
        .into_iter()
        .find(|known| *known == name);
    single.or_else(|| {
        let (stem, set) = name.rsplit_once('_')?;
        SETS.into_iter().find(|known| *known == stem && is_set(set))
    })
}
