//! The numbers of `v`, `vt` and `vn` lines that are not plain (see [`super::numbers`]), through `tobj`, a block of lines at
//! a time.
//!
//! tobj gives the vertices that faces use, in the order in which they do. So each block of lines ends with one made-up
//! face that uses all of them in order. Blocks keep tobj's tables of indices in the cache, and a large file from being
//! in memory twice.

use super::codes;
use crate::diag::Diagnostic;
use tobj::LoadError;

/// Lines of a block.
pub(super) const BLOCK: usize = 4096;

/// The keywords of the kinds of line, in the order of the indices of a corner.
pub(super) const KINDS: [&str; 3] = ["v", "vt", "vn"];

/// Lines of one kind that wait for being read.
pub(super) struct Records {
    kind: usize,
    text: String,
    /// What each line is among all of its kind.
    places: Vec<usize>,
    /// The face of the block before, which is the next one's too if that is as long.
    face: (usize, String),
}

impl Records {
    /// Lines of kind `KINDS[kind]`.
    pub(super) fn of(kind: usize) -> Records {
        Records {
            kind,
            text: String::new(),
            places: Vec::new(),
            face: (0, String::new()),
        }
    }

    /// Adds a line of these numbers, all of which count.
    pub(super) fn push(&mut self, place: usize, numbers: &[&str]) {
        if self.places.is_empty() && self.kind > 0 {
            // A corner of a face needs a position too.
            self.text.push_str("v 0 0 0\n");
        }
        self.text.push_str(KINDS[self.kind]);
        for number in numbers {
            self.text.push(' ');
            self.text.push_str(number);
        }
        self.text.push('\n');
        self.places.push(place);
    }

    /// Whether the block should be read now.
    pub(super) fn is_full(&self) -> bool {
        self.places.len() >= BLOCK
    }

    /// Number of lines that wait.
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Reads the lines; `N` numbers for each, and its place. Numbers that cannot be read are NaN: it matters only if a
    /// face uses them.
    ///
    /// # Errors
    /// If the parser does not do what was asked of it: a bug of luxel.
    pub(super) fn read<const N: usize>(&mut self) -> Result<Vec<(usize, [f64; N])>, Diagnostic> {
        let lines = self.text.len();
        self.push_face();
        let model = read(&self.text).or_else(|_| {
            self.text = readable(&self.text[..lines]);
            self.push_face();
            read(&self.text)
        });
        let says = |says: String| Diagnostic::error(codes::PARSER, says);
        let mesh = model.map_err(|error| says(format!("the OBJ parser says: {error}")))?;
        let numbers = match self.kind {
            0 => mesh.positions,
            1 => mesh.texcoords,
            _ => mesh.normals,
        };
        if numbers.len() != N * self.len() {
            let found = numbers.len() / N;
            let kind = KINDS[self.kind];
            return Err(says(format!(
                "the OBJ parser gave {found} `{kind}`, not {}",
                self.len()
            )));
        }
        self.text.clear();
        let places = self.places.drain(..);
        Ok(places.zip(numbers.as_chunks().0.iter().copied()).collect())
    }

    /// A face of all the lines in order, of at least three corners: those of fewer are not faces to the parser.
    fn push_face(&mut self) {
        let count = self.places.len();
        let (corners, face) = &mut self.face;
        if *corners != count {
            *corners = count;
            face.clear();
            face.push('f');
            for corner in 1..=count.max(3) {
                face.push_str([" ", " 1/", " 1//"][self.kind]);
                face.push_str(&corner.min(count).to_string());
            }
            face.push('\n');
        }
        self.text.push_str(face);
    }
}

fn read(text: &str) -> Result<tobj::Mesh, LoadError> {
    let options = tobj::LoadOptions {
        single_index: false,
        triangulate: false,
        ignore_points: true,
        ignore_lines: true,
    };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, no_materials)?;
    Ok(models
        .into_iter()
        .next()
        .map(|model| model.mesh)
        .unwrap_or_default())
}

/// Words of a line that the parser may see: a keyword, three numbers and a weight.
const MAX_WORDS: usize = 5;

/// Lines with NaN for every number that cannot be read.
fn readable(lines: &str) -> String {
    let mut text = String::with_capacity(lines.len());
    for line in lines.lines() {
        for (i, word) in line.split_whitespace().take(MAX_WORDS).enumerate() {
            let bad_weight = i == 4 && word.parse() == Ok(0.0);
            let bad = i > 0 && (bad_weight || word.parse::<f64>().is_err());
            text.push_str(if i == 0 { "" } else { " " });
            text.push_str(if bad { "nan" } else { word });
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_any_length_come_back_in_order() {
        for count in [1, 2, 3, 4, 5, BLOCK] {
            let number = |i: usize| format!("{i}.5");
            let mut positions = Records::of(0);
            let mut uvs = Records::of(1);
            let mut normals = Records::of(2);
            for i in 0..count {
                let words = [number(i), number(i + 1), number(0)];
                let words = words.each_ref().map(String::as_str);
                positions.push(i, &words);
                uvs.push(2 * i, &words[..2]);
                normals.push(i, &words);
            }
            assert_eq!(positions.is_full(), count == BLOCK);
            let expect = |i: usize| (i, [i as f64 + 0.5, i as f64 + 1.5, 0.5]);
            let expect: Vec<(usize, [f64; 3])> = (0..count).map(expect).collect();
            let two = expect.iter().map(|&(i, [u, v, _])| (2 * i, [u, v]));
            let two: Vec<(usize, [f64; 2])> = two.collect();
            assert_eq!(positions.read::<3>().as_ref(), Ok(&expect));
            assert_eq!(normals.read::<3>().as_ref(), Ok(&expect));
            assert_eq!(uvs.read::<2>(), Ok(two));
            assert_eq!((positions.len(), uvs.is_full()), (0, false));
        }
    }

    #[test]
    fn what_is_no_number_is_nan_and_spoils_nothing_else() {
        let mut records = Records::of(0);
        records.push(0, &["1", "x", "3"]);
        records.push(1, &["2", "4", "6", "2"]);
        records.push(2, &["2", "4", "6", "0"]);
        let read = records.read::<3>().expect("numbers");
        let [(_, first), second, (_, third)] = read[..] else {
            panic!("{read:?}");
        };
        assert!(first[1].is_nan() && third[0].is_nan());
        assert_eq!((first[0], second), (1.0, (1, [1.0, 2.0, 3.0])));
    }
}
