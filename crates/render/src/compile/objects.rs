//! Objects and instances → geometry.

use std::collections::{HashMap, HashSet};

use glam::{DMat4, DVec3, Vec2, Vec3};
use jaspe_scene::description::{
    Geometry as Written, Instance, Mesh, Name, Object, Op, Plane, Transform, TransformKind, VertexData,
};
use jaspe_scene::{Diagnostic, Diagnostics, Dialect, Span};

use super::materials::Materials;
use super::shape::Sources;
use crate::affine;
use crate::geometry::{Geometry, MeshShape, PerVertex, Placement, Plan};
use crate::material::BLACK;
use crate::motion::{Motion, Shutter};

/// The geometry of a scene, and what one dialect needs besides.
pub(super) struct Planned {
    pub geometry: Geometry,
    /// Normals of the planes with the length that they were written with.
    pub plane_normals: Vec<Vec3>,
}

pub(super) fn compile(
    sources: &Sources<'_>,
    dialect: Dialect,
    mut plan: Plan,
    materials: &mut Materials<'_>,
    diagnostics: &mut Diagnostics,
) -> Planned {
    let scene = sources.scene;
    let mut compiler = Compiler { dialect, shutter: sources.shutter, materials, diagnostics, missing: HashSet::new() };
    let mut appearances: HashMap<&str, Vec<&Instance>> = HashMap::new();
    let known: HashSet<&str> = scene.objects.iter().filter_map(|o| o.name.as_ref().map(|n| n.value.as_str())).collect();
    for instance in &scene.instances {
        if known.contains(instance.geometry.value.as_str()) {
            appearances.entry(&instance.geometry.value).or_default().push(instance);
        } else {
            compiler.unknown_geometry(&instance.geometry);
        }
    }
    let mut plane_normals = Vec::new();
    let mut taken = HashSet::new();
    for object in &scene.objects {
        let name = object.name.as_ref().map(|name| name.value.as_str());
        // Sunflow: of two objects with one name, the second is dropped (P5). The original shows both.
        let repeated = name.is_some_and(|name| !taken.insert(name));
        if repeated && dialect == Dialect::Sunflow {
            continue;
        }
        let mut places = Vec::new();
        if object.visible {
            places.extend(compiler.place(
                object.transform.as_ref(),
                [&object.shaders, &object.modifiers],
                object.span,
                &object.geometry,
            ));
        }
        let instances = name.filter(|_| !repeated).and_then(|name| appearances.get(name));
        for instance in instances.into_iter().flatten() {
            let place = compiler.place(
                instance.transform.as_ref(),
                [&instance.shaders, &instance.modifiers],
                instance.span,
                &object.geometry,
            );
            places.extend(place);
        }
        if !sources.add(&mut plan, &object.geometry, &places, compiler.diagnostics) {
            add(&mut plan, object, &places, dialect, &mut plane_normals);
        }
    }
    Planned { geometry: plan.finish(), plane_normals }
}

/// Adds an object with all its appearances.
fn add(plan: &mut Plan, object: &Object, places: &[Placement], dialect: Dialect, plane_normals: &mut Vec<Vec3>) {
    match &object.geometry {
        Written::Sphere { .. } => places.iter().for_each(|place| plan.sphere(place)),
        Written::Plane(plane) => {
            let (point, normal, uv) = match *plane {
                Plane::Normal { point, normal } => (point.into(), Vec3::from_array(normal), None),
                Plane::Points(points) => {
                    let [a, b, c] = points.map(Vec3::from_array);
                    (a, (b - a).cross(c - a), Some([b - a, c - a]))
                }
            };
            for place in places {
                plan.plane(point, normal, uv, place);
                let back: affine::Affine = place.object_from_world.into();
                plane_normals.push(back.transposed(normal));
            }
        }
        Written::Mesh(mesh) => plan.mesh(mesh_shape(mesh, dialect), places),
        Written::Box { corners } => plan.mesh(box_shape(*corners), places),
        _ => {}
    }
}

