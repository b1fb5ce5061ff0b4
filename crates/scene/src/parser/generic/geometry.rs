//! Geometries and their instances.

use super::super::value::shorten;
use super::super::{Namespace, Parser};
use super::value::{Parameters, vertex_data};
use crate::description::{
    BezierNet, Geometry, Hair, Instance, Mesh, Name, Object, Plane, PointSource, Tessellation, Transform,
};
use crate::diagnostic::Diagnostic;
use crate::source::Span;

/// Declares a shape. False if there is none of that type.
pub(super) fn geometry(
    parser: &mut Parser<'_>,
    parameters: &mut Parameters,
    name: &Name,
    class: &Name,
    span: Span,
) -> bool {
    let geometry = match shape(parser, parameters, &class.value, span) {
        None => return false,
        Some(Some(geometry)) => geometry,
        Some(None) => {
            let message = format!("`{}` lacks parameters, or they do not fit each other", shorten(&name.value));
            parser.diagnostics.push(Diagnostic::error(span, message));
            parser.dropped_objects.entry(name.value.clone()).or_insert(name.span);
            return true;
        }
    };
    parser.declare(Namespace::Object, name);
    let (shaders, modifiers) = (Vec::new(), Vec::new());
    let name = Some(name.clone());
    parser.scene.objects.push(Object { name, shaders, modifiers, transform: None, geometry, visible: false, span });
    true
}

/// The shape of that type, if its parameters suffice.
fn shape(parser: &mut Parser<'_>, p: &mut Parameters, class: &str, span: Span) -> Option<Option<Geometry>> {
    let tessellation = |p: &mut Parameters| {
        let default = Tessellation::default();
        Tessellation {
            subdivs: p.whole("subdivs", 1, 100_000).unwrap_or(default.subdivs),
            smooth: p.bool("smooth").unwrap_or(default.smooth),
        }
    };
    Some(match class {
        "sphere" => Some(Geometry::Sphere { center: [0.0; 3], radius: 1.0 }),
        "cylinder" => Some(Geometry::Cylinder),
        "banchoff" => Some(Geometry::Banchoff),
        "triangle_mesh" => triangle_mesh(p).map(Geometry::Mesh),
        "box" => {
            // Sunflow: the corners are the box around the points.
            let points = p.points("points").filter(|points| !points.is_empty()).unwrap_or(vec![[-1.0; 3], [1.0; 3]]);
            let fold = |pick: fn(f32, f32) -> f32| {
                points.iter().copied().reduce(|a, b| std::array::from_fn(|axis| pick(a[axis], b[axis])))
            };
            fold(f32::min).zip(fold(f32::max)).map(|(a, b)| Geometry::Box { corners: [a, b] })
        }
        "plane" => {
            let point = p.point("center").unwrap_or_default();
            Some(Geometry::Plane(match (p.point("point1"), p.point("point2")) {
                (Some(a), Some(b)) => Plane::Points([point, a, b]),
                _ => Plane::Normal { point, normal: p.point("normal").unwrap_or([0.0, 1.0, 0.0]) },
            }))
        }
        "torus" => {
            let (tube, ring) = (p.float("radiusInner").unwrap_or(0.25), p.float("radiusOuter").unwrap_or(1.0));
            (tube > 0.0 && ring > 0.0).then_some(Geometry::Torus { tube, ring })
        }
        "sphereflake" => Some(Geometry::SphereFlake {
            level: p.whole("level", 0, 20).unwrap_or(2),
            axis: p.point("axis").filter(|axis| *axis != [0.0; 3]).unwrap_or([0.0, 0.0, 1.0]),
            radius: positive(p.float("radius")).unwrap_or(1.0),
        }),
        "julia" => {
            let mut component = |name: &str, default: f32| p.float(name).unwrap_or(default);
            let c = [component("cw", -0.4), component("cx", 0.2), component("cy", 0.3), component("cz", -0.2)];
            let epsilon = positive(p.float("epsilon")).unwrap_or(1e-5);
            Some(Geometry::Julia { c, iterations: p.whole("iterations", 0, 1000).unwrap_or(15), epsilon })
        }
        "hair" => {
            let segments = p.whole("segments", 1, 1_000_000).unwrap_or(1);
            let width = positive(p.float("widths").or_else(|| p.floats("widths")?.first().copied()));
            let points = p.points("points").or_else(|| {
                let numbers = p.floats("points")?;
                Some(numbers.as_chunks::<3>().0.to_vec())
            });
            let fits = |points: &Vec<[f32; 3]>| points.len().is_multiple_of(segments as usize + 1);
            points.filter(fits).zip(width).map(|(points, width)| Geometry::Hair(Hair { segments, width, points }))
        }
        "particles" => {
            let points = p.points("particles").or_else(|| Some(p.floats("particles")?.as_chunks::<3>().0.to_vec()));
            let count = p.whole("num", 0, u32::MAX);
            points.map(|points| Geometry::Particles {
                points: PointSource::Points(points),
                count,
                radius: positive(p.float("radius")).unwrap_or(1.0),
            })
        }
        "file_mesh" => {
            let smooth_normals = p.bool("smooth_normals").unwrap_or(false);
            p.string("filename").map(|file| Geometry::FileMesh { file, smooth_normals })
        }
        "bezier_mesh" => {
            let size = [p.whole("nu", 3, 65536)?, p.whole("nv", 3, 65536)?];
            let wrap = [p.bool("uwrap").unwrap_or(false), p.bool("vwrap").unwrap_or(false)];
            let points = p.points("points").unwrap_or_default();
            let net = BezierNet { size, wrap, points };
            let [u, v] = net.patches();
            let wanted = tessellation(p);
            if net.points.len() as u64 != u64::from(size[0]) * u64::from(size[1]) {
                return Some(None);
            }
            let tessellation = parser.bounded(wanted, u64::from(u) * u64::from(v), span)?;
            Some(Geometry::BezierMesh { net, tessellation })
        }
        "teapot" => {
            let wanted = tessellation(p);
            parser.bounded(wanted, super::super::shape::TEAPOT_PATCHES, span).map(Geometry::Teapot)
        }
        "gumbo" => {
            let wanted = tessellation(p);
            parser.bounded(wanted, super::super::shape::GUMBO_PATCHES, span).map(Geometry::Gumbo)
        }
        _ => return None,
    })
}

