//! What a scene requires: computed by the build, it selects the stages.

/// One flag per thing that costs something.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Triangles anywhere.
    pub triangles: bool,
    /// Spheres in the tree.
    pub tree_spheres: bool,
    /// Spheres outside the tree.
    pub looped_spheres: bool,
    /// Instances.
    pub instances: bool,
    /// Interpolated normals.
    pub smooth_normals: bool,
    /// Texture coordinates.
    pub uvs: bool,
    /// A second set of texture coordinates.
    pub uvs1: bool,
    /// Colours at the corners of triangles.
    pub vertex_colors: bool,
    /// Textures.
    pub textures: bool,
    /// Surfaces that rays may pass.
    pub opacity: bool,
    /// A lens.
    pub lens: bool,
    /// Something emits, or shines without extent.
    pub lights: bool,
    /// Lights without extent.
    pub punctual: bool,
    /// The background is the same everywhere and not black.
    pub background: bool,
    /// The background is an image.
    pub environment: bool,
    /// [`super::Scatter::Diffuse`] occurs.
    pub diffuse: bool,
    /// [`super::Scatter::Mirror`] occurs.
    pub mirror: bool,
    /// [`super::Scatter::Glass`] occurs.
    pub glass: bool,
    /// [`super::Scatter::Plastic`] occurs.
    pub plastic: bool,
    /// [`super::Scatter::Metal`] occurs.
    pub metal: bool,
}
