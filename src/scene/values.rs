//! Numbers, vectors, colours and paths: their types and their ranges.

use super::layer::Node;
use super::reader::{Fields, Reader};
use super::schema::{ColorDesc, Placed, TextureFilterDesc, WrapDesc};
use super::srgb;
use crate::diag::codes;

/// Largest magnitude of a number: its square is still finite.
const MAX_MAGNITUDE: f64 = 1e150;

/// Largest radiance: sums and products of a path still fit single precision.
pub(super) const MAX_RADIANCE: f64 = 1e18;

/// Which finite numbers are allowed.
#[derive(Clone, Copy, Debug)]
pub(super) enum Domain {
    Any,
    Positive,
    NonNegative,
    /// 0 to 1, both included.
    Unit,
    /// Between two numbers, both excluded.
    Between(f64, f64),
    /// From 0 to a number, both included.
    UpTo(f64),
}

impl Domain {
    fn contains(self, x: f64) -> bool {
        match self {
            Domain::Any => true,
            Domain::Positive => x > 0.0,
            Domain::NonNegative => x >= 0.0,
            Domain::Unit => (0.0..=1.0).contains(&x),
            Domain::Between(low, high) => x > low && x < high,
            Domain::UpTo(high) => (0.0..=high).contains(&x),
        }
    }

    /// What a number should be instead of `x`.
    fn words(self, x: f64) -> String {
        match self {
            Domain::Any => "a number".to_owned(),
            Domain::Positive => "above 0".to_owned(),
            Domain::NonNegative => "0 or above".to_owned(),
            Domain::Unit => "from 0 to 1".to_owned(),
            Domain::Between(low, high) => format!("above {low} and below {high}"),
            Domain::UpTo(MAX_RADIANCE) if x < 0.0 => Domain::NonNegative.words(x),
            Domain::UpTo(MAX_RADIANCE) => format!("from 0 to {MAX_RADIANCE:e}"),
            Domain::UpTo(high) => format!("from 0 to {high}"),
        }
    }
}

impl<'a> Reader<'a> {
    /// A finite number within `domain`.
    pub(super) fn number(&self, node: Node<'a>, name: &str, domain: Domain) -> Option<f64> {
        let Some(x) = node.number() else {
            return self.wrong_type(node, name, "a number");
        };
        if !x.is_finite() {
            let message = match node.text.contains(|c: char| c.is_ascii_digit()) {
                true => format!("{name} is too large for a number: {}", node.text),
                false => format!("{name} must be finite, not {}", node.text),
            };
            self.error(codes::NOT_FINITE, node, message);
            return None;
        }
        if x.abs() > MAX_MAGNITUDE {
            let message = format!(
                "{name} must be within ±{MAX_MAGNITUDE:e}, not {}",
                node.text
            );
            self.error(codes::OUT_OF_RANGE, node, message);
            return None;
        }
        if !domain.contains(x) {
            let message = format!("{name} must be {}, not {}", domain.words(x), node.text);
            match domain {
                Domain::Unit if x > 1.0 => {
                    self.error_hint(
                        codes::OUT_OF_RANGE,
                        node,
                        message,
                        "above 1 it would give back more light than it gets",
                    );
                }
                _ => self.error(codes::OUT_OF_RANGE, node, message),
            }
            return None;
        }
        Some(x)
    }

    /// A whole number from `low` to `high`.
    pub(super) fn whole(&self, node: Node<'a>, name: &str, low: u32, high: u32) -> Option<u32> {
        match (node.literal::<u32>(), node.literal::<f64>()) {
            (Ok(n), _) if (low..=high).contains(&n) => Some(n),
            (_, Ok(x)) if !x.is_finite() || x.fract() != 0.0 || node.text.contains('.') => {
                self.wrong_type(node, name, "a whole number")
            }
            (_, Ok(x)) => {
                let range = if x < f64::from(low) {
                    format!("{low} or above")
                } else {
                    format!("{high} or below")
                };
                let message = format!("{name} must be {range}, not {}", node.text);
                self.error(codes::OUT_OF_RANGE, node, message);
                None
            }
            (_, Err(_)) => self.wrong_type(node, name, "a whole number"),
        }
    }

    /// `true` or `false`.
    pub(super) fn truth(&self, node: Node<'a>, name: &str) -> Option<bool> {
        node.literal()
            .ok()
            .or_else(|| self.wrong_type(node, name, "true or false"))
    }

    /// A string.
    pub(super) fn string(&self, node: Node<'a>, name: &str) -> Option<String> {
        node.string()
            .or_else(|| self.wrong_type(node, name, "a string"))
    }

    /// `N` numbers in parentheses.
    pub(super) fn vector<const N: usize>(
        &self,
        node: Node<'a>,
        name: &str,
        domain: Domain,
    ) -> Option<[f64; N]> {
        let wanted = format!("{N} numbers in parentheses");
        let items = self.layer(node, node.tuple(), name, &wanted)?;
        if items.len() != N {
            return self.wrong_type(node, name, &wanted);
        }
        let mut values = [Some(0.0); N];
        for (value, item) in values.iter_mut().zip(items) {
            *value = self.number(item, name, domain);
        }
        if values.contains(&None) {
            return None;
        }
        Some(values.map(|v| v.unwrap_or_default()))
    }