fn positive(value: Option<f32>) -> Option<f32> {
    value.filter(|value| *value > 0.0)
}

/// A mesh whose lists fit each other.
pub(super) fn triangle_mesh(p: &mut Parameters) -> Option<Mesh> {
    let (points, triangles) = (p.points("points")?, p.triangles("triangles")?);
    let in_range = triangles.iter().flatten().all(|&index| (index as usize) < points.len());
    let counts = (points.len(), triangles.len());
    let normals = vertex_data(p.varying_points("normals"), counts.0, counts.1);
    let uvs = vertex_data(p.varying_texcoords("uvs"), counts.0, counts.1);
    let face_shaders = p
        .ints("faceshaders")
        .map(|list| list.into_iter().map(|index| u32::try_from(index).unwrap_or(u32::MAX)).collect::<Vec<_>>());
    let face_shaders = face_shaders.filter(|list| list.len() == triangles.len());
    in_range.then_some(Mesh { points, triangles, normals, uvs, face_shaders })
}

/// Shows a shape: here the type is the name of the geometry.
pub(super) fn instance(
    parser: &mut Parser<'_>,
    parameters: &mut Parameters,
    name: &Name,
    geometry: &Name,
    span: Span,
) -> bool {
    parser.declare(Namespace::Object, name);
    let transform = parameters.transform().map(|kind| Transform { kind, span });
    let shaders = parameters.strings("shaders").unwrap_or_default();
    let modifiers = parameters.strings("modifiers").unwrap_or_default();
    let (name, geometry) = (Some(name.clone()), geometry.clone());
    parser.scene.instances.push(Instance { name, geometry, shaders, modifiers, transform, span });
    true
}
