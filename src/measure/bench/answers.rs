//! What arms answer, and whether they agree: before anything is timed.

use super::contender::Contender;
use crate::trace::{Hits, Rays};
use std::fmt;

/// Rays that are traced, and timed, at a time.
pub(super) const CHUNK: usize = 4096;

/// What an arm says of a batch; the buffers are kept from batch to batch.
#[derive(Clone, Debug, Default)]
pub(super) struct Answers {
    pub(super) hits: Hits,
    pub(super) occluded: Vec<bool>,
}

impl Answers {
    /// What decides a picture, of one ray: the bits of t, u, v and the primitive, or occlusion.
    fn of(&self, ray: usize, occlusion: bool) -> [u32; 4] {
        if occlusion {
            return [u32::from(self.occluded[ray]), 0, 0, 0];
        }
        let h = &self.hits;
        let [t, u, v] = [h.t[ray], h.u[ray], h.v[ray]].map(f32::to_bits);
        [t, u, v, h.prim[ray]]
    }

    fn words(&self, ray: usize, occlusion: bool) -> String {
        if occlusion {
            return self.occluded[ray].to_string();
        }
        let h = &self.hits;
        let (t, u, v, prim) = (h.t[ray], h.u[ray], h.v[ray], h.prim[ray]);
        match prim {
            Hits::NONE => "no hit".to_owned(),
            _ => format!("primitive {prim} at t = {t:e}, u = {u:e}, v = {v:e}"),
        }
    }
}

/// A part of a ray set, with the answers that all arms must give.
#[derive(Clone, Debug)]
pub(super) struct Chunk {
    pub(super) rays: Rays,
    occlusion: bool,
    /// The place of its first ray in the set.
    first: usize,
    expected: Answers,
}

impl Chunk {
    /// Cuts a ray set; `reference` says what is right.
    pub(super) fn cut(rays: &Rays, occlusion: bool, reference: &Contender) -> Vec<Chunk> {
        let part = |first: usize| {
            let rays = rays.part(first..rays.len().min(first + CHUNK));
            let mut expected = Answers::default();
            reference.trace(&rays, occlusion, &mut expected);
            Chunk {
                rays,
                occlusion,
                first,
                expected,
            }
        };
        (0..rays.len()).step_by(CHUNK).map(part).collect()
    }

    /// Traces it.
    pub(super) fn trace(&self, contender: &Contender, answers: &mut Answers) {
        contender.trace(&self.rays, self.occlusion, answers);
    }

    /// Whether the answers are the expected ones.
    pub(super) fn check(&self, answers: &Answers) -> Result<(), Disagreement> {
        let differs =
            |&ray: &usize| answers.of(ray, self.occlusion) != self.expected.of(ray, self.occlusion);
        match (0..self.rays.len()).find(differs) {
            None => Ok(()),
            Some(ray) => Err(Disagreement {
                ray: self.first + ray,
                origin: [0, 1, 2].map(|axis| self.rays.origin[axis][ray]),
                dir: [0, 1, 2].map(|axis| self.rays.dir[axis][ray]),
                t_max: self.rays.t_max[ray],
                found: answers.words(ray, self.occlusion),
                expected: self.expected.words(ray, self.occlusion),
                ..Disagreement::default()
            }),
        }
    }

    /// FNV-1a over the expected answers, going on from `sum`.
    pub(super) fn checksum(&self, mut sum: u64) -> u64 {
        const PRIME: u64 = 0x0100_0000_01b3;
        for ray in 0..self.rays.len() {
            for word in self.expected.of(ray, self.occlusion) {
                for byte in word.to_le_bytes() {
                    sum = (sum ^ u64::from(byte)).wrapping_mul(PRIME);
                }
            }
        }
        sum
    }
}

/// Where [`Chunk::checksum`] starts: FNV-1a of nothing.
pub(super) const NO_ANSWERS: u64 = 0xcbf2_9ce4_8422_2325;

/// An arm says something else of a ray than the product does: a bug in one of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Disagreement {
    /// The arm.
    pub arm: String,
    /// Subject and ray set.
    pub case: String,
    /// Number of the ray in its set.
    pub ray: usize,
    /// Its origin.
    pub origin: [f32; 3],
    /// Its direction.
    pub dir: [f32; 3],
    /// Its end.
    pub t_max: f32,
    /// What the arm says.
    pub found: String,
    /// What the product's kernel says.
    pub expected: String,
}

impl fmt::Display for Disagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([ox, oy, oz], [dx, dy, dz]) = (self.origin, self.dir);
        write!(
            f,
            "the arm {} is wrong on {}, ray {}: {} instead of {} (origin {ox:e} {oy:e} {oz:e}, direction {dx:e} {dy:e} \
             {dz:e}, t_max {:e})",
            self.arm, self.case, self.ray, self.found, self.expected, self.t_max
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Subject, meshes};
    use super::*;
    use crate::build::bvh::{Accel, build};
    use crate::measure::arms::{Layout, Luxel, Tree};
    use crate::trace::Isa;
    use std::sync::Arc;

    fn case(subject: &Subject, occlusion: bool) -> (Vec<Chunk>, Answers) {
        let arm = Luxel(Arc::new(
            subject.scene(build(&subject.primitives(), Accel::Bvh)),
        ));
        let contender = Contender {
            tree: Tree::Bvh8,
            layout: Layout::Luxel,
            isa: Isa::best(),
            arm: &arm,
        };
        let sets = super::super::RaySets::new(subject, &arm.0, CHUNK + 100);
        let rays = sets.of(super::super::RayKind::Primary);
        let chunks = Chunk::cut(rays, occlusion, &contender);
        let mut answers = Answers::default();
        chunks[1].trace(&contender, &mut answers);
        (chunks, answers)
    }

    #[test]
    fn planted_differences_are_found() {
        let ball = meshes::ball(3);
        let (chunks, right) = case(&ball, false);
        assert_eq!([chunks[0].rays.len(), chunks[1].rays.len()], [CHUNK, 100]);
        assert_eq!(chunks[1].check(&right), Ok(()));
        let ray = 77;
        let plants: [fn(&mut Hits, usize); 4] = [
            |h, i| h.t[i] = h.t[i].next_up(),
            |h, i| h.u[i] = -h.u[i],
            |h, i| h.v[i] = f32::NAN,
            |h, i| h.prim[i] ^= 1,
        ];
        for plant in plants {
            let mut wrong = right.clone();
            plant(&mut wrong.hits, ray);
            let told = chunks[1].check(&wrong).expect_err("a difference");
            assert_eq!(told.ray, CHUNK + ray);
            let mut chunk = chunks[1].clone();
            chunk.expected = wrong;
            assert_ne!(chunk.checksum(NO_ANSWERS), chunks[1].checksum(NO_ANSWERS));
        }
    }

    #[test]
    fn planted_light_is_found() {
        let (chunks, right) = case(&meshes::soup(2000), true);
        assert_eq!(chunks[1].check(&right), Ok(()));
        let mut wrong = right.clone();
        wrong.occluded[5] ^= true;
        let told = chunks[1].check(&wrong).expect_err("a difference");
        assert_eq!(told.ray, CHUNK + 5);
    }
}
