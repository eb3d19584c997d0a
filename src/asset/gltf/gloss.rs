//! Metallic-roughness (section 3.9.2 and appendix B) mapped to the materials that luxel has.
//!
//! | file | here | exact for |
//! |---|---|---|
//! | transmission ≥ 0.5 | [`Scattering::Glass`] | transmission 1, roughness 0, a closed surface |
//! | else metallic > 0.5, roughness < 0.3 | [`Scattering::Metal`] | metallic 1, roughness 0 |
//! | else metallic ≤ 0.5, roughness < 0.3 | [`Scattering::Plastic`] | metallic 0, roughness 0 |
//! | else | [`Scattering::Diffuse`] | metallic 0, roughness 1, but for the faint sheen of that |
//!
//! One warning per file names the materials for which this is an approximation. KHR_materials_transmission alone means a
//! thin sheet; luxel's glass is solid, as KHR_materials_volume has it.

use super::notes::{Notes, names};
use crate::asset::{Scattering, codes};
use crate::diag::Diagnostic;
use std::collections::BTreeMap;

/// Transmission from which a surface is glass.
const GLASS: f64 = 0.5;

/// Metalness above which a surface is metal.
const METAL: f64 = 0.5;

/// Roughness below which a surface is polished.
const POLISHED: f64 = 0.3;

/// Index of refraction of a dielectric that names none (KHR_materials_ior).
pub(super) const DEFAULT_IOR: f64 = 1.5;

/// Largest index of refraction that luxel has.
const MAX_IOR: f64 = 100.0;

/// What a material of a file says of its gloss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Surface {
    pub(super) transmission: f64,
    pub(super) metallic: f64,
    pub(super) roughness: f64,
    pub(super) ior: f64,
}

impl Surface {
    /// How it scatters, and whether that is what the file says.
    pub(super) fn scattering(&self) -> (Scattering, bool) {
        let Surface {
            transmission,
            metallic,
            roughness,
            ior,
        } = *self;
        // 0 stands for infinity, with which specular-glossiness was written as metallic-roughness.
        let known = (1.0..=MAX_IOR).contains(&ior);
        let ior = if known { ior } else { DEFAULT_IOR };
        if transmission >= GLASS {
            (
                Scattering::Glass { ior },
                transmission == 1.0 && roughness == 0.0,
            )
        } else if roughness >= POLISHED {
            let exact = metallic == 0.0 && roughness == 1.0 && transmission == 0.0;
            (Scattering::Diffuse, exact)
        } else if metallic > METAL {
            (Scattering::Metal, metallic == 1.0 && roughness == 0.0)
        } else {
            let exact = metallic == 0.0 && roughness == 0.0 && transmission == 0.0;
            (Scattering::Plastic { ior }, exact)
        }
    }
}

/// The materials whose gloss is not what the file says, by what they became.
#[derive(Debug, Default)]
pub(super) struct Approximated {
    /// JSON pointer of the first.
    first: Option<String>,
    names: BTreeMap<&'static str, Vec<String>>,
}

impl Approximated {
    pub(super) fn add(&mut self, scattering: Scattering, name: &str, pointer: &str) {
        let became = match scattering {
            Scattering::Glass { .. } => "clear glass",
            Scattering::Metal | Scattering::Mirror => "polished metal",
            Scattering::Plastic { .. } => "polished plastic",
            Scattering::Diffuse | Scattering::Nothing => "matte",
        };
        self.first.get_or_insert_with(|| pointer.to_owned());
        let known = self.names.entry(became).or_default();
        if known.iter().all(|known| known != name) {
            known.push(name.to_owned());
        }
    }

    /// One warning for all of them.
    pub(super) fn say(self, notes: &mut Notes) {
        let Some(first) = self.first else {
            return;
        };
        let groups = self.names.iter();
        let groups: Vec<String> = groups
            .map(|(became, of)| format!("{became}: {}", names(of)))
            .collect();
        let says = format!(
            "rough gloss, rough metal and blends of kinds are not modelled; shown as {}",
            groups.join("; ")
        );
        let warning = Diagnostic::warning(codes::GLTF_GLOSS, says).pointer(first);
        notes.tell(warning.hint("choose another look by `material` on the entity"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gloss_becomes_the_nearest_material_and_says_when_it_is_not_the_same() {
        let of = |transmission, metallic, roughness| {
            let surface = Surface {
                transmission,
                metallic,
                roughness,
                ior: 1.4,
            };
            surface.scattering()
        };
        let (glass, plastic) = (
            Scattering::Glass { ior: 1.4 },
            Scattering::Plastic { ior: 1.4 },
        );
        for (surface, expected) in [
            (of(1.0, 0.0, 0.0), (glass, true)),
            (of(0.5, 0.0, 0.0), (glass, false)),
            (of(1.0, 1.0, 0.2), (glass, false)),
            (of(0.0, 1.0, 0.0), (Scattering::Metal, true)),
            (of(0.0, 0.6, 0.29), (Scattering::Metal, false)),
            (of(0.0, 1.0, 0.3), (Scattering::Diffuse, false)),
            (of(0.0, 0.5, 0.0), (plastic, false)),
            (of(0.0, 0.0, 0.0), (plastic, true)),
            (of(0.49, 0.0, 1.0), (Scattering::Diffuse, false)),
            (of(0.0, 0.0, 1.0), (Scattering::Diffuse, true)),
            (of(0.0, 0.0, 0.5), (Scattering::Diffuse, false)),
        ] {
            assert_eq!(surface, expected);
        }
    }

    #[test]
    fn an_index_of_refraction_out_of_range_is_the_default() {
        for (ior, expected) in [(0.0, 1.5), (1.0, 1.0), (1e9, 1.5), (2.4, 2.4)] {
            let surface = Surface {
                transmission: 1.0,
                metallic: 0.0,
                roughness: 0.0,
                ior,
            };
            assert_eq!(surface.scattering().0, Scattering::Glass { ior: expected });
        }
    }
}
