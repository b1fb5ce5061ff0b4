//! Reads the `camera` block.

use super::block::{Grammar, Key, Required};
use super::value::unknown_word;
use super::{Failed, Parsed, Parser};
use crate::description::{Camera, Lens, Transform, TransformKind, View};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::source::{Span, Spanned};

/// The keywords of a camera as far as they were written.
#[derive(Debug, Default)]
struct Draft {
    shutter: Option<Spanned<[f32; 2]>>,
    eye: Option<[f32; 3]>,
    target: Option<[f32; 3]>,
    up: Option<[f32; 3]>,
    transform: Option<Transform>,
    fov: f32,
    aspect: f32,
    shift: [f32; 2],
    fdist: f32,
    lensr: f32,
    sides: u32,
    rotation: f32,
}

/// A lens: its own keywords, beside those of [`COMMON`].
struct LensType {
    name: &'static str,
    keys: &'static [&'static str],
    required: &'static [Required],
    build: fn(&Draft) -> Lens,
}

const FOV: Required = (&["fov"], "fov 60");
const ASPECT: Required = (&["aspect"], "aspect 1.333");

const LENSES: &[LensType] = &[
    LensType {
        name: "pinhole",
        keys: &["fov", "aspect", "shift"],
        required: &[FOV, ASPECT],
        build: |d| Lens::Pinhole { fov: d.fov, aspect: d.aspect, shift: d.shift },
    },
    LensType {
        name: "thinlens",
        keys: &["fov", "aspect", "shift", "fdist", "lensr", "sides", "rotation"],
        required: &[FOV, ASPECT, (&["fdist"], "fdist 10"), (&["lensr"], "lensr 0.1")],
        build: |d| Lens::Thinlens {
            fov: d.fov,
            aspect: d.aspect,
            shift: d.shift,
            fdist: d.fdist,
            lensr: d.lensr,
            sides: d.sides,
            rotation: d.rotation,
        },
    },
    LensType { name: "spherical", keys: &[], required: &[], build: |_| Lens::Spherical },
    LensType { name: "fisheye", keys: &[], required: &[], build: |_| Lens::Fisheye },
];

/// What a camera that is not given by a transform needs.
const LOOK_AT: [Required; 3] =
    [(&["eye", "transform"], "eye 0 0 5"), (&["target"], "target 0 0 0"), (&["up"], "up 0 1 0")];

/// The keywords of every camera.
const COMMON: [&str; 7] = ["type", "shutter", "transform", "eye", "target", "up", "steps"];

const KEYS: &[Key<Draft>] = &[
    Key::new("type", "type pinhole", |p, _, _| p.word("a lens").map(drop)),
    Key::new("shutter", "shutter 0 1", |p, d, _| {
        d.shutter = Some(p.spanned(Parser::numbers)?);
        Ok(())
    }),
    Key::new("transform", "transform { translate 0 0 5 }", |p, d, _| {
        d.transform = Some(p.transform()?);
        Ok(())
    }),
    Key::new("eye", "eye 0 0 5", |p, d, _| {
        d.eye = Some(p.numbers()?);
        Ok(())
    }),
    Key::new("target", "target 0 0 0", |p, d, _| {
        d.target = Some(p.numbers()?);
        Ok(())
    }),
    Key::new("up", "up 0 1 0", |p, d, _| {
        d.up = Some(p.numbers()?);
        Ok(())
    }),
    Key::new("steps", "steps 2 times 0 1 { eye 0 0 5 target 0 0 0 up 0 1 0 } …", |p, d, span| {
        let kind = p.steps(camera_step)?;
        let end = p.lexer.position() as u32;
        d.transform = Some(Transform { kind, span: Span { end, ..span } });
        Ok(())
    }),
    Key::new("fov", "fov 60", |p, d, _| {
        let fov = p.spanned(Parser::number::<f32>)?;
        p.require_between("`fov`", fov, 0.0, 180.0)?;
        d.fov = fov.value;
        Ok(())
    }),
    Key::new("aspect", "aspect 1.333", |p, d, _| {
        d.aspect = p.positive("`aspect`")?;
        Ok(())
    }),
    Key::new("shift", "shift 0 0", |p, d, _| {
        d.shift = p.numbers()?;
        Ok(())
    }),
    Key::new("fdist", "fdist 10", |p, d, _| {
        d.fdist = p.positive("`fdist`")?;
        Ok(())
    }),
    Key::new("lensr", "lensr 0.1", |p, d, _| {
        d.lensr = p.number()?;
        Ok(())
    }),
    Key::new("sides", "sides 6", |p, d, _| {
        let sides = p.spanned(Parser::int)?;
        d.sides = p.clamped("`sides`", sides, 0, 1000) as u32;
        Ok(())
    }),
    Key::new("rotation", "rotation 30", |p, d, _| {
        d.rotation = p.number()?;
        Ok(())
    }),
];

