//! Pictures in turn as YUV4MPEG2, which every encoder reads: a line for the film, a line and three planes a frame.
//!
//! Y′CbCr of ITU-R BT.709 in the narrow range, 8 bits, chroma at every pixel: what is lost is lost by the encoder.

use std::io::{self, Write};

/// Weights of red and blue in luma (BT.709-6, item 3.2).
const KR: f64 = 0.2126;
const KB: f64 = 0.0722;

/// Codes of luma and of chroma in the narrow range (BT.709-6, item 4.6), and where they begin or centre.
const LUMA: (f64, f64) = (219.0, 16.0);
const CHROMA: (f64, f64) = (224.0, 128.0);

/// Denominators of frame rates: whole and half ones, those of NTSC, then anything to a thousandth.
const DENOMINATORS: [u64; 4] = [1, 2, 1001, 1000];

/// A rate is told as a fraction that is off by at most this part.
const RATE_TOLERANCE: f64 = 1e-5;

/// Writes the line that begins a film.
///
/// # Errors
/// Those of `to`.
pub fn write_y4m_header(to: &mut impl Write, size: (u32, u32), fps: f64) -> io::Result<()> {
    let (numerator, denominator) = rate(fps);
    writeln!(
        to,
        "YUV4MPEG2 W{} H{} F{numerator}:{denominator} Ip A1:1 C444 XCOLORRANGE=LIMITED",
        size.0, size.1
    )
}

/// Writes a frame of three sRGB bytes per pixel, row by row from the top.
///
/// # Errors
/// Those of `to`.
pub fn write_y4m_frame(to: &mut impl Write, rgb: &[u8]) -> io::Result<()> {
    let pixels = rgb.len() / 3;
    let mut planes = vec![0; 3 * pixels];
    for (i, pixel) in rgb.chunks_exact(3).enumerate() {
        let codes = codes([pixel[0], pixel[1], pixel[2]]);
        for (plane, code) in codes.into_iter().enumerate() {
            planes[plane * pixels + i] = code;
        }
    }
    to.write_all(b"FRAME\n")?;
    to.write_all(&planes)
}

/// Y′, Cb and Cr of an sRGB colour (BT.709-6, items 3.2, 3.3 and 4.6), rounded half up.
fn codes(rgb: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = rgb.map(|code| f64::from(code) / 255.0);
    let y = KR * r + (1.0 - KR - KB) * g + KB * b;
    let code = |(scale, offset): (f64, f64), x: f64| (scale * x + offset + 0.5) as u8;
    [
        code(LUMA, y),
        code(CHROMA, (b - y) / (2.0 * (1.0 - KB))),
        code(CHROMA, (r - y) / (2.0 * (1.0 - KR))),
    ]
}

/// A frame rate as a fraction.
fn rate(fps: f64) -> (u64, u64) {
    let near = |d: u64| {
        let n = (fps * d as f64).round().max(1.0);
        ((n / d as f64 - fps).abs() <= RATE_TOLERANCE * fps).then_some((n as u64, d))
    };
    let [.., last] = DENOMINATORS;
    let rough = ((fps * last as f64).round().max(1.0) as u64, last);
    DENOMINATORS.into_iter().find_map(near).unwrap_or(rough)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_the_usual_fractions() {
        for (fps, wanted) in [
            (24.0, (24, 1)),
            (12.5, (25, 2)),
            (29.97, (30000, 1001)),
            (23.976, (24000, 1001)),
            (59.94, (60000, 1001)),
            (18.75, (18750, 1000)),
            (0.001, (1, 1000)),
        ] {
            assert_eq!(rate(fps), wanted, "{fps}");
        }
    }

    #[test]
    fn colours_are_those_of_the_recommendation() {
        // BT.709 colour bars of 100 %, as in SMPTE RP 219: white, yellow, cyan, green, magenta, red, blue, black.
        for (rgb, wanted) in [
            ([255, 255, 255], [235, 128, 128]),
            ([255, 255, 0], [219, 16, 138]),
            ([0, 255, 255], [188, 154, 16]),
            ([0, 255, 0], [173, 42, 26]),
            ([255, 0, 255], [78, 214, 230]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 0, 255], [32, 240, 118]),
            ([0, 0, 0], [16, 128, 128]),
        ] {
            assert_eq!(codes(rgb), wanted, "{rgb:?}");
        }
    }

    #[test]
    fn a_film_is_lines_and_planes() {
        let mut film = Vec::new();
        write_y4m_header(&mut film, (2, 1), 24.0).expect("memory");
        write_y4m_frame(&mut film, &[0, 0, 0, 255, 255, 255]).expect("memory");
        let mut wanted =
            b"YUV4MPEG2 W2 H1 F24:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\nFRAME\n".to_vec();
        wanted.extend([16, 235, 128, 128, 128, 128]);
        assert_eq!(film, wanted);
    }
}
