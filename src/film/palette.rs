//! Few colours for many: the palette of a GIF.
//!
//! Colours are cells of 64³; a box of cells is cut where the summed squared distance of its two halves to their means
//! becomes smallest, the worst box first (after Wu, *Color Quantization by Dynamic Programming and Principal Analysis*,
//! ACM TOG 11(4), 1992, in the variant that cuts along the axis of greatest variance). Sums run in the order of the
//! cells: equal pictures have equal palettes on every machine.

/// Bits of a channel that tell cells apart: steps of 4 in 8 bits, below what a palette of 256 can show.
const BITS: u32 = 6;
const CELLS: usize = 1 << (3 * BITS);

/// How often colours occur.
#[derive(Clone)]
pub(super) struct Histogram {
    /// Pixels in each cell.
    count: Vec<u32>,
    /// Sums of their channels.
    sum: Vec<[u64; 3]>,
}

/// A cell that occurs.
#[derive(Clone, Copy)]
struct Cell {
    index: usize,
    color: [f64; 3],
    weight: f64,
}

/// Colours, and which of them is nearest to each cell.
pub(super) struct Palette {
    /// sRGB codes.
    pub(super) colors: Vec<[u8; 3]>,
    nearest: Vec<u8>,
}

impl Histogram {
    pub(super) fn new() -> Histogram {
        Histogram {
            count: vec![0; CELLS],
            sum: vec![[0; 3]; CELLS],
        }
    }

    /// Counts pixels of three sRGB bytes.
    pub(super) fn add(&mut self, rgb: &[u8]) {
        for pixel in rgb.chunks_exact(3) {
            let color = [pixel[0], pixel[1], pixel[2]];
            let cell = cell_of(color);
            self.count[cell] = self.count[cell].saturating_add(1);
            for (sum, channel) in self.sum[cell].iter_mut().zip(color) {
                *sum += u64::from(channel);
            }
        }
    }

    /// At most `len` (1 to 256) colours that stand for all.
    pub(super) fn palette(&self, len: usize) -> Palette {
        let mut cells: Vec<Cell> = (0..CELLS)
            .filter(|&index| self.count[index] > 0)
            .map(|index| {
                let count = f64::from(self.count[index]);
                Cell {
                    index,
                    color: self.sum[index].map(|sum| sum as f64 / count),
                    // A backdrop has many times the pixels of what stands before it, but is not that much more important.
                    weight: count.sqrt(),
                }
            })
            .collect();
        let colors = cut(&mut cells, len);
        let mut nearest = vec![0; CELLS];
        for cell in &cells {
            nearest[cell.index] = closest(&colors, cell.color);
        }
        Palette { colors, nearest }
    }
}

impl Palette {
    /// The entry for a colour that the histogram has counted.
    pub(super) fn index(&self, color: [u8; 3]) -> u8 {
        self.nearest[cell_of(color)]
    }
}

fn cell_of(color: [u8; 3]) -> usize {
    let [r, g, b] = color.map(|channel| usize::from(channel >> (8 - BITS)));
    (r << (2 * BITS)) | (g << BITS) | b
}

/// Weighted sums over cells.
#[derive(Clone, Copy, Default)]
struct Sums {
    weight: f64,
    color: [f64; 3],
    square: [f64; 3],
}

impl Sums {
    fn of(cells: &[Cell]) -> Sums {
        cells.iter().fold(Sums::default(), Sums::with)
    }

    fn with(mut self, cell: &Cell) -> Sums {
        self.weight += cell.weight;
        for c in 0..3 {
            self.color[c] += cell.weight * cell.color[c];
            self.square[c] += cell.weight * cell.color[c] * cell.color[c];
        }
        self
    }

    fn without(self, other: Sums) -> Sums {
        Sums {
            weight: self.weight - other.weight,
            color: std::array::from_fn(|c| self.color[c] - other.color[c]),
            square: std::array::from_fn(|c| self.square[c] - other.square[c]),
        }
    }

    /// Summed squared distances to the mean, by channel.
    fn scatter(self) -> [f64; 3] {
        if self.weight <= 0.0 {
            return [0.0; 3];
        }
        std::array::from_fn(|c| {
            (self.square[c] - self.color[c] * self.color[c] / self.weight).max(0.0)
        })
    }

    fn error(self) -> f64 {
        self.scatter().iter().sum()
    }

