//! The validator of glTF 2.0: what is wrong in a file, in words that name the place.
//!
//! Enter: the JSON, before the typed document sees it; later the bytes of buffers. Leave: findings with JSON pointers.
//! What luxel needs and cannot read, or could read in two ways, is an error; everything else that breaks the
//! specification is a warning. What breaks nothing is silent: unused objects, empty nodes, custom properties.
//!
//! ```text
//!  tables ─▶ walk (types, ranges, indices)    accessors, meshes, nodes, skins, animations, looks (rules between places)
//!  buffers ─▶ elements, images (what the bytes hold)
//! ```

mod accessors;
mod animations;
mod elements;
mod extensions;
mod formats;
mod images;
mod looks;
mod meshes;
mod motion;
mod nodes;
mod report;
mod schema;
mod skins;
mod strip;
mod tables;
#[cfg(test)]
mod tests;
mod usages;
mod vertices;
mod walk;

pub(super) use elements::check as check_elements;
pub(super) use images::check as check_images;
pub(super) use report::Report;
pub(super) use strip::strip;
pub(super) use usages::Usages;

use super::layout::Layouts;
use super::uses::Uses;
use crate::asset::codes;
use crate::diag::Diagnostic;
use serde_json::Value;

/// What the rules look at, and where they report.
pub(super) struct Rules<'a> {
    pub(super) json: &'a Value,
    pub(super) layouts: &'a Layouts,
    pub(super) uses: &'a Uses,
    pub(super) report: &'a mut Report,
    pub(super) usages: Usages,
}

impl Rules<'_> {
    /// Reports an error where the default scene uses the place, and a warning elsewhere.
    fn wrong(
        &mut self,
        used: bool,
        (error, warning): (&'static str, &'static str),
        pointer: impl Into<String>,
        says: impl Into<String>,
    ) {
        if used {
            self.report.error(error, pointer, says);
        } else {
            self.report.warning(warning, pointer, says);
        }
    }

    fn warn(&mut self, code: &'static str, pointer: impl Into<String>, says: impl Into<String>) {
        self.report.warning(code, pointer, says);
    }
}

/// Checks everything that the JSON alone can tell. False for a file of another version, whose places mean other things.
pub(super) fn check(rules: &mut Rules) -> bool {
    if let Some(error) = version(rules.json) {
        rules.report.add(error);
        return false;
    }
    minimum_version(rules);
    walk::check(rules.json, rules.report);
    extensions::check(rules.json, rules.report);
    accessors::check(rules);
    meshes::check(rules);
    let parents = nodes::check(rules);
    skins::check(rules, &parents);
    animations::check(rules);
    looks::check(rules);
    true
}

/// The error of a file that says it is not glTF 2 (section 3.2), or is built like a glTF 1.0 one.
fn version(json: &Value) -> Option<Diagnostic> {
    let version = json.pointer("/asset/version");
    let major = version
        .and_then(Value::as_str)
        .and_then(|text| text.split('.').next());
    // In glTF 1.0 the collections are objects.
    let is_old = version.is_none() && json.get("meshes").is_some_and(Value::is_object);
    let known = major.is_none_or(|major| major == "2" || major.parse::<u32>().is_err());
    if known && !is_old {
        return None;
    }
    let named = major.unwrap_or("1").to_owned();
    let error = Diagnostic::error(
        codes::GLTF_VERSION,
        format!("glTF {named}.x cannot be read"),
    );
    Some(
        error
            .pointer("/asset/version")
            .hint("export it again as glTF 2.0"),
    )
}

/// `minVersion` above `version`, or above what luxel reads (section 3.2).
fn minimum_version(rules: &mut Rules) {
    let parts = |name: &str| -> Option<(u32, u32)> {
        let text = rules.json.get("asset")?.get(name)?.as_str()?;
        let (major, minor) = text.split_once('.')?;
        Some((major.parse().ok()?, minor.parse().ok()?))
    };
    let (version, least) = (parts("version"), parts("minVersion"));
    if let (Some(version), Some(least)) = (version, least)
        && least > version
    {
        let says = format!(
            "minVersion {}.{} is above version {}.{}",
            least.0, least.1, version.0, version.1
        );
        rules.warn(codes::GLTF_ODD_VALUE, "/asset/minVersion", says);
    }
    if let Some(least) = least.filter(|&least| least > (2, 0)) {
        let says = format!(
            "the file needs glTF {}.{}, and luxel reads 2.0",
            least.0, least.1
        );
        rules
            .report
            .error(codes::GLTF_VERSION, "/asset/minVersion", says);
    } else if let Some(version) = version.filter(|&version| version > (2, 0)) {
        let says = format!("glTF {}.{} is read as 2.0", version.0, version.1);
        rules.warn(codes::GLTF_ODD_VALUE, "/asset/version", says);
    }
}
