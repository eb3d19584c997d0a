//! The chart: relative error over samples, both axes in powers.

use super::Row;
use crate::math::ln;
use std::fmt::Write;

/// Pixels: the panel, and what stands around it.
const PANEL: [f64; 2] = [520.0, 300.0];
const LEFT: f64 = 70.0;
const TOP: f64 = 60.0;
const FOOT: f64 = 52.0;
const RIGHT: f64 = 24.0;

/// Lines of slope −½ are this many powers of two apart.
const GUIDES: i32 = 2;

/// The part of the plane that is shown, in powers of two.
struct Window {
    low: [f64; 2],
    high: [f64; 2],
}

impl Window {
    fn of(rows: &[Row]) -> Window {
        let mut window = Window {
            low: [0.0, f64::INFINITY],
            high: [1.0, f64::NEG_INFINITY],
        };
        for row in rows {
            window.high[0] = window.high[0].max(log2(f64::from(row.spp)));
            let predicted = row.predicted.map(|(relative, _)| relative);
            for y in [Some(row.relative_rmse), predicted].into_iter().flatten() {
                if y > 0.0 {
                    window.low[1] = window.low[1].min(log2(y).floor());
                    window.high[1] = window.high[1].max(log2(y).ceil());
                }
            }
        }
        if window.low[1] >= window.high[1] {
            let middle = if window.low[1].is_finite() {
                window.low[1]
            } else {
                0.0
            };
            (window.low[1], window.high[1]) = (middle - 1.0, middle + 1.0);
        }
        window
    }

    /// Pixels from powers of two.
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let part = |v: f64, k: usize| (v - self.low[k]) / (self.high[k] - self.low[k]);
        [
            LEFT + PANEL[0] * part(x, 0),
            TOP + PANEL[1] * (1.0 - part(y, 1)),
        ]
    }
}

pub(super) fn svg(rows: &[Row], title: &str) -> String {
    let window = Window::of(rows);
    let mut body = String::new();
    text(&mut body, [20.0, 26.0], "t", title);
    text(
        &mut body,
        [20.0, 44.0],
        "n",
        "relative RMSE: dots against the reference, bars as the image says itself (95 %); thin lines fall as 1/√n",
    );
    frame(&mut body, &window);
    for row in rows {
        let x = log2(f64::from(row.spp));
        if let Some((relative, half)) = row.predicted.filter(|(relative, _)| *relative > 0.0) {
            let end = |y: f64| window.at([x, log2(y.max(relative / 16.0))]);
            let ([x, low], [_, high]) = (end(relative - half), end(relative + half));
            // Writing to a string does not fail: the results are dropped here and below.
            let _ = write!(
                body,
                "<line x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{low:.1}\" y2=\"{high:.1}\" stroke=\"#2a6fb0\" stroke-width=\"5\" \
                 stroke-opacity=\"0.45\"/>"
            );
        }
    }
    for row in rows.iter().filter(|row| row.relative_rmse > 0.0) {
        let [x, y] = window.at([log2(f64::from(row.spp)), log2(row.relative_rmse)]);
        let _ = write!(
            body,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"#b3261e\"/>"
        );
    }
    let [width, height] = [LEFT + PANEL[0] + RIGHT, TOP + PANEL[1] + FOOT];
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"11\" fill=\"#222\"><style>.t{{font-size:15px;font-weight:600}}\
         .a{{text-anchor:end}}.m{{text-anchor:middle}}.n{{fill:#666}}</style>\
         <clipPath id=\"p\"><rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" height=\"{}\"/></clipPath>\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>{body}</svg>\n",
        PANEL[0], PANEL[1]
    )
}

/// The panel, its guides and its labels.
fn frame(body: &mut String, window: &Window) {
    let [width, height] = PANEL;
    let _ = write!(
        body,
        "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{width}\" height=\"{height}\" fill=\"#f6f7f9\"/><g clip-path=\"url(#p)\" \
         stroke=\"#c9ced6\">"
    );
    let [low, high] = [window.low[1], window.high[1] + 0.5 * window.high[0]];
    let mut start = low;
    while start <= high {
        let ([x1, y1], [x2, y2]) = (
            window.at([0.0, start]),
            window.at([window.high[0], start - 0.5 * window.high[0]]),
        );
        let _ = write!(
            body,
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\"/>"
        );
        start += f64::from(GUIDES);
    }
    body.push_str("</g>");
    for k in 0..=window.high[0] as i32 {
        let [x, y] = window.at([f64::from(k), window.low[1]]);
        text(body, [x, y + 16.0], "m n", &format!("{}", 1u64 << k));
    }
    for k in window.low[1] as i32..=window.high[1] as i32 {
        let [x, y] = window.at([0.0, f64::from(k)]);
        let share = 100.0 * crate::math::pow(2.0, f64::from(k));
        let decimals = if share >= 10.0 { 0 } else { 2 };
        text(
            body,
            [x - 8.0, y + 4.0],
            "a n",
            &format!("{share:.decimals$} %"),
        );
    }
    let foot = [LEFT + 0.5 * width, TOP + height + 38.0];
    text(body, foot, "m", "samples per pixel");
}

fn log2(x: f64) -> f64 {
    ln(x) / std::f64::consts::LN_2
}

fn text(body: &mut String, [x, y]: [f64; 2], class: &str, words: &str) {
    let words = words.replace('&', "&amp;").replace('<', "&lt;");
    let _ = write!(
        body,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"{class}\">{words}</text>"
    );
}
