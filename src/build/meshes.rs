//! Meshes to triangles: flattened into scene units, or kept in local units for their instances.

use super::flatten::Context;
use super::rebase::{self, to_local};
use super::support::Support;
use crate::asset::normals::smooth;
use crate::asset::{Mesh, MeshId, PerCorner};
use crate::flat::{self, ObjectId, Rebase, Shading};
use crate::math::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3, unit};
use crate::world::Normals;

/// A mesh with its normals: what is flattened, or what instances share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct MeshKey {
    pub(crate) mesh: MeshId,
    /// What [`Normals`] it is, and the bits of its angle.
    normals: (u8, u64),
}

impl MeshKey {
    pub(crate) fn new(mesh: MeshId, normals: Normals) -> MeshKey {
        let normals = match normals {
            Normals::File => (0, 0),
            Normals::Flat => (1, 0),
            Normals::Smooth { angle_deg } => (2, angle_deg.to_bits()),
        };
        MeshKey { mesh, normals }
    }
}

/// Unit corner normals in the mesh's own space that are not those of its file as they stand.
pub(crate) fn smooth_normals(mesh: &Mesh, normals: Normals) -> PerCorner<DVec3> {
    match normals {
        Normals::Smooth { angle_deg } => smooth(mesh, angle_deg),
        Normals::File | Normals::Flat => {
            let smooth = smooth(mesh, Normals::DEFAULT_ANGLE_DEG);
            mesh.normals.or(&smooth)
        }
    }
}

/// Triangles of one space with their cold arrays, before there is a tree.
#[derive(Debug, Default)]
pub(crate) struct Soup {
    pub(crate) triangles: Vec<[Vec3; 3]>,
    pub(crate) shading: Shading,
}

/// What to append to a [`Soup`], and how.
pub(crate) struct Part<'a> {
    pub(crate) mesh: &'a Mesh,
    /// Unit normals in the mesh's own space; `None` where every triangle is flat.
    pub(crate) normals: Option<&'a PerCorner<DVec3>>,
    /// From the mesh's own space to that of the soup.
    pub(crate) to: DAffine3,
    /// Which cold arrays the soup keeps.
    pub(crate) keep: Keep,
}

/// Which cold arrays something requires.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Keep {
    pub(crate) normals: bool,
    pub(crate) uvs: bool,
    pub(crate) uvs1: bool,
    pub(crate) colors: bool,
}

impl Soup {
    /// Appends every triangle of a mesh, with the material that `material` gives to its index in the file.
    ///
    /// A map that mirrors swaps the second and third corner, with all that belongs to them, so that counter-clockwise
    /// stays outward. Every coordinate is rounded once; a triangle that collapses is kept, and never hit.
    pub(crate) fn append(
        &mut self,
        part: &Part,
        object: Option<ObjectId>,
        material: impl Fn(u32) -> u32,
    ) {
        let Part { mesh, to, keep, .. } = part;
        let points: Vec<DVec3> = mesh
            .positions
            .iter()
            .map(|p| to.transform_point3(*p))
            .collect();
        let cofactor = cofactor(&to.matrix3);
        let normals = part.normals.map_or(&[][..], PerCorner::values);
        let turned: Vec<Option<Vec3>> = normals
            .iter()
            .map(|normal| unit(cofactor * *normal).map(|normal| normal.as_vec3()))
            .collect();
        let order = if mirrors(&to.matrix3) {
            [0, 2, 1]
        } else {
            [0, 1, 2]
        };
        self.reserve(mesh.triangle_count(), keep);
        for prim in 0..mesh.triangle_count() {
            let corners = order.map(|k| 3 * prim + k);
            let vertices = corners.map(|c| points[mesh.corners[c] as usize]);
            self.triangles.push(vertices.map(|v| v.as_vec3()));
            if keep.normals {
                let normal = |c: usize| {
                    let authored = part.normals.and_then(|normals| turned[normals.index(c)?]);
                    authored.unwrap_or_else(|| geometric_normal(&vertices).as_vec3())
                };
                let normals = corners.map(|c| normal(c).to_array());
                self.shading.normals.corner.extend(normals);
            }
            if keep.uvs {
                let uvs = corners.map(|c| rounded(mesh.uvs.get(c)));
                self.shading.uvs.extend(uvs);
            }
            if keep.uvs1 {
                let uvs = corners.map(|c| rounded(mesh.uvs1.get(c)));
                self.shading.uvs1.extend(uvs);
            }
            if keep.colors {
                let colors = corners.map(|c| mesh.colors.get(c).copied().unwrap_or([1.0; 4]));
                self.shading.colors.extend(colors);
            }
            let prim = prim as u32;
            self.shading.file_prim.push(prim);
            self.shading.material.push(material(prim));
            self.shading.object.extend(object);
        }
    }

