//! Gathers the shapes of a scene and builds its [`Geometry`].
//!
//! A mesh that is seen once is baked into world space, so that its triangles share the top tree; one that is seen
//! several times keeps a tree of its own, and every appearance is an instance of it.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat4, DVec3, Vec3, Vec4};
use rayon::prelude::*;

use super::analytic::{Analytic, Leaf, Leaves};
use super::build::{Item, build};
use super::bvh::{Aabb, Child, Kind, Node};
use super::pages;
use super::traverse::{InstanceLeaf, SphereBlock, Tree, TriangleBlock};
use super::{Geometry, Id, MeshShape, Motions, Object, PerVertex, PlaneShape, Pose, Shape, SphereSet};
use crate::affine::{self, Affine};
use crate::motion::{Motion, Shutter};

/// Where an object stands and what it is made of.
#[derive(Debug, Clone)]
pub(crate) struct Placement {
    pub world_from_object: DMat4,
    pub object_from_world: DMat4,
    pub materials: Vec<u32>,
    /// How it moves during the exposure, if it does: `world_from_object` over time.
    motion: Option<Moving>,
}

/// A motion, and matrices between which it stays while the shutter is open.
#[derive(Debug, Clone)]
struct Moving {
    motion: Motion,
    extent: Vec<DMat4>,
}

impl Placement {
    /// Where the object is written, with the first material.
    pub fn identity() -> Self {
        let identity = DMat4::IDENTITY;
        Placement { world_from_object: identity, object_from_world: identity, materials: vec![0], motion: None }
    }

    /// A placement by `world_from_object`, unless that map cannot be inverted.
    pub fn new(world_from_object: DMat4, materials: Vec<u32>) -> Option<Self> {
        let object_from_world = affine::inverse(world_from_object)?;
        Some(Placement { world_from_object, object_from_world, materials, motion: None })
    }

    /// The same, in motion while the shutter is open.
    pub fn moving(self, motion: Motion, shutter: Shutter) -> Self {
        let extent = motion.during(shutter);
        Placement { motion: Some(Moving { motion, extent }), ..self }
    }
}

/// Shapes on their way into a [`Geometry`].
#[derive(Debug, Default)]
pub(crate) struct Plan {
    planes: Vec<PlaneShape>,
    meshes: Vec<MeshShape>,
    objects: Vec<Object>,
    sphere_sets: Vec<SphereSet>,
    analytics: Vec<Arc<dyn Analytic>>,
    /// By object, where it is.
    places: Vec<DMat4>,
    /// Objects that are instances, and of what.
    instances: Vec<(u32, Shared)>,
    motions: Vec<Motion>,
    /// By motion: matrices between which it stays.
    extents: Vec<Vec<DMat4>>,
}

/// What instances show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Shared {
    UnitSphere,
    /// Index into the meshes.
    Mesh(u32),
    /// Index into the sets of spheres.
    Spheres(u32),
}

impl Plan {
    fn object(&mut self, shape: Shape, place: &Placement) -> u32 {
        let motion = place.motion.as_ref().map(|moving| {
            self.motions.push(moving.motion.clone());
            self.extents.push(moving.extent.clone());
            (self.motions.len() - 1) as u32
        });
        self.places.push(place.world_from_object);
        self.objects.push(Object {
            shape,
            pose: Pose {
                object_from_world: place.object_from_world.into(),
                world_from_object: place.world_from_object.into(),
            },
            motion,
            materials: place.materials.clone(),
        });
        (self.objects.len() - 1) as u32
    }

    /// The unit sphere, placed.
    pub fn sphere(&mut self, place: &Placement) {
        match affine::similarity_scale(place.world_from_object) {
            Some(scale) if place.motion.is_none() => {
                let center = place.world_from_object.transform_point3(DVec3::ZERO).as_vec3();
                self.object(Shape::Sphere { center, radius: scale as f32 }, place);
            }
            _ => {
                let object = self.object(Shape::Ellipsoid, place);
                self.instances.push((object, Shared::UnitSphere));
            }
        }
    }

