//! The walk over a file by the tables: types, required properties, ranges, words, indices, empty things, misspelt names.
//!
//! Deliberately absent: rules that tie two places of the file together; see the other modules of [`super`].

use super::extensions;
use super::report::Report;
use super::schema::{Care, Kind, Object, Property, Range};
use super::tables::ROOT;
use crate::asset::codes;
use crate::asset::gltf::layout::{items, natural};
use crate::asset::gltf::uri;
use crate::asset::gltf::uses::is_read;
use crate::asset::paths::most_similar;
use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// Checks the whole of a file against the tables.
pub(super) fn check(json: &Value, report: &mut Report) {
    let declared = extensions::declared(json);
    let mut walk = Walk {
        json,
        declared,
        report,
    };
    walk.value(json, &Kind::Object(&ROOT), Care::Need, "");
}

/// Whether a value alone is of a kind, whatever its parts and its range.
pub(super) fn is_of(json: &Value, value: &Value, kind: &Kind) -> bool {
    match kind {
        Kind::Bool => value.is_boolean(),
        Kind::Text => value.is_string(),
        Kind::Version => value.as_str().is_some_and(is_version),
        Kind::Uri => value.as_str().is_some_and(is_uri),
        Kind::Word(words) => value.as_str().is_some_and(|word| words.contains(&word)),
        Kind::Code(codes) => natural(value).is_some_and(|code| codes.contains(&(code as u64))),
        Kind::Integer(least) => natural(value).is_some_and(|number| number >= *least),
        Kind::Number(_) => is_number(value),
        Kind::Numbers(lengths, _) => value.as_array().is_some_and(|all| {
            all.iter().all(is_number) && (lengths.is_empty() || lengths.contains(&all.len()))
        }),
        Kind::Index(array) => natural(value).is_some_and(|index| index < items(json, array).len()),
        Kind::IndexOf(extension, array) => natural(value)
            .is_some_and(|index| index < extensions::listed(json, extension, array).len()),
        Kind::List(_) | Kind::Set(_) => value.is_array(),
        Kind::Object(_) | Kind::Attributes => value.is_object(),
    }
}

/// A number that is finite as f32, which the format means (section 3.6.2.2) and the typed document holds.
fn is_number(value: &Value) -> bool {
    value
        .as_f64()
        .is_some_and(|number| number.abs() <= f64::from(f32::MAX))
}

/// `<major>.<minor>` (section 3.2).
fn is_version(text: &str) -> bool {
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|c| c.is_ascii_digit());
    text.split_once('.')
        .is_some_and(|(major, minor)| digits(major) && digits(minor))
}

/// Whether a URI can be one at all: not empty, no empty scheme, and data after `data:`, which are decoded later.
fn is_uri(text: &str) -> bool {
    match uri::scheme(text).map(str::to_ascii_lowercase).as_deref() {
        Some("") => false,
        Some("data") => text.contains(','),
        _ => !text.is_empty(),
    }
}

/// What a value of a kind is, for a message.
fn meant(kind: &Kind) -> String {
    match kind {
        Kind::Bool => "true or false".into(),
        Kind::Text => "a string".into(),
        Kind::Version => "a version like \"2.0\"".into(),
        Kind::Uri => "a path or a data URI".into(),
        Kind::Word(words) => format!("one of {}", words.join(", ")),
        Kind::Code(codes) => {
            let codes: Vec<String> = codes.iter().map(u64::to_string).collect();
            format!("one of {}", codes.join(", "))
        }
        Kind::Integer(0) => "a non-negative integer".into(),
        Kind::Integer(least) => format!("an integer of at least {least}"),
        Kind::Number(_) => "a number".into(),
        Kind::Numbers([], _) => "an array of numbers".into(),
        Kind::Numbers(lengths, _) => {
            let lengths: Vec<String> = lengths.iter().map(usize::to_string).collect();
            format!("an array of {} numbers", lengths.join(", "))
        }
        Kind::Index(array) => format!("an index into {array:?}"),
        Kind::IndexOf(extension, array) => format!("an index into the {array} of {extension}"),
        Kind::List(_) | Kind::Set(_) => "an array".into(),
        Kind::Object(_) | Kind::Attributes => "an object".into(),
    }
}

