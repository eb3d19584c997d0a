//! All numbers of a run, a row for every setting and number of samples.

use super::super::{Report, accel_name, fresnel_name, sampler_name, tree_name};
use super::name;
use std::fmt::Write;

/// The columns. Squares and errors are relative; times are CPU seconds of the small pictures, but for the last.
const HEADER: &str = "setting,bounces,nee,mis,sampler,roulette,fresnel,accel,tree,biased,dropped,width,height,spp,seeds,\
seconds_least,seconds_median,build_seconds,squared_error,squared_error_pm,variance,variance_pm,squared_bias,\
squared_bias_pm,brightness,brightness_pm,full_rmse,full_seconds";

/// Comma-separated values with a header; `pm` is half of a 95 % interval.
#[must_use]
pub fn csv(report: &Report) -> String {
    let mut text = format!("{HEADER}\n");
    let (width, height) = report.size;
    for row in &report.rows {
        let d = &row.dials;
        for level in &row.levels {
            let [least, median] = level.seconds;
            let x = &level.differences;
            // Writing to a string does not fail.
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{},{},{},{},{width},{height},{},{},{least:.6},{median:.6},{:.6},{:e},{:e},{:e},{:e},{:e},{:e},{:e},{:e},{:e},{:.6}",
                name(report, row),
                d.bounces,
                d.nee,
                d.mis,
                sampler_name(d.sampler),
                d.roulette,
                fresnel_name(d.fresnel),
                accel_name(d.accel),
                tree_name(d.quality),
                row.biases > 0,
                row.dropped,
                level.spp,
                level.seeds,
                row.build,
                x.squared.value,
                x.squared.half_width,
                x.variance.value,
                x.variance.half_width,
                x.bias_squared.value,
                x.bias_squared.half_width,
                x.brightness.value,
                x.brightness.half_width,
                report.error(row, level, None).value,
                report.seconds(row, level.spp, None),
            );
        }
    }
    text
}
