use super::super::{PartWriter, encode_patch};
use super::*;
use crate::film::Sums;
use std::fs;
use std::path::PathBuf;

const WINDOWS: [Window; 2] = [
    Window {
        x: 0,
        y: 0,
        width: 2,
        height: 1,
    },
    Window {
        x: 2,
        y: 0,
        width: 1,
        height: 1,
    },
];

/// A patch with everything that one may have: 12 samples, a block and half of one.
fn patch(window: Window) -> Patch {
    let pixels = (window.width * window.height) as usize;
    let triples = |value: f64| vec![[value, -value, 1.0 / 3.0]; pixels];
    let mut patch = Patch::new(window, 0, false);
    for end in [1, 2, 4, 8, 12] {
        patch.open = Sums {
            rgb: triples(f64::from(end)),
            rgb_squared: triples(1e300),
            albedo: triples(0.5),
            normal: triples(-0.0),
            geonormal: triples(1e-300),
            depth: vec![7.0; pixels],
        };
        patch.advance(end, &mut Sums::default());
    }
    patch.count = vec![11; pixels];
    patch.non_finite = vec![1; pixels];
    patch.uv = vec![[0.1, f32::MIN_POSITIVE]; pixels];
    patch.prim = vec![u32::MAX; pixels];
    patch.lost = vec![[0, 5]];
    patch
}

struct Part(PathBuf);

impl Part {
    fn new(name: &str) -> Part {
        let name = format!("luxel-part-{name}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let mut header = Metadata::default();
        header.push("seed", 7);
        let file = File::create(&path).expect("a temporary file");
        let mut part = PartWriter::begin(file, &header, 2).expect("room");
        let mut bytes = Vec::new();
        for window in WINDOWS {
            encode_patch(&patch(window), &mut bytes);
            part.patch(&bytes).expect("room");
        }
        part.finish().expect("room");
        Part(path)
    }

    fn change(&self, change: impl FnOnce(&mut Vec<u8>)) -> PartError {
        let mut bytes = fs::read(&self.0).expect("there");
        let whole = bytes.clone();
        change(&mut bytes);
        fs::write(&self.0, &bytes).expect("ours");
        let refused = PartFile::open(&self.0).expect_err("it is not whole");
        fs::write(&self.0, &whole).expect("ours");
        refused
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

#[test]
fn patches_come_back_bit_by_bit() {
    let part = Part::new("back");
    let mut file = PartFile::open(&part.0).expect("whole");
    assert_eq!(file.header.to_lines(), "seed: 7\n");
    let entries = file.entries.clone();
    assert_eq!(entries.len(), 2);
    for (entry, window) in entries.iter().zip(WINDOWS) {
        assert_eq!((entry.window, entry.first, entry.done), (window, 0, 12));
        assert_eq!(file.patch(entry).expect("whole"), patch(window));
    }
}

#[test]
fn cuts_and_flipped_bits_are_found() {
    let part = Part::new("cut");
    let length = fs::metadata(&part.0).expect("there").len() as usize;
    for cut in 0..length {
        let refused = part.change(|bytes| bytes.truncate(cut));
        let short = matches!(refused, PartError::Short) || cut == 0;
        assert!(short, "cut after {cut} of {length}: {refused}");
    }
    for bit in (0..8 * length).step_by(5) {
        part.change(|bytes| bytes[bit / 8] ^= 1 << (bit % 8));
    }
    let more = part.change(|bytes| bytes.push(0));
    assert!(matches!(more, PartError::Damaged), "{more}");
}

#[test]
fn other_files_and_formats_are_told() {
    let part = Part::new("other");
    let newer = part.change(|bytes| bytes[MAGIC.len() - 1] = b'2');
    assert!(newer.to_string().contains("`luxel part 2`"), "{newer}");
    let other = part.change(|bytes| *bytes = b"\x89PNG\r\n\x1a\n".to_vec());
    assert!(matches!(other, PartError::Other), "{other}");
    let missing = PartFile::open(Path::new("/no/such.part"));
    assert!(matches!(missing, Err(PartError::Io(_))));
}
