//! Which corners of a primitive make its triangles (glTF 2.0, section 3.7.2.1).

use gltf::mesh::Mode;

/// How the corners of a primitive, one after another, make triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Assembly {
    /// Three by three.
    List,
    /// Each with the two before it.
    Strip,
    /// Each with the one before it and the first of all.
    Fan,
}

impl Assembly {
    /// `None` for points and lines.
    pub(super) fn of(mode: Mode) -> Option<Assembly> {
        match mode {
            Mode::Triangles => Some(Assembly::List),
            Mode::TriangleStrip => Some(Assembly::Strip),
            Mode::TriangleFan => Some(Assembly::Fan),
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
        }
    }

    /// Triangles of so many corners; what is left over makes none.
    pub(super) fn count(self, corners: usize) -> usize {
        match self {
            Assembly::List => corners / 3,
            Assembly::Strip | Assembly::Fan => corners.saturating_sub(2),
        }
    }

    /// The corners of triangle `i`, counter-clockwise.
    pub(super) fn triangle(self, i: usize) -> [usize; 3] {
        match self {
            Assembly::List => [3 * i, 3 * i + 1, 3 * i + 2],
            // Every second one has the other winding: its last two corners change places.
            Assembly::Strip => [i, i + 1 + i % 2, i + 2 - i % 2],
            Assembly::Fan => [i + 1, i + 2, 0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_those_of_the_specification() {
        // The examples of section 3.7.2.1, written out.
        let list = |assembly: Assembly, corners| -> Vec<[usize; 3]> {
            let count = assembly.count(corners);
            (0..count).map(|i| assembly.triangle(i)).collect()
        };
        assert_eq!(list(Assembly::List, 7), [[0, 1, 2], [3, 4, 5]]);
        let strip = [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]];
        assert_eq!(list(Assembly::Strip, 6), strip);
        assert_eq!(list(Assembly::Fan, 5), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        for assembly in [Assembly::List, Assembly::Strip, Assembly::Fan] {
            assert_eq!(list(assembly, 2), [[0; 3]; 0]);
        }
    }
}
