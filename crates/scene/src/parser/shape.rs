//! Reads the objects that few words describe: patches, analytic shapes, points, and triangles of other files.

use super::block::{Key, Outcome, Required};
use super::object::{Draft, ObjectType};
use super::value::put;
use super::{Parsed, Parser};
use crate::description::{BezierNet, ByteOrder, Geometry, Hair, Name, PointSource, Tessellation};
use crate::diagnostic::Diagnostic;
use crate::source::{Span, Spanned};

/// So many triangles or spheres are made in all for the shapes of a scene that do not list them one by one. They take
/// about 2 GB; nothing that is looked at needs more.
const MOST_GENERATED: u64 = 20_000_000;
/// Patches of the teapot and of the elephant.
pub(super) const TEAPOT_PATCHES: u64 = 32;
pub(super) const GUMBO_PATCHES: u64 = 128;
/// Sunflow draws no deeper flakes.
const DEEPEST_FLAKE: i64 = 20;

/// The keywords of these shapes as far as they were written.
#[derive(Default)]
pub(super) struct ShapeDraft {
    file: Option<Name>,
    smooth_normals: Option<bool>,
    size: Option<Spanned<[u32; 2]>>,
    wrap: Option<[bool; 2]>,
    points: Option<Vec<[f32; 3]>>,
    subdivs: Option<Spanned<u32>>,
    smooth: Option<bool>,
    radii: Option<[f32; 2]>,
    level: Option<u32>,
    axis: Option<[f32; 3]>,
    radius: Option<f32>,
    quaternion: Option<[f32; 4]>,
    iterations: Option<u32>,
    epsilon: Option<f32>,
    segments: Option<u32>,
    width: Option<f32>,
    order: ByteOrder,
    count: Option<u32>,
}

const SUBDIVS: Key<Draft> = Key::new("subdivs", "subdivs 8", |p, d, _| {
    put(&mut d.shape.subdivs, p.spanned(|p| p.whole("`subdivs`", 1, 100_000)))
});
const SMOOTH: Key<Draft> =
    Key::new("smooth", "smooth true", |p, d, _| put(&mut d.shape.smooth, p.boolean().map(|smooth| smooth.value)));
const FILENAME: Key<Draft> =
    Key::new("filename", "filename \"mesh.obj\"", |p, d, _| put(&mut d.shape.file, p.word("a file name")));
const RADIUS: Key<Draft> = Key::new("radius", "radius 0.1", |p, d, _| put(&mut d.shape.radius, p.positive("`radius`")));
const PARTICLES: &[Key<Draft>] = &[
    FILENAME,
    Key::new("little_endian", "little_endian", |_, d, _| {
        d.shape.order = ByteOrder::LittleEndian;
        Ok(())
    }),
    Key::new("points", "points 2 0 0 0 1 0 0", |p, d, key| {
        let count = p.count()?;
        put(&mut d.shape.points, p.point_list(key, count))
    }),
    Key::new("num", "num 1000", |p, d, _| put(&mut d.shape.count, p.whole("`num`", 0, i64::from(u32::MAX)))),
    RADIUS,
];

