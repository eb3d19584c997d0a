//! The chart: time against error, both in powers of ten, with the front that nothing is below and left of.

use super::super::{Pick, Report};
use super::{arguments, short, wall};
use crate::math::{ln, pow};
use crate::measure::svg::{document, text};
use std::fmt::Write;

/// Pixels: the panel, and what stands around it.
const PANEL: [f64; 2] = [560.0, 340.0];
const LEFT: f64 = 66.0;
const TOP: f64 = 58.0;
const RIGHT: f64 = 24.0;
const FOOT: f64 = 48.0;
/// A line of the picks below the panel.
const LINE: f64 = 18.0;

/// Falls of the error with the time that guides are drawn for: of random points, and of low-discrepancy ones in soft
/// shadows.
const SLOPES: [f64; 2] = [0.5, 0.75];

/// Names and colours of the points, and of the front.
const KINDS: [(&str, &str); 5] = [
    ("the defaults", "#222"),
    ("other exact dials", "#2f6db5"),
    ("biased dials", "#d9822b"),
    ("smaller pictures", "#8a4fa3"),
    ("front", "#3c8d5a"),
];

/// The first of [`KINDS`] that is biased; those are hollow.
const FIRST_BIASED: usize = 2;

/// A setting with a number of samples.
struct Point {
    seconds: [f64; 2],
    error: f64,
    half_width: f64,
    /// Index of [`KINDS`].
    kind: usize,
    /// Out of the race.
    faint: bool,
}

/// A picture of a report. `picks` are named.
#[must_use]
pub fn svg(report: &Report, picks: &[Pick], title: &str) -> String {
    let points = points(report);
    let span = |of: &dyn Fn(&Point) -> f64, more: Vec<f64>| {
        let all = points.iter().map(of).chain(more);
        all.fold([f64::INFINITY, 0.0f64], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    };
    let seconds = picks.iter().map(|p| wall(report, p.seconds)).collect();
    let frame = Frame {
        x: span(&|p| p.seconds[0], seconds),
        y: span(&|p| p.error, picks.iter().map(|p| p.error).collect()),
    };
    let mut body = String::new();
    text(&mut body, [20.0, 26.0], "t", title);
    let says = "relative RMSE over seconds; the line is the front; whiskers are 95 % intervals and least to median times";
    text(&mut body, [20.0, 44.0], "n", says);
    frame.draw(&mut body);
    for point in &points {
        draw(&mut body, &frame, point);
    }
    front(&mut body, &frame, &points);
    let bottom = TOP + PANEL[1] + FOOT;
    legend(&mut body);
    for (k, pick) in picks.iter().enumerate() {
        let at = [
            frame.across(wall(report, pick.seconds)),
            frame.down(pick.error),
        ];
        star(&mut body, at, pick.quality.name());
        let words = format!(
            "{}: {} % in {} s: {}",
            pick.quality.name(),
            short(100.0 * pick.error),
            short(wall(report, pick.seconds)),
            arguments(report, pick)
        );
        text(
            &mut body,
            [LEFT, bottom + LINE * k as f64 + 4.0],
            "s",
            &words,
        );
    }
    let height = bottom + LINE * picks.len() as f64 + 4.0;
    document([LEFT + PANEL[0] + RIGHT, height], &body)
}

/// Every setting at the full size, and the defaults in smaller pictures.
fn points(report: &Report) -> Vec<Point> {
    let rows = report.rows.iter().enumerate();
    let full = rows.map(|(k, row)| (k, row, None));
    let smaller = report.shrunk.iter().map(|s| (0, report.exact(), Some(s)));
    let mut all = Vec::new();
    for (k, row, shrunk) in full.chain(smaller) {
        for level in &row.levels {
            let error = report.error(row, level, shrunk);
            let least = wall(report, report.seconds(row, level.spp, shrunk));
            let slower = level.seconds[1] / level.seconds[0].max(f64::MIN_POSITIVE);
            all.push(Point {
                seconds: [least, least * slower],
                error: error.value,
                half_width: error.half_width,
                kind: match (k, row.biases, shrunk) {
                    (_, _, Some(_)) => 3,
                    (0, ..) => 0,
                    (_, 0, _) => 1,
                    _ => 2,
                },
                faint: row.dropped,
            });
        }
    }
    all.retain(|p| p.error > 0.0 && p.seconds[0] > 0.0);
    all
}

/// Where numbers are drawn.
struct Frame {
    x: [f64; 2],
    y: [f64; 2],
}

impl Frame {
    fn across(&self, seconds: f64) -> f64 {
        LEFT + PANEL[0] * (0.04 + 0.92 * part(self.x, seconds))
    }

    fn down(&self, error: f64) -> f64 {
        TOP + PANEL[1] * (0.95 - 0.90 * part(self.y, error))
    }

    /// Ground, ticks at 1, 2 and 5, guides.
    fn draw(&self, body: &mut String) {
        // Writing to a string does not fail: the results are dropped here and below.
        let _ = write!(
            body,
            "<clipPath id=\"p\"><rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{0}\" height=\"{1}\"/></clipPath>\
             <rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{0}\" height=\"{1}\" fill=\"#f6f7f9\"/>",
            PANEL[0], PANEL[1]
        );
        for tick in ticks(self.x) {
            let x = self.across(tick);
            line(body, [x, TOP], [x, TOP + PANEL[1]], "#e3e5e9", "");
            text(body, [x, TOP + PANEL[1] + 16.0], "m n", &format!("{tick}"));
        }
        for tick in ticks(self.y) {
            let y = self.down(tick);
            line(body, [LEFT, y], [LEFT + PANEL[0], y], "#e3e5e9", "");
            let percent = format!("{} %", (1e7 * tick).round() / 1e5);
            text(body, [LEFT - 8.0, y + 4.0], "a n", &percent);
        }
        let middle = LEFT + 0.5 * PANEL[0];
        text(body, [middle, TOP + PANEL[1] + 33.0], "m", "seconds");
        for slope in SLOPES {
            let ratio = self.x[1] / self.x[0];
            let start = [self.across(self.x[0]), self.down(self.y[1])];
            let end = self.y[1] * pow(ratio, -slope);
            let end = [self.across(self.x[1]), self.down(end)];
            line(
                body,
                start,
                end,
                "#bbb",
                "stroke-dasharray=\"2 4\" clip-path=\"url(#p)\"",
            );
            let along = 0.25;
            let at = [0, 1].map(|k| start[k] + along * (end[k] - start[k]));
            text(
                body,
                [at[0] + 4.0, at[1] - 3.0],
                "n k",
                &format!("slope −{slope}"),
            );
        }
    }
}

/// Where a number lies between two, by its logarithm.
fn part([low, high]: [f64; 2], x: f64) -> f64 {
    ln(x / low) / ln(high / low).max(f64::MIN_POSITIVE)
}

/// 1, 2 and 5 times powers of ten.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let decades = (-9..9).flat_map(|k| [1.0, 2.0, 5.0].map(|m| m * pow(10.0, f64::from(k))));
    let digits = |x: f64| format!("{x:.0e}").parse().unwrap_or(x);
    let mut all: Vec<f64> = decades.map(digits).collect();
    all.retain(|x| (low..=high).contains(x));
    all
}