struct Compiler<'a, 'm> {
    dialect: Dialect,
    shutter: Shutter,
    materials: &'a mut Materials<'m>,
    diagnostics: &'a mut Diagnostics,
    /// Names of shaders and modifiers that were reported already.
    missing: HashSet<String>,
}

impl Compiler<'_, '_> {
    /// Where an appearance stands, unless its transform cannot be inverted.
    fn place(
        &mut self,
        transform: Option<&Transform>,
        [shaders, modifiers]: [&[Name]; 2],
        span: Span,
        geometry: &Written,
    ) -> Option<Placement> {
        let mut materials = self.materials(shaders, span);
        if self.dialect == Dialect::Sunflow {
            materials.iter_mut().zip(modifiers).for_each(|(material, name)| self.modify(material, name));
        }
        let base = match geometry {
            Written::Sphere { center, radius } => affine::ball(*center, *radius),
            _ => DMat4::IDENTITY,
        };
        let mut motion = None;
        let matrix = match (transform, self.dialect) {
            (None, _) => base,
            (Some(transform), Dialect::Report) => report_matrix(&transform.kind, geometry, base),
            (Some(transform), Dialect::Sunflow) => {
                let course = Motion::new(&transform.kind);
                let matrix = course.at(self.shutter.middle()) * base;
                motion = Some((course, transform.span));
                matrix
            }
        };
        let place = Placement::new(matrix, materials);
        if place.is_none() {
            let at = transform.map_or(span, |transform| transform.span);
            self.diagnostics.push(
                Diagnostic::warning(at, "the object vanishes: its transform or its radius flattens it to nothing")
                    .hint("scales and radii must not be zero"),
            );
        }
        match motion.filter(|(motion, _)| self.shutter.has_duration() && !motion.is_still()) {
            Some((_, span)) if matches!(geometry, Written::Plane(_)) => {
                let message = "a moving plane is not blurred: it stands as in the middle of the exposure";
                let hint = "a mesh of two triangles is";
                self.diagnostics.push(Diagnostic::warning(span, message).hint(hint));
                place
            }
            Some((motion, _)) => place.map(|place| place.moving(motion.of(base), self.shutter)),
            None => place,
        }
    }

    /// The materials of an appearance's shaders, in order.
    fn materials(&mut self, shaders: &[Name], span: Span) -> Vec<u32> {
        if shaders.is_empty() {
            let anything = self.materials.get("");
            if anything.is_none() {
                self.diagnostics.push(
                    Diagnostic::warning(span, "this object has no shader: it will be black")
                        .hint("name one with `shader NAME` as the first line of the object"),
                );
            }
            return vec![anything.unwrap_or(BLACK)];
        }
        shaders.iter().map(|name| self.material(name)).collect()
    }

    fn material(&mut self, name: &Name) -> u32 {
        if let Some(material) = self.materials.get(&name.value) {
            return material;
        }
        if self.missing.insert(name.value.clone()) {
            let mut diagnostic = Diagnostic::warning(
                name.span,
                format!("there is no shader `{}`: the object will be black", name.value),
            );
            if let Some(near) = jaspe_scene::nearest(&name.value, self.materials.known()) {
                diagnostic = diagnostic.hint(format!("did you mean `{near}`?"));
            }
            self.diagnostics.push(diagnostic);
        }
        BLACK
    }

    /// Turns the normals of a material.
    fn modify(&mut self, material: &mut u32, name: &Name) {
        if let Some(modified) = self.materials.modify(*material, &name.value) {
            *material = modified;
        } else if self.missing.insert(format!("modifier {}", name.value)) {
            let text = format!("there is no modifier `{}`: the surface stays as it is", name.value);
            let mut diagnostic = Diagnostic::warning(name.span, text);
            if let Some(near) = jaspe_scene::nearest(&name.value, self.materials.known_modifiers()) {
                diagnostic = diagnostic.hint(format!("did you mean `{near}`?"));
            }
            self.diagnostics.push(diagnostic);
        }
    }