    /// A vector that is not zero.
    pub(super) fn direction<const N: usize>(&self, node: Node<'a>, name: &str) -> Option<[f64; N]> {
        let v = self.vector(node, name, Domain::Any)?;
        if v.iter().all(|&x| x == 0.0) {
            self.error(
                codes::DEGENERATE,
                node,
                format!("{name} must not have length 0"),
            );
            return None;
        }
        Some(v)
    }

    /// A path of a file, as written.
    pub(super) fn path(&self, node: Node<'a>, name: &str) -> Option<Placed<String>> {
        let value = self.string(node, name)?;
        if value.contains("://") {
            let hint = "download the file and name it here";
            self.error_hint(
                codes::BAD_PATH,
                node,
                format!("the path of {name} must be a file, not an address"),
                hint,
            );
            return None;
        }
        if value.trim().is_empty() {
            self.error(
                codes::BAD_PATH,
                node,
                format!("the path of {name} is empty"),
            );
            return None;
        }
        Some(Placed {
            value,
            at: node.at,
            len: node.text.len(),
        })
    }

    /// The one value of a variant such as `Mesh("cat.obj")`.
    pub(super) fn single(&self, body: Node<'a>, variant: &str, wanted: &str) -> Option<Node<'a>> {
        let items = self.layer(body, body.tuple(), &format!("`{variant}`"), wanted)?;
        match items.as_slice() {
            [one] => Some(*one),
            _ => self.wrong_type(body, &format!("`{variant}`"), wanted),
        }
    }

    /// A colour that reflects: from 0 to 1.
    pub(super) fn color(&self, node: Node<'a>, name: &str) -> Option<ColorDesc> {
        let (variant, body) =
            self.color_variant(node, name, &["Linear", "Srgb", "Texture", "Image"])?;
        match variant {
            "Linear" => self.vector(body, name, Domain::Unit).map(ColorDesc::Linear),
            "Srgb" => self.srgb(body).map(ColorDesc::Linear),
            "Image" => self.image(body),
            _ => Some(ColorDesc::Image {
                path: self.path(
                    self.single(body, "Texture", "Texture(\"file\")")?,
                    "the texture",
                )?,
                wrap: WrapDesc::default(),
                filter: TextureFilterDesc::default(),
            }),
        }
    }

    /// One of the variants `known` of a colour, which says its space.
    pub(super) fn color_variant(
        &self,
        node: Node<'a>,
        name: &str,
        known: &[&'static str],
    ) -> Option<(&'static str, Node<'a>)> {
        if node.tuple().is_ok_and(|items| items.len() == 3) {
            let hint = format!("a colour says its space: Linear{}", node.text);
            self.error_hint(
                codes::WRONG_TYPE,
                node,
                format!("{name} is a colour without a space"),
                hint,
            );
            return None;
        }
        self.variant(node, name, known)
    }

    /// What stands in `Srgb("#rrggbb")`, linear.
    pub(super) fn srgb(&self, body: Node<'a>) -> Option<[f64; 3]> {
        let node = self.single(body, "Srgb", "Srgb(\"#rrggbb\")")?;
        let hex = self.string(node, "`Srgb`")?;
        let color = srgb::decode_hex(&hex);
        if color.is_none() {
            let hint = "write # and six hexadecimal digits, as in \"#c0ffee\"";
            self.error_hint(
                codes::BAD_HEX,
                node,
                format!("{hex:?} is not a colour"),
                hint,
            );
        }
        color
    }

    fn image(&self, body: Node<'a>) -> Option<ColorDesc> {
        let fields = Fields::read(self, body, "`Image`", &["path", "wrap", "filter"])?;
        let path = fields.require("path", |r, n| r.path(n, "the image"));
        let wrap = fields.read_or("wrap", WrapDesc::default(), |r, n| {
            let (variant, body) = r.variant(n, "`wrap`", &["Repeat", "Mirror", "Clamp"])?;
            r.no_fields(body, variant)?;
            Some(match variant {
                "Repeat" => WrapDesc::Repeat,
                "Mirror" => WrapDesc::Mirror,
                _ => WrapDesc::Clamp,
            })
        });
        let filter = fields.read_or("filter", TextureFilterDesc::default(), texture_filter);
        Some(ColorDesc::Image {
            path: path?,
            wrap,
            filter,
        })
    }

    /// Refuses what the format knows but the renderer cannot do yet.
    pub(super) fn not_yet(&self, node: Node<'_>, what: &str) {
        self.error(
            codes::NOT_YET,
            node,
            format!("{what} cannot be rendered yet"),
        );
    }
}

/// `Bilinear` or `Nearest`.
pub(super) fn texture_filter<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<TextureFilterDesc> {
    let (variant, body) = reader.variant(node, "`filter`", &["Bilinear", "Nearest"])?;
    reader.no_fields(body, variant)?;
    Some(match variant {
        "Bilinear" => TextureFilterDesc::Bilinear,
        _ => TextureFilterDesc::Nearest,
    })
}
