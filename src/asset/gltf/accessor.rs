//! Accessors to numbers: every component type, normalised integers, strides, sparse elements.
//!
//! Enter: layouts and the bytes of buffers. Leave: components as f64, or indices as u32; or what keeps an accessor from
//! being read. Nothing is allocated before its bytes are known to exist and to fit the budget.

use super::buffers::Buffers;
use super::layout::{Accessor, Component, Layouts, Shape, Sparse, View};
use crate::asset::codes;
use crate::diag::Diagnostic;

/// The elements of an accessor, one after another.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Elements {
    /// Components of each element; those of a matrix column by column.
    pub(super) width: usize,
    /// All components; length `width` times the count of the accessor.
    pub(super) components: Vec<f64>,
}

/// Reads the elements of an accessor. Integers that are normalised become what they stand for (section 3.6.2.2).
///
/// # Errors
/// An accessor that does not fit its view, its buffer or its stride, or whose bytes are not there.
pub(super) fn numbers(
    layouts: &Layouts,
    buffers: &Buffers,
    index: usize,
) -> Result<Elements, Diagnostic> {
    let accessor = known(layouts, index)?;
    elements(layouts, buffers, index, accessor, accessor.normalized)
}

/// Reads the elements of an accessor as they are stored, whatever they stand for.
///
/// # Errors
/// As for [`numbers`].
pub(super) fn stored(
    layouts: &Layouts,
    buffers: &Buffers,
    index: usize,
) -> Result<Elements, Diagnostic> {
    elements(layouts, buffers, index, known(layouts, index)?, false)
}

fn elements(
    layouts: &Layouts,
    buffers: &Buffers,
    index: usize,
    accessor: &Accessor,
    normalized: bool,
) -> Result<Elements, Diagnostic> {
    let width = accessor.shape.width();
    let bytes = (accessor.count as u64).saturating_mul((width * size_of::<f64>()) as u64);
    // Without bytes it stands for as many zeros as it says.
    let room = buffers.allow(bytes, "what the accessor decodes to");
    room.map_err(|error| error.pointer(format!("/accessors/{index}")))?;
    let mut components = match accessor.view {
        Some(view) => {
            let place = (view, accessor.offset);
            let run = run(layouts, buffers, index, place, Elementary::of(accessor))?;
            let mut components = Vec::with_capacity(accessor.count * width);
            run.read(normalized, |component| components.push(component));
            components
        }
        None => vec![0.0; accessor.count * width],
    };
    if let Some(sparse) = &accessor.sparse {
        let (at, new) = overrides(layouts, buffers, index, (accessor, sparse), normalized)?;
        for (place, element) in at.into_iter().zip(new.chunks_exact(width)) {
            let old = components.chunks_exact_mut(width).nth(place as usize);
            let count = accessor.count;
            let beyond = || unreadable(index, format!("sparse index {place} of {count} elements"));
            old.ok_or_else(beyond)?.copy_from_slice(element);
        }
    }
    Ok(Elements { width, components })
}

/// Reads the elements of a scalar accessor of unsigned integers.
///
/// # Errors
/// As for [`numbers`], and an accessor of another format.
pub(super) fn indices(
    layouts: &Layouts,
    buffers: &Buffers,
    index: usize,
) -> Result<Vec<u32>, Diagnostic> {
    let accessor = known(layouts, index)?;
    let is_index = matches!(
        accessor.component,
        Component::U8 | Component::U16 | Component::U32
    );
    if accessor.shape.name != "SCALAR" || !is_index || accessor.normalized {
        let format = accessor.format();
        let says = format!("{format} cannot be indices, which are SCALAR of unsigned integers");
        return Err(unreadable(index, says));
    }
    let elements = numbers(layouts, buffers, index)?;
    // Unsigned integers of at most 32 bits are exact in f64.
    Ok(elements.components.into_iter().map(|i| i as u32).collect())
}

fn known(layouts: &Layouts, index: usize) -> Result<&Accessor, Diagnostic> {
    let known = layouts.accessor(index);
    known.ok_or_else(|| unreadable(index, "this accessor is malformed".into()))
}

fn unreadable(index: usize, says: String) -> Diagnostic {
    Diagnostic::error(codes::GLTF_ACCESSOR, says)
        .pointer(format!("/accessors/{index}"))
        .hint("export the file again")
}

/// What the elements of one run of bytes are.
#[derive(Clone, Copy)]
struct Elementary {
    component: Component,
    shape: Shape,
    count: usize,
}

impl Elementary {
    fn of(accessor: &Accessor) -> Elementary {
        Elementary {
            component: accessor.component,
            shape: accessor.shape,
            count: accessor.count,
        }
    }
}

/// Elements in a buffer, known to be there.
struct Run<'a> {
    bytes: &'a [u8],
    stride: usize,
    elements: Elementary,
}

impl Run<'_> {
    /// Every component in order.
    fn read(&self, normalized: bool, mut each: impl FnMut(f64)) {
        let Elementary {
            component,
            shape,
            count,
        } = self.elements;
        let column_stride = shape.column_stride(component);
        for element in 0..count {
            let at = element * self.stride;
            for column in 0..shape.columns {
                for row in 0..shape.rows {
                    let at = at + column * column_stride + row * component.size();
                    each(decode(component, normalized, &self.bytes[at..]));
                }
            }
        }
    }
}

