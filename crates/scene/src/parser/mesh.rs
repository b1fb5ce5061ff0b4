//! Reads the numbers of triangle meshes.

use super::block::{Key, Outcome, Required};
use super::list::List;
use super::loose::Loose;
use super::object::Draft;
use super::{Context, Failed, Parsed, Parser};
use crate::description::{Geometry, Mesh, Triangles, VertexData};
use crate::diagnostic::Diagnostic;
use crate::number;
use crate::source::Span;

/// What `normals` or `uvs` say.
#[derive(Debug, Default)]
enum Attribute<const N: usize> {
    #[default]
    Absent,
    None,
    Vertex(List<[f32; N]>),
    FaceVarying(List<[f32; N]>),
}

/// The lists of a mesh as far as they were written.
#[derive(Debug, Default)]
pub(super) struct MeshDraft {
    points: Option<List<[f32; 3]>>,
    triangles: Option<List<[u32; 3]>>,
    normals: Attribute<3>,
    uvs: Attribute<2>,
    face_shaders: Option<List<u32>>,
}

impl MeshDraft {
    /// How many points there are, as far as is known.
    fn point_count(&self) -> usize {
        self.points.as_ref().map_or(0, |list| list.values.len())
    }

    /// How many triangles there are, as far as is known.
    fn triangle_count(&self) -> usize {
        self.triangles.as_ref().map_or(0, |list| list.values.len())
    }
}

/// The keywords of `generic-mesh`.
pub(super) const KEYS: &[Key<Draft>] = &[
    Key::new("points", "points 3 0 0 0 1 0 0 0 1 0", |p, d, key| p.mesh_points(key, &mut d.mesh)),
    Key::new("triangles", "triangles 1 0 1 2", |p, d, key| p.mesh_triangles(key, &mut d.mesh)),
    Key::new("normals", "normals none", |p, d, key| {
        d.mesh.normals = p.attribute(key, &d.mesh)?;
        Ok(())
    }),
    Key::new("uvs", "uvs none", |p, d, key| {
        d.mesh.uvs = p.attribute(key, &d.mesh)?;
        Ok(())
    }),
    Key::new("face_shaders", "face_shaders 0 0 1", |p, d, key| {
        let List { values, rest, start, key } = p.list::<u32, 1>(key, d.mesh.triangle_count(), number::index)?;
        d.mesh.face_shaders = Some(List { values: values.into_iter().flatten().collect(), rest, start, key });
        Ok(())
    }),
];

/// What every mesh of the new form needs.
pub(super) const POINTS_REQUIRED: Required = (&["points"], "points 3 0 0 0 1 0 0 0 1 0");
pub(super) const TRIANGLES_REQUIRED: Required = (&["triangles"], "triangles 1 0 1 2");

impl Parser<'_> {
    /// The value of `points`.
    pub(super) fn mesh_points(&mut self, key: Span, mesh: &mut MeshDraft) -> Parsed<()> {
        let count = self.count()?;
        let list = self.list(key, count, number::float::<f32>)?;
        self.check_count(&list, count)?;
        mesh.points = Some(list);
        Ok(())
    }

    /// The value of `triangles`.
    pub(super) fn mesh_triangles(&mut self, key: Span, mesh: &mut MeshDraft) -> Parsed<()> {
        let count = self.count()?;
        let list = self.list(key, count, number::index)?;
        self.check_count(&list, count)?;
        mesh.triangles = Some(list);
        Ok(())
    }

    /// The value of `normals` or `uvs`.
    fn attribute<const N: usize>(&mut self, key: Span, mesh: &MeshDraft) -> Parsed<Attribute<N>> {
        let choices = [("none", 0), ("vertex", 1), ("facevarying", 2)];
        Ok(match self.choice("a kind of vertex data", &choices)?.value {
            0 => Attribute::None,
            1 => Attribute::Vertex(self.list(key, mesh.point_count(), number::float::<f32>)?),
            _ => Attribute::FaceVarying(self.list(key, 3 * mesh.triangle_count(), number::float::<f32>)?),
        })
    }
}

