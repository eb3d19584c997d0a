//! A texture line of an MTL file: options, then a path that may have spaces.
//!
//! Enters: what follows `map_Kd`, `map_Ke` or `map_d`. Leaves: a [`TextureLine`], and the options that would change the look
//! and are not modelled.

use super::{TextureId, TextureUse, Wrap};

/// Options of a texture line, with the greatest number of values that each takes.
const OPTIONS: [(&str, usize); 14] = [
    ("-blendu", 1),
    ("-blendv", 1),
    ("-bm", 1),
    ("-boost", 1),
    ("-cc", 1),
    ("-clamp", 1),
    ("-colorspace", 1),
    ("-imfchan", 1),
    ("-mm", 2),
    ("-o", 3),
    ("-s", 3),
    ("-t", 3),
    ("-texres", 1),
    ("-type", 1),
];

/// Options whose values are numbers, and fewer than the greatest number may be given.
const VECTOR_OPTIONS: [&str; 4] = ["-mm", "-o", "-s", "-t"];

/// What a texture line asks for.
pub(super) struct TextureLine {
    /// As written.
    pub(super) path: String,
    /// Byte offset of the line.
    pub(super) at: usize,
    /// `-mm 0 gain`: multiplies the texels.
    pub(super) gain: f64,
    /// `-s u v`.
    scale: [f64; 2],
    /// `-o u v`.
    offset: [f64; 2],
    /// `-clamp on`.
    clamp: bool,
}

impl TextureLine {
    /// Reads what follows the keyword; the second part are the options that are ignored.
    pub(super) fn read(rest: &str, at: usize) -> (TextureLine, Vec<&str>) {
        let mut line = TextureLine {
            path: String::new(),
            at,
            gain: 1.0,
            scale: [1.0; 2],
            offset: [0.0; 2],
            clamp: false,
        };
        let mut rest = rest.trim();
        let mut ignored = Vec::new();
        while let Some((option, after)) = split_word(rest) {
            let Some(&(_, most)) = OPTIONS.iter().find(|(name, _)| *name == option) else {
                break;
            };
            let mut values = Vec::new();
            rest = after;
            while values.len() < most {
                let Some((value, after)) = split_word(rest) else {
                    break;
                };
                if VECTOR_OPTIONS.contains(&option) && value.parse::<f64>().is_err() {
                    break;
                }
                values.push(value);
                rest = after;
            }
            if !line.take(option, &values) {
                ignored.push(option);
            }
        }
        line.path = unquote(rest).to_owned();
        (line, ignored)
    }

    /// Whether an option is modelled, or leaves a texture as it is.
    fn take(&mut self, option: &str, values: &[&str]) -> bool {
        let numbers: Vec<f64> = values
            .iter()
            .filter_map(|value| value.parse().ok())
            .collect();
        let finite = numbers.iter().all(|x| x.is_finite());
        let along = |axis: usize, none: f64| numbers.get(axis).copied().unwrap_or(none);
        match option {
            "-s" => self.scale = [along(0, 1.0), along(1, 1.0)],
            "-o" => self.offset = [along(0, 0.0), along(1, 0.0)],
            "-mm" => match numbers[..] {
                [base, gain] if base == 0.0 && gain >= 0.0 && finite => self.gain = gain,
                _ => return false,
            },
            "-clamp" => self.clamp = values == ["on"],
            "-t" => return numbers.iter().all(|&x| x == 0.0),
            "-cc" => return values == ["off"],
            "-imfchan" | "-type" => return false,
            _ => {}
        }
        finite
    }

    /// The texture as the line reads it: at scale · (u, v) + offset, as three.js, Blender and assimp understand the
    /// options, of which the format says only that they shift the origin and scale the pattern.
    pub(super) fn reads(&self, texture: TextureId) -> TextureUse {
        let ([su, sv], [ou, ov]) = (self.scale, self.offset);
        let transform = [su, 0.0, ou, 0.0, sv, ov];
        let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let wrap = if self.clamp {
            Wrap::Clamp
        } else {
            Wrap::Repeat
        };
        let usable = transform.iter().all(|x| x.is_finite()) && transform != identity;
        TextureUse {
            transform: usable.then_some(transform),
            wrap: [wrap; 2],
            ..TextureUse::plain(texture)
        }
    }
}

/// The first word, and what follows it.
fn split_word(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start();
    let end = text.find(char::is_whitespace).unwrap_or(text.len());
    (end > 0).then(|| (&text[..end], text[end..].trim_start()))
}

/// Drops a pair of quotation marks around a name.
pub(super) fn unquote(name: &str) -> &str {
    name.strip_prefix('"')
        .and_then(|name| name.strip_suffix('"'))
        .unwrap_or(name)
}
