//! What a node of a file is in the words of a scene: its transform, its material.

use crate::asset::{AlphaMode, Curve, Interpolation, Mesh, Motion, NodeTransform, Scattering};
use crate::math::{DMat3, DVec3};
use crate::scene::{
    ColorDesc, EaseDesc, KeyDesc, KeysDesc, MaterialDesc, RotateDesc, TransformDesc,
};

/// Columns of a matrix whose cosine is below this are at right angles: files hold single precision.
const SHEAR: f64 = 1e-5;

/// T · R · S of a node. A matrix that is sheared, which glTF forbids, keeps its columns' lengths and nearest directions,
/// and a note says so.
pub(super) fn transform(
    node: &NodeTransform,
    name: &str,
    notes: &mut Vec<String>,
) -> TransformDesc {
    match node {
        NodeTransform::Parts {
            translate,
            rotate,
            scale,
        } => TransformDesc {
            translate: translate.to_array(),
            rotate: rotation(*rotate),
            scale: upright(*scale, name, notes),
        },
        NodeTransform::Matrix(map) => {
            let (rotation_matrix, scale, cosine) = polar(&map.matrix3);
            if cosine > SHEAR {
                notes.push(format!(
                    "The matrix of {name:?} is sheared, which an entity cannot be."
                ));
            }
            TransformDesc {
                translate: map.translation.to_array(),
                rotate: rotation(quaternion_of(&rotation_matrix)),
                scale: upright(scale, name, notes),
            }
        }
    }
}

/// The keys of a node, at all of its times. A scene has one ease for all of an entity's parts, and no splines: where a file
/// has, the way from key to key is straight, and a note says so.
pub(super) fn keys(motion: &Motion, name: &str, notes: &mut Vec<String>) -> Option<KeysDesc> {
    let curves = [&motion.translate, &motion.rotate, &motion.scale];
    let curves: Vec<&Curve> = curves.into_iter().flatten().collect();
    let first = curves.first()?.interpolation;
    let same = curves.iter().all(|curve| curve.interpolation == first);
    let ease = match (same, first) {
        (true, Interpolation::Step) => EaseDesc::Step,
        (true, Interpolation::Linear) => EaseDesc::Linear,
        _ => {
            notes.push(format!(
                "{name:?} moves along curves, here straight from key to key."
            ));
            EaseDesc::Linear
        }
    };
    let mut times: Vec<f64> = curves
        .iter()
        .flat_map(|curve| &curve.times)
        .copied()
        .collect();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    let at = |curve: &Option<Curve>, t: f64| {
        let curve = curve.as_ref()?;
        let at = curve
            .times
            .binary_search_by(|time| time.total_cmp(&t))
            .ok()?;
        curve.values.get(at).copied()
    };
    let vector = |[x, y, z, _]: [f64; 4]| [x, y, z];
    let key = |t: f64| KeyDesc {
        t,
        translate: at(&motion.translate, t).map(vector),
        rotate: at(&motion.rotate, t).map(RotateDesc::Quat),
        scale: at(&motion.scale, t).map(vector),
    };
    Some(KeysDesc {
        keys: times.into_iter().map(key).collect(),
        ease,
    })
}

/// A scene refuses a scale of 0, by which glTF files hide nodes.
fn upright(scale: DVec3, name: &str, notes: &mut Vec<String>) -> [f64; 3] {
    /// Flat enough.
    const NEARLY_NOTHING: f64 = 1e-9;
    let scale = scale.to_array();
    if scale.contains(&0.0) {
        notes.push(format!(
            "The scale of {name:?} is 0, here {NEARLY_NOTHING:e}."
        ));
    }
    scale.map(|s| if s == 0.0 { NEARLY_NOTHING } else { s })
}

/// The default where the quaternion turns nothing.
fn rotation(q: [f64; 4]) -> RotateDesc {
    match q {
        [x, y, z, _] if x == 0.0 && y == 0.0 && z == 0.0 => TransformDesc::default().rotate,
        q => RotateDesc::Quat(q),
    }
}

/// Rotation, scale, and the largest cosine between two columns, by Gram and Schmidt. A mirrored matrix scales x by a
/// negative number.
fn polar(m: &DMat3) -> (DMat3, DVec3, f64) {
    let unit = |v: DVec3, other: DVec3| crate::math::unit(v).unwrap_or(other);
    let (x, y, z) = (
        unit(m.x_axis, DVec3::X),
        unit(m.y_axis, DVec3::Y),
        unit(m.z_axis, DVec3::Z),
    );
    let cosine = x.dot(y).abs().max(y.dot(z).abs()).max(z.dot(x).abs());
    let mirror = if x.cross(y).dot(z) < 0.0 { -1.0 } else { 1.0 };
    // The z axis stays, y comes to be at right angles to it, x to both.
    let y = unit(y - z * y.dot(z), z.any_orthonormal_vector());
    let rotation = DMat3::from_cols(y.cross(z), y, z);
    let length = |v: DVec3| v.dot(v).sqrt();
    let scale = DVec3::new(
        mirror * length(m.x_axis),
        length(m.y_axis),
        length(m.z_axis),
    );
    (rotation, scale, cosine)
}

/// x, y, z, w of any length, after Shepperd (1978): from the largest of the four, without a root, so that quarter turns
/// are exact.
fn quaternion_of(m: &DMat3) -> [f64; 4] {
    let [[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]] = m.to_cols_array_2d();
    let rows = [
        [1.0 + xx - yy - zz, yx + xy, xz + zx, zy - yz],
        [yx + xy, 1.0 - xx + yy - zz, zy + yz, xz - zx],
        [xz + zx, zy + yz, 1.0 - xx - yy + zz, yx - xy],
        [zy - yz, xz - zx, yx - xy, 1.0 + xx + yy + zz],
    ];
    // The w row first: the identity of two equals.
    let order = [3, 0, 1, 2];
    let best = order.into_iter().reduce(|best, i| {
        if rows[i][i] > rows[best][best] {
            i
        } else {
            best
        }
    });
    let row = rows[best.unwrap_or(3)];
    let largest = row.iter().fold(0.0f64, |most, c| most.max(c.abs()));
    row.map(|c| 0.0 + c / largest)
}

/// The one material of a mesh with its name, where a scene can say it as well: one colour, opaque, dark.
pub(super) fn plain_material(mesh: &Mesh) -> Option<(String, MaterialDesc)> {
    let [material] = mesh.materials.as_slice() else {
        return None;
    };
    let opaque = material.opacity.mode == AlphaMode::Opaque;
    let plain = material.texture.is_none()
        && !material.vertex_colors
        && material.emission == [0.0; 3]
        && material.emission_texture.is_none()
        && opaque
        && mesh.material.iter().all(|m| *m == Some(0));
    let color = ColorDesc::Linear(material.color);
    let desc = match material.scattering {
        Scattering::Nothing => return None,
        Scattering::Diffuse => MaterialDesc::Diffuse { color },
        Scattering::Mirror => MaterialDesc::Mirror { color },
        Scattering::Glass { ior } => MaterialDesc::Glass { ior, color },
        Scattering::Plastic { ior } => MaterialDesc::Plastic { ior, color },
        Scattering::Metal => MaterialDesc::Metal {
            color,
            roughness: MaterialDesc::ROUGHNESS,
        },
    };
    let name = match material.name.trim() {
        "" => "material".to_owned(),
        _ => material.name.clone(),
    };
    plain.then_some((name, desc))
}
