//! Attributes of corners: a table of values, and for each corner which of them, if any.
//!
//! As the files have it, and for the same reason: a value is shared by the corners that meet at it, so that it is read,
//! checked and transformed once, and a corner costs four bytes.

/// Stands for a corner without a value.
pub(super) const NONE: u32 = u32::MAX;

/// One attribute of the corners of a [`super::Mesh`]: corner `3 * triangle + k`.
#[derive(Clone, Debug, PartialEq)]
pub struct PerCorner<T> {
    pub(super) values: Vec<T>,
    /// Index into `values` of each corner, or [`NONE`]. Empty if the file has nothing of the kind at all.
    pub(super) of: Vec<u32>,
}

impl<T> Default for PerCorner<T> {
    fn default() -> PerCorner<T> {
        PerCorner {
            values: Vec::new(),
            of: Vec::new(),
        }
    }
}

impl<T: Copy> PerCorner<T> {
    /// Bytes of a corner with a value of its own.
    pub(super) const BYTES: usize = size_of::<u32>() + size_of::<T>();

    /// Corners of which each names one of `values`. An index beyond the table counts as none.
    #[must_use]
    pub fn new(values: Vec<T>, of: impl IntoIterator<Item = Option<u32>>) -> PerCorner<T> {
        let len = values.len();
        let known = |index: &u32| (*index as usize) < len && *index != NONE;
        let of = of
            .into_iter()
            .map(|index| index.filter(known).unwrap_or(NONE));
        PerCorner {
            of: of.collect(),
            values,
        }
    }

    /// Whether the file has nothing of the kind.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.of.is_empty()
    }

    /// Number of corners: those of the mesh, or 0.
    #[must_use]
    pub fn len(&self) -> usize {
        self.of.len()
    }

    /// The value of a corner.
    #[must_use]
    pub fn get(&self, corner: usize) -> Option<T> {
        self.values.get(self.index(corner)?).copied()
    }

    /// Which of [`PerCorner::values`] a corner has.
    #[must_use]
    pub fn index(&self, corner: usize) -> Option<usize> {
        let index = *self.of.get(corner)?;
        (index != NONE).then_some(index as usize)
    }

    /// The table.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The value of each corner.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Option<T>> {
        (0..self.len()).map(|corner| self.get(corner))
    }

    /// The values of these corners, and of others where these have none. Both are of one mesh.
    #[must_use]
    pub fn or(&self, others: &PerCorner<T>) -> PerCorner<T> {
        let values = [self.values.as_slice(), &others.values].concat();
        let index = |corner| {
            let other = || others.index(corner).map(|index| index + self.values.len());
            Some(self.index(corner).or_else(other)? as u32)
        };
        PerCorner::new(values, (0..others.len()).map(index))
    }

    /// Whether any corner has a value.
    #[must_use]
    pub fn any(&self) -> bool {
        self.of.iter().any(|&index| index != NONE)
    }

    /// Whether there are corners and all have a value.
    #[must_use]
    pub fn all(&self) -> bool {
        !self.is_empty() && !self.of.contains(&NONE)
    }
}

impl<T> FromIterator<Option<T>> for PerCorner<T> {
    /// A table with a value of its own for each corner that has one.
    fn from_iter<I: IntoIterator<Item = Option<T>>>(corners: I) -> PerCorner<T> {
        let mut made = PerCorner::default();
        made.extend(corners);
        made
    }
}

impl<T> Extend<Option<T>> for PerCorner<T> {
    /// Appends corners, with a value of its own for each that has one.
    fn extend<I: IntoIterator<Item = Option<T>>>(&mut self, corners: I) {
        for value in corners {
            let next = self.values.len() as u32;
            self.of.push(value.as_ref().map_or(NONE, |_| next));
            self.values.extend(value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_share_values_or_have_none() {
        let some = PerCorner::new(vec!['a', 'b'], [Some(1), None, Some(0), Some(1), Some(2)]);
        let expect = [Some('b'), None, Some('a'), Some('b'), None];
        assert_eq!(some.iter().collect::<Vec<_>>(), expect);
        assert!(some.any() && !some.all() && !some.is_empty());
        let own: PerCorner<char> = expect.into_iter().collect();
        assert_eq!(
            (own.values(), own.index(3)),
            (&['b', 'a', 'b'][..], Some(2))
        );
        let others = PerCorner::new(vec!['x'], [Some(0); 5]);
        let full: Vec<_> = some.or(&others).iter().flatten().collect();
        assert_eq!(full, ['b', 'x', 'a', 'b', 'x']);
        assert!(some.or(&others).all() && others.all());
        let none = PerCorner::<char>::default();
        assert!(none.is_empty() && !none.any() && !none.all() && none.get(0).is_none());
        assert_eq!(none.or(&others).iter().flatten().count(), 5);
    }
}
