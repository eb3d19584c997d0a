//! Small files that claim or unpack to much: refused at once, or read without what they would unpack to.
//!
//! One test, since the allocator counts for the whole process.

#[path = "mutate/memory.rs"]
mod memory;

use luxel::asset::{Limits, Loader};
use std::time::{Duration, Instant};

/// What opening an image may take besides its own bytes, a few times over.
const MAX_MEMORY: usize = 32 << 20;
/// A busy machine takes its time; decoding the largest of these would take minutes.
const MAX_TIME: Duration = Duration::from_secs(2);

/// Bytes that the packed ones unpack to.
const UNPACKED: usize = 64 << 20;

#[test]
fn bombs_do_not_go_off() {
    let packed = zeros(UNPACKED);
    assert_eq!(
        miniz_oxide::inflate::decompress_to_vec_zlib(&zeros(1000)).ok(),
        Some(vec![0; 1000])
    );
    let texel = zeros(4);
    let profile = [b"p\0\0", &packed[..]].concat();
    let megabyte = vec![0; 1 << 20];
    for (name, bytes, refused) in [
        (
            "huge.png",
            png((30_000, 30_000), &[(b"IDAT", &megabyte)]),
            Some("E111"),
        ),
        ("huge.jpg", jpeg(65_500, 65_500), Some("E111")),
        (
            "wide.png",
            png((i32::MAX as u32, 1), &[(b"IDAT", &megabyte)]),
            Some("E111"),
        ),
        (
            "profile.png",
            png((1, 1), &[(b"iCCP", &profile), (b"IDAT", &texel)]),
            None,
        ),
        (
            "text.png",
            png((1, 1), &[(b"zTXt", &profile), (b"IDAT", &texel)]),
            None,
        ),
        ("pixels.png", png((1, 1), &[(b"IDAT", &packed)]), None),
    ] {
        let path = std::env::temp_dir().join(format!("luxel-bomb-{}-{name}", std::process::id()));
        std::fs::write(&path, bytes).expect("a file");
        let start = Instant::now();
        let (loaded, peak) = memory::peak(|| {
            let mut loader = Loader::with_limits(Limits::DEFAULT);
            loader.texture(&path)
        });
        let time = start.elapsed();
        std::fs::remove_file(&path).expect("gone");
        println!("{name}: {time:?}, {peak} bytes, {loaded:?}");
        assert_eq!(loaded.err().map(|error| error.code), refused, "{name}");
        assert!(peak < MAX_MEMORY, "{name} took {peak} bytes");
        assert!(time < MAX_TIME, "{name} took {time:?}");
    }
}

/// A PNG image of 8-bit RGB with these chunks (PNG third edition, section 5).
fn png((width, height): (u32, u32), chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let size = [width.to_be_bytes(), height.to_be_bytes()].concat();
    let header = [&size[..], &[8, 2, 0, 0, 0]].concat();
    let ends = [(b"IHDR", &header[..]), (b"IEND", &[])];
    for (kind, content) in [&ends[..1], chunks, &ends[1..]].concat() {
        file.extend((content.len() as u32).to_be_bytes());
        let start = file.len();
        file.extend(kind);
        file.extend(content);
        file.extend(crc(&file[start..]).to_be_bytes());
    }
    file
}

/// The headers of a JPEG image (ITU-T T.81, annex B), and nothing behind them.
fn jpeg(width: u16, height: u16) -> Vec<u8> {
    let [[w0, w1], [h0, h1]] = [width, height].map(u16::to_be_bytes);
    let mut file = b"\xFF\xD8\xFF\xDB\0\x43\0".to_vec();
    file.extend([1; 64]);
    file.extend([0xFF, 0xC0, 0, 17, 8, h0, h1, w0, w1, 3]);
    file.extend([1, 0x11, 0, 2, 0x11, 0, 3, 0x11, 0]);
    file.extend([0xFF, 0xDA, 0, 12, 3, 1, 0, 2, 0, 3, 0, 0, 63, 0]);
    file.extend([0; 64]);
    file
}

/// A zlib stream of at least this many zeros: one, and matches of 258 bytes at distance 1, which fixed codes write in 13
/// bits (RFC 1951, section 3.2.6).
fn zeros(count: usize) -> Vec<u8> {
    let mut bits = Bits::default();
    bits.put(0b011, 3);
    // The literal 0: 00110000, most significant bit first, as all codes are.
    bits.put(0b0000_1100, 8);
    for _ in 0..(count - 1) / 258 {
        // Code 285, 11000101, and distance code 0, 00000.
        bits.put(0b1010_0011, 13);
    }
    for _ in 0..(count - 1) % 258 {
        bits.put(0b0000_1100, 8);
    }
    // End of the block.
    bits.put(0, 7);
    bits.put(0, 7);
    let adler = ((count % 65_521) as u32) << 16 | 1;
    [&[0x78, 0x01][..], &bits.bytes, &adler.to_be_bytes()].concat()
}

#[derive(Default)]
struct Bits {
    bytes: Vec<u8>,
    word: u32,
    count: u32,
}

impl Bits {
    fn put(&mut self, bits: u32, count: u32) {
        self.word |= bits << self.count;
        self.count += count;
        while self.count >= 8 {
            self.bytes.push(self.word as u8);
            self.word >>= 8;
            self.count -= 8;
        }
    }
}

/// The checksum of a chunk (PNG third edition, annex D).
fn crc(bytes: &[u8]) -> u32 {
    let mut table = [0u32; 256];
    for (i, entry) in table.iter_mut().enumerate() {
        *entry = (0..8).fold(i as u32, |c, _| (c >> 1) ^ (0xEDB8_8320 * (c & 1)));
    }
    let step = |c: u32, byte: &u8| table[((c ^ u32::from(*byte)) & 0xFF) as usize] ^ (c >> 8);
    !bytes.iter().fold(u32::MAX, step)
}