    fn unknown_geometry(&mut self, name: &Name) {
        self.diagnostics.push(
            Diagnostic::warning(name.span, format!("there is no object `{}`: the instance is left out", name.value))
                .hint("`geometry` takes the `name` of an object"),
        );
    }
}

/// The original applies transforms in an order of its own: scales, rotations about x, y and z, translation. A sphere's
/// radius takes every scale, and its centre none.
fn report_matrix(kind: &TransformKind, geometry: &Written, base: DMat4) -> DMat4 {
    let TransformKind::Ops(ops) = kind else { return affine::matrix(kind) * base };
    let rank = |op: &Op| match op {
        Op::ScaleX(_) | Op::ScaleY(_) | Op::ScaleZ(_) | Op::Scale(_) | Op::ScaleU(_) => 0,
        Op::RotateX(_) => 1,
        Op::RotateY(_) => 2,
        Op::RotateZ(_) | Op::Rotate { .. } => 3,
        Op::Translate(_) => 4,
    };
    let mut ordered = ops.clone();
    ordered.sort_by_key(rank);
    if !matches!(geometry, Written::Sphere { .. }) {
        return affine::matrix(&TransformKind::Ops(ordered)) * base;
    }
    let factor: f64 = ops
        .iter()
        .map(|op| match *op {
            Op::ScaleX(s) | Op::ScaleY(s) | Op::ScaleZ(s) | Op::ScaleU(s) => s,
            Op::Scale([x, y, z]) => x * y * z,
            _ => 1.0,
        })
        .product();
    ordered.retain(|op| rank(op) > 0);
    affine::matrix(&TransformKind::Ops(ordered)) * base * DMat4::from_scale(DVec3::splat(factor))
}

fn mesh_shape(mesh: &Mesh, dialect: Dialect) -> MeshShape {
    let points: Vec<Vec3> = mesh.points.iter().map(|&p| p.into()).collect();
    let (normals, uvs) = match dialect {
        Dialect::Sunflow => (per_vertex(&mesh.normals, Vec3::from_array), per_vertex(&mesh.uvs, Vec2::from_array)),
        // The original shades flat, and reads one uv per point whatever the kind; what is left over is dropped.
        Dialect::Report => {
            let uvs = match &mesh.uvs {
                VertexData::FaceVarying(uvs) if uvs.len() >= points.len() => {
                    PerVertex::Vertex(uvs[..points.len()].iter().map(|&uv| uv.into()).collect())
                }
                VertexData::FaceVarying(_) => PerVertex::None,
                other => per_vertex(other, Vec2::from_array),
            };
            (PerVertex::None, uvs)
        }
    };
    MeshShape {
        points,
        triangles: mesh.triangles.clone(),
        normals,
        uvs,
        slots: mesh.face_shaders.clone().unwrap_or_default(),
    }
}

fn per_vertex<T: Copy, U: Copy>(data: &VertexData<T>, convert: impl Fn(T) -> U) -> PerVertex<U> {
    match data {
        VertexData::None => PerVertex::None,
        VertexData::Vertex(values) => PerVertex::Vertex(values.iter().map(|&v| convert(v)).collect()),
        VertexData::FaceVarying(values) => PerVertex::Corner(values.iter().map(|&v| convert(v)).collect()),
    }
}

/// Twelve triangles, wound outwards, with the unit square of texture coordinates on every face.
fn box_shape([a, b]: [[f32; 3]; 2]) -> MeshShape {
    let mut mesh = MeshShape::default();
    let mut uvs = Vec::new();
    for axis in 0..3 {
        for side in 0..2 {
            // Corners of the face counter-clockwise from outside.
            let (u, v) = if side == 1 { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
            let first = mesh.points.len() as u32;
            for (at_u, at_v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let mut point = [0.0; 3];
                point[axis] = [a, b][side][axis];
                point[u] = [a, b][at_u][u];
                point[v] = [a, b][at_v][v];
                mesh.points.push(point.into());
                uvs.push(Vec2::new(at_u as f32, at_v as f32));
            }
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    mesh.uvs = PerVertex::Vertex(uvs);
    mesh
}
