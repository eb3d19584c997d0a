//! f64 sums over consecutive samples, and how they add up.

/// Sums over consecutive samples of the pixels of a window, row by row. Arrays that were not asked for are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sums {
    /// Radiance.
    pub rgb: Vec<[f64; 3]>,
    /// Squares of radiance, for the standard error.
    pub rgb_squared: Vec<[f64; 3]>,
    /// Albedos.
    pub albedo: Vec<[f64; 3]>,
    /// Shading normals, authored axes.
    pub normal: Vec<[f64; 3]>,
    /// Geometric normals, authored axes.
    pub geonormal: Vec<[f64; 3]>,
    /// Depths along the view axis, authored units.
    pub depth: Vec<f64>,
}

impl Sums {
    /// Adds the sums over samples that follow. Of two operands, order does not matter; of three, it would.
    pub(super) fn add(&mut self, next: &Sums) {
        for (into, from) in self.triples_mut().into_iter().zip(next.triples()) {
            add(into.as_flattened_mut(), from.as_flattened());
        }
        add(&mut self.depth, &next.depth);
    }

    /// As many zeros.
    pub(super) fn zeros(&self) -> Sums {
        let zeros = |from: &Vec<[f64; 3]>| vec![[0.0; 3]; from.len()];
        Sums {
            rgb: zeros(&self.rgb),
            rgb_squared: zeros(&self.rgb_squared),
            albedo: zeros(&self.albedo),
            normal: zeros(&self.normal),
            geonormal: zeros(&self.geonormal),
            depth: vec![0.0; self.depth.len()],
        }
    }

    /// Gives what there is and leaves zeros, in the memory of `spare` if it is as large.
    pub(super) fn take(&mut self, spare: &mut Sums) -> Sums {
        let mut zeros = std::mem::take(spare);
        let lengths = |sums: &Sums| (sums.triples().map(Vec::len), sums.depth.len());
        if lengths(&zeros) == lengths(self) {
            for array in zeros.triples_mut() {
                array.fill([0.0; 3]);
            }
            zeros.depth.fill(0.0);
        } else {
            zeros = self.zeros();
        }
        std::mem::replace(self, zeros)
    }

    /// All arrays but the depths.
    pub(super) fn triples(&self) -> [&Vec<[f64; 3]>; 5] {
        [
            &self.rgb,
            &self.rgb_squared,
            &self.albedo,
            &self.normal,
            &self.geonormal,
        ]
    }

    /// The same, to be filled.
    pub(super) fn triples_mut(&mut self) -> [&mut Vec<[f64; 3]>; 5] {
        [
            &mut self.rgb,
            &mut self.rgb_squared,
            &mut self.albedo,
            &mut self.normal,
            &mut self.geonormal,
        ]
    }
}

fn add(into: &mut [f64], from: &[f64]) {
    for (into, from) in into.iter_mut().zip(from) {
        *into += from;
    }
}
