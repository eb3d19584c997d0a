//! The linear picture: one part, f32 `R G B` and the AOVs that were asked for, ZIP-compressed scan lines.

use super::{Aov, EncodeError, Film, Metadata};
use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    SmallVec, Text, WritableImage,
};

/// The film as the bytes of an OpenEXR file.
///
/// Single-part, since some viewers cannot read several. The metadata become the one text attribute `luxel`, a
/// `key: value` line each: the writer keeps attributes in a hash map, and the order of two would change from run to
/// run.
///
/// # Errors
/// If the image is larger than the format allows.
///
/// # Panics
/// If an AOV is asked for whose samples were not gathered.
pub fn encode_exr(film: &Film, aovs: &[Aov], metadata: &Metadata) -> Result<Vec<u8>, EncodeError> {
    let mut channels = split("", &["R", "G", "B"], &film.radiance());
    for &aov in aovs {
        channels.extend(aov_channels(film, aov));
    }
    let mut attributes = LayerAttributes {
        software_name: Some(Text::from("luxel")),
        ..LayerAttributes::default()
    };
    attributes.other.insert(
        Text::from("luxel"),
        AttributeValue::Text(Text::from(metadata.to_lines().as_str())),
    );
    let layer = Layer::new(
        (film.width() as usize, film.height() as usize),
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels),
    );
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|e| EncodeError {
            format: "EXR",
            reason: e.to_string(),
        })?;
    Ok(bytes.into_inner())
}

type Channels = SmallVec<[AnyChannel<FlatSamples>; 4]>;

fn aov_channels(film: &Film, aov: Aov) -> Channels {
    let planes = film.planes();
    let parts = aov.channels();
    let single = |samples: FlatSamples| -> Channels {
        let name = format!("{}.{}", aov.name(), parts[0]);
        std::iter::once(AnyChannel::new(name.as_str(), samples)).collect()
    };
    match aov {
        Aov::Albedo => split(aov.name(), parts, &film.feature(&planes.albedo)),
        Aov::Normal => split(aov.name(), parts, &film.feature(&planes.normal)),
        Aov::Geonormal => split(aov.name(), parts, &film.feature(&planes.geonormal)),
        Aov::Depth => single(FlatSamples::F32(film.depth())),
        Aov::Uv => split(aov.name(), parts, &planes.uv),
        Aov::Prim => single(FlatSamples::U32(planes.prim.clone())),
        Aov::Entity => single(FlatSamples::U32(planes.entity.clone())),
        // Exact up to 2^24 samples; viewers show floats.
        Aov::Samples => single(FlatSamples::F32(
            planes.count.iter().map(|&n| n as f32).collect(),
        )),
        Aov::Stderr => split(aov.name(), parts, &film.standard_error()),
    }
}

/// Pixels of N components to N channels `layer.part`.
fn split<const N: usize>(layer: &str, parts: &[&str], pixels: &[[f32; N]]) -> Channels {
    let channel = |(i, part): (usize, &&str)| {
        let name = match layer {
            "" => (*part).to_owned(),
            layer => format!("{layer}.{part}"),
        };
        let samples = pixels.iter().map(|p| p[i]).collect();
        AnyChannel::new(name.as_str(), FlatSamples::F32(samples))
    };
    parts.iter().enumerate().map(channel).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Planes, Window};
    use super::*;
    use ::exr::prelude::{ReadChannels, ReadLayers, read};

    fn film() -> Film {
        let mut film = Film::new(2, 1);
        let window = Window {
            x: 0,
            y: 0,
            width: 2,
            height: 1,
        };
        let planes = Planes {
            rgb: vec![[0.25, 0.5, 1e6], [1.0, 3.0, 5.0]],
            rgb_squared: vec![[1.0; 3]; 2],
            gains: Vec::new(),
            count: vec![1, 2],
            non_finite: vec![0; 2],
            hit_count: vec![0, 2],
            albedo: vec![[0.0; 3], [1.0; 3]],
            normal: vec![[0.0; 3], [0.0, 2.0, 0.0]],
            geonormal: vec![[0.0; 3], [0.0, 0.0, 2.0]],
            depth: vec![0.0, 7.0],
            uv: vec![[0.0; 2], [0.5, 1.5]],
            prim: vec![u32::MAX, 3],
            entity: vec![u32::MAX, 1],
        };
        film.put(window, &planes);
        film
    }

    fn metadata() -> Metadata {
        let mut metadata = Metadata::default();
        metadata.push("seed", 7);
        metadata.push("spp", 2);
        metadata
    }

    #[test]
    fn channels_read_back() {
        let bytes = encode_exr(&film(), &Aov::ALL, &metadata()).expect("small");
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(std::io::Cursor::new(bytes))
            .expect("an EXR");
        let channel = |name: &str| {
            let found = image
                .layer_data
                .channel_data
                .list
                .iter()
                .find(|c| c.name.eq(name));
            found.map(|c| c.sample_data.clone()).expect(name)
        };
        assert_eq!(channel("B"), FlatSamples::F32(vec![1e6, 2.5]));
        assert_eq!(channel("normal.Y"), FlatSamples::F32(vec![0.0, 1.0]));
        assert_eq!(
            channel("depth.Z"),
            FlatSamples::F32(vec![f32::INFINITY, 3.5])
        );
        assert_eq!(channel("uv.V"), FlatSamples::F32(vec![0.0, 1.5]));
        assert_eq!(channel("prim.I"), FlatSamples::U32(vec![u32::MAX, 3]));
        assert_eq!(channel("entity.I"), FlatSamples::U32(vec![u32::MAX, 1]));
        assert_eq!(channel("samples.N"), FlatSamples::F32(vec![1.0, 2.0]));
        let names = image.layer_data.channel_data.list.len();
        let expected: usize = Aov::ALL.iter().map(|a| a.channels().len()).sum();
        assert_eq!(names, 3 + expected);
        let written = image.layer_data.attributes.other.get(&Text::from("luxel"));
        assert_eq!(
            written,
            Some(&AttributeValue::Text(Text::from("seed: 7\nspp: 2\n")))
        );
    }

    #[test]
    fn equal_films_are_equal_files() {
        let once = encode_exr(&film(), &Aov::ALL, &metadata()).expect("small");
        let again = encode_exr(&film(), &Aov::ALL, &metadata()).expect("small");
        assert_eq!(once, again);
    }
}