/// The start of a value, for a message; quoted, so that like findings are told apart from it.
fn shown(value: &Value) -> String {
    const KEPT: usize = 40;
    let text = match value {
        Value::Array(_) => "an array".into(),
        Value::Object(_) => "an object".into(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    match text.char_indices().nth(KEPT) {
        Some((at, _)) => format!("{:?}", format!("{}...", &text[..at])),
        None if value.is_array() || value.is_object() => text,
        None if value.is_string() => format!("{text:?}"),
        None => text,
    }
}

/// A JSON pointer, one step further (RFC 6901).
pub(super) fn step(pointer: &str, name: &str) -> String {
    format!("{pointer}/{}", name.replace('~', "~0").replace('/', "~1"))
}

struct Walk<'a> {
    json: &'a Value,
    declared: BTreeSet<&'a str>,
    report: &'a mut Report,
}

impl Walk<'_> {
    /// Reports by the care for the place: an error with this code where it is needed, else a warning.
    fn wrong(&mut self, care: Care, code: &'static str, pointer: &str, says: String) {
        if care == Care::Need {
            self.report.error(code, pointer, says);
        } else {
            self.report.warning(codes::GLTF_ODD_VALUE, pointer, says);
        }
    }

    fn value(&mut self, value: &Value, kind: &Kind, care: Care, pointer: &str) {
        if !is_of(self.json, value, kind) {
            let dangling = matches!(kind, Kind::Index(_) | Kind::IndexOf(..)) && value.is_u64();
            let (code, says) = if dangling {
                let array = meant(kind);
                let says = format!("{value} is not {array}: there is no such element");
                (codes::GLTF_REFERENCE, says)
            } else {
                let says = format!("{} is not {}", shown(value), meant(kind));
                (codes::GLTF_VALUE, says)
            };
            return self.wrong(care, code, pointer, says);
        }
        match (kind, value) {
            (Kind::Number(range), number) => self.range(*range, number, pointer),
            (Kind::Numbers(_, range), Value::Array(all)) => {
                if all.is_empty() {
                    self.report.warning(
                        codes::GLTF_EMPTY,
                        pointer,
                        "an empty array, which should be absent",
                    );
                }
                for (i, number) in all.iter().enumerate() {
                    self.range(*range, number, &format!("{pointer}/{i}"));
                }
            }
            (Kind::List(of) | Kind::Set(of), Value::Array(all)) => {
                self.list(all, of, matches!(kind, Kind::Set(_)), care, pointer);
            }
            (Kind::Uri, Value::String(text)) if uri::has_empty_parameter(text) => {
                let says = "a data URI with an empty parameter (`;;`)";
                self.report.warning(codes::GLTF_ODD_VALUE, pointer, says);
            }
            (Kind::Object(object), Value::Object(map)) => self.object(map, object, care, pointer),
            (Kind::Attributes, Value::Object(map)) => self.attributes(map, care, pointer),
            _ => {}
        }
    }

    fn range(&mut self, range: Range, value: &Value, pointer: &str) {
        let Some(number) = value.as_f64().filter(|&number| !range.contains(number)) else {
            return;
        };
        let Range { least, most, above } = range;
        let from = if above { "above" } else { "at least" };
        let says = match (least.is_finite(), most.is_finite()) {
            (true, true) => format!("{number} is out of range: it may be {least} to {most}"),
            (false, true) => format!("{number} is out of range: it may be at most {most}"),
            _ => format!("{number} is out of range: it must be {from} {least}"),
        };
        self.report.warning(codes::GLTF_ODD_VALUE, pointer, says);
    }

    fn list(&mut self, all: &[Value], of: &Kind, unique: bool, care: Care, pointer: &str) {
        if all.is_empty() {
            let says = "an empty array, which should be absent";
            self.report.warning(codes::GLTF_EMPTY, pointer, says);
        }
        let mut seen = BTreeSet::new();
        for (i, value) in all.iter().enumerate() {
            let pointer = format!("{pointer}/{i}");
            if unique && !seen.insert(value.to_string()) {
                let says = format!("{} is in the array twice", shown(value));
                self.report.warning(codes::GLTF_ODD_VALUE, &pointer, says);
            }
            self.value(value, of, care, &pointer);
        }
    }

    fn object(&mut self, map: &Map<String, Value>, object: &Object, care: Care, pointer: &str) {
        for property in object.properties {
            self.property(map, property, care.min(property.care), pointer);
        }
        for (name, value) in map {
            let known = |property: &Property| property.name == name;
            if name == "extensions" {
                self.extensions(value, object, care, &step(pointer, name));
            } else if name != "extras" && !object.properties.iter().any(known) {
                self.unknown(map, object, name, pointer);
            }
        }
    }

    fn property(
        &mut self,
        map: &Map<String, Value>,
        property: &Property,
        care: Care,
        pointer: &str,
    ) {
        match map.get(property.name) {
            Some(value) => self.value(value, &property.kind, care, &step(pointer, property.name)),
            None if property.required => {
                // What a required word or code stands for cannot be guessed, but may not be needed either.
                let says = format!("{:?} is missing: {}", property.name, meant(&property.kind));
                self.wrong(care, codes::GLTF_VALUE, pointer, says);
            }
            None => {}
        }
    }

    /// A property that the object does not have; told where it may be a misspelt one.
    fn unknown(&mut self, map: &Map<String, Value>, object: &Object, name: &str, pointer: &str) {
        let absent = object.properties.iter().map(|property| property.name);
        let absent = absent.filter(|name| !map.contains_key(*name));
        if let Some(similar) = most_similar(name, absent) {
            let says = format!("there is no property {name:?}: did you mean {similar:?}?");
            self.report
                .warning(codes::GLTF_UNKNOWN_PROPERTY, step(pointer, name), says);
        }
    }

    fn extensions(&mut self, value: &Value, object: &Object, care: Care, pointer: &str) {
        let Some(map) = value.as_object() else {
            let says = format!("{} is not an object", shown(value));
            return self.wrong(Care::Skip, codes::GLTF_VALUE, pointer, says);
        };
        for (name, value) in map {
            let pointer = step(pointer, name);
            if !self.declared.contains(name.as_str()) {
                let says = format!("the extension {name:?} is not declared in \"extensionsUsed\"");
                self.report.warning(codes::GLTF_DECLARATION, &pointer, says);
            }
            let read = object.extensions.iter().find(|(known, _)| known == name);
            match read {
                Some((_, object)) => {
                    self.value(value, &Kind::Object(object), care.min(Care::Keep), &pointer)
                }
                None if !value.is_object() => {
                    let says = format!("{} is not an object", shown(value));
                    self.report.warning(codes::GLTF_ODD_VALUE, &pointer, says);
                }
                None if extensions::has_places(name) => {
                    let says = format!("the extension {name:?} has no place here");
                    self.report.warning(codes::GLTF_DECLARATION, &pointer, says);
                }
                None => {}
            }
        }
    }

    fn attributes(&mut self, map: &Map<String, Value>, care: Care, pointer: &str) {
        if map.is_empty() {
            let says = "an empty object, which should be absent";
            self.report.warning(codes::GLTF_EMPTY, pointer, says);
        }
        for (name, value) in map {
            let care = if is_read(name) { care } else { Care::Skip };
            self.value(value, &Kind::Index("accessors"), care, &step(pointer, name));
        }
    }
}
