//! The small assets: a plinth authored as polygons, a cube with a seam at every edge, and a texture to test with.

/// Texels of `uv_test.png`.
pub(crate) const UV_TEST_SIZE: [usize; 2] = [96, 64];
/// Side of a cell of it.
const CELL: usize = 8;

/// A plinth as a person would author it: quads around, and a concave twelve-cornered cross above and below.
pub(crate) const PLINTH: &str = "\
# A cross-shaped plinth, one unit tall, four wide: quads around two concave polygons.
mtllib plinth.mtl
o plinth
usemtl stone
v -1 0 2
v 1 0 2
v 1 0 1
v 2 0 1
v 2 0 -1
v 1 0 -1
v 1 0 -2
v -1 0 -2
v -1 0 -1
v -2 0 -1
v -2 0 1
v -1 0 1
v -1 1 2
v 1 1 2
v 1 1 1
v 2 1 1
v 2 1 -1
v 1 1 -1
v 1 1 -2
v -1 1 -2
v -1 1 -1
v -2 1 -1
v -2 1 1
v -1 1 1
f 13 14 15 16 17 18 19 20 21 22 23 24
f 12 11 10 9 8 7 6 5 4 3 2 1
f 1 2 14 13
f 2 3 15 14
f 3 4 16 15
f 4 5 17 16
f 5 6 18 17
f 6 7 19 18
f 7 8 20 19
f 8 9 21 20
f 9 10 22 21
f 10 11 23 22
f 11 12 24 23
f 12 1 13 24
";

/// Of [`PLINTH`].
pub(crate) const PLINTH_MTL: &str = "# Light stone.\nnewmtl stone\nKd 0.68 0.66 0.62\n";

/// A cube of side 2 whose faces lie apart in the texture, two of them turned: no corner shares its uv with the same
/// vertex of another face.
pub(crate) const SEAM_CUBE: &str = "\
# A cube with a seam at every edge: eight vertices, twenty-four texture coordinates.
mtllib seam_cube.mtl
o seam_cube
usemtl cells
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
vt 0.02 0.52
vt 0.31 0.52
vt 0.31 0.98
vt 0.02 0.98
vt 0.35 0.52
vt 0.64 0.52
vt 0.64 0.98
vt 0.35 0.98
vt 0.69 0.52
vt 0.98 0.52
vt 0.98 0.98
vt 0.69 0.98
vt 0.02 0.02
vt 0.31 0.02
vt 0.31 0.48
vt 0.02 0.48
vt 0.35 0.02
vt 0.64 0.02
vt 0.64 0.48
vt 0.35 0.48
vt 0.69 0.02
vt 0.98 0.02
vt 0.98 0.48
vt 0.69 0.48
f 1/1 2/2 3/3 4/4
f 2/6 6/7 7/8 3/5
f 6/9 5/10 8/11 7/12
f 5/13 1/14 4/15 8/16
f 4/19 3/20 7/17 8/18
f 5/21 6/22 2/23 1/24
";

/// Of [`SEAM_CUBE`].
pub(crate) const SEAM_CUBE_MTL: &str = "newmtl cells\nKd 1 1 1\nmap_Kd uv_test.png\n";

/// Every cell has its own colour, and its lower left texel is dark, so that neither a shift, a turn nor a mirror image
/// of the texture looks like the texture.
pub(crate) fn uv_test() -> Vec<u8> {
    let [width, height] = UV_TEST_SIZE;
    let mut texels = Vec::with_capacity(3 * width * height);
    for y in 0..height {
        for x in 0..width {
            let (i, j) = (x / CELL, y / CELL);
            let dark = x % CELL == 0 && y % CELL == CELL - 1;
            let colour = [30 + 20 * i, 30 + 30 * j, 40 + 12 * ((i * 7 + j * 5) % 16)];
            texels.extend(colour.map(|c| if dark { 0 } else { c as u8 }));
        }
    }
    texels
}
