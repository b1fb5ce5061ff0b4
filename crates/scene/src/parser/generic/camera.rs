//! Cameras.

use super::super::Parser;
use super::value::Parameters;
use crate::description::{Camera, Lens, Name, Transform, TransformKind, View};
use crate::source::{Span, Spanned};

/// Declares a camera. False if there is none of that type.
pub(super) fn camera(parser: &mut Parser<'_>, p: &mut Parameters, class: &Name, span: Span) -> bool {
    let positive = |value: Option<f32>, default: f32| value.filter(|value| *value > 0.0).unwrap_or(default);
    let fov = p.float("fov").filter(|fov| *fov > 0.0 && *fov < 180.0).unwrap_or(90.0);
    let aspect = positive(p.float("aspect"), 1.0);
    let shift = [p.float("shift.x").unwrap_or(0.0), p.float("shift.y").unwrap_or(0.0)];
    let lens = match class.value.as_str() {
        "pinhole" => Lens::Pinhole { fov, aspect, shift },
        "thinlens" => Lens::Thinlens {
            fov,
            aspect,
            shift,
            fdist: positive(p.float("focus.distance"), 1.0),
            lensr: p.float("lens.radius").unwrap_or(0.0),
            sides: p.whole("lens.sides", 0, 1000).unwrap_or(0),
            rotation: p.float("lens.rotation").unwrap_or(0.0),
        },
        "spherical" => Lens::Spherical,
        "fisheye" => Lens::Fisheye,
        _ => return false,
    };
    let shutter = p.float("shutter.open").zip(p.float("shutter.close"));
    let kind = p.transform().unwrap_or(TransformKind::Ops(Vec::new()));
    let view = View::Transform(Transform { kind, span });
    let shutter = shutter.map(|(open, close)| Spanned::new([open, close], span));
    parser.scene.cameras.push(Camera { lens, view, shutter, span });
    true
}
