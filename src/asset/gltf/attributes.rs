//! Attributes of a primitive: accessors as vectors, each read once for all primitives of a mesh that share it.

use super::accessor::Elements;
use super::source::Source;
use crate::asset::{PerCorner, codes};
use crate::diag::Diagnostic;
use crate::math::{DVec2, DVec3};
use gltf::Semantic;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The accessors of the attributes that luxel reads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attributes {
    pub(super) positions: usize,
    pub(super) normals: Option<usize>,
    pub(super) uvs: [Option<usize>; 2],
    pub(super) colors: Option<usize>,
}

impl Attributes {
    /// `None` for a primitive without positions.
    pub(super) fn of(primitive: &gltf::Primitive<'_>) -> Option<Attributes> {
        let of = |semantic| Some(primitive.get(&semantic)?.index());
        Some(Attributes {
            positions: of(Semantic::Positions)?,
            normals: of(Semantic::Normals),
            uvs: [0, 1].map(|set| of(Semantic::TexCoords(set))),
            colors: of(Semantic::Colors(0)),
        })
    }

    /// Bytes of a [`Mesh`](crate::asset::Mesh) for each triangle that has these attributes and vertices of its own.
    pub(super) fn bytes_per_triangle(&self) -> usize {
        let corner = size_of::<u32>()
            + size_of::<DVec3>()
            + self.normals.map_or(0, |_| PerCorner::<DVec3>::BYTES)
            + self.uvs.iter().flatten().count() * PerCorner::<DVec2>::BYTES
            + self.colors.map_or(0, |_| size_of::<[f32; 4]>());
        3 * corner + size_of::<Option<u32>>()
    }
}

/// The accessors that a mesh has read.
pub(super) struct Cache<'a> {
    source: &'a Source,
    read: BTreeMap<usize, Rc<Elements>>,
}

impl<'a> Cache<'a> {
    pub(super) fn new(source: &'a Source) -> Cache<'a> {
        Cache {
            source,
            read: BTreeMap::new(),
        }
    }

    /// The elements of an attribute's accessor, of one of the widths in `widths`.
    ///
    /// # Errors
    /// An accessor that cannot be read, or has elements of another width.
    pub(super) fn elements(
        &mut self,
        accessor: usize,
        widths: &[usize],
    ) -> Result<Rc<Elements>, Diagnostic> {
        let elements = match self.read.get(&accessor) {
            Some(known) => known.clone(),
            None => {
                let read = Rc::new(self.source.numbers(accessor)?);
                self.read.insert(accessor, read.clone());
                read
            }
        };
        if widths.contains(&elements.width) {
            return Ok(elements);
        }
        let says = format!(
            "elements of {} components, where the attribute needs {}",
            elements.width, widths[0]
        );
        let error = Diagnostic::error(codes::GLTF_ATTRIBUTE, says);
        Err(error
            .pointer(format!("/accessors/{accessor}"))
            .hint("export the file again"))
    }
}

impl Elements {
    /// The element of a vertex; `None` beyond the last. Of wider elements, the first `N` components.
    pub(super) fn at<const N: usize>(&self, vertex: u32) -> Option<[f64; N]> {
        let from = (vertex as usize).checked_mul(self.width)?;
        let element = self.components.get(from..)?;
        element.first_chunk::<N>().copied()
    }
}
