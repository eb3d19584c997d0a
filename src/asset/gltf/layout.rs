//! Where the elements of accessors lie: buffer views and accessors as numbers.
//!
//! Read from the JSON itself, so that the validator may look at elements before the typed document exists, and at those
//! of skins and animations, which the typed document does not keep. What is malformed is absent here; the validator has
//! said why. Specification: sections 3.6.2 and 5.1 to 5.4.

use serde_json::Value;

/// Type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    /// The type of a `componentType`.
    pub(super) fn of(code: u64) -> Option<Component> {
        Some(match code {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    /// Size in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// Its name in the specification.
    pub(super) fn name(self) -> &'static str {
        match self {
            Component::I8 => "BYTE",
            Component::U8 => "UNSIGNED_BYTE",
            Component::I16 => "SHORT",
            Component::U16 => "UNSIGNED_SHORT",
            Component::U32 => "UNSIGNED_INT",
            Component::F32 => "FLOAT",
        }
    }
}

/// Type of an element: columns of components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shape {
    pub(super) name: &'static str,
    pub(super) columns: usize,
    pub(super) rows: usize,
}

const fn shape(name: &'static str, columns: usize, rows: usize) -> Shape {
    Shape {
        name,
        columns,
        rows,
    }
}

/// Every `type` of an accessor (section 3.6.2.2).
const SHAPES: [Shape; 7] = [
    Shape::SCALAR,
    shape("VEC2", 1, 2),
    shape("VEC3", 1, 3),
    shape("VEC4", 1, 4),
    shape("MAT2", 2, 2),
    shape("MAT3", 3, 3),
    shape("MAT4", 4, 4),
];

/// The start of each column of a matrix is aligned to this many bytes (section 3.6.2.4).
const COLUMN_ALIGNMENT: usize = 4;

impl Shape {
    /// One component.
    pub(super) const SCALAR: Shape = shape("SCALAR", 1, 1);

    /// The shape of a `type`.
    pub(super) fn of(name: &str) -> Option<Shape> {
        SHAPES.into_iter().find(|shape| shape.name == name)
    }

    /// Components of an element.
    pub(super) fn width(self) -> usize {
        self.columns * self.rows
    }

    pub(super) fn is_matrix(self) -> bool {
        self.columns > 1
    }

    /// Bytes from one column to the next.
    pub(super) fn column_stride(self, component: Component) -> usize {
        let bytes = self.rows * component.size();
        if self.is_matrix() {
            bytes.next_multiple_of(COLUMN_ALIGNMENT)
        } else {
            bytes
        }
    }

    /// Bytes from one element to the next where no stride says otherwise.
    pub(super) fn size(self, component: Component) -> usize {
        self.columns * self.column_stride(component)
    }

    /// Bytes from the start of an element to the end of its last component: without the padding of its last column.
    pub(super) fn extent(self, component: Component) -> usize {
        (self.columns - 1) * self.column_stride(component) + self.rows * component.size()
    }
}

/// A part of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct View {
    pub(super) buffer: usize,
    pub(super) offset: usize,
    pub(super) len: usize,
    pub(super) stride: Option<usize>,
}

/// A typed reading of a buffer view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Accessor {
    pub(super) view: Option<usize>,
    pub(super) offset: usize,
    pub(super) component: Component,
    pub(super) shape: Shape,
    pub(super) count: usize,
    pub(super) normalized: bool,
    pub(super) sparse: Option<Sparse>,
}

impl Accessor {
    /// Bytes of an element.
    pub(super) fn size(&self) -> usize {
        self.shape.size(self.component)
    }

    /// `VEC3 of FLOAT`, for messages.
    pub(super) fn format(&self) -> String {
        let normalized = if self.normalized { " normalized" } else { "" };
        format!(
            "{} of {}{normalized}",
            self.shape.name,
            self.component.name()
        )
    }