    /// A plane given in object space; `uv` are two edge vectors along which the texture coordinates run.
    pub fn plane(&mut self, point: Vec3, normal: Vec3, uv: Option<[Vec3; 2]>, place: &Placement) {
        let object = self.object(Shape::Plane(self.planes.len() as u32), place);
        let back: Affine = place.object_from_world.into();
        let forth: Affine = place.world_from_object.into();
        let uv = uv.map(|edges| dual_basis(edges.map(|edge| forth.vector(edge))));
        let normal = back.transposed(normal).normalize_or(Vec3::Z);
        self.planes.push(PlaneShape { point: forth.point(point), normal, uv, object });
    }

    /// A mesh in object space and all its appearances.
    pub fn mesh(&mut self, mut mesh: MeshShape, places: &[Placement]) {
        let index = self.meshes.len() as u32;
        match places {
            [] => return,
            [place] if place.motion.is_none() => {
                bake(&mut mesh, place);
                self.object(Shape::Mesh(index), place);
            }
            _ => {
                for place in places {
                    let object = self.object(Shape::MeshInstance(index), place);
                    self.instances.push((object, Shared::Mesh(index)));
                }
            }
        }
        self.meshes.push(mesh);
    }

    /// Spheres in object space and all their appearances.
    pub fn spheres(&mut self, mut set: SphereSet, places: &[Placement]) {
        let index = self.sphere_sets.len() as u32;
        if let [place] = places
            && place.motion.is_none()
            && let Some(scale) = affine::similarity_scale(place.world_from_object)
        {
            for sphere in &mut set.spheres {
                let center = place.world_from_object.transform_point3(sphere.truncate().as_dvec3()).as_vec3();
                *sphere = center.extend((f64::from(sphere.w) * scale) as f32);
            }
            self.object(Shape::Spheres(index), place);
        } else {
            for place in places {
                let object = self.object(Shape::SpheresInstance(index), place);
                self.instances.push((object, Shared::Spheres(index)));
            }
        }
        self.sphere_sets.push(set);
    }

    /// A shape that is met by a formula, and all its appearances.
    pub fn analytic(&mut self, shape: Arc<dyn Analytic>, places: &[Placement]) {
        let index = self.analytics.len() as u32;
        places.iter().for_each(|place| {
            self.object(Shape::Analytic(index), place);
        });
        self.analytics.push(shape);
    }

    /// A box in the world around a box of an object, wherever that is during the exposure.
    fn around(&self, bounds: Aabb, object: u32) -> Aabb {
        let here = std::slice::from_ref(&self.places[object as usize]);
        let motion = self.objects[object as usize].motion;
        let extent = motion.map_or(here, |motion| &self.extents[motion as usize]);
        let corners = bounds.corners().map(|corner| corner.as_dvec3());
        Aabb::around(extent.iter().flat_map(|matrix| corners.map(|corner| matrix.transform_point3(corner).as_vec3())))
    }

    /// Builds the tree.
    pub fn finish(self) -> Geometry {
        let mut builder = Builder::default();
        let shared = self.shared_trees(&mut builder);
        let mut roots = Vec::new();
        roots.extend(builder.triangles_of(self.objects.iter().enumerate().filter_map(|(object, o)| match o.shape {
            Shape::Mesh(mesh) => Some((&self.meshes[mesh as usize], object as u32)),
            _ => None,
        })));
        // A few spheres and nothing else are quicker to meet without a tree.
        let alone = roots.is_empty() && self.instances.is_empty() && self.analytics.is_empty();
        let least = if alone { 8 } else { 1 };
        roots.extend(builder.spheres_of(
            least,
            (0..).zip(&self.objects).flat_map(|(object, o)| {
                let (single, set) = match o.shape {
                    Shape::Sphere { center, radius } => (Some(center.extend(radius)), &[][..]),
                    Shape::Spheres(set) => (None, &self.sphere_sets[set as usize].spheres[..]),
                    _ => (None, &[][..]),
                };
                named(single.into_iter().chain(set.iter().copied()), object)
            }),
        ));
        roots.extend(builder.instances_of(&self, &shared));
        roots.extend(builder.analytics_of(&self));
        let root = builder.join(&roots);
        let Builder { nodes, triangles, spheres, instances, analytic } = builder;
        let motions = Motions(self.motions);
        let tree = Tree { root, nodes, triangles, spheres, instances, analytic, motions };
        let mut geometry = Geometry {
            tree,
            planes: self.planes,
            meshes: self.meshes,
            sphere_sets: self.sphere_sets,
            objects: self.objects,
            only_material: Vec::new(),
        };
        geometry.only_material = geometry.only_materials();
        geometry
    }

