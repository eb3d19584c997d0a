use super::*;

/// A sample of a pixel: a third, so that every addition rounds.
fn sample(s: u32) -> f64 {
    f64::from(s.wrapping_mul(0x9e37_79b9) >> 20) / 3.0
}

/// What a tile has after the samples from `first` to `end`.
fn of(first: u32, end: u32) -> (Blocks, Sums) {
    let mut blocks = Blocks::default();
    let mut open = Sums {
        rgb: vec![[0.0; 3]; 2],
        ..Sums::default()
    };
    let (mut done, mut spare) = (first, Sums::default());
    while done < end {
        let next = Blocks::next(done);
        for s in done..next.min(end) {
            open.rgb[0] = open.rgb[0].map(|sum| sum + sample(s));
        }
        done = next.min(end);
        if done == next {
            blocks.take(done, &mut open, &mut spare);
        }
    }
    (blocks, open)
}

fn finish((blocks, open): (Blocks, Sums), samples: u32) -> Whole {
    blocks.finish(samples, open)
}

/// The definition, without any state: the tree over whole runs, then what is left from its end.
fn by_definition(first: u32, end: u32) -> f64 {
    let length = u64::from(end - first);
    if length <= u64::from(BLOCK) {
        return (first..end).fold(0.0, |sum, s| sum + sample(s));
    }
    let half = length.next_power_of_two() as u32 / 2;
    by_definition(first, first + half) + by_definition(first + half, end)
}

#[test]
fn samples_add_up_as_a_tree_over_their_indices() {
    for samples in [1, 3, 8, 9, 16, 24, 45, 64, 100, 200, 1000, 1024] {
        let whole = finish(of(0, samples), samples);
        assert_eq!(
            whole.sums.rgb[0],
            [by_definition(0, samples); 3],
            "{samples}"
        );
    }
    let in_order = (0..1000).fold(0.0, |sum, s| sum + sample(s));
    assert_ne!(
        by_definition(0, 1000),
        in_order,
        "the order would not matter"
    );
}

#[test]
fn runs_put_together_have_the_bits_of_one() {
    for samples in [16, 45, 64, 200, 1024] {
        let one = finish(of(0, samples), samples);
        for parts in [2, 3, 5, 8] {
            let ends: Vec<u32> = (0..=parts)
                .map(|part| Blocks::share(samples, (part, parts)))
                .collect();
            let (mut all, mut last) = (Blocks::default(), Sums::default());
            for ends in ends.windows(2).filter(|ends| ends[0] < ends[1]) {
                let (part, open) = of(ends[0], ends[1]);
                all.append(part);
                last = open;
            }
            let whole = all.finish(samples, last);
            assert_eq!(whole.sums, one.sums, "{samples} in {parts}");
            assert_eq!(whole.gains, one.gains, "{samples} in {parts}");
        }
    }
}

#[test]
fn shares_cover_all_samples_in_whole_blocks() {
    for (spp, parts) in [(64, 8), (45, 4), (7, 3), (1 << 24, 1000)] {
        let ends: Vec<u32> = (0..=parts)
            .map(|part| Blocks::share(spp, (part, parts)))
            .collect();
        assert_eq!((ends[0], ends[parts as usize]), (0, spp));
        assert!(ends.windows(2).all(|w| w[0] <= w[1]));
        assert!(ends.iter().all(|&end| Blocks::may_end(end, spp)));
    }
}

#[test]
fn neighbouring_runs_are_compared() {
    for samples in [2, 4, 8, 16, 48, 64, 200] {
        let means = finish(of(0, samples), samples).gains;
        let values: Vec<f64> = (0..samples).map(sample).collect();
        let lowest = samples.ilog2().saturating_sub(LEVELS);
        assert_eq!(means.len(), samples.ilog2() as usize);
        for k in lowest..samples.ilog2() {
            let length = 1usize << k;
            let mean = |block: &[f64]| block.iter().sum::<f64>() / length as f64;
            let pairs = Blocks::pairs(samples, k) as usize;
            let squares = values.chunks_exact(2 * length).take(pairs).map(|pair| {
                let half = (mean(&pair[..length]) - mean(&pair[length..])) / 2.0;
                half * half
            });
            let expected = squares.sum::<f64>() / pairs as f64;
            let [found, dark] = means[k as usize][..] else {
                panic!("two pixels at {samples} samples, level {k}");
            };
            assert!(pairs > 0 && (f64::from(found[0]) / expected - 1.0).abs() < 1e-4);
            assert_eq!(dark, [0.0; 3]);
        }
    }
}

#[test]
fn only_the_last_levels_are_kept() {
    let means = finish(of(0, 1024), 1024).gains;
    let kept: Vec<bool> = means.iter().map(|level| !level.is_empty()).collect();
    let expected: Vec<bool> = (0..10).map(|k| k >= 5).collect();
    assert_eq!(kept, expected);
}

#[test]
fn independent_samples_are_not_compared() {
    let mut blocks = Blocks::new(true);
    let mut open = Sums::default();
    for end in [1, 2, 4, 8, 16, 24] {
        open.rgb = vec![[1.0; 3]];
        blocks.take(end, &mut open, &mut Sums::default());
    }
    assert!(
        blocks
            .finish(24, Sums::default())
            .gains
            .iter()
            .all(Vec::is_empty)
    );
}
