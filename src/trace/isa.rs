//! Instruction sets: which kernels run. Every one gives the same bits.

use std::fmt;
use std::str::FromStr;

/// An instruction set that this machine has: [`Isa::best`] and [`Isa::available`] are the only ways to get one above
/// the baseline, so that a value is a proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Isa(Level);

/// Names of instruction sets, whether this machine has them or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// One lane.
    Scalar,
    /// Eight lanes at the target's baseline: SSE2 on x86-64, elsewhere what the compiler makes of arrays.
    Sse2,
    /// Eight lanes of AVX2.
    Avx2,
    /// Sixteen lanes of AVX-512 (F, VL, DQ, BW) against spheres outside the tree; in the tree, AVX2.
    Avx512,
}

impl Level {
    /// All, slowest first.
    pub const ALL: [Level; 4] = [Level::Scalar, Level::Sse2, Level::Avx2, Level::Avx512];
}

impl Isa {
    /// One lane; every machine has it.
    pub const SCALAR: Isa = Isa(Level::Scalar);

    /// This level, if this machine has it.
    #[must_use]
    pub fn available(level: Level) -> Option<Isa> {
        #[cfg(target_arch = "x86_64")]
        // Every machine with AVX2 so far has the bit instructions as well.
        let avx2 = || {
            is_x86_feature_detected!("avx2")
                && is_x86_feature_detected!("bmi1")
                && is_x86_feature_detected!("bmi2")
                && is_x86_feature_detected!("lzcnt")
                && is_x86_feature_detected!("popcnt")
        };
        #[cfg(target_arch = "x86_64")]
        let has = match level {
            Level::Scalar | Level::Sse2 => true,
            Level::Avx2 => avx2(),
            Level::Avx512 => {
                avx2()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512bw")
            }
        };
        #[cfg(not(target_arch = "x86_64"))]
        let has = matches!(level, Level::Scalar | Level::Sse2);
        has.then_some(Isa(level))
    }

    /// All that this machine has, slowest first.
    pub fn all() -> impl Iterator<Item = Isa> {
        Level::ALL.into_iter().filter_map(Isa::available)
    }

    /// The fastest that this machine has.
    #[must_use]
    pub fn best() -> Isa {
        Isa::all().last().unwrap_or(Isa::SCALAR)
    }

    /// Its name.
    #[must_use]
    pub fn level(self) -> Level {
        self.0
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Level::Scalar => "scalar",
            Level::Sse2 => "sse2",
            Level::Avx2 => "avx2",
            Level::Avx512 => "avx512",
        })
    }
}

impl FromStr for Level {
    type Err = String;

    fn from_str(s: &str) -> Result<Level, String> {
        Level::ALL
            .into_iter()
            .find(|l| l.to_string() == s)
            .ok_or_else(|| format!("no instruction set \"{s}\": scalar, sse2, avx2 or avx512"))
    }
}