/// The shapes of this module.
pub(super) const TYPES: &[ObjectType] = &[
    ObjectType {
        name: "file-mesh",
        keys: &[
            FILENAME,
            Key::new("smooth_normals", "smooth_normals true", |p, d, _| {
                put(&mut d.shape.smooth_normals, p.boolean().map(|smooth| smooth.value))
            }),
        ],
        bare: None,
        build: |p, d, outcome, head| {
            p.require("file-mesh", outcome, head, &[(&["filename"], "filename \"mesh.obj\"")]);
            let smooth_normals = d.shape.smooth_normals.unwrap_or(false);
            Some(Geometry::FileMesh { file: d.shape.file.take()?, smooth_normals })
        },
    },
    ObjectType {
        name: "bezier-mesh",
        keys: &[
            Key::new("n", "n 4 4", |p, d, _| {
                put(&mut d.shape.size, p.spanned(|p| Ok([p.whole("`n`", 3, 65536)?, p.whole("`n`", 3, 65536)?])))
            }),
            Key::new("wrap", "wrap false false", |p, d, _| {
                put(&mut d.shape.wrap, p.boolean().and_then(|u| Ok([u.value, p.boolean()?.value])))
            }),
            Key::new("points", "points 0 0 0 1 0 0 …", |p, d, key| {
                let count = d.shape.size.map_or(0, |size| size.value[0] as usize * size.value[1] as usize);
                match d.shape.size {
                    Some(_) => put(&mut d.shape.points, p.point_list(key, count)),
                    // How many there should be is told later.
                    None => put(&mut d.shape.points, p.any_points(key)),
                }
            }),
            SUBDIVS,
            SMOOTH,
        ],
        bare: None,
        build: bezier_mesh,
    },
    ObjectType {
        name: "teapot",
        keys: &[SUBDIVS, SMOOTH],
        bare: None,
        build: |p, d, _, head| Some(Geometry::Teapot(p.tessellation(&d.shape, TEAPOT_PATCHES, head)?)),
    },
    ObjectType {
        name: "gumbo",
        keys: &[SUBDIVS, SMOOTH],
        bare: None,
        build: |p, d, _, head| Some(Geometry::Gumbo(p.tessellation(&d.shape, GUMBO_PATCHES, head)?)),
    },
    ObjectType {
        name: "torus",
        keys: &[Key::new("r", "r 0.25 1", |p, d, _| {
            let tube = p.positive("the radius of the tube")?;
            put(&mut d.shape.radii, p.positive("the radius of the ring").map(|ring| [tube, ring]))
        })],
        bare: None,
        build: |p, d, outcome, head| {
            p.require("torus", outcome, head, &[(&["r"], "r 0.25 1")]);
            let [tube, ring] = d.shape.radii?;
            Some(Geometry::Torus { tube, ring })
        },
    },
    ObjectType { name: "cylinder", keys: &[], bare: None, build: |_, _, _, _| Some(Geometry::Cylinder) },
    ObjectType { name: "banchoff", keys: &[], bare: None, build: |_, _, _, _| Some(Geometry::Banchoff) },
    ObjectType {
        name: "sphereflake",
        keys: &[
            Key::new("level", "level 2", |p, d, _| {
                let level = p.spanned(Parser::int)?;
                d.shape.level = Some(p.clamped("`level`", level, 0, DEEPEST_FLAKE) as u32);
                Ok(())
            }),
            Key::new("axis", "axis 0 0 1", |p, d, _| put(&mut d.shape.axis, p.direction())),
            RADIUS,
        ],
        bare: None,
        build: |_, d, _, _| {
            let (level, radius) = (d.shape.level.unwrap_or(2), d.shape.radius.unwrap_or(1.0));
            Some(Geometry::SphereFlake { level, axis: d.shape.axis.unwrap_or([0.0, 0.0, 1.0]), radius })
        },
    },
    ObjectType {
        name: "julia",
        keys: &[
            Key::new("q", "q -0.4 0.2 0.3 -0.2", |p, d, _| put(&mut d.shape.quaternion, p.numbers())),
            Key::new("iterations", "iterations 15", |p, d, _| {
                put(&mut d.shape.iterations, p.whole("`iterations`", 0, 1000))
            }),
            Key::new("epsilon", "epsilon 0.00001", |p, d, _| put(&mut d.shape.epsilon, p.positive("`epsilon`"))),
        ],
        bare: None,
        build: |_, d, _, _| {
            let c = d.shape.quaternion.unwrap_or([-0.4, 0.2, 0.3, -0.2]);
            let (iterations, epsilon) = (d.shape.iterations.unwrap_or(15), d.shape.epsilon.unwrap_or(1e-5));
            Some(Geometry::Julia { c, iterations, epsilon })
        },
    },
    ObjectType {
        name: "hair",
        keys: &[
            Key::new("segments", "segments 5", |p, d, _| {
                put(&mut d.shape.segments, p.whole("`segments`", 1, 1_000_000))
            }),
            Key::new("width", "width 0.01", |p, d, _| put(&mut d.shape.width, p.positive("`width`"))),
            Key::new("points", "points 6 0 0 0 0 0 1", |p, d, key| {
                let count = p.count()?;
                put(&mut d.shape.points, p.flat_point_list(key, count))
            }),
        ],
        bare: None,
        build: hair,
    },
    ObjectType { name: "particles", keys: PARTICLES, bare: None, build: particles },
    ObjectType { name: "dlasurface", keys: PARTICLES, bare: None, build: particles },
];

