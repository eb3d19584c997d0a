//! Every operation of every backend against one lane, bit for bit.

#![allow(
    unsafe_code,
    reason = "each backend runs in an entry of its instruction set"
)]

use super::{BitLanes, Lanes, MOST, WideLanes, Words, baseline, portable};

/// Signs, zeros, denormals, halfway cases of rounding, infinities and NaN.
const VALUES: [f32; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1.0 + f32::EPSILON,
    -3.0,
    0.1,
    f32::MIN_POSITIVE,
    1e-45,
    -1e-40,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    16_777_217.0,
];

/// Results that are computed: the sign and payload of a NaN depend on the order of operands, which is nobody's.
fn computed(x: f32) -> u32 {
    if x.is_nan() {
        f32::NAN.to_bits()
    } else {
        x.to_bits()
    }
}

/// Bits of all operations on lanes that hold `a[i]` and `b[i]`, lane by lane.
#[inline(always)]
fn operations<L: Lanes>(a: &[f32; 16], b: &[f32; 16]) -> Vec<[u32; 24]> {
    let mut out = vec![[0; 24]; 16];
    let mut at = 0;
    while at < 16 {
        let [x, y] = [L::load(&a[at..]), L::load(&b[at..])];
        let [w, v] = [x.widen(), y.widen()];
        let third = L::Wide::splat(1.0 / 3.0);
        let calculated = [
            x + y,
            x - y,
            x * y,
            x / y,
            L::narrow((w * third + v) * third),
            L::narrow(w - v / third),
            L::narrow(w.sqrt()),
            x.sqrt(),
            L::narrow(w / v),
            L::narrow(L::Wide::load(&[1e-46; 16]) * w),
        ];
        let chosen = [
            -x,
            x.abs(),
            x.min(y),
            x.max(y),
            L::select(x.lt(y), x, y),
            L::select(x.le(y), y, x),
            L::select(x.lt(y) & L::splat(0.0).le(x), x, y),
            L::select(x.lt(y) | L::splat(0.0).le(x), x, y),
            L::narrow(w.min(v)),
            L::narrow(w.max(v)),
            L::narrow(w.copysign(-v)),
            L::narrow(w.positive_or(v)),
        ];
        let mut lanes = [0.0; 16];
        for (k, value) in calculated.iter().chain(&chosen).enumerate() {
            value.store(&mut lanes);
            for i in 0..L::N {
                let exact = k >= calculated.len() && k < calculated.len() + 8;
                out[at + i][k] = if exact {
                    lanes[i].to_bits()
                } else {
                    computed(lanes[i])
                };
            }
        }
        let bits = L::bits(x.lt(y));
        (0..L::N).for_each(|i| out[at + i][22] = bits >> i & 1);
        let bytes = a.map(|x| (x.to_bits() >> 18) as u8);
        L::load_bytes(&bytes[at..]).store(&mut lanes);
        for i in 0..L::N {
            assert_eq!(lanes[i], f32::from(bytes[at + i]));
            out[at + i][23] = lanes[i].to_bits();
        }
        assert_eq!(
            w.any_not_negative(),
            a[at..at + L::N].iter().any(|x| *x >= 0.0)
        );
        at += L::N;
    }
    out
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn on_avx2(a: &[f32; 16], b: &[f32; 16]) -> Vec<[u32; 24]> {
    operations::<super::avx2::F32x8>(a, b)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,avx512f,avx512vl,avx512dq,avx512bw")]
fn on_avx512(a: &[f32; 16], b: &[f32; 16]) -> Vec<[u32; 24]> {
    operations::<super::avx512::F32x16>(a, b)
}

#[test]
fn every_backend_gives_the_bits_of_one_lane() {
    use crate::trace::isa::{Isa, Level};
    for turn in 0..16 {
        let a = VALUES;
        let mut b = VALUES;
        b.rotate_left(turn);
        let expected = operations::<f32>(&a, &b);
        assert_eq!(
            operations::<portable::F32x8>(&a, &b),
            expected,
            "portable, turn {turn}"
        );
        assert_eq!(
            operations::<portable::F32x4>(&a, &b),
            expected,
            "four portable, turn {turn}"
        );
        assert_eq!(
            operations::<baseline::F32x4>(&a, &b),
            expected,
            "four, turn {turn}"
        );
        assert_eq!(
            operations::<baseline::F32x8>(&a, &b),
            expected,
            "eight, turn {turn}"
        );
        #[cfg(target_arch = "x86_64")]
        if Isa::available(Level::Avx2).is_some() {
            // SAFETY: just asked.
            let found = unsafe { on_avx2(&a, &b) };
            assert_eq!(found, expected, "avx2, turn {turn}");
        }
        #[cfg(target_arch = "x86_64")]
        if Isa::available(Level::Avx512).is_some() {
            // SAFETY: just asked.
            let found = unsafe { on_avx512(&a, &b) };
            assert_eq!(found, expected, "avx512, turn {turn}");
        }
    }
}

#[test]
fn minimum_and_maximum_are_selects() {
    let second = |x: f32, y: f32| (Lanes::min(x, y).to_bits(), Lanes::max(x, y).to_bits());
    let nan = f32::NAN;
    assert_eq!(second(nan, 1.0), (1f32.to_bits(), 1f32.to_bits()));
    assert_eq!(second(1.0, nan), (nan.to_bits(), nan.to_bits()));
    assert_eq!(
        second(0.0, -0.0),
        ((-0.0f32).to_bits(), (-0.0f32).to_bits())
    );
    assert_eq!(second(-0.0, 0.0), (0, 0));
}

/// The promise of [`Lanes::sort_falling`] for every set of lanes: the chosen items by falling keys, with bounds that are not
/// above them and at most seven units in the last place below.
#[inline(always)]
fn sorts<L: Lanes>(keys: &[f32; 8]) {
    let items = [10, 11, 12, 13, 14, 15, 16, 17];
    for chosen in 0..256 {
        let lanes: Vec<usize> = (0..8).filter(|lane| chosen >> lane & 1 == 1).collect();
        let mut blended = [-1.0; 8];
        lanes.iter().for_each(|&lane| blended[lane] = keys[lane]);
        let (mut out, mut bounds) = ([0; 8], [0.0; 8]);
        let len = L::sort_falling(&blended, chosen, &items, &mut out, &mut bounds);
        assert_eq!(len, lanes.len());
        let mut found: Vec<u32> = out[..len].to_vec();
        found.sort_unstable();
        let expected: Vec<u32> = lanes.iter().map(|&lane| items[lane]).collect();
        assert_eq!(found, expected, "{chosen:08b}");
        for (at, item) in out[..len].iter().enumerate() {
            let key = keys[*item as usize - 10];
            let below = key.to_bits().wrapping_sub(bounds[at].to_bits());
            assert!(below < 8, "{key} has the bound {}", bounds[at]);
            assert!(at == 0 || bounds[at] <= bounds[at - 1], "{chosen:08b}");
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn sorts_on_avx2(keys: &[f32; 8]) {
    sorts::<super::avx2::F32x8>(keys);
}

#[test]
fn children_are_sorted_by_falling_keys() {
    use crate::trace::isa::{Isa, Level};
    let mut keys = [3.0, 0.0, 7.5, 0.125, 1e30, 2.0, 2.0, 1e-40];
    for turn in 0..8 {
        keys.rotate_left(1);
        keys.swap(0, turn);
        sorts::<f32>(&keys);
        sorts::<baseline::F32x8>(&keys);
        #[cfg(target_arch = "x86_64")]
        if Isa::available(Level::Avx2).is_some() {
            // SAFETY: just asked.
            unsafe { sorts_on_avx2(&keys) };
        }
    }
}

/// Bits of every operation that only stages have on lanes that hold `a[i]` and `b[i]`, lane by lane.
#[inline(always)]
fn bit_operations<L: BitLanes>(a: &[f32; 16], b: &[f32; 16]) -> Vec<[u32; 14]> {
    let words = |from: &[f32; 16]| from.map(|x| x.to_bits().wrapping_mul(0x9e37_79b9));
    let (v, w) = (words(a), words(b));
    let mut out = vec![[0; 14]; 16];
    let mut at = 0;
    while at < 16 {
        let [x, y] = [L::load(&a[at..]), L::load(&b[at..])];
        let [m, n]: [L::Bits; 2] = [Words::load(&v[at..]), Words::load(&w[at..])];
        let index: [u32; MOST] = std::array::from_fn(|i| v[(at + i) % 16] >> 28);
        let small = m.down::<9>();
        let numbers = [
            L::from_bits(m.plus(n)),
            L::from_bits(m.times(n)),
            L::from_bits(m.xor(n)),
            L::from_bits(m.and(n)),
            L::from_bits(m.or(n)),
            L::from_bits(m.up::<5>()),
            L::from_bits(m.down::<7>()),
            L::from_bits(m.reversed()),
            L::from_bits(x.to_bits().xor(Words::splat(1 << 31))),
            L::from_words(small),
            L::from_bits((L::from_words(small) * L::splat(0.37)).to_words()),
            L::select(L::wide_lt(x.widen(), y.widen()), x, y),
            L::gather(a, &index),
            L::from_bits(Words::gather(&v, &index)),
        ];
        let mut lanes = [0.0; MOST];
        for (k, value) in numbers.iter().enumerate() {
            value.store(&mut lanes);
            (0..L::N).for_each(|i| out[at + i][k] = lanes[i].to_bits());
        }
        for chosen in 0..1 << L::N.min(8) {
            let (mut floats, mut words) = ([0.0; MOST], [0; MOST]);
            x.pack(chosen, &mut floats);
            n.pack(chosen, &mut words);
            let members = (0..L::N).filter(|i| chosen >> i & 1 == 1);
            for (to, from) in members.enumerate() {
                assert_eq!(floats[to].to_bits(), a[at + from].to_bits(), "{chosen:b}");
                assert_eq!(words[to], w[at + from], "{chosen:b}");
            }
        }
        at += L::N;
    }
    out
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn bits_on_avx2(a: &[f32; 16], b: &[f32; 16]) -> Vec<[u32; 14]> {
    bit_operations::<super::avx2::F32x8>(a, b)
}

#[test]
fn every_backend_has_the_bits_of_one_lane() {
    use crate::trace::isa::{Isa, Level};
    for turn in 0..16 {
        let a = VALUES;
        let mut b = VALUES;
        b.rotate_left(turn);
        let expected = bit_operations::<f32>(&a, &b);
        assert_eq!(
            bit_operations::<portable::F32x8>(&a, &b),
            expected,
            "{turn}"
        );
        assert_eq!(
            bit_operations::<baseline::F32x4>(&a, &b),
            expected,
            "{turn}"
        );
        assert_eq!(
            bit_operations::<baseline::F32x8>(&a, &b),
            expected,
            "{turn}"
        );
        #[cfg(target_arch = "x86_64")]
        if Isa::available(Level::Avx2).is_some() {
            // SAFETY: just asked.
            assert_eq!(unsafe { bits_on_avx2(&a, &b) }, expected, "{turn}");
        }
    }
}