    fn mean(self) -> [u8; 3] {
        // A mean of bytes is one; the cast rounds half up.
        self.color.map(|sum| (sum / self.weight + 0.5) as u8)
    }
}

/// Reorders the cells into boxes and gives the mean of each.
fn cut(cells: &mut [Cell], len: usize) -> Vec<[u8; 3]> {
    if cells.is_empty() {
        return vec![[0; 3]];
    }
    let mut boxes = vec![(0..cells.len(), Sums::of(cells))];
    while boxes.len() < len {
        let errors = boxes.iter().map(|(_, sums)| sums.error()).enumerate();
        let worst = errors.max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((worst, _)) = worst.filter(|&(_, error)| error > 0.0) else {
            break;
        };
        let (range, sums) = boxes[worst].clone();
        let Some(at) = halve(&mut cells[range.clone()], sums) else {
            // One cell whose error is rounding.
            boxes[worst].1.square = [0.0; 3];
            continue;
        };
        let middle = range.start + at;
        for (place, half) in [
            (worst, range.start..middle),
            (boxes.len(), middle..range.end),
        ] {
            let half = (half.clone(), Sums::of(&cells[half]));
            if place == boxes.len() {
                boxes.push(half);
            } else {
                boxes[place] = half;
            }
        }
    }
    boxes.iter().map(|(_, sums)| sums.mean()).collect()
}

/// Sorts the cells of a box along its longest axis and gives the cut with the least error; `None` for a single cell.
fn halve(cells: &mut [Cell], sums: Sums) -> Option<usize> {
    let scatter = sums.scatter();
    let axis = (0..3).max_by(|&a, &b| scatter[a].total_cmp(&scatter[b]))?;
    cells.sort_by(|a, b| {
        let by_color = a.color[axis].total_cmp(&b.color[axis]);
        by_color.then(a.index.cmp(&b.index))
    });
    let mut below = Sums::default();
    let mut best = None;
    for (i, cell) in cells.iter().enumerate().take(cells.len() - 1) {
        below = below.with(cell);
        let error = below.error() + sums.without(below).error();
        if best.is_none_or(|(least, _)| error < least) {
            best = Some((error, i + 1));
        }
    }
    best.map(|(_, at)| at)
}

fn closest(colors: &[[u8; 3]], color: [f64; 3]) -> u8 {
    let distance = |entry: &[u8; 3]| -> f64 {
        let difference = |c: usize| f64::from(entry[c]) - color[c];
        (0..3).map(|c| difference(c) * difference(c)).sum()
    };
    let all = colors.iter().map(distance).enumerate();
    // At most 256 colours.
    all.min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(i, _)| i as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn palette(pixels: &[u8], len: usize) -> Palette {
        let mut histogram = Histogram::new();
        histogram.add(pixels);
        histogram.palette(len)
    }

    #[test]
    fn few_colours_are_kept_exactly() {
        let pixels = [0, 0, 0, 255, 255, 255, 200, 40, 7, 200, 40, 7, 10, 90, 255];
        let palette = palette(&pixels, 255);
        assert_eq!(palette.colors.len(), 4);
        for pixel in pixels.chunks(3) {
            let index = palette.index([pixel[0], pixel[1], pixel[2]]);
            assert_eq!(palette.colors[usize::from(index)], pixel);
        }
    }

    #[test]
    fn a_grey_ramp_is_cut_evenly() {
        let pixels: Vec<u8> = (0..=255u8).flat_map(|k| [k; 3]).collect();
        let palette = palette(&pixels, 16);
        assert_eq!(palette.colors.len(), 16);
        for k in 0..=255u8 {
            let shown = palette.colors[usize::from(palette.index([k; 3]))][0];
            assert!(shown.abs_diff(k) <= 12, "{k} is shown as {shown}");
        }
    }

    #[test]
    fn a_small_spot_of_colour_survives_a_large_backdrop() {
        let mut pixels: Vec<u8> = (0..60_000u32)
            .flat_map(|i| [120 + (i % 16) as u8; 3])
            .collect();
        pixels.extend([250, 10, 10].repeat(40));
        let palette = palette(&pixels, 4);
        let shown = palette.colors[usize::from(palette.index([250, 10, 10]))];
        assert_eq!(shown, [250, 10, 10]);
    }

    #[test]
    fn nothing_at_all_has_a_palette() {
        assert_eq!(palette(&[], 255).colors.len(), 1);
    }
}