/// The mesh of a `generic-mesh`.
pub(super) fn generic(parser: &mut Parser<'_>, draft: &mut Draft, outcome: &Outcome, head: Span) -> Option<Geometry> {
    parser.require("generic-mesh", outcome, head, &[POINTS_REQUIRED, TRIANGLES_REQUIRED]);
    for (key, loose) in [("normals", Loose::MeshWithoutNormals), ("uvs", Loose::MeshWithoutUvs)] {
        if !outcome.has(key) {
            parser.loose(loose, head);
        }
    }
    build(parser, draft)
}

/// The mesh of a `mesh`.
pub(super) fn smooth(parser: &mut Parser<'_>, draft: &mut Draft, outcome: &Outcome, head: Span) -> Option<Geometry> {
    if !outcome.failed {
        parser.require_legacy_lists(&draft.mesh, head);
    }
    build(parser, draft)
}

/// The mesh of a `flat-mesh`: its normals are written and not used.
pub(super) fn flat(parser: &mut Parser<'_>, draft: &mut Draft, outcome: &Outcome, head: Span) -> Option<Geometry> {
    draft.mesh.normals = Attribute::None;
    smooth(parser, draft, outcome, head)
}

/// Checks the lists against each other. An inconsistent mesh is reported and not kept.
fn build(parser: &mut Parser<'_>, draft: &mut Draft) -> Option<Geometry> {
    let MeshDraft { points, triangles, normals, uvs, face_shaders } = std::mem::take(&mut draft.mesh);
    let (points, triangles) = (points?, triangles?);
    let counts = [points.values.len(), triangles.values.len()];
    let in_range = parser.check_indices(&triangles, counts[0]);
    let normals = parser.vertex_data("normals", normals, counts);
    let uvs = parser.vertex_data("uvs", uvs, counts);
    let face_shaders = match face_shaders {
        Some(list) => Some(parser.face_shaders(list, counts[1], draft)?),
        None => None,
    };
    if !in_range {
        return None;
    }
    let (points, triangles) = (points.values, triangles.values);
    Some(Geometry::Mesh(Mesh { points, triangles, normals: normals?, uvs: uvs?, face_shaders }))
}

