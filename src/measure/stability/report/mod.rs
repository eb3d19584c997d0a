//! Reports: a table and a verdict for people, a chart, and CSV.

mod chart;
mod table;

pub use chart::svg;
pub use table::{csv, table, verdict};

/// `1e-6`, `2^20`, `1`: a number as it was asked for.
fn power(x: f64) -> String {
    let exponent = (x.to_bits() >> 52) as i32 - 1023;
    if x > 0.0 && x.to_bits() << 12 == 0 && exponent != 0 {
        return format!("2^{exponent}");
    }
    match x {
        0.0 => "0".to_owned(),
        _ if (0.1..1000.0).contains(&x) => x.to_string(),
        _ => format!("{x:e}"),
    }
}

/// To three digits; 0 as 0.
fn short(x: f64) -> String {
    match x {
        0.0 => "0".to_owned(),
        _ => format!("{x:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_told_as_they_were_asked_for() {
        let of = [0.0, 1.0, 1e-6, 0.1, 10.0, 1e7, 1048576.0, 1.0 / 1024.0].map(power);
        assert_eq!(of, ["0", "1", "1e-6", "0.1", "10", "1e7", "2^20", "2^-10"]);
    }
}
