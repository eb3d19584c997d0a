//! What each choice buys: times of arms that differ in one thing alone.

use super::super::Record;
use super::distinct;
use crate::math::{exp, ln};
use crate::measure::arms::{Layout, Tree};
use crate::trace::isa::Level;
use std::fmt::Write;

/// One choice against another wherever both were timed.
struct Choice {
    /// `lane blocks over array of structs, avx2`.
    title: String,
    /// How many times faster, and in which case.
    ratios: Vec<(f64, String)>,
}

/// A line for every choice that the run can judge, empty if there is none: geometric mean, worst and best case.
#[must_use]
pub fn summary(records: &[Record]) -> String {
    let choices: Vec<Choice> = choices(records)
        .into_iter()
        .filter(|choice| !choice.ratios.is_empty())
        .collect();
    let width = choices.iter().map(|c| c.title.chars().count()).max();
    let mut text = String::new();
    for choice in &choices {
        let by_ratio = |a: &&(f64, String), b: &&(f64, String)| a.0.total_cmp(&b.0);
        let (Some(worst), Some(best), Some(width)) = (
            choice.ratios.iter().min_by(by_ratio),
            choice.ratios.iter().max_by(by_ratio),
            width,
        ) else {
            continue;
        };
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "  {:width$}  {:.2}×   {:.2} ({}) to {:.2} ({})",
            choice.title,
            choice.mean(),
            worst.0,
            worst.1,
            best.0,
            best.1,
        );
    }
    if text.is_empty() {
        return text;
    }
    format!(
        "What each choice buys, all else equal: times faster, geometric mean, worst and best case\n{text}"
    )
}

impl Choice {
    /// Wherever records agree in all but the choice. `side` tells which side a record is on; `key` is what must be equal.
    fn between<K: PartialEq>(
        title: String,
        records: &[Record],
        side: impl Fn(&Record) -> Option<Side>,
        key: impl Fn(&Record) -> K,
    ) -> Choice {
        let of = |wanted| {
            records
                .iter()
                .filter(|r| side(r) == Some(wanted))
                .collect::<Vec<_>>()
        };
        let same = |a: &Record, b: &Record| {
            (&a.subject, a.rays) == (&b.subject, b.rays) && key(a) == key(b)
        };
        let mut ratios = Vec::new();
        let old = of(Side::Old);
        for new in of(Side::New) {
            let fastest = old
                .iter()
                .copied()
                .filter(|old| same(new, old))
                .map(Record::ns)
                .min_by(f64::total_cmp);
            let case = format!("{}, {}", new.rays, new.subject);
            ratios.extend(fastest.map(|old| (old / new.ns(), case)));
        }
        Choice { title, ratios }
    }

    /// Geometric mean.
    fn mean(&self) -> f64 {
        let sum: f64 = self.ratios.iter().map(|(ratio, _)| ln(*ratio)).sum();
        exp(sum / self.ratios.len() as f64)
    }
}

/// Which side of a choice.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    New,
    Old,
}

fn side(new: bool, old: bool) -> Option<Side> {
    if new {
        Some(Side::New)
    } else {
        old.then_some(Side::Old)
    }
}

fn choices(records: &[Record]) -> Vec<Choice> {
    let isas = distinct(records, |r| r.isa);
    let layouts = distinct(records, |r| r.layout);
    let best = isas.iter().max();
    // What a ray costs without a tree says nothing of traversal.
    let in_tree = |r: &Record| !r.tree.exhaustive();
    let mut all = Vec::new();
    for &isa in &isas {
        let plain = [Layout::Structs, Layout::Luxel];
        for &layout in layouts.iter().filter(|layout| !plain.contains(layout)) {
            let here = |r: &Record| in_tree(r) && r.isa == isa;
            all.push(Choice::between(
                format!("{} over {}, {isa}", layout.title(), Layout::Structs.title()),
                records,
                |r| {
                    side(
                        here(r) && r.layout == layout,
                        here(r) && r.layout == Layout::Structs,
                    )
                },
                |r| r.tree,
            ));
        }
    }
    for &isa in isas.iter().filter(|&&isa| isa != Level::Scalar) {
        for &layout in &layouts {
            let here = |r: &Record| in_tree(r) && r.layout == layout;
            all.push(Choice::between(
                format!("{isa} over scalar, {}", layout.title()),
                records,
                |r| side(here(r) && r.isa == isa, here(r) && r.isa == Level::Scalar),
                |r| r.tree,
            ));
        }
    }
    for &isa in &isas {
        let of = |r: &Record, layout| in_tree(r) && r.isa == isa && r.layout == layout;
        all.push(Choice::between(
            format!(
                "{} over {}, {isa}",
                Layout::Blocks.title(),
                Layout::Fours.title()
            ),
            records,
            |r| side(of(r, Layout::Blocks), of(r, Layout::Fours)),
            |r| r.tree,
        ));
    }
    all.push(Choice::between(
        "boxes in floats over bytes".to_owned(),
        records,
        |r| side(r.tree == Tree::Bvh8, r.tree == Tree::Bvh8q),
        |r| (r.layout, r.isa),
    ));
    all.push(Choice::between(
        "eight children over two".to_owned(),
        records,
        |r| side(r.tree == Tree::Bvh8, r.tree == Tree::Bvh2),
        |r| (r.layout, r.isa),
    ));
    all.push(Choice::between(
        "luxel over the fastest rival".to_owned(),
        records,
        |r| {
            let luxel = r.layout == Layout::Luxel;
            side(
                luxel && r.tree == Tree::Bvh8 && Some(&r.isa) == best,
                !luxel && in_tree(r),
            )
        },
        |_| (),
    ));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bench::RayKind;

    fn record(layout: Layout, isa: Level, rays: RayKind, ns: f64) -> Record {
        Record {
            subject: "1m".to_owned(),
            primitives: 1,
            rays,
            tree: Tree::Bvh8,
            layout,
            isa,
            timed: 1000,
            passes: 3,
            seconds: ns * 1e-6,
            work: None,
            bytes: 0.0,
            build_ms: 0.0,
            checksum: 0,
        }
    }

    #[test]
    fn equal_cases_are_compared() {
        use Layout::{Blocks, Luxel, Structs};
        use Level::{Avx2, Scalar};
        use RayKind::{Primary, Random};
        let records = [
            record(Structs, Scalar, Primary, 800.0),
            record(Structs, Avx2, Primary, 400.0),
            record(Blocks, Avx2, Primary, 100.0),
            record(Structs, Avx2, Random, 600.0),
            record(Blocks, Avx2, Random, 600.0),
            record(Luxel, Avx2, Random, 300.0),
        ];
        let text = summary(&records);
        let line = |title: &str| {
            let line = text
                .lines()
                .find(|line| line.trim_start().starts_with(title));
            let line = line.unwrap_or_else(|| panic!("no {title} in {text}"));
            line.split_whitespace().collect::<Vec<_>>().join(" ")
        };
        assert_eq!(
            line("lane blocks over"),
            "lane blocks over array of structs, avx2 2.00× 1.00 (random, 1m) to 4.00 (primary, 1m)"
        );
        assert_eq!(
            line("avx2 over scalar"),
            "avx2 over scalar, array of structs 2.00× 2.00 (primary, 1m) to 2.00 (primary, 1m)"
        );
        assert_eq!(
            line("luxel over"),
            "luxel over the fastest rival 2.00× 2.00 (random, 1m) to 2.00 (random, 1m)"
        );
        assert_eq!(text.lines().count(), 4, "{text}");
        assert_eq!(summary(&records[..1]), "");
    }
}
