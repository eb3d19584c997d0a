//! Which share of a still is rendered: what `--shard` and `--samples-range` mean for a number of samples and of tiles.

use super::failure::Failure;
use super::part_args::ShardBy;
use crate::film::Blocks;
use crate::render::{Settings, Share};
use std::ops::Range;

/// The share, the suffix of its name, and what its header says of it.
pub(super) type Shared = (Share, String, Vec<(&'static str, String)>);

/// Share `index` of `count`, of the samples if not said.
pub(super) fn of_all(
    (index, count): (u32, u32),
    by: Option<ShardBy>,
    settings: &Settings,
) -> Result<Shared, Failure> {
    let words = format!("{index}/{count}");
    let suffix = format!(".{index}-of-{count}");
    let (width, height) = settings.size;
    if by == Some(ShardBy::Tiles) {
        let tiles = width.div_ceil(settings.tile) * height.div_ceil(settings.tile);
        if count > tiles {
            return Err(Failure::usage(
                format!("{tiles} tiles are not enough for {count} shares"),
                "make fewer shares, or smaller tiles: --tile 16",
            ));
        }
        let share = Share {
            samples: None,
            tiles: Some((index, count)),
        };
        return Ok((share, suffix, vec![("part.tiles", words)]));
    }
    let end = |index| Blocks::share(settings.spp, (index, count));
    let samples = end(index)..end(index + 1);
    if (0..count).any(|index| end(index) == end(index + 1)) {
        return Err(Failure::usage(
            format!(
                "{} samples are not enough for {count} shares: they are cut into blocks of {}",
                settings.spp,
                Blocks::LENGTH
            ),
            "make fewer shares, or share the tiles: --shard-by tiles",
        ));
    }
    let own = vec![("part.shard", words), ("part.samples", words_of(&samples))];
    let share = Share {
        samples: Some(samples),
        tiles: None,
    };
    Ok((share, suffix, own))
}

/// The samples of `--samples-range`.
pub(super) fn of_range(range: &Range<u32>, spp: u32) -> Result<Shared, Failure> {
    let block = Blocks::LENGTH;
    if range.end > spp || !range.start.is_multiple_of(block) || !Blocks::may_end(range.end, spp) {
        return Err(Failure::usage(
            format!(
                "samples {}..{} are no share of {spp}",
                range.start, range.end
            ),
            &format!("begin and end at multiples of {block}, or at the end, {spp}"),
        ));
    }
    let share = Share {
        samples: Some(range.clone()),
        tiles: None,
    };
    let words = words_of(range);
    Ok((share, format!(".{words}"), vec![("part.samples", words)]))
}

fn words_of(samples: &Range<u32>) -> String {
    format!("{}..{}", samples.start, samples.end)
}
