//! A mesh of a glTF file: its primitives, one after another.
//!
//! Enter: a file and the index of a mesh. Leaves: a [`Mesh`] whose material slots are [`Look`]s, for which the materials
//! are found later, once for the file. Deliberately absent: points, lines, morph targets, skins and tangents. A mesh in
//! which no primitive has normals is faceted; where only some have, the others get those of their triangles (section
//! 3.7.2.1: "client applications MUST calculate flat normals").

use super::accessor::Elements;
use super::attributes::{Attributes, Cache};
use super::layout::{items, natural};
use super::materials::{self, Look};
use super::notes::{Notes, Topic};
use super::source::Source;
use super::triangles::Assembly;
use crate::asset::obj::{MAX_COORDINATE, has_area};
use crate::asset::{Mesh, codes, normals};
use crate::diag::Diagnostic;
use crate::math::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::rc::Rc;

const NO_TRIANGLES: Topic = Topic {
    code: codes::GLTF_NO_TRIANGLES,
    says: "primitives of points or lines are skipped",
    hint: "luxel renders triangles and spheres",
};

const NO_POSITIONS: Topic = Topic {
    code: codes::GLTF_NO_TRIANGLES,
    says: "primitives without positions are skipped",
    hint: "an extension that luxel does not have may hold them: export without it",
};

const NO_AREA: Topic = Topic {
    code: codes::ZERO_AREA,
    says: "triangles without area are dropped",
    hint: "they cannot be seen: clean up the mesh, or leave it as it is",
};

const BAD_NORMAL: Topic = Topic {
    code: codes::BAD_NORMAL,
    says: "corners have a normal that is zero or not a finite number, which is made from their triangles instead",
    hint: "export the normals again, or say `normals: Flat` or `Smooth`",
};

/// A mesh, but for its materials.
pub(super) struct Shaped {
    pub(super) mesh: Mesh,
    /// What the materials of the mesh will be made from, one for each slot.
    pub(super) looks: Vec<Look>,
    pub(super) notes: Notes,
}

/// A primitive of triangles.
struct Part<'a> {
    /// JSON pointer.
    place: String,
    assembly: Assembly,
    indices: Option<usize>,
    attributes: Attributes,
    material: gltf::Material<'a>,
}

/// Reads the mesh with index `index`.
///
/// # Errors
/// Accessors that cannot be read, vertices that are not there or not finite.
pub(super) fn mesh(source: &Source, index: usize) -> Result<Shaped, Vec<Diagnostic>> {
    let mut builder = Builder::new(source);
    let Some(mesh) = source.document.meshes().nth(index) else {
        return Ok(builder.shaped);
    };
    let parts = parts(&mesh, &mut builder.shaped.notes);
    builder.keep(&parts);
    let failed = parts.iter().filter_map(|part| builder.append(part).err());
    let errors: Vec<Diagnostic> = failed.collect();
    if errors.is_empty() {
        Ok(builder.shaped)
    } else {
        Err(errors)
    }
}

/// Bytes that the triangles of a mesh will take at most, by the counts that its accessors claim.
pub(super) fn bytes(source: &Source, index: usize) -> u64 {
    let Some(mesh) = source.document.meshes().nth(index) else {
        return 0;
    };
    let parts = parts(&mesh, &mut Notes::default());
    let of_part = |part: &Part<'_>| {
        let corners = part.indices.unwrap_or(part.attributes.positions);
        let corners = items(&source.json, "accessors").get(corners);
        let corners = corners.and_then(|accessor| natural(accessor.get("count")?));
        let triangles = part.assembly.count(corners.unwrap_or_default()) as u64;
        triangles.saturating_mul(part.attributes.bytes_per_triangle() as u64)
    };
    parts.iter().map(of_part).fold(0, u64::saturating_add)
}

fn parts<'a>(mesh: &gltf::Mesh<'a>, notes: &mut Notes) -> Vec<Part<'a>> {
    let mut parts = Vec::new();
    for primitive in mesh.primitives() {
        let place = format!("/meshes/{}/primitives/{}", mesh.index(), primitive.index());
        let Some(assembly) = Assembly::of(primitive.mode()) else {
            notes.add(&NO_TRIANGLES, place);
            continue;
        };
        let Some(attributes) = Attributes::of(&primitive) else {
            notes.add(&NO_POSITIONS, place);
            continue;
        };
        parts.push(Part {
            place,
            assembly,
            indices: primitive.indices().map(|indices| indices.index()),
            attributes,
            material: primitive.material(),
        });
    }
    parts
}

/// Which arrays per corner the mesh has.
#[derive(Clone, Copy, Default)]
struct Keep {
    normals: bool,
    uvs: [bool; 2],
    colors: bool,
}

