//! A lattice of crossed slats: one square of it, whose holes are in the texture's alpha.

/// Texels of `lattice.png`, which tiles in both directions.
pub(crate) const LATTICE_SIZE: [usize; 2] = [64, 64];
/// Width of a slat in texels, measured along a row.
const SLAT: i32 = 17;
/// Texels from a slat's edge to its full colour.
const ROUND: i32 = 5;

/// Two by one, one square of the texture to every eighth: the slats run diagonally.
pub(crate) const LATTICE: &str = "\
# A screen two units wide and one tall, standing on the ground.
mtllib lattice.mtl
o lattice
usemtl slats
v -1 0 0
v 1 0 0
v 1 1 0
v -1 1 0
vt 0 0
vt 8 0
vt 8 4
vt 0 4
f 1/1 2/2 3/3 4/4
";

/// Of [`LATTICE`].
pub(crate) const LATTICE_MTL: &str = "\
# Painted slats; where the image is transparent there is nothing.
newmtl slats
Kd 1 1 1
map_Kd lattice.png
map_d lattice.png
";

/// R, G, B and alpha: slats that rise to the right over slats that fall.
pub(crate) fn lattice() -> Vec<u8> {
    let [width, height] = LATTICE_SIZE.map(|n| n as i32);
    let mut texels = Vec::with_capacity((4 * width * height) as usize);
    for y in 0..height {
        for x in 0..width {
            let (rising, falling) = ((x + y).rem_euclid(width), (x - y).rem_euclid(width));
            let (a, b) = (depth(rising), depth(falling));
            // The rising slats lie on top.
            let (slat, across) = match (a, b) {
                (Some(a), _) => (a, rising),
                (None, Some(b)) => (b - 2, falling + width),
                (None, None) => (0, 0),
            };
            let hole = a.is_none() && b.is_none();
            // Lighter towards the middle of a slat, with a grain along it.
            let light = 9 * slat.min(ROUND) + grain(across);
            let colour = [150, 118, 84].map(|c| (c + light) as u8);
            texels.extend(colour);
            texels.push(if hole { 0 } else { 255 });
        }
    }
    texels
}

/// Texels from the edge of the slat that holds this offset, if one does.
fn depth(offset: i32) -> Option<i32> {
    (offset < SLAT).then(|| offset.min(SLAT - 1 - offset))
}

/// 0 to 11, by a hash of two rounds.
fn grain(x: i32) -> i32 {
    let mut h = x as u32;
    h = (h ^ (h >> 7)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    (h >> 24) as i32 % 12
}
