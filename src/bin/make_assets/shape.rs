//! The cat as an implicit surface: tapered capsules and ellipsoids under a smooth union.
//!
//! Enters: a point. Leaves: a signed value (negative inside, close to a distance near the surface), its gradient and
//! the body part that owns the point. Deliberately absent: triangles and colours.
//!
//! Space: Y up, the cat sits at the origin and faces +Z, so its left is +X; it is about one unit tall and stands on
//! y = 0. The head is modelled upright and turned afterwards by rational rotations (Pythagorean triples), so that no
//! transcendental function is needed.

use luxel::math::DVec3;

/// What a point of the cat belongs to. Left is the cat's own left, +X.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Part {
    Body,
    Head,
    EarLeft,
    EarRight,
    ForeLeft,
    ForeRight,
    HindLeft,
    HindRight,
    Tail,
}

/// A primitive of the union.
#[derive(Clone, Copy)]
enum Form {
    /// Around a segment, with a radius that goes linearly from one end to the other.
    Capsule(DVec3, DVec3, f64, f64),
    /// Axis-aligned: centre and radii.
    Ellipsoid(DVec3, DVec3),
    /// A flattened, pointed capsule hollowed from the front: base, tip.
    Ear(DVec3, DVec3),
}

/// A primitive, the part it belongs to, and the width of the fillet with what stands before it in the list.
#[derive(Clone, Copy)]
struct Blob {
    part: Part,
    form: Form,
    fillet: f64,
}

/// The pivot about which the head is turned.
const HEAD_PIVOT: DVec3 = v(0.0, 0.66, 0.07);
/// Cosine and sine of the head's turn to its left (12.7 degrees) and of its tilt (7.6 degrees).
const TURN: (f64, f64) = (40.0 / 41.0, 9.0 / 41.0);
const TILT: (f64, f64) = (112.0 / 113.0, 15.0 / 113.0);
/// Fillet between the cat and the ground plane that cuts it off flat.
const SOLE_FILLET: f64 = 0.015;
/// How much thinner than wide an ear is.
const EAR_SQUEEZE: DVec3 = v(1.0, 1.0, 1.35);
/// The tail's axis and radii: from the rump to the cat's left, with the tip lifted.
const TAIL: [(DVec3, f64); 8] = [
    (v(0.0, 0.1, -0.34), 0.055),
    (v(0.1, 0.06, -0.44), 0.052),
    (v(0.22, 0.05, -0.47), 0.05),
    (v(0.33, 0.05, -0.42), 0.049),
    (v(0.4, 0.05, -0.32), 0.048),
    (v(0.425, 0.07, -0.2), 0.046),
    (v(0.425, 0.13, -0.1), 0.044),
    (v(0.44, 0.21, -0.06), 0.038),
];
/// Half step of central differences for the gradient: far below every feature, far above rounding.
const GRADIENT_STEP: f64 = 1e-5;

/// A box around the cat.
pub(crate) const BOUNDS: (DVec3, DVec3) = (v(-0.42, -0.06, -0.62), v(0.54, 1.12, 0.46));

const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The cat.
pub(crate) struct Cat {
    blobs: Vec<Blob>,
}

impl Cat {
    /// Sitting, its head a little turned, its tail around its left side.
    pub(crate) fn sitting() -> Cat {
        let mut blobs = Vec::new();
        torso(&mut blobs);
        for side in [1.0, -1.0] {
            hind_leg(&mut blobs, side);
            fore_leg(&mut blobs, side);
        }
        tail(&mut blobs);
        head(&mut blobs);
        Cat { blobs }
    }

    /// The field: negative inside.
    pub(crate) fn value(&self, p: DVec3) -> f64 {
        let in_head = to_head(p);
        let mut sum = f64::INFINITY;
        for blob in &self.blobs {
            let d = blob.form.value(blob.point(p, in_head));
            sum = if sum == f64::INFINITY {
                d
            } else {
                smooth_min(sum, d, blob.fillet)
            };
        }
        -smooth_min(-sum, p.y, SOLE_FILLET)
    }

