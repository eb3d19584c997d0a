//! The words of the tables: what a value of a glTF file may be, and how much luxel cares.

/// How much luxel cares for a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Care {
    /// It is not read: what is wrong with it is a warning.
    Skip,
    /// It is read, and its default will do: what is wrong with it is a warning.
    Keep,
    /// The file cannot be used without it: what is wrong with it is an error.
    Need,
}

/// What a value may be.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Bool,
    Text,
    /// `<major>.<minor>`.
    Version,
    /// A URI or a path.
    Uri,
    /// One of these words.
    Word(&'static [&'static str]),
    /// One of these integers.
    Code(&'static [u64]),
    /// An integer of at least this.
    Integer(usize),
    Number(Range),
    /// An array of numbers of one of these lengths; of any length where there are none.
    Numbers(&'static [usize], Range),
    /// The index of an element of a top-level array.
    Index(&'static str),
    /// The index of an element of an array of a top-level extension.
    IndexOf(&'static str, &'static str),
    /// A nonempty array.
    List(&'static Kind),
    /// A nonempty array without repetition.
    Set(&'static Kind),
    Object(&'static Object),
    /// A nonempty object from attribute names to accessors.
    Attributes,
}

/// A range of numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub(super) least: f64,
    pub(super) most: f64,
    /// Whether `least` itself is outside.
    pub(super) above: bool,
}

impl Range {
    pub(super) fn contains(self, value: f64) -> bool {
        value <= self.most && (value > self.least || value == self.least && !self.above)
    }
}

const fn range(least: f64, most: f64, above: bool) -> Range {
    Range { least, most, above }
}

/// Any number.
pub(super) const ANY: Range = range(f64::NEG_INFINITY, f64::INFINITY, false);
/// 0 to 1.
pub(super) const SHARE: Range = range(0.0, 1.0, false);
/// −1 to 1.
pub(super) const SINE: Range = range(-1.0, 1.0, false);
/// 0 and above.
pub(super) const NOT_NEGATIVE: Range = range(0.0, f64::INFINITY, false);
/// Above 0.
pub(super) const POSITIVE: Range = range(0.0, f64::INFINITY, true);

/// An object of known properties. Every object may also have `extensions` and `extras`.
#[derive(Debug)]
pub(super) struct Object {
    pub(super) properties: &'static [Property],
    /// Extensions that luxel reads here.
    pub(super) extensions: &'static [(&'static str, &'static Object)],
}

/// A property of an object.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: &'static str,
    pub(super) kind: Kind,
    pub(super) care: Care,
    pub(super) required: bool,
}

impl Property {
    /// The same property, required.
    pub(super) const fn required(self) -> Property {
        Property {
            required: true,
            ..self
        }
    }
}

const fn property(name: &'static str, kind: Kind, care: Care) -> Property {
    Property {
        name,
        kind,
        care,
        required: false,
    }
}

/// A property without which the file cannot be used.
pub(super) const fn need(name: &'static str, kind: Kind) -> Property {
    property(name, kind, Care::Need)
}

/// A property that is read and has a default.
pub(super) const fn keep(name: &'static str, kind: Kind) -> Property {
    property(name, kind, Care::Keep)
}

/// A property that is not read.
pub(super) const fn skip(name: &'static str, kind: Kind) -> Property {
    property(name, kind, Care::Skip)
}

/// An object without extensions that luxel reads.
pub(super) const fn object(properties: &'static [Property]) -> Object {
    Object {
        properties,
        extensions: &[],
    }
}
