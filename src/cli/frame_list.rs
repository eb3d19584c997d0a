//! Which frames: `0..48`, `0..=47`, `1,3..8`, `0..48:2`.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Most frames of one command: eleven hours at 24 a second.
const MAX_FRAMES: u64 = 1_000_000;

const REMEDY: &str =
    "write frames like 7, 0..48 (without 48), 0..=47, 0..48:2 (every second) or 1,3..8";

/// Frames in rising order, each once, at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FrameList(Vec<u32>);

impl FrameList {
    /// The frames of a range that is not empty.
    pub(crate) fn of_range(range: Range<u32>) -> FrameList {
        FrameList(range.collect())
    }

    /// Every `count`-th frame from the one at `index` on, so that each share has its part of what costs most; `None` if
    /// that is none.
    pub(crate) fn share(&self, index: u32, count: u32) -> Option<FrameList> {
        let own = self.iter().skip(index as usize).step_by(count as usize);
        let own: Vec<u32> = own.collect();
        (!own.is_empty()).then_some(FrameList(own))
    }

    /// How many.
    pub(crate) fn len(&self) -> u32 {
        self.0.len() as u32
    }

    /// In order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = u32> {
        self.0.iter().copied()
    }

    /// How many frames of the scene one of these stands for: 2 if every second is named, 1 if they have no rhythm.
    pub(crate) fn step(&self) -> u32 {
        let mut gaps = self.0.windows(2).map(|two| two[1] - two[0]);
        let first = gaps.next().unwrap_or(1);
        if gaps.all(|gap| gap == first) {
            first
        } else {
            1
        }
    }

    /// Runs of equal steps: first, last, step. Steps above 1 are told of three frames and more.
    fn runs(&self) -> Vec<[u32; 3]> {
        let mut runs: Vec<[u32; 3]> = Vec::new();
        for (i, &frame) in self.0.iter().enumerate() {
            let gap = |at: usize| Some(self.0.get(at + 1)? - self.0.get(at)?);
            match runs.last_mut() {
                Some([first, last, step]) if first != last && frame - *last == *step => {
                    *last = frame
                }
                Some([first, last, step])
                    if first == last && (frame - *last == 1 || gap(i) == Some(frame - *last)) =>
                {
                    (*step, *last) = (frame - *last, frame);
                }
                _ => runs.push([frame, frame, 1]),
            }
        }
        runs
    }
}

/// `48 frames: 0–47`, `4 frames: 1, 3–5`, `24 frames: 0–46 by 2`.
impl fmt::Display for FrameList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.0.len();
        write!(
            f,
            "{count} {}: ",
            if count == 1 { "frame" } else { "frames" }
        )?;
        for (i, [first, last, step]) in self.runs().into_iter().enumerate() {
            f.write_str(if i > 0 { ", " } else { "" })?;
            match (first == last, step) {
                (true, _) => write!(f, "{first}")?,
                (false, 1) => write!(f, "{first}–{last}")?,
                (false, step) => write!(f, "{first}–{last} by {step}")?,
            }
        }
        Ok(())
    }
}

impl FromStr for FrameList {
    type Err = String;

    fn from_str(text: &str) -> Result<FrameList, String> {
        let mut frames = Vec::new();
        for part in text.split(',') {
            let (range, step) = part_of(part.trim())?;
            let count = u64::from(range.end() - range.start()) / u64::from(step) + 1;
            if frames.len() as u64 + count > MAX_FRAMES {
                return Err(format!("more than {MAX_FRAMES} frames; name fewer"));
            }
            frames.extend(range.step_by(step as usize));
        }
        frames.sort_unstable();
        frames.dedup();
        Ok(FrameList(frames))
    }
}

/// `7`, `0..48`, `0..=47`, each with `:2` behind it; never empty.
fn part_of(text: &str) -> Result<(std::ops::RangeInclusive<u32>, u32), String> {
    let number = |text: &str| -> Result<u32, String> {
        let digits = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        digits
            .then(|| text.parse().ok())
            .flatten()
            .ok_or_else(|| format!("`{text}` is no frame number; {REMEDY}"))
    };
    let (range, step) = match text.split_once(':') {
        Some((range, step)) => (range, number(step)?),
        None => (text, 1),
    };
    if step == 0 {
        return Err("a step of 0 goes nowhere; write 1 or more behind the colon".to_owned());
    }
    let Some((first, end)) = range.split_once("..") else {
        let frame = number(range)?;
        return Ok((frame..=frame, step));
    };
    let first = number(first)?;
    let (end, included) = match end.strip_prefix('=') {
        Some(end) => (number(end)?, true),
        None => (number(end)?, false),
    };
    if end < first {
        return Err(format!("`{range}` runs backwards; {REMEDY}"));
    }
    if end == first && !included {
        return Err(format!(
            "`{range}` holds no frame, since its end is left out; {REMEDY}"
        ));
    }
    let last = if included { end } else { end - 1 };
    Ok((first..=last, step))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str) -> Vec<u32> {
        text.parse::<FrameList>().map(|list| list.0).expect(text)
    }

    #[test]
    fn what_is_written_is_meant() {
        assert_eq!(frames("7"), [7]);
        assert_eq!(frames("0..3"), [0, 1, 2]);
        assert_eq!(frames("0..=3"), [0, 1, 2, 3]);
        assert_eq!(frames("1,3..8"), [1, 3, 4, 5, 6, 7]);
        assert_eq!(frames("0..7:3"), [0, 3, 6]);
        assert_eq!(frames("0..=6:3, 6, 2"), [0, 2, 3, 6]);
        assert_eq!(frames("4294967295"), [u32::MAX]);
        assert_eq!(frames("4294967294..=4294967295"), [u32::MAX - 1, u32::MAX]);
    }

    #[test]
    fn mistakes_are_told() {
        let told = |text: &str| text.parse::<FrameList>().expect_err(text);
        for (text, word) in [
            ("", "no frame number"),
            ("a", "`a` is no frame number"),
            ("-1", "no frame number"),
            ("1.5", "no frame number"),
            ("1..", "no frame number"),
            ("..5", "no frame number"),
            ("1,,2", "no frame number"),
            ("+3", "no frame number"),
            ("4294967296", "no frame number"),
            ("0..0", "holds no frame"),
            ("5..5", "holds no frame"),
            ("48..0", "backwards"),
            ("48..1", "backwards"),
            ("8..=7", "backwards"),
            ("0..8:0", "step of 0"),
            ("0..8:x", "no frame number"),
            ("0..4000000000", "more than 1000000"),
        ] {
            let told = told(text);
            assert!(told.contains(word), "{text}: {told}");
        }
    }

    #[test]
    fn lists_read_well() {
        for (text, shown, step) in [
            ("0..48", "48 frames: 0–47", 1),
            ("7", "1 frame: 7", 1),
            ("1,3..8", "6 frames: 1, 3–7", 1),
            ("0..48:2", "24 frames: 0–46 by 2", 2),
            ("0,2", "2 frames: 0, 2", 2),
            ("0,5,6,7,20,30,40", "7 frames: 0, 5–7, 20–40 by 10", 1),
        ] {
            let list: FrameList = text.parse().expect(text);
            assert_eq!(list.to_string(), shown);
            assert_eq!(list.step(), step, "{text}");
        }
    }
}
