//! Roulette: ends paths that carry little, and raises the others by as much.

use super::chunk::Chunk;
use super::sampler::Pair;
use super::scatter::{Bounce, Numbers};
use super::wave::Wave;
use crate::math::lanes::BitLanes;

/// Arvo and Kirk 1990. A throughput that a refraction shrank only until the path leaves the medium is not held against
/// it.
#[inline(always)]
pub(super) fn roulette<L: BitLanes>(wave: &mut Wave, bounce: Bounce) {
    let one = L::splat(1.0);
    for first in (0..wave.paths.len()).step_by(L::N) {
        let chunk = Chunk::range::<L>(first, wave.paths.len());
        let throughput = chunk.vector::<L>(&wave.paths.throughput);
        let [r, g, b] = throughput.0;
        let survival = r.max(g.max(b)) * chunk.lanes(&wave.paths.eta2);
        let safe = one.le(survival);
        if L::bits(safe) & chunk.members() == chunk.members() {
            continue;
        }
        let numbers = Numbers::<L>::new((&wave.paths.key, &wave.paths.sample), bounce, &chunk);
        let [u, _] = numbers.pair(Pair::Roulette(bounce.index));
        let lives = L::bits(u.lt(survival)) | L::bits(safe);
        let raised = L::select(safe, one, one / survival);
        chunk.put_vector(throughput * raised, &mut wave.paths.throughput);
        for (lane, &i) in chunk.index().iter().enumerate() {
            wave.alive[i as usize] &= lives >> lane & 1 == 1;
        }
    }
}
