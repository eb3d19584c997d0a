//! `luxel compare`.

use super::args::{CompareArgs, MaskArg, MetricArg};
use super::failure::Failure;
use super::output::check_writable;
use super::print_result;
use crate::film;
use crate::measure::{
    self, Errors, Image, Pair, PairError, ReadError, Selection, flip, heat, relative_squared,
};
use serde_json::json;
use std::ffi::OsStr;
use std::fmt::Write;
use std::path::Path;

const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// Measures, prints, draws, and judges by `--max`.
pub(crate) fn run(args: &CompareArgs) -> Result<(), Failure> {
    check_arguments(args)?;
    let image = read(&args.image)?;
    let reference = read(&args.reference)?;
    let pair = Pair::new(&image, &reference, selection(args)).map_err(|e| refused(&e))?;
    let flip_map = flip::map(&pair, ppd(args));
    let measured = Measured {
        errors: measure::errors(&pair),
        flip: pair.mean(&flip_map),
    };
    if let Some(path) = &args.heatmap {
        draw(path, &pair, args.metric, flip_map)?;
    }
    let report = if args.json {
        format!("{:#}\n", measured.json(args, &pair))
    } else {
        measured.table(args, &pair)
    };
    print_result(report.as_bytes())?;
    measured.judge(args)
}

/// What can be refused before anything is read.
fn check_arguments(args: &CompareArgs) -> Result<(), Failure> {
    if args.max.is_some() && args.metric == MetricArg::Psnr {
        return Err(Failure::usage(
            "--max cannot limit psnr, which is larger for better images",
            "limit the error instead: --metric rmse --max X, where X = 10^(-PSNR/20)",
        ));
    }
    let Some(path) = &args.heatmap else {
        return Ok(());
    };
    if path.extension() != Some(OsStr::new("png")) {
        return Err(Failure::usage(
            format!("\"{}\" is no PNG file", path.display()),
            "end the name of --heatmap in .png",
        ));
    }
    let same = |input: &Path| {
        let real = |path: &Path| std::fs::canonicalize(path).ok();
        real(path).is_some_and(|path| real(input) == Some(path))
    };
    if same(&args.image) || same(&args.reference) {
        return Err(Failure::usage(
            "--heatmap would overwrite an image that is compared",
            "give it another name",
        ));
    }
    check_writable(path)
}

pub(super) fn read(path: &Path) -> Result<Image, Failure> {
    Image::read(path).map_err(|e| match &e {
        ReadError::File { cause, .. } => Failure::no_input(path, cause),
        ReadError::Content { .. } => Failure::bad_file(e),
    })
}

fn selection(args: &CompareArgs) -> Selection {
    match args.mask {
        None => Selection::All,
        Some(MaskArg::Peers) => Selection::Peers,
    }
}

fn ppd(args: &CompareArgs) -> f64 {
    args.ppd.unwrap_or(flip::PIXELS_PER_DEGREE)
}

pub(super) fn refused(error: &PairError) -> Failure {
    match error {
        PairError::Sizes(..) => Failure::usage(error, "only images of one size can be compared"),
        PairError::NonFinite(..) => Failure::different(error),
        PairError::Nothing => Failure::usage(error, "compare without --mask"),
    }
}

fn draw(
    path: &Path,
    pair: &Pair<'_>,
    metric: MetricArg,
    flip_map: Vec<f32>,
) -> Result<(), Failure> {
    let map = match metric {
        MetricArg::Flip => flip_map,
        _ => relative_squared(pair).into_iter().map(f32::sqrt).collect(),
    };
    let io = |e: &dyn std::fmt::Display| Failure::io(format!("\"{}\"", path.display()), e);
    let bytes = heat::encode_png(pair, &map).map_err(|e| io(&e))?;
    film::write_file(path, &bytes).map_err(|e| io(&e))
}

/// The numbers.
struct Measured {
    errors: Errors,
    flip: f64,
}

impl Measured {
    fn table(&self, args: &CompareArgs, pair: &Pair<'_>) -> String {
        let e = &self.errors;
        let (width, height) = (pair.reference().width(), pair.reference().height());
        let mut rows = vec![
            ("image", args.image.display().to_string()),
            ("reference", args.reference.display().to_string()),
            (
                "size",
                format!("{width}×{height}, {} pixels compared", e.pixels),
            ),
            ("RMSE", number(e.rmse)),
            ("relMSE", number(e.relmse)),
            ("PSNR", format!("{:.2} dB", e.psnr)),
            ("FLIP", number(self.flip)),
        ];
        for (name, bias) in ["bias R", "bias G", "bias B"].into_iter().zip(&e.bias) {
            let share = match bias.relative.is_finite() {
                true => format!("  ({:+.3} %)", 100.0 * bias.relative),
                false => String::new(),
            };
            let (mean, half) = (signed(bias.mean), number(bias.half_width));
            rows.push((name, format!("{mean} ± {half}{share}")));
        }
        let (x, y) = e.maximum.at;
        let channel = CHANNELS[e.maximum.channel];
        let worst = number(e.maximum.value);
        rows.push((
            "maximum",
            format!("{worst} in {channel} at column {x}, row {y}"),
        ));
        let mut table = String::new();
        for (name, value) in rows {
            // Writing to a string does not fail.
            let _ = writeln!(table, "{name:>9}  {value}");
        }
        table
    }

    /// Values that are not finite, such as the PSNR of equal images, are null.
    fn json(&self, args: &CompareArgs, pair: &Pair<'_>) -> serde_json::Value {
        let e = &self.errors;
        let bias = e.bias.map(
            |b| json!({ "mean": b.mean, "half_width_95": b.half_width, "relative": b.relative }),
        );
        json!({
            "image": args.image.display().to_string(),
            "reference": args.reference.display().to_string(),
            "size": [pair.reference().width(), pair.reference().height()],
            "mask": args.mask.map(|MaskArg::Peers| "peers"),
            "pixels": e.pixels,
            "rmse": e.rmse,
            "relmse": e.relmse,
            "psnr": e.psnr,
            "flip": self.flip,
            "flip_pixels_per_degree": ppd(args),
            "bias": bias,
            "maximum": {
                "value": e.maximum.value,
                "channel": CHANNELS[e.maximum.channel],
                "at": [e.maximum.at.0, e.maximum.at.1],
            },
        })
    }

    fn judge(&self, args: &CompareArgs) -> Result<(), Failure> {
        let Some(max) = args.max else {
            return Ok(());
        };
        let (name, value) = match args.metric {
            MetricArg::Rmse => ("RMSE", self.errors.rmse),
            MetricArg::Relmse => ("relMSE", self.errors.relmse),
            MetricArg::Psnr => ("PSNR", self.errors.psnr),
            MetricArg::Flip => ("FLIP", self.flip),
        };
        if value <= max {
            return Ok(());
        }
        Err(Failure::different(format!("{name} {value} is above {max}")))
    }
}

/// Four significant digits at least; powers of ten only where zeros would hide the digits.
fn number(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        a if (1e-3..1e6).contains(&a) => format!("{x:.6}"),
        a if a.is_finite() => format!("{x:.4e}"),
        _ => format!("{x}"),
    }
}

fn signed(x: f64) -> String {
    let sign = if x > 0.0 { "+" } else { "" };
    format!("{sign}{}", number(x))
}
