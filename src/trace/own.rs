//! The rays that a scene's own paths ask about, for those who measure with them.

use super::path::{arrive, leave, start_paths};
use super::scatter::Bounce;
use super::stages::compact;
use super::tally::Laps;
use super::wave::Wave;
use super::{Rays, Rect, TraceOptions};
use crate::flat::FlatScene;
use std::ops::Range;

/// Rays that ask for their closest hit, and rays that ask whether something is in their way, in the order of the waves; what
/// goes on through surfaces that are not there is left out.
#[must_use]
pub fn own_rays(
    scene: &FlatScene,
    options: &TraceOptions,
    rect: Rect,
    samples: Range<u32>,
) -> [Rays; 2] {
    let [mut closest, mut occlusion] = [Rays::default(), Rays::default()];
    let mut wave = Wave::new(scene);
    let pixels = rect.width as usize * rect.height as usize;
    start_paths(&mut wave, scene, options, rect, (0..pixels, samples));
    let mut laps = Laps::start();
    for index in 0..=options.max_bounces {
        if wave.paths.len() == 0 {
            break;
        }
        let bounce = Bounce {
            scene,
            options,
            index,
        };
        closest.append(&wave.paths.rays);
        arrive(&mut wave, bounce, &mut laps);
        if index < options.max_bounces {
            leave(&mut wave, bounce, &mut laps);
            occlusion.append(&wave.shadows.rays);
            compact(options.isa, &mut wave);
        }
    }
    [closest, occlusion]
}
