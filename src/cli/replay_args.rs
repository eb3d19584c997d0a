//! The argument that names one sample.

use crate::scene::RenderDesc;
use clap::Args;

/// One sample of a render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SampleName {
    pub(crate) frame: u32,
    pub(crate) pixel: (u32, u32),
    pub(crate) sample: u32,
}

/// `--replay`, in place of an image.
#[derive(Clone, Debug, Args)]
pub(crate) struct ReplayArgs {
    /// Print the path of one sample, vertex by vertex, in place of rendering; other options as for the image it belongs to
    #[arg(long, value_name = "FRAME,X,Y,SAMPLE", value_parser = parse, conflicts_with_all = ["output", "stats", "time", "noise", "vs", "aov"])]
    pub(crate) replay: Option<SampleName>,
}

fn parse(text: &str) -> Result<SampleName, String> {
    let numbers: Vec<Option<u32>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    let &[Some(frame), Some(x), Some(y), Some(sample)] = numbers.as_slice() else {
        return Err(
            "write four whole numbers: frame, column, row, sample, e.g. 0,12,7,3".to_owned(),
        );
    };
    if sample >= RenderDesc::MAX_SPP {
        return Err(format!(
            "samples count from 0 to {}",
            RenderDesc::MAX_SPP - 1
        ));
    }
    Ok(SampleName {
        frame,
        pixel: (x, y),
        sample,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_have_four_numbers() {
        let named = parse("2, 12,7,3").expect("four numbers");
        assert_eq!((named.frame, named.pixel, named.sample), (2, (12, 7), 3));
        for bad in [
            "",
            "1,2,3",
            "1,2,3,4,5",
            "1,2,3,-4",
            "1,2,3,x",
            "0,0,0,16777216",
        ] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
