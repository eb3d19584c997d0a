//! Images as textures.

use super::super::*;
use super::{Folder, png};

#[test]
fn images_become_eight_bit_rgb() {
    use png::{BitDepth::*, ColorType::*};
    for (bytes, texels) in [
        (
            png(Rgb, Eight, 2, &[1, 2, 3, 4, 5, 6]),
            vec![1, 2, 3, 4, 5, 6],
        ),
        (png(Rgba, Eight, 1, &[9, 8, 7, 0]), vec![9, 8, 7]),
        (
            png(Grayscale, Eight, 2, &[7, 200]),
            vec![7, 7, 7, 200, 200, 200],
        ),
        (
            png(Grayscale, Sixteen, 3, &[0, 128, 0, 129, 255, 255]),
            vec![0, 0, 0, 1, 1, 1, 255, 255, 255],
        ),
    ] {
        let folder = Folder::of(&[("t.jpg", &bytes)]);
        let mut loader = Loader::new();
        let id = loader.texture(&folder.0.join("t.jpg")).expect("a texture");
        let store = loader.finish();
        let texture = store.texture(id);
        assert_eq!(
            (texture.width as usize, texture.height),
            (texels.len() / 3, 1)
        );
        assert_eq!(texture.texels[..], texels[..]);
        let alpha = texture.alpha.as_deref();
        assert_eq!(alpha, (texels == [9, 8, 7]).then_some(&[0][..]));
    }
}

#[test]
fn alpha_is_kept_where_it_says_something() {
    use png::{BitDepth::*, ColorType::*};
    let alpha = |bytes: &[u8]| {
        let folder = Folder::of(&[("t.png", bytes)]);
        let mut loader = Loader::new();
        let id = loader.texture(&folder.0.join("t.png")).expect("a texture");
        loader
            .finish()
            .texture(id)
            .alpha
            .as_deref()
            .map(<[u8]>::to_vec)
    };
    let two = |alpha| png(Rgba, Eight, 2, &[1, 2, 3, 255, 4, 5, 6, alpha]);
    assert_eq!(alpha(&two(7)), Some(vec![255, 7]));
    assert_eq!(alpha(&two(255)), None);
    assert_eq!(
        alpha(&png(GrayscaleAlpha, Eight, 1, &[1, 9])),
        Some(vec![9])
    );
    let wide = [0, 0, 0, 0, 0, 0, 128, 0];
    assert_eq!(alpha(&png(Rgba, Sixteen, 1, &wide)), Some(vec![128]));
    assert_eq!(alpha(&png(Rgb, Eight, 1, &[1, 2, 3])), None);
}

#[test]
fn images_that_cannot_be_used_say_why() {
    let good = png(png::ColorType::Rgb, png::BitDepth::Eight, 1, &[1, 2, 3]);
    let mut huge = good.clone();
    huge[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let crc = crc32(&huge[12..29]);
    huge[29..33].copy_from_slice(&crc.to_be_bytes());
    for (bytes, code) in [
        (&good[..good.len() - 20], "E108"),
        (&good[..20], "E108"),
        (&huge[..], "E111"),
        (b"#?RADIANCE\n", "E107"),
        (b"GIF89a", "E107"),
        (b"", "E107"),
    ] {
        let folder = Folder::of(&[("t.png", bytes)]);
        let error = Loader::new()
            .texture(&folder.0.join("t.png"))
            .expect_err("an error");
        assert_eq!(error.code, code, "{error}");
        assert!(error.file.is_some_and(|file| file.ends_with("t.png")));
    }
}

/// The checksum of PNG chunks (ISO 3309), bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| {
            if c & 1 == 1 {
                (c >> 1) ^ 0xEDB8_8320
            } else {
                c >> 1
            }
        })
    })
}

#[test]
fn images_read_ahead_are_those_read_one_by_one() {
    use png::{BitDepth::Eight, ColorType::Rgb};
    let mut files: Vec<(String, Vec<u8>)> = (0..20)
        .map(|i| (format!("{i}.png"), png(Rgb, Eight, 1, &[i, 2, 3])))
        .collect();
    // One that is damaged, among the others; one that is missing; one that is named twice.
    let whole = files[5].1.len();
    files[5].1.truncate(whole - 24);
    let refer: Vec<(&str, &[u8])> = files.iter().map(|(n, b)| (n.as_str(), &b[..])).collect();
    let folder = Folder::of(&refer);
    let names = files.iter().map(|(name, _)| name.as_str());
    let paths: Vec<PathBuf> = ["3.png"]
        .into_iter()
        .chain(names)
        .chain(["missing.png"])
        .map(|name| folder.0.join(name))
        .collect();
    let read = |ahead: bool| {
        let mut loader = Loader::new();
        if ahead {
            loader.textures_ahead(paths.clone());
        }
        let ids: Vec<_> = paths.iter().map(|path| loader.texture(path)).collect();
        let store = loader.finish();
        let firsts: Vec<u8> = store.textures.iter().map(|t| t.texels[0]).collect();
        (ids, firsts, store.hash(), store.memory())
    };
    let (ids, firsts, hash, memory) = read(false);
    assert_eq!(
        (ids[1].clone(), ids[0].clone()),
        (Ok(TextureId(1)), Ok(TextureId(0)))
    );
    let refused = ids.iter().filter_map(|id| id.as_ref().err());
    let refused: Vec<_> = refused.map(|error| error.code).collect();
    assert_eq!(refused, [codes::IMAGE_CORRUPT, codes::UNREADABLE]);
    // The damaged one takes nothing.
    assert_eq!((firsts.len(), memory), (19, 19 * 3));
    assert_eq!(read(true), (ids, firsts, hash, memory));
}
