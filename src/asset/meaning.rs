//! What a definition of an MTL file means: its [`MeshMaterial`], with the textures that it names.
//!
//! Enters: a definition and its library. Leaves: colour, emission and opacity, each a factor and a texture; warnings.
//! Deliberately absent: the alpha of `map_Kd`'s image, which counts only where `map_d` names it.

use super::loader::Loader;
use super::materials::{Library, Source};
use super::texture_line::TextureLine;
use super::{AlphaMode, MeshMaterial, Opacity, TextureUse, codes, mtl};
use crate::diag::Diagnostic;

/// Colour of a material that gives none, as of the scene's default material.
const NEUTRAL: [f64; 3] = [0.8; 3];

/// A linear factor and the texture that it multiplies.
type Textured = ([f64; 3], Option<TextureUse>);

impl Loader {
    /// The material of a definition; its textures are read.
    pub(super) fn material(
        &mut self,
        library: &Library,
        definition: &mtl::Definition,
    ) -> Result<MeshMaterial, Diagnostic> {
        let source = Source {
            path: &library.path,
            text: &library.source,
        };
        let name = &definition.name;
        let (color, texture) = self.color(&source, definition)?;
        let (emission, emission_texture) = self.emission(&source, definition)?;
        Ok(MeshMaterial {
            texture,
            opacity: self.opacity(&source, definition)?,
            emission,
            emission_texture,
            ..MeshMaterial::diffuse(name, color)
        })
    }

    /// `Kd` and `map_Kd`.
    fn color(
        &mut self,
        source: &Source<'_>,
        definition: &mtl::Definition,
    ) -> Result<Textured, Diagnostic> {
        let (texture, gain) = self.read_line(source, definition.texture.as_ref())?;
        let lost = definition.texture.is_some() && texture.is_none();
        let color = match definition.color {
            Some(color) if lost && color == [0.0; 3] => NEUTRAL,
            Some(color) => color,
            None if texture.is_some() => [1.0; 3],
            None => NEUTRAL,
        };
        let color = color.map(|c| c * gain);
        let name = &definition.name;
        if texture.is_some() && color == [0.0; 3] {
            let says = format!("the colour (Kd) of \"{name}\" is black, which hides its texture");
            self.warn(source, definition.at, codes::BLACK_FACTOR, says);
        }
        if color.iter().any(|&c| c > 1.0) {
            let says = format!("the colour (Kd) of \"{name}\" is above 1, and taken as 1");
            self.warn(source, definition.at, codes::BRIGHT_COLOR, says);
        }
        Ok((color.map(|c| c.min(1.0)), texture))
    }

    /// `Ke` and `map_Ke`.
    fn emission(
        &mut self,
        source: &Source<'_>,
        definition: &mtl::Definition,
    ) -> Result<Textured, Diagnostic> {
        let (texture, gain) = self.read_line(source, definition.emission_texture.as_ref())?;
        let none = if texture.is_some() { 1.0 } else { 0.0 };
        let emission = definition.emission.unwrap_or([none; 3]);
        let emission = emission.map(|c| (c * gain).min(f64::from(f32::MAX)));
        if texture.is_some() && emission == [0.0; 3] {
            let name = &definition.name;
            let says = format!("the emission (Ke) of \"{name}\" is black, which hides its texture");
            self.warn(source, definition.at, codes::BLACK_FACTOR, says);
        }
        Ok((emission, texture))
    }

    /// The texture that a line reads, if it is there, and what multiplies it.
    fn read_line(
        &mut self,
        source: &Source<'_>,
        line: Option<&TextureLine>,
    ) -> Result<(Option<TextureUse>, f64), Diagnostic> {
        let Some(line) = line else {
            return Ok((None, 1.0));
        };
        let texture = self.material_texture(source, &line.path, line.at)?;
        Ok(match texture {
            Some(texture) => (Some(line.reads(texture)), line.gain),
            None => (None, 1.0),
        })
    }

    fn warn(&mut self, source: &Source<'_>, at: usize, code: &'static str, says: String) {
        self.tell(source, at, Diagnostic::warning(code, says));
    }

    /// How much of a material's surface is there. No one means a surface that cannot be seen: exporters that write
    /// `Tr 1` or `d 0` mean an opaque one.
    fn opacity(
        &mut self,
        source: &Source<'_>,
        definition: &mtl::Definition,
    ) -> Result<Opacity, Diagnostic> {
        let name = &definition.name;
        let mut factor = 1.0;
        match definition.opacity {
            Some((0.0, at)) => {
                let says = format!("\"{name}\" would be invisible, and is taken as opaque");
                self.warn(source, at, codes::INVISIBLE, says);
            }
            Some((opacity, _)) => factor = opacity,
            None => {}
        }
        let mut texture = None;
        let line = definition.opacity_texture.as_ref();
        if let Some(line) = line
            && let (Some(read), gain) = self.read_line(source, Some(line))?
        {
            if self.store.texture(read.texture).alpha.is_some() {
                texture = Some(read);
                factor = (factor * gain).min(1.0);
            } else if definition
                .texture
                .as_ref()
                .is_none_or(|color| color.path != line.path)
            {
                // The colour's own image is named out of habit.
                let says = format!("the image has no alpha: \"{name}\" stays opaque");
                self.warn(source, line.at, codes::NO_ALPHA, says);
            }
        }
        let mode = match (factor, texture) {
            (1.0, None) => AlphaMode::Opaque,
            _ => AlphaMode::Blend,
        };
        Ok(Opacity {
            factor,
            texture,
            vertex_alpha: false,
            mode,
        })
    }
}