    fn reserve(&mut self, triangles: usize, keep: &Keep) {
        self.triangles.reserve(triangles);
        let shading = &mut self.shading;
        shading.file_prim.reserve(triangles);
        shading.material.reserve(triangles);
        if keep.normals {
            shading.normals.corner.reserve(3 * triangles);
        }
        if keep.uvs {
            shading.uvs.reserve(3 * triangles);
        }
    }
}

/// Texture coordinates in f32, finite; 0 where there are none.
fn rounded(uv: Option<DVec2>) -> [f32; 2] {
    let uv = uv.unwrap_or_default().as_vec2();
    uv.clamp(Vec2::MIN, Vec2::MAX).to_array()
}

/// A mesh in its local units, for its instances.
#[derive(Debug)]
pub(crate) struct LocalMesh {
    pub(crate) geometry: std::sync::Arc<flat::Geometry>,
    /// From the mesh's own space to local units.
    pub(crate) rebase: Rebase,
    /// How far its vertices reach.
    pub(crate) support: Support,
    /// The largest absolute coordinates of its vertices.
    pub(crate) farthest: DVec3,
}

impl LocalMesh {
    /// Builds the geometry; its materials are slots, see [`slot`].
    pub(crate) fn new(
        mesh: &Mesh,
        normals: Option<&PerCorner<DVec3>>,
        context: &Context,
    ) -> LocalMesh {
        let rebase = rebase::of_mesh(mesh);
        let mut soup = Soup::default();
        let part = Part {
            mesh,
            normals,
            to: to_local(&rebase),
            keep: Keep {
                normals: normals.is_some(),
                ..context.keep
            },
        };
        soup.append(&part, None, |prim| slot(mesh, prim) as u32);
        let corners = soup.triangles.iter().flatten();
        let farthest = corners.fold(DVec3::ZERO, |far, p| far.max(p.as_dvec3().abs()));
        let primitives = super::bvh::Primitives {
            triangles: &soup.triangles,
            ..Default::default()
        };
        let built = super::bvh::build_with(&primitives, context.accel, context.quality);
        let geometry = flat::Geometry {
            triangles: built.triangles,
            bvh: built.bvh,
            shading: soup.shading,
        };
        LocalMesh {
            support: Support::of(&geometry),
            geometry: std::sync::Arc::new(geometry),
            rebase,
            farthest,
        }
    }
}

/// The vertices of a triangle, as rays see them.
pub(crate) fn triangle(triangles: &flat::Triangles, prim: usize) -> [Vec3; 3] {
    let place = triangles.place[prim] as usize;
    let (block, lane) = (&triangles.blocks[place / flat::BLOCK], place % flat::BLOCK);
    block
        .v
        .map(|axes| Vec3::from_array(axes.map(|lanes| lanes[lane])))
}

/// The material slot of a triangle: the file's material, or the one behind the last for triangles without.
pub(crate) fn slot(mesh: &Mesh, prim: u32) -> usize {
    let named = mesh.material.get(prim as usize).copied().flatten();
    named.map_or(mesh.materials.len(), |m| m as usize)
}

/// Which slots of a mesh occur.
pub(crate) fn used_slots(mesh: &Mesh) -> Vec<bool> {
    let mut used = vec![false; mesh.materials.len() + 1];
    for prim in 0..mesh.triangle_count() {
        used[slot(mesh, prim as u32)] = true;
    }
    used
}

/// Whether a map turns left hands into right ones.
pub(crate) fn mirrors(linear: &DMat3) -> bool {
    let largest = largest(linear);
    (*linear * (1.0 / largest)).determinant() < 0.0
}

/// The map of normals, up to a positive factor: the inverse transpose is cofactors / determinant, and the sign of the
/// determinant keeps normals on the outer side.
fn cofactor(linear: &DMat3) -> DMat3 {
    let m = *linear * (1.0 / largest(linear));
    let sign = if mirrors(linear) { -1.0 } else { 1.0 };
    DMat3::from_cols(
        m.y_axis.cross(m.z_axis) * sign,
        m.z_axis.cross(m.x_axis) * sign,
        m.x_axis.cross(m.y_axis) * sign,
    )
}

/// Largest absolute entry, or 1 if all are 0: products of scaled entries neither overflow nor underflow.
fn largest(linear: &DMat3) -> f64 {
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
    let largest = columns
        .iter()
        .fold(0.0, |m: f64, c| m.max(c.abs().max_element()));
    if largest > 0.0 { largest } else { 1.0 }
}

/// Unit normal of a counter-clockwise triangle; some unit vector for one that has none.
fn geometric_normal(v: &[DVec3; 3]) -> DVec3 {
    unit((v[1] - v[0]).cross(v[2] - v[0])).unwrap_or(DVec3::Z)
}
