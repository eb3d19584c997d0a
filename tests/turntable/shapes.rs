//! The same studio for every size, origin and axis, and for shapes that are hard to show.

use crate::studio::{Folder, Take, coverage, exposure, film, is_inside, mask};
use luxel::author::{NoExtent, Turntable, Up, turntable};
use luxel::film::Film;
use luxel::math::DVec3;

const TAKE: Take = Take {
    up: Up::Y,
    side: 40,
    spp: 4,
    frames: 4,
};

/// A wedge without any symmetry, whose corners go through `place`.
fn wedge(place: impl Fn([f64; 3]) -> [f64; 3]) -> String {
    let corners = [
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [4.0, 0.0, 2.0],
        [0.0, 0.0, 2.0],
        [0.0, 3.0, 0.0],
        [0.0, 3.0, 1.0],
    ];
    obj(
        &corners.map(place),
        "f 1 2 3 4\nf 1 5 2\nf 4 3 6\nf 1 4 6 5\nf 2 5 6 3\n",
    )
}

fn obj(corners: &[[f64; 3]], faces: &str) -> String {
    let line = |[x, y, z]: &[f64; 3]| format!("v {x:e} {y:e} {z:e}\n");
    corners.iter().map(line).collect::<String>() + faces
}

fn turn(folder: &Folder, text: &str, up: Up) -> Vec<Film> {
    let mesh = folder.file("mesh.obj", text);
    film(&mesh, Take { up, ..TAKE }).expect("it turns")
}

/// Mean absolute difference of the frames' radiance.
fn difference(a: &[Film], b: &[Film]) -> f64 {
    let of =
        |films: &[Film]| -> Vec<f32> { films.iter().flat_map(Film::radiance).flatten().collect() };
    let (a, b) = (of(a), of(b));
    let sum: f64 = a
        .iter()
        .zip(&b)
        .map(|(a, b)| f64::from((a - b).abs()))
        .sum();
    sum / a.len() as f64
}

/// A pixel on an edge may fall to the other side by rounding; a shift by a tenth of a pixel makes more than ten times
/// this.
const SAME: f64 = 2e-4;

#[test]
fn size_and_origin_change_nothing() {
    let folder = Folder::new("size");
    let model = turn(&folder, &wedge(|p| p), Up::Y);
    let (mean, burnt) = exposure(&model[0]);
    assert!((0.2..0.5).contains(&mean) && burnt < 0.01, "{mean} {burnt}");
    for scale in [1e-90, 1e-6, 0.02, 1000.0, 1e6, 1e90] {
        let same = turn(&folder, &wedge(|p| p.map(|x| x * scale)), Up::Y);
        let off = difference(&model, &same);
        assert!(off < SAME, "{scale:e}: {off:e}");
    }
    for origin in [[100.0, -7.0, 3.0], [-1e6, 1e6, 1e6]] {
        let place = |p: [f64; 3]| std::array::from_fn(|c| p[c] + origin[c]);
        let off = difference(&model, &turn(&folder, &wedge(place), Up::Y));
        assert!(off < SAME, "{origin:?}: {off:e}");
    }
    let larger = turn(&folder, &wedge(|[x, y, z]| [x, 1.1 * y, z]), Up::Y);
    let off = difference(&model, &larger);
    assert!(off > 10.0 * SAME, "the measure sees a change: {off:e}");
}

#[test]
fn every_axis_can_point_up() {
    let folder = Folder::new("up");
    let model = turn(&folder, &wedge(|p| p), Up::Y);
    type Place = fn([f64; 3]) -> [f64; 3];
    let cases: [(Up, Place); 5] = [
        (Up::Z, |[x, y, z]| [x, -z, y]),
        (Up::MinusZ, |[x, y, z]| [x, z, -y]),
        (Up::X, |[x, y, z]| [y, -x, z]),
        (Up::MinusX, |[x, y, z]| [-y, x, z]),
        (Up::MinusY, |[x, y, z]| [x, -y, -z]),
    ];
    for (up, place) in cases {
        let off = difference(&model, &turn(&folder, &wedge(place), up));
        assert!(off < SAME, "{up:?}: {off:e}");
        let other = difference(&model, &turn(&folder, &wedge(place), Up::Y));
        assert!(other > 10.0 * SAME, "{up:?} matters: {other:e}");
    }
}