fn draw(body: &mut String, frame: &Frame, point: &Point) {
    let color = KINDS[point.kind].1;
    let faint = if point.faint { "0.35" } else { "0.9" };
    let [x, y] = [frame.across(point.seconds[0]), frame.down(point.error)];
    let slow = frame.across(point.seconds[1]).min(LEFT + PANEL[0]);
    let lowest = (point.error - point.half_width).max(0.5 * point.error);
    let ends = [point.error + point.half_width, lowest].map(|e| frame.down(e));
    let _ = write!(
        body,
        "<g opacity=\"{faint}\" stroke=\"{color}\"><path d=\"M{x:.1} {:.1}V{:.1}M{x:.1} {y:.1}H{slow:.1}\"/>\
         <circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"{}\"/></g>",
        ends[0],
        ends[1],
        if point.kind < FIRST_BIASED {
            color
        } else {
            "#fff"
        }
    );
}

/// The points that none is both faster and better than, joined.
fn front(body: &mut String, frame: &Frame, points: &[Point]) {
    let mut order: Vec<&Point> = points.iter().collect();
    order.sort_by(|a, b| a.seconds[0].total_cmp(&b.seconds[0]));
    let mut best = f64::INFINITY;
    order.retain(|p| {
        let better = p.error < best;
        best = best.min(p.error);
        better
    });
    let at = |p: &&Point| {
        format!(
            "{:.1},{:.1}",
            frame.across(p.seconds[0]),
            frame.down(p.error)
        )
    };
    let places: Vec<String> = order.iter().map(at).collect();
    let _ = write!(
        body,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>",
        places.join(" "),
        KINDS[4].1
    );
}

fn legend(body: &mut String) {
    for (k, (words, color)) in KINDS.iter().enumerate() {
        let y = TOP + 18.0 + 16.0 * k as f64;
        let x = LEFT + PANEL[0] - 110.0;
        let hollow = (FIRST_BIASED..KINDS.len() - 1).contains(&k);
        let fill = if hollow { "#fff" } else { color };
        let _ = write!(
            body,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"3\" fill=\"{fill}\" stroke=\"{color}\"/>"
        );
        text(body, [x + 10.0, y + 4.0], "", words);
    }
}

fn star(body: &mut String, [x, y]: [f64; 2], words: &str) {
    let _ = write!(
        body,
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\" fill=\"none\" stroke=\"#b3261e\" stroke-width=\"2\"/>"
    );
    match x < LEFT + 0.85 * PANEL[0] {
        true => text(body, [x + 9.0, y - 7.0], "s w", words),
        false => text(body, [x - 9.0, y - 7.0], "s w a", words),
    }
}

fn line(body: &mut String, a: [f64; 2], b: [f64; 2], color: &str, more: &str) {
    let _ = write!(
        body,
        "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{color}\" {more}/>",
        a[0], a[1], b[0], b[1]
    );
}