fn bezier_mesh(parser: &mut Parser<'_>, draft: &mut Draft, outcome: &Outcome, head: Span) -> Option<Geometry> {
    parser.require("bezier-mesh", outcome, head, &[(&["n"], "n 4 4"), (&["points"], "points X Y Z …")]);
    let (size, points) = (draft.shape.size?, draft.shape.points.take()?);
    let net = BezierNet { size: size.value, wrap: draft.shape.wrap.unwrap_or_default(), points };
    let needed = u64::from(net.size[0]) * u64::from(net.size[1]);
    if net.points.len() as u64 != needed {
        let [u, v] = net.size;
        let message = format!("a net of {u} × {v} needs {needed} points, found {}", net.points.len());
        parser.diagnostics.push(Diagnostic::error(outcome.place("points"), message));
        return None;
    }
    for (axis, fits) in [0, 1].map(|axis| (axis, if net.wrap[axis] { 0 } else { 1 })) {
        if net.size[axis] % 3 != fits || net.patches()[axis] == 0 {
            let message = format!("{} points do not make patches", net.size[axis]);
            let hint = match fits {
                0 => "with `wrap true` their number is a multiple of 3",
                _ => "their number is 4, or 3 more for each further patch: 4, 7, 10 …",
            };
            parser.diagnostics.push(Diagnostic::warning(size.span, message).hint(hint));
        }
    }
    let [u, v] = net.patches();
    let tessellation = parser.tessellation(&draft.shape, u64::from(u) * u64::from(v), head)?;
    Some(Geometry::BezierMesh { net, tessellation })
}

fn hair(parser: &mut Parser<'_>, draft: &mut Draft, outcome: &Outcome, head: Span) -> Option<Geometry> {
    let required: &[Required] =
        &[(&["segments"], "segments 5"), (&["width"], "width 0.01"), (&["points"], "points N X Y Z …")];
    parser.require("hair", outcome, head, required);
    let (segments, width, points) = (draft.shape.segments?, draft.shape.width?, draft.shape.points.take()?);
    let per_strand = segments as usize + 1;
    if points.len() % per_strand != 0 {
        let message = format!("{} points do not make strands of {segments} segments", points.len());
        let hint = format!("each strand has {per_strand} points; `points` counts numbers, three for each");
        parser.diagnostics.push(Diagnostic::error(outcome.place("points"), message).hint(hint));
        return None;
    }
    Some(Geometry::Hair(Hair { segments, width, points }))
}

fn particles(parser: &mut Parser<'_>, draft: &mut Draft, outcome: &Outcome, head: Span) -> Option<Geometry> {
    let required: &[Required] = &[(&["points", "filename"], "points N X Y Z …"), (&["radius"], "radius 0.1")];
    parser.require("particles", outcome, head, required);
    let shape = &mut draft.shape;
    let points = match (shape.file.take(), shape.points.take()) {
        (Some(file), None) => PointSource::File { file, order: shape.order },
        (None, Some(points)) => PointSource::Points(points),
        (Some(_), Some(_)) => {
            let diagnostic = Diagnostic::error(outcome.place("points"), "the points are here and in a file");
            let label = outcome.place("filename").map(|span| (span, "the file"));
            let diagnostic = label.into_iter().fold(diagnostic, |d, (span, what)| d.label(span, what));
            parser.diagnostics.push(diagnostic.hint("write one of `points` and `filename`"));
            return None;
        }
        (None, None) => return None,
    };
    Some(Geometry::Particles { points, count: shape.count, radius: shape.radius? })
}

impl Parser<'_> {
    /// How `patches` patches become triangles, unless these are too many.
    fn tessellation(&mut self, shape: &ShapeDraft, patches: u64, head: Span) -> Option<Tessellation> {
        let default = Tessellation::default();
        let subdivs = shape.subdivs.map_or(default.subdivs, |subdivs| subdivs.value);
        let place = shape.subdivs.map_or(head, |subdivs| subdivs.span);
        self.bounded(Tessellation { subdivs, smooth: shape.smooth.unwrap_or(default.smooth) }, patches, place)
    }

    /// The tessellation of `patches` patches, unless these become too many triangles.
    pub(super) fn bounded(&mut self, tessellation: Tessellation, patches: u64, place: Span) -> Option<Tessellation> {
        let subdivs = tessellation.subdivs;
        let triangles = patches * 2 * u64::from(subdivs) * u64::from(subdivs);
        self.generated = self.generated.saturating_add(triangles);
        if self.generated > MOST_GENERATED {
            let message = format!("the shape has {triangles} triangles: too many, or too many with those before it");
            let diagnostic = Diagnostic::error(place, message);
            let hint = format!("use a smaller `subdivs`: a scene may make {MOST_GENERATED} triangles from patches");
            self.diagnostics.push(diagnostic.hint(hint));
            self.generated -= triangles;
            return None;
        }
        Some(tessellation)
    }

    /// A whole number within its limits.
    pub(super) fn whole(&mut self, what: &str, min: i64, max: i64) -> Parsed<u32> {
        let number = self.spanned(Parser::int)?;
        if number.value < min || number.value > max {
            let message = format!("{what} must be from {min} to {max}, and is {}", number.value);
            return Err(self.refuse(number.span, message));
        }
        Ok(number.value as u32)
    }
}
