//! Textured materials over triangles of which some have no texture coordinates. A mesh without any is reported when the
//! world is spawned.

use super::codes;
use super::posed::{Form, Item, Posed};
use crate::asset::{Mesh, MeshMaterial};
use crate::diag::Diagnostic;
use crate::world::{Color, codes as world_codes};
use std::collections::BTreeSet;

/// Meshes that are textured in places only, each at the first entity that brings it.
pub(super) fn partly_textured(posed: &Posed) -> Vec<Diagnostic> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for item in &posed.items {
        let (Form::Mesh(id), Some(mesh)) = (item.form, posed.mesh(item)) else {
            continue;
        };
        let by_scene = item
            .material
            .map(|m| matches!(m.color, Color::Texture { .. }));
        if seen.insert((id, by_scene)) {
            found.extend(partly(posed, item, mesh, by_scene));
        }
    }
    found
}

/// What there is to say about the texture coordinates of a mesh file by itself.
#[must_use]
pub fn check_mesh(mesh: &Mesh) -> Option<Diagnostic> {
    let count = Count::of(mesh, None)?;
    let (code, says) = match count.without == count.textured {
        true => (
            world_codes::FILE_WITHOUT_UV,
            "a material is textured, but the file has no texture coordinates for it".to_owned(),
        ),
        false => (codes::PARTLY_WITHOUT_UV, count.says(mesh)),
    };
    let warning = Diagnostic::warning(code, says).in_file(&mesh.path);
    Some(warning.hint(HINT))
}

/// What to do about it.
const HINT: &str = "give these faces texture coordinates, or a material of one colour";

/// `by_scene` is whether the scene's own material is textured, where there is one.
fn partly(posed: &Posed, item: &Item, mesh: &Mesh, by_scene: Option<bool>) -> Option<Diagnostic> {
    let some = mesh.uvs.iter().any(|uv| uv.is_some()) || mesh.uvs1.iter().any(|uv| uv.is_some());
    let count = Count::of(mesh, by_scene).filter(|_| some)?;
    let component = match by_scene {
        Some(_) => "material",
        None => item.component(),
    };
    let code = codes::PARTLY_WITHOUT_UV;
    let warning = posed.warn(item.entity(), component, code, count.says(mesh));
    Some(warning.hint(HINT))
}

/// Textured triangles, and those of them that have no texture coordinates.
struct Count {
    textured: usize,
    without: usize,
    /// The first of those without, counted from 0 in file order.
    first: usize,
}

impl Count {
    /// `by_scene` is whether the scene's own material is textured, where there is one. `None` where nothing is missing.
    fn of(mesh: &Mesh, by_scene: Option<bool>) -> Option<Count> {
        if by_scene == Some(false) || by_scene.is_none() && !is_textured(mesh) {
            return None;
        }
        let sets: Vec<Vec<u8>> = mesh.materials.iter().map(uv_sets).collect();
        let has: [Vec<bool>; 2] = [
            mesh.uvs.iter().map(|uv| uv.is_some()).collect(),
            mesh.uvs1.iter().map(|uv| uv.is_some()).collect(),
        ];
        let (mut textured, mut without, mut first) = (0, 0, None);
        for (triangle, material) in mesh.material.iter().enumerate() {
            let own = material.and_then(|m| sets.get(m as usize));
            let reads: &[u8] = match by_scene {
                Some(_) => &[0],
                None => own.map_or(&[], Vec::as_slice),
            };
            let corners = 3 * triangle..3 * triangle + 3;
            let covered = |set: &u8| {
                let uvs = has
                    .get(usize::from(*set))
                    .and_then(|uvs| uvs.get(corners.clone()));
                uvs.is_some_and(|uvs| !uvs.contains(&false))
            };
            textured += usize::from(!reads.is_empty());
            if !reads.iter().all(covered) {
                without += 1;
                first.get_or_insert(triangle);
            }
        }
        first.map(|first| Count {
            textured,
            without,
            first,
        })
    }

    fn says(&self, mesh: &Mesh) -> String {
        format!(
            "{} of the {} textured triangles of {} have no texture coordinates: one texel colours them; the first is \
             triangle {}, counted from 0",
            self.without,
            self.textured,
            mesh.path.display(),
            self.first
        )
    }
}

fn is_textured(mesh: &Mesh) -> bool {
    mesh.materials.iter().any(|m| !uv_sets(m).is_empty())
}

/// The sets of texture coordinates that a material of a file reads.
fn uv_sets(material: &MeshMaterial) -> Vec<u8> {
    let uses = [material.texture, material.emission_texture];
    uses.into_iter().flatten().map(|of| of.uv_set).collect()
}