/// The elements of a primitive, as far as the mesh keeps them.
struct Streams {
    positions: Rc<Elements>,
    normals: Option<Rc<Elements>>,
    uvs: [Option<Rc<Elements>>; 2],
    colors: Option<Rc<Elements>>,
}

struct Builder<'a> {
    source: &'a Source,
    cache: Cache<'a>,
    keep: Keep,
    /// For each accessor of positions, the index in the mesh of each vertex that a triangle has used.
    places: BTreeMap<usize, Vec<Option<u32>>>,
    slots: BTreeMap<Look, u32>,
    shaped: Shaped,
}

impl<'a> Builder<'a> {
    fn new(source: &'a Source) -> Builder<'a> {
        Builder {
            source,
            cache: Cache::new(source),
            keep: Keep::default(),
            places: BTreeMap::new(),
            slots: BTreeMap::new(),
            shaped: Shaped {
                mesh: Mesh {
                    path: source.path.clone(),
                    ..Mesh::default()
                },
                looks: Vec::new(),
                notes: Notes::default(),
            },
        }
    }

    /// Decides which arrays the mesh has.
    fn keep(&mut self, parts: &[Part<'_>]) {
        let any = |has: &dyn Fn(&Part<'_>) -> bool| parts.iter().any(has);
        self.keep = Keep {
            normals: any(&|part| part.attributes.normals.is_some()),
            uvs: [
                any(&|part| part.attributes.uvs[0].is_some()),
                any(&|part| {
                    part.attributes.uvs[1].is_some() && materials::reads_uv_set(&part.material, 1)
                }),
            ],
            colors: any(&|part| part.attributes.colors.is_some()),
        };
        self.shaped.mesh.faceted = !self.keep.normals;
    }

    fn append(&mut self, part: &Part<'_>) -> Result<(), Diagnostic> {
        let streams = self.streams(part)?;
        let order = part.indices.map(|accessor| self.source.indices(accessor));
        let order = order.transpose()?;
        let vertices = streams.positions.components.len() / 3;
        let corners = order.as_ref().map_or(vertices, Vec::len);
        let material = self.slot(part, &streams);
        let positions = part.attributes.positions;
        let known = self.places.remove(&positions);
        let mut places = known.unwrap_or_else(|| vec![None; vertices]);
        let mut flat = 0;
        for i in 0..part.assembly.count(corners) {
            let triangle = part.assembly.triangle(i).map(|corner| match &order {
                Some(order) => order.get(corner).copied().unwrap_or(u32::MAX),
                None => corner as u32,
            });
            let mut points = [DVec3::ZERO; 3];
            for (point, vertex) in points.iter_mut().zip(triangle) {
                *point = position(&streams, part, vertex)?;
            }
            if has_area(points) {
                let placed = self.place(part, &mut places, triangle, points)?;
                self.shaped.mesh.corners.extend(placed);
                self.shaped.mesh.material.push(Some(material));
                self.shade(part, &streams, triangle, points);
            } else {
                flat += 1;
            }
        }
        self.places.insert(positions, places);
        // Strips turn corners by triangles without area: they are meant.
        if part.assembly != Assembly::Strip {
            self.shaped.notes.add_many(&NO_AREA, flat, &part.place);
        }
        Ok(())
    }

    fn streams(&mut self, part: &Part<'_>) -> Result<Streams, Diagnostic> {
        let Attributes {
            positions,
            normals,
            uvs,
            colors,
        } = part.attributes;
        let keep = self.keep;
        let mut read = |accessor: Option<usize>, keep: bool, widths: &[usize]| {
            let accessor = accessor.filter(|_| keep);
            let read = accessor.map(|accessor| self.cache.elements(accessor, widths));
            read.transpose()
        };
        Ok(Streams {
            normals: read(normals, keep.normals, &[3])?,
            uvs: [
                read(uvs[0], keep.uvs[0], &[2])?,
                read(uvs[1], keep.uvs[1], &[2])?,
            ],
            colors: read(colors, keep.colors, &[3, 4])?,
            positions: self.cache.elements(positions, &[3])?,
        })
    }

    /// The material slot of a primitive.
    fn slot(&mut self, part: &Part<'_>, streams: &Streams) -> u32 {
        let look = Look {
            material: part.material.index(),
            uv_sets: part.attributes.uvs.map(|set| set.is_some()),
            colors: streams.colors.is_some(),
            alphas: streams.colors.as_deref().is_some_and(has_alpha),
        };
        let Shaped { looks, notes, .. } = &mut self.shaped;
        *self.slots.entry(look).or_insert_with(|| {
            looks.push(look);
            materials::say_missing_uvs(&part.material, &look, &part.place, notes);
            looks.len() as u32 - 1
        })
    }

    /// The indices in the mesh of the vertices of a triangle; a vertex that no triangle uses gets none.
    fn place(
        &mut self,
        part: &Part<'_>,
        places: &mut [Option<u32>],
        vertices: [u32; 3],
        points: [DVec3; 3],
    ) -> Result<[u32; 3], Diagnostic> {
        let positions = &mut self.shaped.mesh.positions;
        let mut placed = [0; 3];
        for k in 0..3 {
            let count = places.len();
            let place = places.get_mut(vertices[k] as usize);
            let place = place.ok_or_else(|| no_vertex(part, vertices[k], count))?;
            placed[k] = match *place {
                Some(known) => known,
                None => {
                    let new = u32::try_from(positions.len()).map_err(|_| too_large(part))?;
                    positions.push(points[k]);
                    *place.insert(new)
                }
            };
        }
        Ok(placed)
    }

    /// Appends what the corners of a triangle have besides their positions.
    fn shade(
        &mut self,
        part: &Part<'_>,
        streams: &Streams,
        vertices: [u32; 3],
        points: [DVec3; 3],
    ) {
        let Shaped { mesh, notes, .. } = &mut self.shaped;
        if self.keep.normals {
            match &streams.normals {
                Some(normals) => {
                    let read = |vertex| normals::unit(normals.at(vertex).map(DVec3::from_array)?);
                    let units = vertices.map(read);
                    let lost = units.iter().filter(|unit| unit.is_none()).count();
                    notes.add_many(&BAD_NORMAL, lost, &part.place);
                    mesh.normals.extend(units);
                }
                None => mesh.normals.extend([face_normal(points); 3]),
            }
        }
        let [first, second] = &streams.uvs;
        let sets = [(first, &mut mesh.uvs), (second, &mut mesh.uvs1)];
        for (set, (stream, uvs)) in sets.into_iter().enumerate() {
            if !self.keep.uvs[set] {
                continue;
            }
            for vertex in vertices {
                let read = stream.as_ref().and_then(|uvs| uvs.at(vertex));
                let finite = read.filter(|[u, v]: &[f64; 2]| u.is_finite() && v.is_finite());
                // In glTF v points down (section 3.8.1).
                uvs.extend([finite.map(|[u, v]| DVec2::new(u, 1.0 - v))]);
            }
        }
        if self.keep.colors {
            for vertex in vertices {
                let read = streams.colors.as_ref().and_then(|colors| colors.at(vertex));
                let [r, g, b]: [f64; 3] = read.unwrap_or([1.0; 3]);
                let alpha = streams
                    .colors
                    .as_ref()
                    .and_then(|colors| alpha(colors, vertex));
                mesh.colors.push([r, g, b, alpha.unwrap_or(1.0)].map(share));
            }
        }
    }
}

fn too_large(part: &Part<'_>) -> Diagnostic {
    Diagnostic::error(codes::TOO_LARGE, "a mesh of more than 2^32 vertices")
        .pointer(&part.place)
        .hint("split it")
}

/// A component of a colour, brought between 0 and 1; 0 for what is no number.
fn share(component: f64) -> f32 {
    if component > 0.0 {
        component.min(1.0) as f32
    } else {
        0.0
    }
}

/// The alpha of a vertex's colour, if it has one.
fn alpha(colors: &Elements, vertex: u32) -> Option<f64> {
    let components: Option<[f64; 4]> = (colors.width == 4).then(|| colors.at(vertex))?;
    components.map(|[.., alpha]| alpha)
}

/// Whether colours have an alpha below 1.
fn has_alpha(colors: &Elements) -> bool {
    let mut alphas = colors.components.iter().skip(3).step_by(4);
    colors.width == 4 && alphas.any(|alpha| *alpha < 1.0)
}

/// The position of a vertex.
fn position(streams: &Streams, part: &Part<'_>, vertex: u32) -> Result<DVec3, Diagnostic> {
    let count = streams.positions.components.len() / 3;
    let point = streams.positions.at(vertex).map(DVec3::from_array);
    let point = point.ok_or_else(|| no_vertex(part, vertex, count))?;
    if point.is_finite() && point.abs().max_element() <= MAX_COORDINATE {
        return Ok(point);
    }
    let says = format!("vertex {vertex} is not finite or beyond 1e100, and a triangle uses it");
    Err(Diagnostic::error(codes::BAD_VERTEX, says)
        .pointer(format!("{}/attributes/POSITION", part.place))
        .hint("export the file again"))
}

fn no_vertex(part: &Part<'_>, vertex: u32, count: usize) -> Diagnostic {
    let says = format!("index {vertex} of a primitive with {count} vertices");
    Diagnostic::error(codes::GLTF_INDEX, says)
        .pointer(format!("{}/indices", part.place))
        .hint("export the file again")
}

/// The unit normal of a triangle that has an area; its edges are scaled first, so that nothing underflows.
fn face_normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let edges = [normals::unit(b - a)?, normals::unit(c - a)?];
    normals::unit(edges[0].cross(edges[1]))
}