#[test]
fn the_turn_comes_full_circle() {
    let folder = Folder::new("circle");
    let frames = turn(&folder, &wedge(|p| p), Up::Y);
    let different = |a: &Film, b: &Film| mask(a).iter().zip(mask(b)).any(|(a, b)| *a != b);
    assert!((1..4).all(|k| different(&frames[0], &frames[k])));
    let mesh = folder.0.join("mesh.obj");
    let more = film(&mesh, Take { frames: 8, ..TAKE }).expect("it turns");
    assert_eq!(mask(&more[2]), mask(&frames[1]), "a quarter is a quarter");
}

#[test]
fn flat_long_and_lonely_shapes_are_seen_whole() {
    let folder = Folder::new("flat");
    // What it is, its corners and faces, and the least share of the frame that it covers at its best.
    let cases: [(&str, Vec<[f64; 3]>, &str, f64); 7] = [
        (
            "a sheet on the ground",
            vec![[0., 0., 0.], [1., 0., 0.], [1., 0., 1.], [0., 0., 1.]],
            "f 1 4 3 2",
            0.1,
        ),
        (
            "the same, upside down",
            vec![[0., 0., 0.], [1., 0., 0.], [1., 0., 1.], [0., 0., 1.]],
            "f 1 2 3 4",
            0.1,
        ),
        (
            "a standing sheet",
            vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
            "f 1 2 3 4",
            0.15,
        ),
        (
            "a triangle",
            vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]],
            "f 1 2 3",
            0.06,
        ),
        (
            "a needle",
            vec![[0., 0., 0.], [0.3, 0., 0.], [0., 9., 0.], [0.1, 0., 0.3]],
            "f 1 2 3\nf 1 3 4\nf 2 4 3",
            0.01,
        ),
        (
            "a ribbon",
            vec![[-9., 0., 0.], [9., 0., 0.], [9., 1.0, 0.], [-9., 1.0, 0.]],
            "f 1 2 3 4",
            0.01,
        ),
        (
            "far from itself",
            vec![
                [0., 0., 0.],
                [1., 0., 0.],
                [0., 1., 0.],
                [8., 0., 0.],
                [9., 0., 0.],
                [8., 1., 0.],
            ],
            "f 1 2 3\nf 4 5 6",
            0.002,
        ),
    ];
    for (what, corners, faces, least) in cases {
        let frames = turn(&folder, &obj(&corners, faces), Up::Y);
        let best = frames.iter().map(coverage).fold(0.0, f64::max);
        assert!(best >= least, "{what}: {best}");
        for frame in &frames {
            assert!(is_inside(frame), "{what}");
            assert_eq!(frame.total_non_finite(), 0, "{what}");
            let (mean, burnt) = exposure(frame);
            assert!(
                (0.2..0.6).contains(&mean) && burnt < 0.02,
                "{what}: {mean} {burnt}"
            );
        }
    }
}

#[test]
fn white_and_black_meshes_both_show() {
    let folder = Folder::new("tones");
    let mut means = Vec::new();
    for (name, tone) in [("white", 0.9), ("black", 0.02)] {
        folder.file("m.mtl", &format!("newmtl m\nKd {tone} {tone} {tone}\n"));
        let text = format!("mtllib m.mtl\nusemtl m\n{}", wedge(|p| p));
        let frames = turn(&folder, &text, Up::Y);
        assert!(exposure(&frames[0]).1 < 0.01, "{name} is burnt");
        let radiance = frames[0].radiance();
        let on_mesh = mask(&frames[0]);
        let tones = radiance
            .iter()
            .zip(&on_mesh)
            .filter(|(_, m)| **m)
            .map(|(p, _)| f64::from(p[1]));
        means.push(tones.clone().sum::<f64>() / tones.count() as f64);
    }
    // The green of the background.
    let backdrop = 0.31;
    assert!(means[0] > 1.1 * backdrop && means[0] < 1.0, "{means:?}");
    assert!(means[1] < 0.3 * backdrop && means[1] > 0.0, "{means:?}");
}

#[test]
fn what_no_scene_can_hold_is_refused() {
    let wanted = Turntable {
        path: "mesh.obj".to_owned(),
        gltf: false,
        up: Up::Y,
        size: (8, 8),
        spp: 1,
        frames: 1,
        seconds: 1.0,
    };
    let of = |points: &[DVec3]| turntable(points, &wanted).map(|_| ());
    let [here, there] = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 2.0, 3.0)];
    assert_eq!(of(&[here, there]), Ok(()));
    let not_a_number = DVec3::new(f64::NAN, 0.0, 0.0);
    for points in [
        &[][..],
        &[here, here],
        &[here * 1e200, there * 1e200],
        &[here * 1e-200, there * 1e-200],
        &[here, not_a_number, there * f64::INFINITY],
    ] {
        assert_eq!(of(points), Err(NoExtent), "{points:?}");
    }
}
