//! Means of FLIP on small synthetic pairs, against those that the authors' evaluator (version 1.7) gives for them.

use super::super::{Image, Pair, Selection};
use super::*;
use crate::math::SRGB_BYTES;

const WIDTH: i32 = 37;
const HEIGHT: i32 = 23;

/// A picture of sRGB codes by column, row and channel.
fn picture(code: impl Fn(i32, i32, i32) -> i32) -> Image {
    let light = |x, y, c| SRGB_BYTES[code(x, y, c).clamp(0, 255) as usize];
    let pixels = (0..WIDTH * HEIGHT)
        .map(|i| [0, 1, 2].map(|c| light(i % WIDTH, i / WIDTH, c)))
        .collect();
    Image::new(WIDTH as usize, pixels).expect("whole")
}

fn noise(seed: i32) -> impl Fn(i32, i32, i32) -> i32 {
    move |x, y, c| (x * x * 37 + y * y * 71 + x * y * 13 + c * 101 + seed * 57) % 256
}

fn edge(at: i32) -> impl Fn(i32, i32, i32) -> i32 {
    move |x, _, c| if x < at { 30 + 40 * c } else { 200 - 30 * c }
}

fn mean(image: &Image, reference: &Image, pixels_per_degree: f64) -> f64 {
    let pair = Pair::new(image, reference, Selection::All).expect("comparable");
    let map = map(&pair, pixels_per_degree);
    assert!(map.iter().all(|v| (0.0..=1.0 + 1e-6).contains(v)));
    pair.mean(&map)
}

#[test]
fn means_are_the_authors() {
    let colours = |x: i32, y: i32, c: i32| (x * 7 + y * c * 5) % 256;
    let speckle = noise(3);
    let noisy = |x, y, c| colours(x, y, c) + speckle(x, y, c) % 21 - 10;
    let dot = |x, y, _| if (x, y) == (18, 11) { 255 } else { 90 };
    let only = |channel| move |_, _, c| if c == channel { 255 } else { 0 };
    // Reference, image, mean at the default distance, mean at 30 pixels per degree.
    let cases = [
        (
            "noise",
            picture(noise(0)),
            picture(noise(1)),
            0.480_549_6,
            0.764_238_5,
        ),
        (
            "ramps",
            picture(|x, _, _| x * 255 / (WIDTH - 1)),
            picture(|x, _, _| x * 230 / (WIDTH - 1)),
            0.218_958_0,
            0.200_423_3,
        ),
        (
            "edges",
            picture(edge(18)),
            picture(edge(20)),
            0.126_970_2,
            0.097_650_8,
        ),
        (
            "a dot",
            picture(dot),
            picture(|_, _, _| 90),
            0.007_204_7,
            0.003_828_3,
        ),
        (
            "green and blue",
            picture(only(1)),
            picture(only(2)),
            1.0,
            1.0,
        ),
        (
            "colours",
            picture(colours),
            picture(noisy),
            0.061_167_4,
            0.121_934_3,
        ),
    ];
    for (name, reference, image, default, near) in &cases {
        let got = mean(image, reference, PIXELS_PER_DEGREE);
        assert!((got - default).abs() < 1e-4, "{name}: {got}, not {default}");
        let got = mean(image, reference, 30.0);
        assert!((got - near).abs() < 1e-4, "{name}: {got}, not {near}");
    }
}

#[test]
fn equal_pictures_have_no_difference_anywhere() {
    let image = picture(noise(0));
    let pair = Pair::new(&image, &image, Selection::All).expect("comparable");
    assert!(map(&pair, PIXELS_PER_DEGREE).iter().all(|&v| v == 0.0));
}

#[test]
fn light_beyond_the_screen_is_not_seen() {
    let of = |bright| Image::new(3, vec![[0.5; 3], [bright; 3], [0.1; 3]]).expect("whole");
    assert_eq!(mean(&of(1.0), &of(50.0), PIXELS_PER_DEGREE), 0.0);
}
