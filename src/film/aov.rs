//! The names of what a film can hold beside radiance.

/// An auxiliary image of the EXR file. Its channels are `name.suffix` for every suffix of [`Aov::channels`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Aov {
    /// Albedo of the first hit, mean over the samples that hit; 0 where none did.
    Albedo,
    /// Shading normal, likewise; authored axes.
    Normal,
    /// Geometric normal, likewise.
    Geonormal,
    /// Depth along the view axis in authored units, likewise; +inf where no sample hit.
    Depth,
    /// Texture coordinates at the pixel's centre; 0 for a miss.
    Uv,
    /// Triangle index in file order at the pixel's centre; `u32::MAX` for a miss.
    Prim,
    /// Index in the scene's `entities` at the pixel's centre; `u32::MAX` for a miss.
    Entity,
    /// Number of samples in the pixel.
    Samples,
    /// Standard error of the pixel's mean radiance; +inf below two samples.
    Stderr,
}

impl Aov {
    /// All, in the order of the documentation.
    pub const ALL: [Aov; 9] = [
        Aov::Albedo,
        Aov::Normal,
        Aov::Geonormal,
        Aov::Depth,
        Aov::Uv,
        Aov::Prim,
        Aov::Entity,
        Aov::Samples,
        Aov::Stderr,
    ];

    /// Its name on the command line and before the dot of its channels.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Aov::Albedo => "albedo",
            Aov::Normal => "normal",
            Aov::Geonormal => "geonormal",
            Aov::Depth => "depth",
            Aov::Uv => "uv",
            Aov::Prim => "prim",
            Aov::Entity => "entity",
            Aov::Samples => "samples",
            Aov::Stderr => "stderr",
        }
    }

    /// The parts after the dot of its channels.
    #[must_use]
    pub fn channels(self) -> &'static [&'static str] {
        match self {
            Aov::Albedo | Aov::Stderr => &["R", "G", "B"],
            Aov::Normal | Aov::Geonormal => &["X", "Y", "Z"],
            Aov::Depth => &["Z"],
            Aov::Uv => &["U", "V"],
            Aov::Prim | Aov::Entity => &["I"],
            Aov::Samples => &["N"],
        }
    }

    /// Whether it is a mean over samples that tracing must gather.
    #[must_use]
    pub fn is_feature(self) -> bool {
        matches!(
            self,
            Aov::Albedo | Aov::Normal | Aov::Geonormal | Aov::Depth
        )
    }

    /// Whether it comes from the ray through the pixel's centre.
    #[must_use]
    pub fn is_id(self) -> bool {
        matches!(self, Aov::Uv | Aov::Prim | Aov::Entity)
    }
}