    /// The gradient, by central differences.
    pub(crate) fn gradient(&self, p: DVec3) -> DVec3 {
        let slope = |e: DVec3| {
            (self.value(p + e * GRADIENT_STEP) - self.value(p - e * GRADIENT_STEP))
                / (2.0 * GRADIENT_STEP)
        };
        v(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z))
    }

    /// The part whose primitives are nearest.
    pub(crate) fn part(&self, p: DVec3) -> Part {
        let in_head = to_head(p);
        let mut best = (f64::INFINITY, Part::Body);
        for blob in &self.blobs {
            let d = blob.form.value(blob.point(p, in_head));
            if d < best.0 {
                best = (d, blob.part);
            }
        }
        best.1
    }

    /// `p` moved to the surface by Newton steps along the gradient.
    pub(crate) fn project(&self, p: DVec3, steps: usize) -> DVec3 {
        (0..steps).fold(p, |q, _| {
            let g = self.gradient(q);
            q - g * (self.value(q) / g.length_squared().max(0.1))
        })
    }
}

/// `p` in the frame in which the head is modelled: upright and facing +Z.
pub(crate) fn to_head(p: DVec3) -> DVec3 {
    let q = p - HEAD_PIVOT;
    let (c, s) = TURN;
    let q = v(c * q.x - s * q.z, q.y, s * q.x + c * q.z);
    let (c, s) = TILT;
    v(c * q.x + s * q.y, c * q.y - s * q.x, q.z) + HEAD_PIVOT
}

impl Blob {
    fn point(&self, p: DVec3, in_head: DVec3) -> DVec3 {
        match self.part {
            Part::Head | Part::EarLeft | Part::EarRight => in_head,
            _ => p,
        }
    }
}

impl Form {
    fn value(&self, p: DVec3) -> f64 {
        match *self {
            Form::Capsule(a, b, ra, rb) => {
                let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                (p - a - (b - a) * t).length() - (ra + (rb - ra) * t)
            }
            Form::Ellipsoid(centre, radii) => {
                let q = (p - centre) / radii;
                let slope = (q / radii).length();
                if slope == 0.0 {
                    -radii.min_element()
                } else {
                    q.length() * (q.length() - 1.0) / slope
                }
            }
            Form::Ear(base, tip) => ear(p, base, tip),
        }
    }
}

/// A capsule squeezed in z, from which the cavity before it is taken away.
fn ear(p: DVec3, base: DVec3, tip: DVec3) -> f64 {
    let shell = squeezed(p, base, tip, 0.08, 0.021);
    -smooth_min(-shell, cavity(p, base, tip), 0.024) / 1.25
}

/// A smaller ear before the ear, further away from it at the base.
fn cavity(p: DVec3, base: DVec3, tip: DVec3) -> f64 {
    let (base, tip) = (base + v(0.0, 0.02, 0.06), tip + v(0.0, -0.035, 0.022));
    squeezed(p, base, tip, 0.05, 0.008)
}

fn squeezed(p: DVec3, base: DVec3, tip: DVec3, ra: f64, rb: f64) -> f64 {
    Form::Capsule(base * EAR_SQUEEZE, tip * EAR_SQUEEZE, ra, rb).value(p * EAR_SQUEEZE)
}

/// Base and tip of the ear of a side (1 left, −1 right), in the head's frame.
fn ear_axis(side: f64) -> (DVec3, DVec3) {
    (v(side * 0.1, 0.866, 0.075), v(side * 0.138, 1.022, 0.062))
}

/// Value of the cavity of the ear on the side of `q`, a point of the head's frame: 0 on the ear's inner skin.
pub(crate) fn ear_cavity(q: DVec3) -> f64 {
    let (base, tip) = ear_axis(if q.x > 0.0 { 1.0 } else { -1.0 });
    cavity(q, base, tip)
}

/// Length along the tail's axis of the point nearest to `p`, 0 at the rump, 1 at the tip.
pub(crate) fn along_tail(p: DVec3) -> f64 {
    let (mut best, mut length) = ((f64::INFINITY, 0.0), 0.0);
    for pair in TAIL.windows(2) {
        let (a, b) = (pair[0].0, pair[1].0);
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        let d = (p - a - (b - a) * t).length();
        if d < best.0 {
            best = (d, length + (b - a).length() * t);
        }
        length += (b - a).length();
    }
    best.1 / length
}

