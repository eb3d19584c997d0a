//! How large the buffers of a scene are.

use crate::flat::{Environment, FlatScene, Geometry};
use std::sync::Arc;

/// A buffer, or buffers of one kind, of a [`FlatScene`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BufferBytes {
    /// What it holds.
    pub name: &'static str,
    /// Number of elements.
    pub len: usize,
    /// Bytes of all elements.
    pub bytes: usize,
}

/// The buffers of a scene that are not empty, hot ones first. Texels count once however many textures share them.
#[must_use]
pub fn buffer_bytes(scene: &FlatScene) -> Vec<BufferBytes> {
    let geometries: Vec<&Geometry> = std::iter::once(&scene.world)
        .chain(scene.local.iter().map(AsRef::as_ref))
        .collect();
    let of_all = |name, buffer: &dyn Fn(&Geometry) -> BufferBytes| {
        geometries.iter().map(|g| buffer(g)).fold(
            BufferBytes {
                name,
                len: 0,
                bytes: 0,
            },
            |sum, b| BufferBytes {
                name,
                len: sum.len + b.len,
                bytes: sum.bytes + b.bytes,
            },
        )
    };
    let spheres = &scene.spheres;
    let triangles = &scene.lights.triangles;
    let mut buffers = vec![
        of_all("nodes", &|g| buffer("", &g.bvh.nodes)),
        of_all("triangle blocks", &|g| buffer("", &g.triangles.blocks)),
        buffer("sphere blocks, tree", &spheres.blocks),
        buffer("sphere blocks, loop", &spheres.looped),
        buffer("instances", &scene.instances),
        buffer("instance order", &scene.world.bvh.instance_order),
        buffer("instance materials", &scene.instance_materials),
        of_all("triangle places", &|g| buffer("", &g.triangles.place)),
        of_all("corner normals", &|g| buffer("", &g.shading.normals.corner)),
        of_all("corner uvs", &|g| buffer("", &g.shading.uvs)),
        of_all("corner uvs, second set", &|g| buffer("", &g.shading.uvs1)),
        of_all("corner colours", &|g| buffer("", &g.shading.colors)),
        of_all("triangle materials", &|g| buffer("", &g.shading.material)),
        of_all("triangle objects", &|g| buffer("", &g.shading.object)),
        of_all("triangle file indices", &|g| {
            buffer("", &g.shading.file_prim)
        }),
        buffer("sphere centres, radii", &spheres.placed),
        buffer("sphere sides", &spheres.inverted),
        buffer("sphere materials", &spheres.material),
        buffer("sphere objects", &spheres.object),
        buffer("sphere rotations", &spheres.to_local),
        buffer("materials", &scene.materials),
        images("texels", 3, scene.textures.iter().map(|t| &t.texels)),
        images(
            "alphas",
            1,
            scene.textures.iter().filter_map(|t| t.alpha.as_ref()),
        ),
        sky("sky texels", scene, |sky| buffer("", &sky.texels)),
        sky("sky row sums", scene, |sky| buffer("", &sky.table.rows)),
        sky("sky column sums", scene, |sky| {
            buffer("", &sky.table.columns)
        }),
        sky("sky heights", scene, |sky| buffer("", &sky.table.heights)),
        buffer("light spheres", &scene.lights.spheres),
        BufferBytes {
            name: "light triangles",
            len: triangles.v0.len(),
            bytes: triangles.v0.len() * LIGHT_TRIANGLE,
        },
        buffer("light triangle sides", &triangles.two_sided),
        buffer("light triangle places", &triangles.place),
        buffer("punctual lights", &scene.lights.punctual),
        buffer("light weights", &scene.lights.cumulative),
        BufferBytes {
            name: "chains",
            len: scene.chains.len(),
            bytes: scene.chains.len() * CHAIN,
        },
    ];
    buffers.retain(|b| b.len > 0);
    buffers
}

/// A key and three rows of four.
const CHAIN: usize = size_of::<u32>() + 3 * size_of::<[f64; 4]>();

/// Three vectors, a colour and an area.
const LIGHT_TRIANGLE: usize = 4 * size_of::<[f32; 3]>() + size_of::<f32>();

fn buffer<T>(name: &'static str, elements: &[T]) -> BufferBytes {
    BufferBytes {
        name,
        len: elements.len(),
        bytes: size_of_val(elements),
    }
}

/// A buffer of the sky, which few scenes have.
fn sky(
    name: &'static str,
    scene: &FlatScene,
    of: impl Fn(&Environment) -> BufferBytes,
) -> BufferBytes {
    let none = buffer::<u8>("", &[]);
    let buffer = scene.environment.as_ref().map_or(none, of);
    BufferBytes { name, ..buffer }
}

/// Planes of images, `texel` bytes an element, each plane once.
fn images<'a>(
    name: &'static str,
    texel: usize,
    planes: impl Iterator<Item = &'a Arc<[u8]>>,
) -> BufferBytes {
    let mut images: Vec<(*const u8, usize)> = planes.map(|p| (p.as_ptr(), p.len())).collect();
    images.sort_unstable();
    images.dedup();
    let bytes = images.iter().map(|i| i.1).sum();
    BufferBytes {
        name,
        len: bytes / texel,
        bytes,
    }
}
