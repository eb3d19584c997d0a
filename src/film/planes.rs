//! The film's buffers and how tiles come into them.

/// Per-pixel sums, row by row from the top, structure of arrays. Arrays that were not asked for are empty; all others
/// have one entry per pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Planes {
    /// Sum of radiance.
    pub rgb: Vec<[f64; 3]>,
    /// Sum of squared radiance, for the standard error.
    pub rgb_squared: Vec<[f64; 3]>,
    /// For each level k, the mean over pairs of neighbouring runs of 2ᵏ samples ([`super::Blocks`]) of the squared
    /// half-difference of their means; no level where samples are independent.
    pub gains: Vec<Vec<[f32; 3]>>,
    /// Samples in those sums.
    pub count: Vec<u32>,
    /// Samples left out of them because their radiance was not finite.
    pub non_finite: Vec<u32>,
    /// Samples whose camera ray hit something: the count of the next four.
    pub hit_count: Vec<u32>,
    /// Sum of albedos.
    pub albedo: Vec<[f64; 3]>,
    /// Sum of shading normals, authored axes.
    pub normal: Vec<[f64; 3]>,
    /// Sum of geometric normals, authored axes.
    pub geonormal: Vec<[f64; 3]>,
    /// Sum of depths along the view axis, authored units.
    pub depth: Vec<f64>,
    /// Texture coordinates at the pixel's centre.
    pub uv: Vec<[f32; 2]>,
    /// Triangle index in file order at the pixel's centre; `u32::MAX` for a miss.
    pub prim: Vec<u32>,
    /// Index in the scene's `entities` at the pixel's centre; `u32::MAX` for a miss.
    pub entity: Vec<u32>,
}

/// Pixels `x..x + width` of rows `y..y + height`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// A whole image of sums. Pixel (0, 0) is top left. Pixels that no tile has reached are zero with a count of zero.
#[derive(Clone, Debug)]
pub struct Film {
    width: u32,
    height: u32,
    planes: Planes,
}

impl Film {
    /// An empty film.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Film {
        let mut film = Film {
            width,
            height,
            planes: Planes::default(),
        };
        film.planes.rgb = vec![[0.0; 3]; film.pixels()];
        film.planes.count = vec![0; film.pixels()];
        film
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The sums.
    #[must_use]
    pub fn planes(&self) -> &Planes {
        &self.planes
    }

    /// Samples in the whole film.
    #[must_use]
    pub fn total_samples(&self) -> u64 {
        self.planes.count.iter().map(|&n| u64::from(n)).sum()
    }

    /// Samples that were left out because they were not finite.
    #[must_use]
    pub fn total_non_finite(&self) -> u64 {
        self.planes.non_finite.iter().map(|&n| u64::from(n)).sum()
    }

    /// Puts a tile in its place. Sums are replaced, not added: a tile carries its own through all of its samples, in the
    /// order of [`super::Blocks`]. Tiles that overlap are a mistake of the caller.
    ///
    /// # Panics
    /// If the window leaves the film or an array of the tile has another length than the window.
    pub fn put(&mut self, window: Window, tile: &Planes) {
        assert!(
            window.x + window.width <= self.width && window.y + window.height <= self.height,
            "a tile outside the film"
        );
        let stride = self.width;
        let pixels = self.pixels();
        let into = &mut self.planes;
        let place = Place {
            window,
            stride,
            pixels,
        };
        place.copy(&mut into.rgb, &tile.rgb, [0.0; 3]);
        place.copy(&mut into.rgb_squared, &tile.rgb_squared, [0.0; 3]);
        if into.gains.len() < tile.gains.len() {
            into.gains.resize(tile.gains.len(), Vec::new());
        }
        for (into, from) in into.gains.iter_mut().zip(&tile.gains) {
            place.copy(into, from, [0.0; 3]);
        }
        place.copy(&mut into.count, &tile.count, 0);
        place.copy(&mut into.non_finite, &tile.non_finite, 0);
        place.copy(&mut into.hit_count, &tile.hit_count, 0);
        place.copy(&mut into.albedo, &tile.albedo, [0.0; 3]);
        place.copy(&mut into.normal, &tile.normal, [0.0; 3]);
        place.copy(&mut into.geonormal, &tile.geonormal, [0.0; 3]);
        place.copy(&mut into.depth, &tile.depth, 0.0);
        place.copy(&mut into.uv, &tile.uv, [0.0; 2]);
        place.copy(&mut into.prim, &tile.prim, u32::MAX);
        place.copy(&mut into.entity, &tile.entity, u32::MAX);
    }
}

/// A window of a film of `pixels` in rows of `stride`.
#[derive(Clone, Copy)]
struct Place {
    window: Window,
    stride: u32,
    pixels: usize,
}

impl Place {
    /// Copies the rows of `from`, making `into` full of `empty` first if it does not exist yet.
    fn copy<T: Copy>(self, into: &mut Vec<T>, from: &[T], empty: T) {
        if from.is_empty() {
            return;
        }
        into.resize(self.pixels, empty);
        let w = self.window;
        let row = w.width as usize;
        assert_eq!(
            from.len(),
            row * w.height as usize,
            "a tile of another size"
        );
        for (y, source) in from.chunks_exact(row.max(1)).enumerate() {
            let start = (w.y as usize + y) * self.stride as usize + w.x as usize;
            into[start..start + row].copy_from_slice(source);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(value: f64, pixels: usize) -> Planes {
        Planes {
            rgb: vec![[value; 3]; pixels],
            count: vec![1; pixels],
            prim: vec![7; pixels],
            ..Planes::default()
        }
    }

    #[test]
    fn tiles_land_in_their_window_and_nowhere_else() {
        let mut film = Film::new(5, 3);
        let window = Window {
            x: 2,
            y: 1,
            width: 3,
            height: 2,
        };
        film.put(window, &tile(4.0, 6));
        for y in 0..3 {
            for x in 0..5 {
                let inside = x >= 2 && y >= 1;
                let i = y * 5 + x;
                assert_eq!(film.planes().rgb[i][0], if inside { 4.0 } else { 0.0 });
                assert_eq!(film.planes().prim[i], if inside { 7 } else { u32::MAX });
            }
        }
        assert_eq!(film.total_samples(), 6);
        assert!(
            film.planes().depth.is_empty(),
            "nobody asked for the depths"
        );
    }

    #[test]
    #[should_panic(expected = "outside the film")]
    fn tiles_outside_are_refused() {
        let window = Window {
            x: 4,
            y: 0,
            width: 2,
            height: 1,
        };
        Film::new(5, 3).put(window, &tile(1.0, 2));
    }
}
