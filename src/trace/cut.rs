//! What a bench cuts out of tracing, to tell what it costs scenes that do not need it (`benches/cuts.sh`). Constants, so that
//! the code drops out; without `--cfg luxel_cut="…"` all of it is there.

pub(super) const LENS: bool = !cfg!(luxel_cut = "lens");
pub(super) const SMOOTH_NORMALS: bool = !cfg!(luxel_cut = "smooth_normals");
pub(super) const TEXTURES: bool = !cfg!(luxel_cut = "textures");
pub(super) const VERTEX_COLORS: bool = !cfg!(luxel_cut = "vertex_colors");
pub(super) const OPACITY: bool = !cfg!(luxel_cut = "opacity");
pub(super) const INSTANCES: bool = !cfg!(luxel_cut = "instances");
pub(super) const BACKGROUND: bool = !cfg!(luxel_cut = "background");
pub(super) const ENVIRONMENT: bool = !cfg!(luxel_cut = "environment");
pub(super) const PUNCTUAL: bool = !cfg!(luxel_cut = "punctual");
pub(super) const MIRROR: bool = !cfg!(luxel_cut = "mirror");
pub(super) const GLASS: bool = !cfg!(luxel_cut = "glass");
pub(super) const PLASTIC: bool = !cfg!(luxel_cut = "plastic");
pub(super) const METAL: bool = !cfg!(luxel_cut = "metal");
