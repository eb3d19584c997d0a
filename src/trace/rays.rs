//! Batches of rays and of hits, structure of arrays.

/// Rays of a batch, scene units. All arrays have the same length.
///
/// `t` runs over (0, `t_max`]; there is no `t_min`, since rays leave a surface by its own error bound.
#[derive(Clone, Debug, Default)]
pub struct Rays {
    /// Origins, by axis.
    pub origin: [Vec<f32>; 3],
    /// Directions, by axis; unit up to rounding.
    pub dir: [Vec<f32>; 3],
    /// Largest t that counts; [`f32::MAX`] for "any".
    pub t_max: Vec<f32>,
}

/// Closest hits of a batch. All arrays have the length of the rays.
#[derive(Clone, Debug, Default)]
pub struct Hits {
    /// Ray parameter; [`f32::INFINITY`] for a miss.
    pub t: Vec<f32>,
    /// Barycentric weight of the triangle's second vertex; 0 for spheres.
    pub u: Vec<f32>,
    /// Barycentric weight of the triangle's third vertex; 0 for spheres.
    pub v: Vec<f32>,
    /// Primitive: a triangle's index in its geometry, or `Spheres::TAG | sphere`. [`Hits::NONE`] for a miss.
    pub prim: Vec<u32>,
    /// Index of the instance, [`Hits::WORLD`] for world geometry and spheres.
    pub instance: Vec<u32>,
    /// Bound on the distance, along the geometric normal, between the surface and the position that `surface`
    /// computes for this hit, as seen by the next ray's test too: rays leave by it. Scene units.
    pub err: Vec<f32>,
}

impl Hits {
    /// `prim` of a miss.
    pub const NONE: u32 = u32::MAX;
    /// `instance` of a hit on world geometry or a sphere.
    pub const WORLD: u32 = u32::MAX;
}

impl Rays {
    /// Number of rays.
    #[must_use]
    pub fn len(&self) -> usize {
        self.t_max.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.t_max.is_empty()
    }

    /// Forgets all rays, keeps the memory.
    pub fn clear(&mut self) {
        self.origin
            .iter_mut()
            .chain(&mut self.dir)
            .for_each(Vec::clear);
        self.t_max.clear();
    }

    /// Adds other rays at the end.
    pub fn append(&mut self, other: &Rays) {
        for axis in 0..3 {
            self.origin[axis].extend_from_slice(&other.origin[axis]);
            self.dir[axis].extend_from_slice(&other.dir[axis]);
        }
        self.t_max.extend_from_slice(&other.t_max);
    }

    /// Keeps the first n rays.
    pub(super) fn truncate(&mut self, n: usize) {
        for array in self.origin.iter_mut().chain(&mut self.dir) {
            array.truncate(n);
        }
        self.t_max.truncate(n);
    }

    /// Moves ray `from` to the place of another.
    pub(super) fn keep(&mut self, from: usize, to: usize) {
        for array in self.origin.iter_mut().chain(&mut self.dir) {
            array[to] = array[from];
        }
        self.t_max[to] = self.t_max[from];
    }

    /// A copy of some of them.
    #[must_use]
    pub fn part(&self, range: std::ops::Range<usize>) -> Rays {
        let of = |array: &Vec<f32>| array[range.clone()].to_vec();
        Rays {
            origin: [0, 1, 2].map(|axis| of(&self.origin[axis])),
            dir: [0, 1, 2].map(|axis| of(&self.dir[axis])),
            t_max: of(&self.t_max),
        }
    }

    /// Appends a ray.
    pub fn push(&mut self, origin: [f32; 3], dir: [f32; 3], t_max: f32) {
        for axis in 0..3 {
            self.origin[axis].push(origin[axis]);
            self.dir[axis].push(dir[axis]);
        }
        self.t_max.push(t_max);
    }
}