    /// A tree for each shape that has instances, in the order of `instances`.
    fn shared_trees(&self, builder: &mut Builder) -> SharedTrees {
        let none = Id::NONE.object;
        let mut trees = SharedTrees::new();
        for &(_, shape) in &self.instances {
            trees.entry(shape).or_insert_with(|| match shape {
                Shared::Mesh(mesh) => builder.triangles_of(std::iter::once((&self.meshes[mesh as usize], none))),
                Shared::UnitSphere => builder.spheres_of(1, named([Vec3::ZERO.extend(1.0)], none)),
                Shared::Spheres(set) => {
                    builder.spheres_of(1, named(self.sphere_sets[set as usize].spheres.iter().copied(), none))
                }
            });
        }
        trees
    }
}

/// The spheres of an object, numbered.
fn named(spheres: impl IntoIterator<Item = Vec4>, object: u32) -> impl Iterator<Item = (Vec4, Id)> {
    spheres.into_iter().zip(0..).map(move |(sphere, index)| (sphere, Id { object, index }))
}

/// The vectors g with g_i · e_j = 1 where i = j and 0 elsewhere, in the plane of the edges.
fn dual_basis([a, b]: [Vec3; 2]) -> [Vec3; 2] {
    let n = a.cross(b);
    let scale = 1.0 / n.length_squared();
    if scale.is_finite() { [b.cross(n) * scale, n.cross(a) * scale] } else { [Vec3::ZERO; 2] }
}

/// Moves a mesh into world space.
fn bake(mesh: &mut MeshShape, place: &Placement) {
    if place.world_from_object == DMat4::IDENTITY {
        return;
    }
    let back: Affine = place.object_from_world.into();
    for point in &mut mesh.points {
        *point = place.world_from_object.transform_point3(point.as_dvec3()).as_vec3();
    }
    if let PerVertex::Vertex(normals) | PerVertex::Corner(normals) = &mut mesh.normals {
        normals.iter_mut().for_each(|n| *n = back.transposed(*n));
    }
}

/// The trees over what instances show; none over what is empty.
type SharedTrees = HashMap<Shared, Option<(Child, Aabb)>>;

/// Trees in the making.
#[derive(Default)]
struct Builder {
    nodes: Vec<Node>,
    triangles: Vec<TriangleBlock>,
    spheres: Vec<SphereBlock>,
    instances: Vec<InstanceLeaf>,
    analytic: Leaves,
}