/// Minimum with a quadratic fillet of width `k`.
fn smooth_min(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

fn torso(blobs: &mut Vec<Blob>) {
    let mut add = |form, fillet| {
        blobs.push(Blob {
            part: Part::Body,
            form,
            fillet,
        })
    };
    add(
        Form::Ellipsoid(v(0.0, 0.215, -0.16), v(0.205, 0.215, 0.23)),
        0.1,
    );
    add(
        Form::Capsule(v(0.0, 0.26, -0.13), v(0.0, 0.52, 0.03), 0.2, 0.138),
        0.12,
    );
    add(
        Form::Ellipsoid(v(0.0, 0.43, 0.075), v(0.125, 0.15, 0.105)),
        0.08,
    );
    add(
        Form::Capsule(v(0.0, 0.52, 0.03), v(0.0, 0.69, 0.075), 0.125, 0.1),
        0.08,
    );
}

fn fore_leg(blobs: &mut Vec<Blob>, side: f64) {
    let part = if side > 0.0 {
        Part::ForeLeft
    } else {
        Part::ForeRight
    };
    let mut add = |form, fillet| blobs.push(Blob { part, form, fillet });
    add(
        Form::Capsule(
            v(side * 0.098, 0.4, 0.085),
            v(side * 0.083, 0.2, 0.135),
            0.072,
            0.052,
        ),
        0.06,
    );
    add(
        Form::Capsule(
            v(side * 0.083, 0.2, 0.135),
            v(side * 0.08, 0.05, 0.155),
            0.052,
            0.046,
        ),
        0.03,
    );
    add(
        Form::Ellipsoid(v(side * 0.078, 0.036, 0.195), v(0.054, 0.042, 0.078)),
        0.035,
    );
}

fn hind_leg(blobs: &mut Vec<Blob>, side: f64) {
    let part = if side > 0.0 {
        Part::HindLeft
    } else {
        Part::HindRight
    };
    let mut add = |form, fillet| blobs.push(Blob { part, form, fillet });
    add(
        Form::Ellipsoid(v(side * 0.168, 0.185, -0.075), v(0.088, 0.17, 0.165)),
        0.07,
    );
    add(
        Form::Capsule(
            v(side * 0.205, 0.05, -0.03),
            v(side * 0.226, 0.04, 0.08),
            0.05,
            0.046,
        ),
        0.05,
    );
    add(
        Form::Ellipsoid(v(side * 0.23, 0.036, 0.1), v(0.056, 0.041, 0.075)),
        0.03,
    );
}

fn tail(blobs: &mut Vec<Blob>) {
    for pair in TAIL.windows(2) {
        let ((a, ra), (b, rb)) = (pair[0], pair[1]);
        blobs.push(Blob {
            part: Part::Tail,
            form: Form::Capsule(a, b, ra, rb),
            fillet: 0.03,
        });
    }
}

fn head(blobs: &mut Vec<Blob>) {
    let mut add = |part, form, fillet| blobs.push(Blob { part, form, fillet });
    add(
        Part::Head,
        Form::Ellipsoid(v(0.0, 0.78, 0.095), v(0.168, 0.138, 0.14)),
        0.05,
    );
    for side in [1.0, -1.0] {
        add(
            Part::Head,
            Form::Ellipsoid(v(side * 0.088, 0.735, 0.12), v(0.088, 0.07, 0.085)),
            0.05,
        );
        add(
            Part::Head,
            Form::Ellipsoid(v(side * 0.032, 0.716, 0.222), v(0.044, 0.036, 0.042)),
            0.025,
        );
        let (base, tip) = ear_axis(side);
        let ear = Form::Ear(base, tip);
        add(
            if side > 0.0 {
                Part::EarLeft
            } else {
                Part::EarRight
            },
            ear,
            0.035,
        );
    }
    add(
        Part::Head,
        Form::Ellipsoid(v(0.0, 0.69, 0.2), v(0.04, 0.03, 0.036)),
        0.03,
    );
    add(
        Part::Head,
        Form::Capsule(v(0.0, 0.8, 0.2), v(0.0, 0.742, 0.246), 0.04, 0.024),
        0.03,
    );
}
