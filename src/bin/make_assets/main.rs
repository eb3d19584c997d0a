//! Writes the project's own assets, byte for byte the same on every machine: `make_assets [--cat-triangles N] [-o DIR]`.
//!
//! The cat is an implicit surface ([`shape`]), meshed ([`net`]), unwrapped ([`unwrap`]) and painted ([`coat`],
//! [`paint`]); [`simple`] holds the small test assets, [`lattice`] a screen with holes, [`gear`] gears, [`sky`] an
//! afternoon. What this writes with its defaults into `assets/` is committed; a finer cat is made on demand into a folder of
//! its own. No transcendental function but luxel's own, no hash order and no clock.

mod coat;
mod gear;
mod lattice;
mod net;
mod obj;
mod paint;
mod shape;
mod simple;
mod sky;
mod unwrap;

#[cfg(test)]
mod tests;

use clap::Parser;
use std::io;
use std::path::{Path, PathBuf};

/// Triangles of the committed cat, about.
const CAT_TRIANGLES: usize = 7000;
/// Texels of the cat's texture.
const CAT_TEXTURE: [usize; 2] = [1024, 512];
const CAT_MTL: &str = "# The cat's coat.\nnewmtl fur\nKd 1 1 1\nmap_Kd cat.png\n";

/// Writes the project's own meshes and textures.
#[derive(Parser)]
struct Arguments {
    /// Triangles of the cat, about.
    #[arg(long, default_value_t = CAT_TRIANGLES)]
    cat_triangles: usize,
    /// Folder to write into; made if it is missing.
    #[arg(short, long, default_value = "assets")]
    out: PathBuf,
}

fn main() -> io::Result<()> {
    let arguments = Arguments::parse();
    write_all(&arguments.out, arguments.cat_triangles)
}

fn write_all(folder: &Path, cat_triangles: usize) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    for (name, bytes) in assets(cat_triangles)? {
        std::fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}

/// Every file: name and contents.
fn assets(cat_triangles: usize) -> io::Result<Vec<(&'static str, Vec<u8>)>> {
    let cat = shape::Cat::sitting();
    let mesh = net::mesh(&cat, cat_triangles)
        .ok_or_else(|| io::Error::other("no closed mesh found; try another number of triangles"))?;
    let layout = unwrap::unwrap(&cat, &mesh, CAT_TEXTURE);
    let texels = paint::paint(&mesh, &layout, CAT_TEXTURE, |p| coat::colour(&cat, p));
    let text = obj::write(&mesh, &layout, CAT_TEXTURE, |p| {
        cat.gradient(p).normalize_or_zero()
    });
    Ok(vec![
        ("cat.obj", text.into_bytes()),
        ("cat.mtl", CAT_MTL.into()),
        ("cat.png", png(CAT_TEXTURE, &texels)?),
        ("gear.mtl", gear::GEAR_MTL.into()),
        ("gear_12.obj", gear::gear(12).into_bytes()),
        ("gear_18.obj", gear::gear(18).into_bytes()),
        ("gear_36.obj", gear::gear(36).into_bytes()),
        ("lattice.obj", lattice::LATTICE.into()),
        ("lattice.mtl", lattice::LATTICE_MTL.into()),
        (
            "lattice.png",
            png(lattice::LATTICE_SIZE, &lattice::lattice())?,
        ),
        ("plinth.obj", simple::PLINTH.into()),
        ("plinth.mtl", simple::PLINTH_MTL.into()),
        ("seam_cube.obj", simple::SEAM_CUBE.into()),
        ("seam_cube.mtl", simple::SEAM_CUBE_MTL.into()),
        ("sky.hdr", sky::sky()),
        (
            "uv_test.png",
            png(simple::UV_TEST_SIZE, &simple::uv_test())?,
        ),
    ])
}

fn png([width, height]: [usize; 2], texels: &[u8]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(if texels.len() == 4 * width * height {
        png::ColorType::Rgba
    } else {
        png::ColorType::Rgb
    });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(texels)?;
    writer.finish()?;
    Ok(bytes)
}