/// The number that little-endian bytes stand for, by the formulas of section 3.6.2.2.
fn decode(component: Component, normalized: bool, bytes: &[u8]) -> f64 {
    let two = || [bytes[0], bytes[1]];
    let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
    let (value, largest) = match component {
        Component::I8 => (f64::from(bytes[0].cast_signed()), 127.0),
        Component::U8 => (f64::from(bytes[0]), 255.0),
        Component::I16 => (f64::from(i16::from_le_bytes(two())), 32767.0),
        Component::U16 => (f64::from(u16::from_le_bytes(two())), 65535.0),
        Component::U32 => return f64::from(u32::from_le_bytes(four())),
        Component::F32 => return f64::from(f32::from_le_bytes(four())),
    };
    match (normalized, value / largest) {
        (true, share) if share < -1.0 => -1.0,
        (true, share) => share,
        (false, _) => value,
    }
}

/// The bytes of the elements at a place (view and offset), checked against view, buffer and stride.
fn run<'a>(
    layouts: &Layouts,
    buffers: &'a Buffers,
    index: usize,
    (view_index, offset): (usize, usize),
    elements: Elementary,
) -> Result<Run<'a>, Diagnostic> {
    let Some(&view) = layouts.view(view_index) else {
        return Err(unreadable(
            index,
            format!("buffer view {view_index} is absent or malformed"),
        ));
    };
    let size = elements.shape.size(elements.component);
    let stride = view.stride.unwrap_or(size);
    if stride < size {
        let says = format!("elements of {size} bytes do not fit a byteStride of {stride}");
        return Err(unreadable(index, says));
    }
    let all = view_bytes(buffers, &view, view_index)?;
    let extent = elements.shape.extent(elements.component);
    let len = span(elements.count, stride, extent);
    let end = len.and_then(|len| offset.checked_add(len));
    let Some(bytes) = end.and_then(|end| all.get(offset..end)) else {
        let count = elements.count;
        let says = format!(
            "{count} elements of {size} bytes every {stride} from byte {offset} do not fit the {} bytes of buffer view {view_index}",
            view.len
        );
        return Err(unreadable(index, says));
    };
    Ok(Run {
        bytes,
        stride,
        elements,
    })
}

/// Bytes from the start of the first element to the end of the last.
pub(super) fn span(count: usize, stride: usize, extent: usize) -> Option<usize> {
    match count {
        0 => Some(0),
        _ => stride.checked_mul(count - 1)?.checked_add(extent),
    }
}

/// The bytes of a buffer view.
///
/// # Errors
/// A view that does not fit its buffer, or whose buffer is not there.
pub(super) fn view_bytes<'a>(
    buffers: &'a Buffers,
    view: &View,
    index: usize,
) -> Result<&'a [u8], Diagnostic> {
    let error = |says: String| {
        Diagnostic::error(codes::GLTF_BUFFER, says)
            .pointer(format!("/bufferViews/{index}"))
            .hint("export the file again")
    };
    let buffer = view.buffer;
    let Some(bytes) = buffers.bytes(buffer) else {
        return Err(error(format!("the bytes of buffer {buffer} are not there")));
    };
    let end = view.offset.checked_add(view.len);
    end.and_then(|end| bytes.get(view.offset..end))
        .ok_or_else(|| {
            let (len, offset, there) = (view.len, view.offset, bytes.len());
            error(format!(
                "{len} bytes from byte {offset} do not fit the {there} bytes of buffer {buffer}"
            ))
        })
}

/// Places and components of the sparse elements (section 3.6.2.3).
fn overrides(
    layouts: &Layouts,
    buffers: &Buffers,
    index: usize,
    (accessor, sparse): (&Accessor, &Sparse),
    normalized: bool,
) -> Result<(Vec<u32>, Vec<f64>), Diagnostic> {
    let elements = Elementary {
        count: sparse.count,
        ..Elementary::of(accessor)
    };
    let at = places(layouts, buffers, index, sparse)?;
    let values = run(layouts, buffers, index, sparse.values, elements)?;
    let mut new = Vec::with_capacity(sparse.count * accessor.shape.width());
    values.read(normalized, |value| new.push(value));
    Ok((at, new))
}

fn places(
    layouts: &Layouts,
    buffers: &Buffers,
    index: usize,
    sparse: &Sparse,
) -> Result<Vec<u32>, Diagnostic> {
    let elements = Elementary {
        component: sparse.index,
        shape: Shape::SCALAR,
        count: sparse.count,
    };
    let run = run(layouts, buffers, index, sparse.indices, elements)?;
    let mut at = Vec::with_capacity(sparse.count);
    run.read(false, |place| at.push(place as u32));
    Ok(at)
}

/// The places of an accessor's sparse elements, where it has any and they can be read.
pub(super) fn sparse_places(
    layouts: &Layouts,
    buffers: &Buffers,
    index: usize,
) -> Option<Vec<u32>> {
    let sparse = layouts.accessor(index)?.sparse.as_ref()?;
    places(layouts, buffers, index, sparse).ok()
}

#[cfg(test)]
mod tests;
