//! When `luxel render` stops, and what it is measured against meanwhile.

use clap::Args;
use std::path::PathBuf;

/// Part of `luxel render`.
#[derive(Clone, Debug, Args)]
pub(crate) struct GoalArgs {
    /// Stop at this relative error of the image: 1% or 0.01. A short pilot, which is not in the image, finds how many samples that
    /// takes
    #[arg(long, value_name = "ERROR", value_parser = parse_noise)]
    pub(crate) noise: Option<f64>,
    /// Write how the error against this image falls, pass by pass, as NAME.error.csv and NAME.error.svg
    #[arg(long, value_name = "REFERENCE")]
    pub(crate) vs: Option<PathBuf>,
}

/// `1%` or `0.01`.
pub(super) fn parse_noise(text: &str) -> Result<f64, String> {
    let value = match text.trim().strip_suffix('%') {
        Some(percent) => percent.trim().parse::<f64>().map(|p| p / 100.0),
        None => text.trim().parse::<f64>(),
    };
    // Below, rounding of f32 is no longer small beside it.
    match value {
        Ok(noise) if (1e-5..=1.0).contains(&noise) => Ok(noise),
        _ => Err("write a share of the image's light from 0.001% to 100%: 1% or 0.01".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_and_shares_are_the_same() {
        assert_eq!(parse_noise("1%"), Ok(0.01));
        assert_eq!(parse_noise("0.01"), Ok(0.01));
        assert_eq!(parse_noise("2.5 %"), Ok(0.025));
        for bad in ["", "%", "0", "-1%", "101%", "nan", "inf", "1e-9", "1 2"] {
            assert!(parse_noise(bad).is_err(), "{bad}");
        }
    }
}
