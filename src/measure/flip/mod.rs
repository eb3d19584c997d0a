//! LDR-FLIP: the difference that a person sees who alternates between two pictures on a screen.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020: "FLIP: A Difference Evaluator for Alternating
//! Images". 0 is no difference, 1 the largest. A colour pipeline blurs both pictures as the eye does at the distance of
//! the observer and measures how far their colours are apart; a feature pipeline finds edges and points that are in one
//! of them only, and raises the colour error there.
//!
//! The screen shows light clamped to [0, 1]. It is sRGB-encoded on the way to the screen and decoded by it, which
//! cancels, so the images stay linear here. Deliberately absent: HDR-FLIP, with its sweep of exposures.

mod colour;
mod filter;

use self::colour::{Lab, Space};
use self::filter::{Feature, Plane, contrast_sensitivity};
use super::{Image, Pair};
use crate::math;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Pixels per degree of a screen 3840 pixels and 0.7 m wide, seen from 0.7 m: the paper's observer, about 67.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Exponent that compresses large colour differences: q_c of the paper.
const COLOUR_EXPONENT: f64 = 0.7;
/// Share p_c of the largest colour difference below which differences spread over [0, p_t].
const KNEE: f64 = 0.4;
/// p_t of the paper.
const KNEE_VALUE: f64 = 0.95;
/// Exponent of feature differences: q_f of the paper.
const FEATURE_EXPONENT: f64 = 0.5;

/// FLIP per pixel, by rows from the top; also where a pixel does not count, since what is seen depends on what is
/// around it. `pixels_per_degree`, of the observer's sight, is from 10 to 1000.
#[must_use]
pub fn map(pair: &Pair<'_>, pixels_per_degree: f64) -> Vec<f32> {
    let space = Space::new();
    let image = Seen::of(pair.image(), &space, pixels_per_degree);
    let reference = Seen::of(pair.reference(), &space, pixels_per_degree);
    let scale = ColourScale::new(&space);
    (0..pair.counts().len())
        .map(|i| {
            let colour = scale.error(image.lab[i].distance(reference.lab[i]));
            let edge = (image.edges[i] - reference.edges[i]).abs();
            let point = (image.points[i] - reference.points[i]).abs();
            let feature = FRAC_1_SQRT_2 * f64::from(edge.max(point));
            let feature = math::pow(feature, FEATURE_EXPONENT);
            // Where no colour differs, nothing does, however strong the feature: 0^0 is 0 here.
            match colour {
                0.0 => 0.0,
                colour => math::pow(colour, 1.0 - feature) as f32,
            }
        })
        .collect()
}

/// A picture as the eye sees it.
struct Seen {
    /// Blurred by the contrast sensitivity, perceptually uniform, Hunt-adjusted.
    lab: Vec<Lab>,
    /// Strength of edges in the achromatic channel.
    edges: Vec<f32>,
    /// Strength of points in it.
    points: Vec<f32>,
}

impl Seen {
    fn of(image: &Image, space: &Space, pixels_per_degree: f64) -> Seen {
        let pixels: Vec<[f64; 3]> = (image.pixels().iter())
            .map(|p| space.opponent(p.map(|c| f64::from(c).clamp(0.0, 1.0))))
            .collect();
        let channel = |c: usize| Plane {
            width: image.width(),
            values: pixels.iter().map(|p| p[c] as f32).collect(),
        };
        let planes = [0, 1, 2].map(channel);
        let achromatic = Plane {
            width: image.width(),
            values: pixels.iter().map(|p| colour::luminance(p) as f32).collect(),
        };
        drop(pixels);
        let strength = |feature| filter::strength(&achromatic, feature, pixels_per_degree);
        let sensitivities = contrast_sensitivity(pixels_per_degree);
        let [a, b, c] = [0, 1, 2].map(|i| sensitivities[i].blur(&planes[i]));
        let lab = (a.values.iter().zip(&b.values).zip(&c.values))
            .map(|((&a, &b), &c)| space.hunt_lab(space.linear([a, b, c].map(f64::from))))
            .collect();
        Seen {
            lab,
            edges: strength(Feature::Edge),
            points: strength(Feature::Point),
        }
    }
}

/// Maps colour distances to [0, 1].
struct ColourScale {
    /// Compressed distance of green and blue, the largest of any two colours of the screen.
    largest: f64,
}

impl ColourScale {
    fn new(space: &Space) -> ColourScale {
        let green = space.hunt_lab([0.0, 1.0, 0.0]);
        let blue = space.hunt_lab([0.0, 0.0, 1.0]);
        ColourScale {
            largest: math::pow(green.distance(blue), COLOUR_EXPONENT),
        }
    }

    /// Compresses a distance, then spreads most of the distances over most of the range.
    fn error(&self, distance: f64) -> f64 {
        let compressed = math::pow(distance, COLOUR_EXPONENT);
        let knee = KNEE * self.largest;
        if compressed < knee {
            return KNEE_VALUE / knee * compressed;
        }
        let rest = (compressed - knee) / (self.largest - knee);
        KNEE_VALUE + rest * (1.0 - KNEE_VALUE)
    }
}

#[cfg(test)]
mod tests;