pub(super) fn camera(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("camera")?;
    let place = parser.span(head);
    let Some(kind) = parser.outline().kind else {
        let remark = parser.missing_type(head, "camera", LENSES.iter().map(|lens| lens.name));
        parser.skip_block(head, Some(remark));
        return Ok(());
    };
    let Some(lens) = LENSES.iter().find(|lens| lens.name == kind.value) else {
        let diagnostic = unknown_word("camera type", &kind, LENSES.iter().map(|lens| lens.name));
        parser.skip_block(head, Some(diagnostic));
        return Ok(());
    };
    let mut draft = Draft { fov: 90.0, aspect: 1.0, fdist: 1.0, ..Draft::default() };
    let outcome = parser.block(head, &Grammar { what: "camera", keys: KEYS, bare: None }, &mut draft);
    for key in KEYS.iter().filter(|key| !COMMON.contains(&key.name) && !lens.keys.contains(&key.name)) {
        if let Some(span) = outcome.place(key.name) {
            let message = format!("`{}` means nothing to a `{}` camera", key.name, lens.name);
            parser.diagnostics.push(Diagnostic::warning(span, message));
        }
    }
    let is_moved = outcome.has("transform") || outcome.has("steps");
    let view: &[Required] = if is_moved { &[] } else { &LOOK_AT };
    parser.require("camera", &outcome, place, &[lens.required, view].concat());
    if let Some(view) = draft.view() {
        let lens = (lens.build)(&draft);
        parser.scene.cameras.push(Camera { lens, view, shutter: draft.shutter, span: outcome.span });
    }
    Ok(())
}

impl Draft {
    /// Where the camera stands, if nothing is missing.
    fn view(&self) -> Option<View> {
        match &self.transform {
            Some(transform) => Some(View::Transform(transform.clone())),
            None => Some(View::LookAt { eye: self.eye?, target: self.target?, up: self.up? }),
        }
    }
}

impl Parser<'_> {
    /// A number above zero.
    pub(super) fn positive(&mut self, what: &str) -> Parsed<f32> {
        let number = self.spanned(Parser::number::<f32>)?;
        self.require_between(what, number, 0.0, f32::INFINITY)?;
        Ok(number.value)
    }

    /// Reports a number that is not strictly between its limits.
    fn require_between(&mut self, what: &str, number: Spanned<f32>, low: f32, high: f32) -> Parsed<()> {
        if number.value > low && number.value < high {
            return Ok(());
        }
        let range = match high.is_finite() {
            true => format!("between {low} and {high}"),
            false => format!("greater than {low}"),
        };
        self.failed_at = number.span.end;
        let message = format!("{what} must be {range}, and is {}", number.value);
        self.diagnostics.push(Diagnostic::error(number.span, message));
        Err(Failed)
    }
}

const STEP: &[Key<Draft>] = &[KEYS[3], KEYS[4], KEYS[5]];

/// One position of a moving camera: `transform T` or `{ eye … target … up … }`.
fn camera_step(parser: &mut Parser<'_>) -> Parsed<TransformKind> {
    if parser.take("transform").is_some() {
        return parser.still_transform();
    }
    if parser.take("{").is_none() {
        let found = parser.peek();
        return Err(parser.expected("`{` or `transform`", found));
    }
    let mut draft = Draft::default();
    while parser.take("}").is_none() {
        let found = parser.next();
        let Some(key) = found.and_then(|token| STEP.iter().find(|key| parser.is(token, key.name))) else {
            return Err(parser.expected("`eye`, `target`, `up` or `}`", found));
        };
        let span = parser.end_span();
        (key.read)(parser, &mut draft, span)?;
    }
    let (Some(eye), Some(target), Some(up)) = (draft.eye, draft.target, draft.up) else {
        let found = parser.peek();
        return Err(parser.expected("`eye`, `target` and `up` in each step", found));
    };
    Ok(TransformKind::Matrix(look_at(eye, target, up)))
}

/// The camera-to-world matrix of a view (format reference, §2.7).
fn look_at(eye: [f32; 3], target: [f32; 3], up: [f32; 3]) -> [[f64; 4]; 4] {
    let [eye, target, up] = [eye, target, up].map(|vector| vector.map(f64::from));
    let w = normalize([eye[0] - target[0], eye[1] - target[1], eye[2] - target[2]]);
    let u = normalize(cross(up, w));
    let v = cross(w, u);
    let row = |i: usize| [u[i], v[i], w[i], eye[i]];
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A direction of length one; no direction stays none.
fn normalize(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    if length > 0.0 { v.map(|x| x / length) } else { v }
}

/// All words of the block, for the test of the page on the format.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    KEYS.iter().map(|key| key.name).chain(LENSES.iter().map(|lens| lens.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_becomes_a_matrix() {
        let matrix = look_at([0.0, -5.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]);
        let expected = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, -5.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]];
        assert_eq!(matrix, expected);
    }

    #[test]
    fn a_step_takes_the_keywords_of_a_view() {
        assert_eq!(STEP.iter().map(|key| key.name).collect::<Vec<_>>(), ["eye", "target", "up"]);
    }
}