    /// The buffer views that it reads.
    pub(super) fn views(&self) -> impl Iterator<Item = usize> {
        let sparse = self.sparse.as_ref();
        let of_sparse = sparse.map(|sparse| [sparse.indices.0, sparse.values.0]);
        self.view.into_iter().chain(of_sparse.into_iter().flatten())
    }
}

/// Elements that differ from those of the buffer view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Sparse {
    pub(super) count: usize,
    /// View and offset of the indices.
    pub(super) indices: (usize, usize),
    pub(super) index: Component,
    /// View and offset of the values.
    pub(super) values: (usize, usize),
}

/// The buffer views and accessors of a file; `None` for those that are malformed.
#[derive(Debug, Default)]
pub(super) struct Layouts {
    pub(super) views: Vec<Option<View>>,
    pub(super) accessors: Vec<Option<Accessor>>,
}

impl Layouts {
    pub(super) fn of(json: &Value) -> Layouts {
        Layouts {
            views: items(json, "bufferViews").iter().map(view).collect(),
            accessors: items(json, "accessors").iter().map(accessor).collect(),
        }
    }

    pub(super) fn view(&self, index: usize) -> Option<&View> {
        self.views.get(index)?.as_ref()
    }

    pub(super) fn accessor(&self, index: usize) -> Option<&Accessor> {
        self.accessors.get(index)?.as_ref()
    }
}

/// The elements of a top-level array; none where it is absent or no array.
pub(super) fn items<'a>(json: &'a Value, name: &str) -> &'a [Value] {
    json.get(name)
        .and_then(Value::as_array)
        .map_or(&[], Vec::as_slice)
}

/// A non-negative integer, also where it is written `3.0`.
pub(super) fn natural(value: &Value) -> Option<usize> {
    /// The first integer that f64 does not tell from the next.
    const LARGEST: f64 = 9_007_199_254_740_992.0;
    if let Some(number) = value.as_u64() {
        return usize::try_from(number).ok();
    }
    let number = value.as_f64()?;
    let whole = number.fract() == 0.0 && (0.0..LARGEST).contains(&number);
    whole.then_some(number as usize)
}

/// A natural property; the default where it is absent, `None` where it is something else.
fn natural_or(object: &Value, name: &str, default: usize) -> Option<usize> {
    object.get(name).map_or(Some(default), natural)
}

fn required(object: &Value, name: &str) -> Option<usize> {
    object.get(name).and_then(natural)
}

fn component(object: &Value) -> Option<Component> {
    Component::of(required(object, "componentType")? as u64)
}

fn view(json: &Value) -> Option<View> {
    let stride = match json.get("byteStride") {
        Some(stride) => Some(natural(stride)?),
        None => None,
    };
    Some(View {
        buffer: required(json, "buffer")?,
        offset: natural_or(json, "byteOffset", 0)?,
        len: required(json, "byteLength")?,
        stride,
    })
}

fn accessor(json: &Value) -> Option<Accessor> {
    let view = match json.get("bufferView") {
        Some(view) => Some(natural(view)?),
        None => None,
    };
    let part = match json.get("sparse") {
        Some(part) => Some(sparse(part)?),
        None => None,
    };
    Some(Accessor {
        view,
        offset: natural_or(json, "byteOffset", 0)?,
        component: component(json)?,
        shape: Shape::of(json.get("type")?.as_str()?)?,
        count: required(json, "count")?,
        normalized: json
            .get("normalized")
            .and_then(Value::as_bool)
            .unwrap_or(false),
        sparse: part,
    })
}

fn sparse(json: &Value) -> Option<Sparse> {
    let (indices, values) = (json.get("indices")?, json.get("values")?);
    let place = |part: &Value| {
        Some((
            required(part, "bufferView")?,
            natural_or(part, "byteOffset", 0)?,
        ))
    };
    let index = component(indices)?;
    let is_index = matches!(index, Component::U8 | Component::U16 | Component::U32);
    is_index.then_some(Sparse {
        count: required(json, "count")?,
        indices: place(indices)?,
        index,
        values: place(values)?,
    })
}