impl Builder {
    /// A tree over the triangles of some meshes, each with the object that its hits name.
    fn triangles_of<'a>(&mut self, meshes: impl Iterator<Item = (&'a MeshShape, u32)>) -> Option<(Child, Aabb)> {
        let meshes: Vec<_> = meshes.collect();
        // Where each mesh's triangles start in the builder's numbering.
        let mut starts = Vec::with_capacity(meshes.len());
        let mut items = Vec::with_capacity(meshes.iter().map(|(mesh, _)| mesh.triangles.len()).sum());
        pages::enlarge(&items);
        let mut next = 0u32;
        for (mesh, _) in &meshes {
            starts.push(next);
            let item = |(triangle, index): (&[u32; 3], u32)| {
                // The shear moves corners by roundings of the triangle's size.
                Item::new(Aabb::around(triangle.map(|i| mesh.points[i as usize])).padded(), index)
            };
            let last = next + mesh.triangles.len() as u32;
            items.par_extend(mesh.triangles.par_iter().zip(next..last).map(item));
            next = last;
        }
        items.retain(Item::is_finite);
        build(items, (Kind::Triangles, 8), &mut self.nodes, &mut self.triangles, &|items| {
            let mut block = TriangleBlock::EMPTY;
            for (lane, item) in items.iter().enumerate() {
                let mesh = starts.partition_point(|&start| start <= item.index()) - 1;
                let index = item.index() - starts[mesh];
                let (mesh, object) = meshes[mesh];
                for (vertex, &i) in mesh.triangles[index as usize].iter().enumerate() {
                    for axis in 0..3 {
                        block.vertices[vertex][axis][lane] = mesh.points[i as usize][axis];
                    }
                }
                block.ids[lane] = Id { object, index };
            }
            block
        })
    }

    /// A tree over spheres: centre with radius, and name. No more than `least` of them are a single leaf.
    fn spheres_of(&mut self, least: usize, spheres: impl Iterator<Item = (Vec4, Id)>) -> Option<(Child, Aabb)> {
        let spheres: Vec<_> = spheres.filter(|(sphere, _)| sphere.is_finite()).collect();
        let items: Vec<_> = (0..)
            .zip(&spheres)
            .map(|(index, &(sphere, _))| {
                // Rounding may put a point of the sphere just outside the exact box.
                let (center, radius) = (sphere.truncate(), sphere.w);
                let reach = Vec3::splat(radius * 1.000_001) + center.abs() * 1e-6;
                Item::new(Aabb { min: center - reach, max: center + reach }, index)
            })
            .collect();
        let leaf = |items: &[Item]| {
            let mut block = SphereBlock::EMPTY;
            for (lane, item) in items.iter().enumerate() {
                let (sphere, id) = spheres[item.index() as usize];
                for axis in 0..3 {
                    block.centers[axis][lane] = sphere[axis];
                }
                block.radii[lane] = sphere.w;
                block.ids[lane] = id;
            }
            block
        };
        if (1..=least).contains(&items.len()) {
            let corners = items.iter().map(Item::bounds).flat_map(|bounds| [bounds.min, bounds.max]);
            self.spheres.push(leaf(&items));
            return Some((Child::leaf(Kind::Spheres, self.spheres.len() - 1), Aabb::around(corners)));
        }
        build(items, (Kind::Spheres, 8), &mut self.nodes, &mut self.spheres, &leaf)
    }

    /// A tree over instances.
    fn instances_of(&mut self, plan: &Plan, shared: &SharedTrees) -> Option<(Child, Aabb)> {
        let mut items = Vec::new();
        let mut leaves = Vec::new();
        for &(number, shape) in &plan.instances {
            let Some((root, bounds)) = shared.get(&shape).copied().flatten() else { continue };
            let object = &plan.objects[number as usize];
            let bounds = plan.around(bounds, number);
            if bounds.is_finite() {
                items.push(Item::new(bounds, leaves.len() as u32));
                let moving = object.motion.map(|_| Box::new(object.clone()));
                let object_from_world = object.pose.object_from_world;
                leaves.push(InstanceLeaf { root, object_from_world, object: number, moving });
            }
        }
        let leaf = |items: &[Item]| leaves[items[0].index() as usize].clone();
        build(items, (Kind::Instance, 1), &mut self.nodes, &mut self.instances, &leaf)
    }

    /// A tree over the parts of the shapes that are met by a formula.
    fn analytics_of(&mut self, plan: &Plan) -> Option<(Child, Aabb)> {
        let shapes = &plan.analytics;
        let (mut items, mut leaves, mut placed) = (Vec::new(), Vec::new(), Vec::new());
        for (number, object) in (0..).zip(&plan.objects) {
            let Shape::Analytic(shape) = object.shape else { continue };
            for part in 0..shapes[shape as usize].part_count() {
                let bounds = plan.around(shapes[shape as usize].bounds(part), number);
                if bounds.is_finite() {
                    items.push(Item::new(bounds, leaves.len() as u32));
                    leaves.push(Leaf { part: part as u32, object: placed.len() as u32 });
                }
            }
            placed.push((number, shape, object.clone()));
        }
        (self.analytic.shapes, self.analytic.objects) = (shapes.clone(), placed);
        let leaf = |items: &[Item]| leaves[items[0].index() as usize];
        build(items, (Kind::Analytic, 1), &mut self.nodes, &mut self.analytic.leaves, &leaf)
    }

    /// One root for several trees.
    fn join(&mut self, roots: &[(Child, Aabb)]) -> Child {
        match roots {
            [] => Child::NONE,
            [(root, _)] => *root,
            _ => {
                let children: Vec<_> = roots.iter().map(|&(root, bounds)| (bounds, root)).collect();
                self.nodes.push(Node::new(&children));
                Child::node(self.nodes.len() - 1)
            }
        }
    }
}
