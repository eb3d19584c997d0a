//! Patches as bytes.

use super::super::blocks::{Blocks, Level, Node};
use super::super::{Patch, Sums, Window};

/// Appends a patch.
pub(super) fn put_patch(into: &mut Vec<u8>, patch: &Patch) {
    let w = patch.window;
    put(into, &[w.x, w.y, w.width, w.height]);
    put(into, &[patch.first, patch.done]);
    put(into, &[u32::from(patch.blocks.independent)]);
    for counts in [&patch.count, &patch.non_finite, &patch.hit_count] {
        put_array(into, counts);
    }
    put_array(into, patch.uv.as_flattened());
    put_array(into, &patch.prim);
    put_array(into, &patch.entity);
    put_array(into, patch.lost.as_flattened());
    match patch.done.is_multiple_of(Blocks::LENGTH) {
        // Zeros, which the reader makes as well.
        true => put_sums(into, &Sums::default()),
        false => put_sums(into, &patch.open),
    }
    put_levels(into, &patch.blocks.early);
    put_array(into, patch.blocks.middle.as_flattened());
    put(into, &[patch.blocks.nodes.len() as u32]);
    for node in &patch.blocks.nodes {
        put(into, &[node.first, node.level]);
        put_sums(into, &node.sums);
        put_levels(into, &node.squares);
    }
}

fn put_sums(into: &mut Vec<u8>, sums: &Sums) {
    for array in sums.triples() {
        put_array(into, array.as_flattened());
    }
    put_array(into, &sums.depth);
}

fn put_levels(into: &mut Vec<u8>, levels: &[Level]) {
    put(into, &[levels.len() as u32]);
    for level in levels {
        put(into, &[level.k]);
        put_array(into, level.squares.as_flattened());
    }
}

/// An array behind its length.
fn put_array<T: Number<N>, const N: usize>(into: &mut Vec<u8>, values: &[T]) {
    put(into, &[values.len() as u32]);
    put(into, values);
}

fn put<T: Number<N>, const N: usize>(into: &mut Vec<u8>, values: &[T]) {
    let start = into.len();
    into.resize(start + N * values.len(), 0);
    let (places, _) = into[start..].as_chunks_mut::<N>();
    for (place, value) in places.iter_mut().zip(values) {
        *place = value.to_le();
    }
}

/// The window of a patch and the samples that it holds, from the beginning of its bytes.
pub(super) fn peek(bytes: &[u8]) -> Option<(Window, u32, u32)> {
    let mut bytes = Bytes(bytes);
    let [x, y, width, height, first, done] = bytes.some()?;
    let window = Window {
        x,
        y,
        width,
        height,
    };
    Some((window, first, done))
}

/// A patch; `None` if it is none that [`put_patch`] wrote.
pub(super) fn patch(bytes: &[u8]) -> Option<Patch> {
    let (window, first, done) = peek(bytes)?;
    let pixels = u64::from(window.width) * u64::from(window.height);
    let pixels = usize::try_from(pixels).ok()?;
    let mut bytes = Bytes(bytes);
    let [.., independent] = bytes.some::<7>()?;
    let [count, non_finite, hit_count] = [
        bytes.array(pixels)?,
        bytes.array(pixels)?,
        bytes.array(pixels)?,
    ];
    let uv = pairs(bytes.array(2 * pixels)?);
    let [prim, entity] = [bytes.array(pixels)?, bytes.array(pixels)?];
    let lost = pairs(bytes.list()?);
    let mut open = bytes.sums(pixels)?;
    let early = bytes.levels(pixels)?;
    let middle = triples(bytes.array(3 * pixels)?);
    let [nodes] = bytes.some()?;
    let nodes: Option<Vec<Node>> = (0..nodes).map(|_| bytes.node(pixels)).collect();
    let nodes = nodes?;
    if let (true, Some(node)) = (open.rgb.is_empty(), nodes.last()) {
        open = node.sums.zeros();
    }
    let patch = Patch {
        window,
        first,
        done,
        count,
        non_finite,
        hit_count,
        uv,
        prim,
        entity,
        lost,
        open,
        blocks: Blocks {
            nodes,
            early,
            middle,
            independent: independent != 0,
        },
    };
    bytes.0.is_empty().then_some(patch)
}

/// What has not been read yet.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn some<const COUNT: usize>(&mut self) -> Option<[u32; COUNT]> {
        self.numbers(COUNT)?.try_into().ok()
    }

    /// An array of `length` numbers, or an empty one.
    fn array<T: Number<N>, const N: usize>(&mut self, length: usize) -> Option<Vec<T>> {
        let array = self.list()?;
        (array.is_empty() || array.len() == length).then_some(array)
    }

    fn list<T: Number<N>, const N: usize>(&mut self) -> Option<Vec<T>> {
        let [length] = self.some()?;
        self.numbers(length as usize)
    }

    fn numbers<T: Number<N>, const N: usize>(&mut self, count: usize) -> Option<Vec<T>> {
        let (bytes, rest) = self.0.split_at_checked(count.checked_mul(N)?)?;
        self.0 = rest;
        let (numbers, _) = bytes.as_chunks::<N>();
        Some(numbers.iter().map(|bytes| T::of_le(*bytes)).collect())
    }

    fn sums(&mut self, pixels: usize) -> Option<Sums> {
        let mut sums = Sums::default();
        for array in sums.triples_mut() {
            *array = triples(self.array(3 * pixels)?);
        }
        sums.depth = self.array(pixels)?;
        Some(sums)
    }

    fn levels(&mut self, pixels: usize) -> Option<Vec<Level>> {
        let [count] = self.some()?;
        let level = |_| {
            let [k] = self.some()?;
            let squares = triples(self.array(3 * pixels)?);
            (k < u32::BITS).then_some(Level { k, squares })
        };
        (0..count).map(level).collect()
    }

    fn node(&mut self, pixels: usize) -> Option<Node> {
        let [first, level] = self.some()?;
        let node = Node {
            first,
            level,
            sums: self.sums(pixels)?,
            squares: self.levels(pixels)?,
        };
        (level < u32::BITS).then_some(node)
    }
}

fn pairs<T: Copy>(flat: Vec<T>) -> Vec<[T; 2]> {
    flat.as_chunks().0.to_vec()
}

fn triples<T: Copy>(flat: Vec<T>) -> Vec<[T; 3]> {
    flat.as_chunks().0.to_vec()
}

/// A number of N bytes.
trait Number<const N: usize>: Copy {
    fn to_le(self) -> [u8; N];
    fn of_le(bytes: [u8; N]) -> Self;
}

macro_rules! numbers {
    ($($number:ty: $bytes:literal),*) => {$(
        impl Number<$bytes> for $number {
            fn to_le(self) -> [u8; $bytes] {
                self.to_le_bytes()
            }
            fn of_le(bytes: [u8; $bytes]) -> $number {
                <$number>::from_le_bytes(bytes)
            }
        }
    )*};
}

numbers!(u32: 4, f32: 4, f64: 8);