impl Parser<'_> {
    /// The numbers of the old meshes: `V T`, then V times `v x y z nx ny nz u v`, then T times `t a b c`.
    pub(super) fn legacy_lists(&mut self, mesh: &mut MeshDraft, key: Span) -> Parsed<()> {
        self.context = Context { name: "mesh", example: "" };
        let (vertex_count, triangle_count) = (self.count()?, self.count()?);
        let start = self.lexer;
        let fits = |count: usize, size: usize| count.min(start.remaining(&self.bytes) / size);
        let mut points = Vec::with_capacity(fits(vertex_count, 18));
        let mut normals = Vec::with_capacity(fits(vertex_count, 18));
        let mut uvs = Vec::with_capacity(fits(vertex_count, 18));
        let mut triangles = Vec::with_capacity(fits(triangle_count, 8));
        self.context = Context { name: "v", example: "v 0 0 0 0 0 1 0 0" };
        while self.take("v").is_some() {
            let [x, y, z, nx, ny, nz, u, v] = self.numbers()?;
            points.push([x, y, z]);
            normals.push([nx, ny, nz]);
            uvs.push([u, v]);
        }
        self.context = Context { name: "t", example: "t 0 1 2" };
        let triangles_start = self.lexer;
        while self.take("t").is_some() {
            let mut triangle = [0; 3];
            for index in &mut triangle {
                let found = self.next();
                match found.and_then(|token| number::index(token.bytes(&self.bytes))) {
                    Some(value) => *index = value,
                    None => return Err(self.expected("three indices from 0", found)),
                }
            }
            triangles.push(triangle);
        }
        for (what, expected, found) in [("v", vertex_count, points.len()), ("t", triangle_count, triangles.len())] {
            if expected != found {
                let message = format!("the mesh announces {expected} lines of `{what}`, found {found}");
                let diagnostic = Diagnostic::error(key, message);
                self.failed_at = self.lexer.position() as u32;
                self.diagnostics.push(match self.peek() {
                    Some(end) => diagnostic.label(self.span(end), "the lines end here"),
                    None => diagnostic,
                });
                return Err(Failed);
            }
        }
        mesh.points = Some(List { values: points, rest: 0, start, key });
        mesh.triangles = Some(List { values: triangles, rest: 0, start: triangles_start, key });
        mesh.normals = Attribute::Vertex(List { values: normals, rest: 0, start, key });
        mesh.uvs = Attribute::Vertex(List { values: uvs, rest: 0, start, key });
        Ok(())
    }

    /// Reports an old mesh without numbers.
    pub(super) fn require_legacy_lists(&mut self, mesh: &MeshDraft, head: Span) {
        if mesh.points.is_none() {
            let message = "the mesh lacks its numbers";
            let hint = "write `V T`, V lines `v x y z nx ny nz u v` and T lines `t a b c`";
            self.diagnostics.push(Diagnostic::error(head, message).hint(hint));
        }
    }

    /// The triangles of a mesh, checked, without anything that goes with them.
    pub(super) fn bare_triangles(&mut self, mesh: MeshDraft) -> Option<Triangles> {
        let (points, triangles) = (mesh.points?, mesh.triangles?);
        let in_range = self.check_indices(&triangles, points.values.len());
        in_range.then_some(Triangles { points: points.values, triangles: triangles.values })
    }

    /// Reports indices that no point answers to: the first one, and how many more there are.
    fn check_indices(&mut self, triangles: &List<[u32; 3]>, points: usize) -> bool {
        let is_bad = |index: &u32| *index as usize >= points;
        let indices = || triangles.values.iter().flatten();
        let Some(at) = indices().position(is_bad) else { return true };
        let (first, count) = (triangles.values[at / 3][at % 3], indices().filter(|index| is_bad(index)).count());
        let more = if count > 1 { format!(" (nor for {} more indices)", count - 1) } else { String::new() };
        let message = format!("there is no point {first} in a mesh of {points}{more}");
        let span = self.nth_number(triangles.start, at).unwrap_or(triangles.key);
        let hint = match points {
            0 => "a mesh without points has no triangles".to_owned(),
            _ => format!("points count from 0: the last one is {}", points - 1),
        };
        self.diagnostics.push(Diagnostic::error(span, message).hint(hint));
        false
    }

    fn vertex_data<const N: usize>(
        &mut self,
        what: &'static str,
        attribute: Attribute<N>,
        [points, triangles]: [usize; 2],
    ) -> Option<VertexData<[f32; N]>> {
        let (list, kind, needed) = match attribute {
            Attribute::Absent | Attribute::None => return Some(VertexData::None),
            Attribute::Vertex(list) => (list, "vertex", points),
            Attribute::FaceVarying(list) => (list, "facevarying", 3 * triangles),
        };
        if list.values.len() != needed || list.rest > 0 {
            let (needed, found) = (needed * N, list.values.len() * N + list.rest);
            let message = format!("`{what} {kind}` needs {needed} numbers in this mesh, found {found}");
            let hint = match kind {
                "vertex" => format!("`vertex` means {N} numbers for each of the {points} points"),
                _ => format!("`facevarying` means {N} numbers for each corner of the {triangles} triangles"),
            };
            self.diagnostics.push(Diagnostic::error(list.key, message).hint(hint));
            return None;
        }
        Some(if kind == "vertex" { VertexData::Vertex(list.values) } else { VertexData::FaceVarying(list.values) })
    }

    fn face_shaders(&mut self, list: List<u32>, triangles: usize, draft: &Draft) -> Option<Vec<u32>> {
        if list.values.len() != triangles {
            let message = format!("`face_shaders` needs {triangles} numbers, found {}", list.values.len());
            let hint = "it takes one number for each triangle";
            self.diagnostics.push(Diagnostic::error(list.key, message).hint(hint));
            return None;
        }
        let shaders = draft.shaders.len();
        let at = list.values.iter().position(|index| *index as usize >= shaders);
        if let (Some(at), true) = (at, draft.is_visible() && shaders > 0) {
            let message = format!("there is no shader {} in a list of {shaders}", list.values[at]);
            let span = self.nth_number(list.start, at).unwrap_or(list.key);
            self.diagnostics.push(Diagnostic::error(span, message).hint("`face_shaders` counts from 0"));
            return None;
        }
        Some(list.values)
    }
}
