//! MTL text to materials: our own reader, since the parser's panics on legal files and knows no lines.
//!
//! Read: `newmtl`, `Kd`, `map_Kd`, `Ke`, `map_Ke`, `d`, `Tr`, `map_d`. What else changes the look is remembered, to be told
//! of when the material is used.

use super::codes;
use super::scan::at_line;
use super::text::{Line, Lines};
use super::texture_line::TextureLine;
use crate::diag::Diagnostic;

/// A material as an MTL file has it.
pub(super) struct Definition {
    pub(super) name: String,
    /// Byte offset of its `newmtl` line.
    pub(super) at: usize,
    /// `Kd`, linear.
    pub(super) color: Option<[f64; 3]>,
    /// `map_Kd`.
    pub(super) texture: Option<TextureLine>,
    /// `d`, or 1 − `Tr` where there is no `d`, and the byte offset of the line.
    pub(super) opacity: Option<(f64, usize)>,
    /// `map_d`.
    pub(super) opacity_texture: Option<TextureLine>,
    /// Whether `opacity` comes from `d`, which counts where there are both.
    dissolve: bool,
    /// `Ke`, linear.
    pub(super) emission: Option<[f64; 3]>,
    /// `map_Ke`.
    pub(super) emission_texture: Option<TextureLine>,
    /// Keywords that change the look and are not modelled, with the byte offset of their line.
    pub(super) not_modelled: Vec<(String, usize)>,
}

/// Keywords that change nothing luxel shows: ambient colour, exponents of absent highlights, indices of refraction of
/// opaque materials.
const WITHOUT_EFFECT: [&str; 10] = [
    "Ka",
    "Ns",
    "Ni",
    "map_Ka",
    "map_Ns",
    "sharpness",
    "map_aat",
    "Km",
    "aniso",
    "anisor",
];

/// Highest illumination model that has neither reflection nor transparency.
const LAST_PLAIN_MODEL: f64 = 2.0;

/// Reads the materials of an MTL file, in file order.
///
/// # Errors
/// Values that cannot be read or are impossible, all at once, each with its line.
pub(super) fn read(source: &str) -> Result<Vec<Definition>, Vec<Diagnostic>> {
    let mut definitions: Vec<Definition> = Vec::new();
    let mut errors = Vec::new();
    for line in Lines::of(source) {
        if line.keyword == "newmtl" {
            definitions.push(Definition::new(&line));
        } else if let Some(definition) = definitions.last_mut()
            && let Err(says) = definition.line(&line)
        {
            let error = Diagnostic::error(codes::BAD_MATERIAL, says);
            errors.push(at_line(error, source, line.at));
        }
    }
    if errors.is_empty() {
        Ok(definitions)
    } else {
        errors.truncate(super::scan::MAX_ERRORS);
        Err(errors)
    }
}

impl Definition {
    fn new(line: &Line<'_>) -> Definition {
        Definition {
            name: line.rest.trim_end().to_owned(),
            at: line.at,
            color: None,
            texture: None,
            opacity: None,
            opacity_texture: None,
            dissolve: false,
            emission: None,
            emission_texture: None,
            not_modelled: Vec::new(),
        }
    }

    fn line(&mut self, line: &Line<'_>) -> Result<(), String> {
        match line.keyword {
            "Kd" => self.color = Some(color(line)?),
            "Ke" => self.emission = Some(color(line)?),
            "map_Kd" => self.texture = self.texture(line).or(self.texture.take()),
            "map_Ke" => self.emission_texture = self.texture(line).or(self.emission_texture.take()),
            "map_d" => self.opacity_texture = self.texture(line).or(self.opacity_texture.take()),
            "d" => {
                self.opacity = Some((self.opacity(line)?, line.at));
                self.dissolve = true;
            }
            "Tr" if !self.dissolve => self.opacity = Some((1.0 - self.opacity(line)?, line.at)),
            "Tr" => {}
            keyword if WITHOUT_EFFECT.contains(&keyword) => {}
            keyword if changes_the_look(keyword, line.values()) => {
                self.not_modelled.push((keyword.to_owned(), line.at));
            }
            _ => {}
        }
        Ok(())
    }

    /// A texture line, if it names a file.
    fn texture(&mut self, line: &Line<'_>) -> Option<TextureLine> {
        let (texture, ignored) = TextureLine::read(&line.rest, line.at);
        let keyword = line.keyword;
        let ignored = ignored
            .into_iter()
            .map(|option| (format!("{keyword} {option}"), line.at));
        self.not_modelled.extend(ignored);
        (!texture.path.is_empty()).then_some(texture)
    }

    /// `d x` or `Tr x`, at most 1. `d -halo x`, opacity by the angle of sight, is not modelled.
    fn opacity(&mut self, line: &Line<'_>) -> Result<f64, String> {
        let keyword = line.keyword;
        let mut words = line.values().split_ascii_whitespace();
        let word = words.next().unwrap_or_default();
        if word == "-halo" {
            self.not_modelled
                .push((format!("{keyword} -halo"), line.at));
            return Ok(1.0);
        }
        let number: f64 = word
            .parse()
            .map_err(|_| format!("`{keyword}` needs a number, not `{word}`"))?;
        if !(number.is_finite() && number >= 0.0) {
            return Err(format!("`{keyword}` cannot be {word}"));
        }
        Ok(number.min(1.0))
    }
}

/// `Kd r g b`, or `Kd r` for grey.
fn color(line: &Line<'_>) -> Result<[f64; 3], String> {
    let keyword = line.keyword;
    let words: Vec<&str> = line.values().split_ascii_whitespace().collect();
    if let Some(space @ ("spectral" | "xyz")) = words.first().copied() {
        return Err(format!(
            "`{keyword} {space}` is not supported: give linear red, green and blue"
        ));
    }
    let mut numbers = Vec::with_capacity(3);
    for word in &words {
        let number: f64 = word
            .parse()
            .map_err(|_| format!("`{word}` is not a number"))?;
        if !(number.is_finite() && number >= 0.0) {
            return Err(format!("`{keyword}` cannot be {word}"));
        }
        numbers.push(number);
    }
    match numbers[..] {
        [grey] => Ok([grey; 3]),
        [r, g, b, ..] => Ok([r, g, b]),
        _ => Err(format!(
            "`{keyword}` needs one or three numbers, not {}",
            numbers.len()
        )),
    }
}

/// Whether a property that is not read differs from what an opaque, matt surface has.
fn changes_the_look(keyword: &str, values: &str) -> bool {
    let numbers: Vec<f64> = values
        .split_ascii_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    let all = |neutral: f64| !numbers.is_empty() && numbers.iter().all(|&x| x == neutral);
    match keyword {
        "Tf" => !all(1.0),
        "illum" => numbers
            .first()
            .is_some_and(|&model| model > LAST_PLAIN_MODEL),
        "Ks" | "Kt" | "Pm" | "Ps" | "Pc" | "Pcr" => !all(0.0),
        _ => true,
    }
}
