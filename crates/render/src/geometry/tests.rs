//! Traversal against brute force, packets against single rays, all instruction sets against plain arrays, and the tree
//! itself.

use glam::{DMat4, DVec3, Vec3};

use super::bvh::{Aabb, Child, Kind, Node, Octant};
use super::kernel::{Plain, Shear, dominant, sphere, triangle, turned};
use super::simd::{Lanes, Portable, Simd, Vec3s};
use super::traverse::{Flight, Nested};
use super::*;
use crate::sampler::hash;

/// Uniform numbers, the same in every run.
struct Random(u32);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        (hash(self.0) >> 8) as f32 / 16_777_216.0
    }

    /// A point of the cube from -1 to 1.
    fn point(&mut self) -> Vec3 {
        Vec3::from_array(std::array::from_fn(|_| self.next() * 2.0 - 1.0))
    }
}

fn place(matrix: DMat4) -> Placement {
    Placement::new(matrix, vec![0]).expect("the tests place by regular maps")
}

fn here() -> Placement {
    place(DMat4::IDENTITY)
}

fn soup(corners: impl IntoIterator<Item = [Vec3; 3]>) -> MeshShape {
    let points: Vec<Vec3> = corners.into_iter().flatten().collect();
    let triangles = (0..points.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    MeshShape { points, triangles, ..MeshShape::default() }
}

/// Small triangles all over the cube.
fn random_soup(random: &mut Random, count: usize, size: f32) -> MeshShape {
    soup((0..count).map(|_| {
        let center = random.point();
        [0; 3].map(|_| center + random.point() * size)
    }))
}

/// Rays at the cube from outside and inside: some in bundles, as packets like them, some anywhere.
fn rays(random: &mut Random, count: usize, scale: f32, center: Vec3) -> Vec<Ray> {
    let mut rays = Vec::new();
    while rays.len() < count {
        let (origin, target) = (random.point() * 3.0, random.point());
        let spread = [0.0, 0.01, 0.2, 2.0][rays.len() / 8 % 4];
        for _ in 0..8 {
            let origin = origin + random.point() * spread * 0.5;
            let direction = (target + random.point() * spread - origin).normalize();
            let t_max = if random.next() < 0.7 { f32::INFINITY } else { random.next() * 4.0 * scale };
            let origin = center + origin * scale;
            rays.push(Ray { origin, direction, t_min: 0.0, t_max, skip: Id::NONE, time: None });
        }
    }
    rays
}

impl Geometry {
    /// Improves `hit` by all that one ray meets, alone.
    fn trace<S: Simd>(&self, ray: &Ray, any: bool, hit: &mut Hit, scratch: &mut Scratch) {
        self.planes.iter().for_each(|plane| plane.intersect(ray, hit));
        let (mut flight, inner) = (Box::new(Flight::IDLE), &mut scratch.pool.inner);
        flight.travel::<S>(ray, &self.tree, self.tree.root, *hit, &mut Nested { flight: inner, any });
        *hit = flight.best;
    }
}

impl PlaneShape {
    /// Improves `hit` by where `ray` crosses the plane.
    fn intersect(&self, ray: &Ray, hit: &mut Hit) {
        let t = (self.point - ray.origin).dot(self.normal) / ray.direction.dot(self.normal);
        if t > ray.t_min && ray.skip != self.id() {
            hit.improve(Hit { t, u: 0.0, v: 0.0, id: self.id(), time: None });
        }
    }
}

/// The rays in rows.
fn rows(rays: &[Ray]) -> Rays {
    let mut rows = Rays::default();
    rays.iter().for_each(|&ray| rows.push(ray));
    rows
}

/// Tests every primitive without a tree.
fn brute_force(geometry: &Geometry, ray: &Ray) -> Hit {
    let mut best = Hit { t: ray.t_max, ..Hit::NONE };
    geometry.planes.iter().for_each(|plane| plane.intersect(ray, &mut best));
    for (number, object) in geometry.objects.iter().enumerate() {
        let number = number as u32;
        let mut local = *ray;
        if matches!(object.shape, Shape::Ellipsoid | Shape::MeshInstance(_) | Shape::SpheresInstance(_)) {
            local.origin = object.pose.object_from_world.point(ray.origin);
            local.direction = object.pose.object_from_world.vector(ray.direction);
        }
        match object.shape {
            Shape::Plane(_) => {}
            Shape::Sphere { center, radius } => brute_sphere(&local, center, radius, (number, 0), &mut best),
            Shape::Ellipsoid => brute_sphere(&local, Vec3::ZERO, 1.0, (number, 0), &mut best),
            Shape::Spheres(set) | Shape::SpheresInstance(set) => {
                for (index, sphere) in (0..).zip(&geometry.sphere_sets[set as usize].spheres) {
                    brute_sphere(&local, sphere.truncate(), sphere.w, (number, index), &mut best);
                }
            }
            Shape::Analytic(_) => {
                let analytic = &geometry.tree.analytic;
                for (leaf, part) in analytic.leaves.iter().enumerate() {
                    if analytic.objects[part.object as usize].0 == number {
                        analytic.meet(leaf, ray, 0.0, &geometry.tree.motions, &mut best);
                    }
                }
            }
            Shape::Mesh(mesh) | Shape::MeshInstance(mesh) => {
                brute_mesh(&local, &geometry.meshes[mesh as usize], number, &mut best);
            }
        }
    }
    best
}

fn brute_sphere(ray: &Ray, center: Vec3, radius: f32, (object, index): (u32, u32), best: &mut Hit) {
    let [zero, t_max, radius] = [0.0, best.t, radius].map(Portable::splat);
    let plain = Plain {
        origin: Vec3s::splat(ray.origin),
        direction: Vec3s::splat(ray.direction),
        t_min: Portable::splat(ray.t_min),
    };
    if let Some(crossing) = sphere(&plain, Vec3s::splat(center), radius, zero, t_max)
        && crossing.mask != 0
        && ray.skip != (Id { object, index })
    {
        best.improve(Hit { t: crossing.t.store()[0], u: 0.0, v: 0.0, id: Id { object, index }, time: None });
    }
}

/// A ray as [`triangle`] wants it, and the order of the coordinates.
fn sheared(ray: &Ray) -> (Shear<Portable>, [usize; 3]) {
    let turned = turned(dominant(ray.direction));
    let [i, j, k] = turned.map(|axis| ray.direction[axis]);
    let origin = Vec3s::of(turned.map(|axis| ray.origin[axis]));
    let [x, y, scale, t_min] = [i / k, j / k, 1.0 / k, ray.t_min].map(Portable::splat);
    (Shear { origin, slope: (x, y), scale, t_min }, turned)
}

fn brute_mesh(ray: &Ray, mesh: &MeshShape, object: u32, best: &mut Hit) {
    let (shear, turned) = sheared(ray);
    for index in 0..mesh.triangles.len() {
        let id = Id { object, index: index as u32 };
        let corners = mesh.triangle_points(index).map(|corner| Vec3s::of(turned.map(|axis| corner[axis])));
        let crossing = triangle::<Portable, false>(&shear, corners, Portable::splat(0.0), Portable::splat(best.t));
        if let Some(crossing) = crossing.filter(|crossing| crossing.mask != 0 && id != ray.skip) {
            best.improve(Hit {
                t: crossing.t.store()[0],
                u: crossing.u.store()[0],
                v: crossing.v.store()[0],
                id,
                time: None,
            });
        }
    }
}

fn bits(hit: &Hit) -> (u32, u32, u32, Id) {
    (hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.id)
}

/// Traces rays in every way there is, and compares.
fn check(name: &str, geometry: &Geometry, rays: &[Ray]) {
    let mut scratch = Scratch::default();
    let rows = rows(rays);
    let view = rows.view(0.0);
    let mut found = Hits::default();
    found.resize(rays.len());
    let mut blocked = vec![false; rays.len()];
    geometry.closest_at(Level::Scalar, view, &mut found, &mut scratch);
    geometry.occluded_at(Level::Scalar, view, &mut blocked, &mut scratch);
    let each = |hits: &Hits| -> Vec<Hit> { (0..rays.len()).map(|i| hits.get(i)).collect() };
    let hits = each(&found);
    for level in simd::levels() {
        let (mut wide_found, mut wide_blocked) = (Hits::default(), vec![false; rays.len()]);
        wide_found.resize(rays.len());
        geometry.closest_at(level, view, &mut wide_found, &mut scratch);
        geometry.occluded_at(level, view, &mut wide_blocked, &mut scratch);
        assert_eq!(blocked, wide_blocked, "{name}: shadows of {level:?} and arrays");
        for (i, (hit, wide)) in hits.iter().zip(each(&wide_found)).enumerate() {
            assert_eq!(bits(hit), bits(&wide), "{name}: ray {i} of {level:?} and arrays");
        }
    }
    for (i, ray) in rays.iter().enumerate() {
        let mut alone = Hit { t: ray.t_max, ..Hit::NONE };
        geometry.trace::<Portable>(ray, false, &mut alone, &mut scratch);
        assert_eq!(bits(&hits[i]), bits(&alone), "{name}: ray {i} among others and alone");
        let looks = ray.t_max >= 0.0;
        assert_eq!(blocked[i], hits[i].id != Id::NONE || !looks, "{name}: shadow and hit of ray {i}");
        let brute = brute_force(geometry, ray);
        assert_eq!(hits[i].id == Id::NONE, brute.id == Id::NONE, "{name}: ray {i}: {:?}, {brute:?}", hits[i]);
        let close = hits[i].t == brute.t || (hits[i].t - brute.t).abs() <= 1e-5 * brute.t;
        assert!(close, "{name}: ray {i}: {:?}, {brute:?}", hits[i]);
        assert!(hits[i].t != brute.t || hits[i].id == brute.id, "{name}: ray {i}: {:?}, {brute:?}", hits[i]);
    }
}

fn plan(fill: impl FnOnce(&mut Plan)) -> Geometry {
    let mut plan = Plan::default();
    fill(&mut plan);
    let geometry = plan.finish();
    validate(&geometry);
    geometry
}

/// Every primitive lies in exactly one leaf, and inside all boxes above it.
fn validate(geometry: &Geometry) {
    let tree = &geometry.tree;
    let lengths = [tree.triangles.len(), tree.spheres.len(), tree.instances.len(), tree.analytic.leaves.len()];
    let mut seen = vec![[0u32; 4]; lengths.into_iter().max().unwrap_or(0)];
    let roots = std::iter::once(tree.root).chain(distinct(tree.instances.iter().map(|leaf| leaf.root)));
    for root in roots.filter(|&root| root != Child::NONE) {
        let mut open = vec![(root, Vec::new())];
        while let Some((child, boxes)) = open.pop() {
            if !child.is_node() {
                seen[child.index()][child.kind() as usize] += 1;
                contained(tree, child, &boxes);
                continue;
            }
            let node = &tree.nodes[child.index()];
            for slot in (0..8).filter(|&slot| node.child(slot) != Child::NONE) {
                let side =
                    |side: usize| Vec3::from_array([0, 1, 2].map(|axis: usize| node.sides[2 * axis + side][slot]));
                open.push((node.child(slot), [&boxes[..], &[(side(0), side(1))]].concat()));
            }
        }
    }
    for (kind, &length) in lengths.iter().enumerate() {
        assert!(seen[..length].iter().all(|counts| counts[kind] == 1), "every leaf has one place");
    }
    let mut ids: Vec<_> = tree.triangles.iter().flat_map(|block| block.ids).filter(|&id| id != Id::NONE).collect();
    let count = ids.len();
    ids.sort_by_key(|id| (id.object, id.index));
    ids.dedup();
    let shared = tree.instances.len() > 1;
    assert!(shared || ids.len() == count, "every triangle lies in one leaf");
}

fn distinct(children: impl Iterator<Item = Child>) -> Vec<Child> {
    let mut all = Vec::new();
    children.for_each(|child| all.extend((!all.contains(&child)).then_some(child)));
    all
}

fn contained(tree: &traverse::Tree, leaf: Child, boxes: &[(Vec3, Vec3)]) {
    let inside = |p: Vec3| boxes.iter().all(|(min, max)| p.cmpge(*min).all() && p.cmple(*max).all());
    match leaf.kind() {
        Kind::Triangles => {
            let block = &tree.triangles[leaf.index()];
            for lane in (0..8).filter(|&lane| block.ids[lane] != Id::NONE) {
                for vertex in &block.vertices {
                    assert!(inside(Vec3::new(vertex[0][lane], vertex[1][lane], vertex[2][lane])));
                }
            }
        }
        Kind::Spheres => {
            let block = &tree.spheres[leaf.index()];
            for lane in (0..8).filter(|&lane| block.ids[lane] != Id::NONE) {
                let center = Vec3::from_array([0, 1, 2].map(|axis: usize| block.centers[axis][lane]));
                assert!(inside(center - block.radii[lane]) && inside(center + block.radii[lane]));
            }
        }
        Kind::Instance | Kind::Analytic => {}
    }
}

#[test]
fn triangles_spheres_planes_and_instances_are_met_as_by_brute_force() {
    for seed in 0..6 {
        let mut random = Random(seed * 1000);
        let geometry = plan(|plan| {
            plan.mesh(random_soup(&mut random, 300, 0.3), &[here()]);
            let turned = DMat4::from_rotation_y(1.0) * DMat4::from_scale(DVec3::new(0.3, 1.0, 0.5));
            let moved = DMat4::from_translation(DVec3::new(0.5, 0.2, -0.3)) * DMat4::from_scale(DVec3::splat(0.5));
            plan.mesh(random_soup(&mut random, 100, 0.3), &[place(turned), place(moved)]);
            for _ in 0..40 {
                let at = DMat4::from_translation(random.point().as_dvec3());
                let size = f64::from(random.next()) * 0.2 + 0.01;
                plan.sphere(&place(at * DMat4::from_scale(DVec3::splat(size))));
                plan.sphere(&place(at * DMat4::from_scale(DVec3::new(size, 0.1, 0.05))));
            }
            plan.plane(Vec3::NEG_Y, Vec3::new(0.1, 1.0, 0.0), None, &here());
            plan.plane(Vec3::Z * 2.0, Vec3::Z, None, &here());
        });
        check("mixed", &geometry, &rays(&mut random, 2000, 1.0, Vec3::ZERO));
    }
}

#[test]
fn sets_of_spheres_and_shapes_with_a_formula_are_met_as_by_brute_force() {
    use super::analytic::{Banchoff, Cylinder, Flake, Hair, Julia, Torus};
    use std::sync::Arc;
    for seed in 0..3 {
        let mut random = Random(seed * 1000 + 5);
        let geometry = plan(|plan| {
            let at = |random: &mut Random, size: f64| {
                let turned = DMat4::from_rotation_x(f64::from(random.next()) * 6.0);
                let stretched = DMat4::from_scale(DVec3::new(size, size, size * 1.5));
                place(DMat4::from_translation(random.point().as_dvec3()) * turned * stretched)
            };
            let spheres: Vec<_> = (0..200).map(|_| random.point().extend(0.05)).collect();
            let places = [here(), at(&mut random, 0.5)];
            plan.spheres(SphereSet { spheres: spheres.clone(), uv: false }, &places);
            plan.spheres(SphereSet { spheres, uv: true }, &[place(DMat4::from_scale(DVec3::splat(0.7)))]);
            plan.analytic(Arc::new(Torus { tube: 0.25, ring: 1.0 }), &[at(&mut random, 0.4), at(&mut random, 0.6)]);
            plan.analytic(Arc::new(Cylinder), &[at(&mut random, 0.3)]);
            plan.analytic(Arc::new(Banchoff), &[at(&mut random, 0.4)]);
            let flake = Flake { level: 2, axis: DVec3::Y, radius: 1.0 };
            plan.analytic(Arc::new(flake), &[at(&mut random, 0.3)]);
            let c = glam::DVec4::new(-0.4, 0.2, 0.3, -0.2);
            plan.analytic(Arc::new(Julia { c, iterations: 10, epsilon: 1e-4 }), &[at(&mut random, 0.4)]);
            let points = (0..40).map(|_| random.point()).collect();
            plan.analytic(Arc::new(Hair { segments: 3, width: 0.05, points }), &[here()]);
            plan.mesh(random_soup(&mut random, 50, 0.3), &[here()]);
        });
        check("analytic", &geometry, &rays(&mut random, 1000, 1.0, Vec3::ZERO));
    }
}

#[test]
fn scenes_of_few_primitives_are_met_as_by_brute_force() {
    for count in [0, 1, 2, 7, 8, 9, 65] {
        let mut random = Random(count as u32);
        let triangles = plan(|plan| plan.mesh(random_soup(&mut random, count, 1.0), &[here()]));
        check("triangles", &triangles, &rays(&mut random, 500, 1.0, Vec3::ZERO));
        let spheres = plan(|plan| {
            for _ in 0..count {
                let at = DMat4::from_translation(random.point().as_dvec3());
                plan.sphere(&place(at * DMat4::from_scale(DVec3::splat(0.3))));
            }
        });
        check("spheres", &spheres, &rays(&mut random, 500, 1.0, Vec3::ZERO));
    }
    let mut random = Random(1);
    let plane = plan(|plan| plan.plane(Vec3::ZERO, Vec3::Y, None, &here()));
    check("plane", &plane, &rays(&mut random, 500, 1.0, Vec3::ZERO));
}

#[test]
fn degenerate_scenes_are_met_as_by_brute_force() {
    let mut random = Random(77);
    let one = [random.point(), random.point(), random.point()];
    let degenerate = |random: &mut Random, kind: u32| {
        let (p, q) = (random.point(), random.point());
        match kind {
            0 => [p, p, q],
            1 => [p, p + (q - p) * 0.5, q],
            2 => [p, q, q + random.point() * 1e-6],
            _ => [p, p, p],
        }
    };
    let meshes = [
        ("coincident", soup((0..500).map(|_| one))),
        ("slivers", soup((0..500).map(|i| degenerate(&mut random, i % 4)))),
        ("one point", soup((0..500).map(|_| [Vec3::ONE; 3]))),
        ("nested", soup((1..3000).map(|i| one.map(|p| p * (i as f32 / 1500.0))))),
        (
            "grid",
            soup((0..512).map(|i| {
                let at = Vec3::new((i % 8) as f32, (i / 8 % 8) as f32, (i / 64) as f32) / 4.0 - Vec3::ONE;
                [at, at + Vec3::X * 0.25, at + Vec3::Y * 0.25]
            })),
        ),
    ];
    for (name, mesh) in meshes {
        let geometry = plan(|plan| plan.mesh(mesh, &[here()]));
        check(name, &geometry, &rays(&mut random, 600, 1.0, Vec3::ZERO));
    }
    let center = Vec3::new(1e5, -3e4, 2e5);
    let mut far = random_soup(&mut random, 300, 0.4);
    far.points.iter_mut().for_each(|p| *p = center + *p * 100.0);
    let geometry = plan(|plan| plan.mesh(far, &[here()]));
    check("far away", &geometry, &rays(&mut random, 1000, 100.0, center));
}

#[test]
fn rays_along_the_axes_and_in_the_planes_of_triangles_are_met_as_by_brute_force() {
    let mut random = Random(5);
    let flat = soup((0..200).map(|_| {
        let at = random.point();
        [0; 3].map(|_| (at + random.point() * 0.5).with_z(0.25))
    }));
    let geometry = plan(|plan| plan.mesh(flat, &[here()]));
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let rays: Vec<Ray> = (0..960)
        .map(|i| {
            let direction = axes[i / 16 % 6];
            let origin = random.point() - direction * 2.0;
            let origin = if i % 2 == 0 { origin } else { origin.with_z(0.25) };
            Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, skip: Id::NONE, time: None }
        })
        .collect();
    check("axes", &geometry, &rays);
}

/// A sphere of triangles around the origin, with bumps of a part of its radius; neighbours share their vertices.
fn ball(random: &mut Random, rings: u32, bumps: f32, radius: f32) -> MeshShape {
    let sectors = 2 * rings;
    let mut points = vec![Vec3::Y * radius, Vec3::NEG_Y * radius];
    for ring in 1..rings {
        for sector in 0..sectors {
            let (polar, around) = (f64::from(ring) / f64::from(rings), f64::from(sector) / f64::from(sectors));
            let (sin, cos) = crate::math::sin_cos_degrees(polar * 180.0);
            let (s, c) = crate::math::sin_cos_degrees(around * 360.0);
            points.push(DVec3::new(sin * c, cos, sin * s).as_vec3() * radius * (1.0 - bumps * random.next()));
        }
    }
    let at = |ring: u32, sector: u32| 2 + (ring - 1) * sectors + sector % sectors;
    let mut triangles = Vec::new();
    for sector in 0..sectors {
        triangles.push([0, at(1, sector), at(1, sector + 1)]);
        triangles.push([1, at(rings - 1, sector + 1), at(rings - 1, sector)]);
        for ring in 1..rings - 1 {
            triangles.push([at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)]);
            triangles.push([at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)]);
        }
    }
    MeshShape { points, triangles, ..MeshShape::default() }
}

#[test]
fn no_ray_leaves_a_closed_mesh_between_its_triangles() {
    for (seed, size) in (0..).zip([1e-3, 1.0, 1e3, 1e6]) {
        let mut random = Random(seed);
        let mesh = ball(&mut random, 20, 0.3, size);
        // Straight at the corners, at the edges and at the middles.
        let mut targets = mesh.points.clone();
        for triangle in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.triangle_points(triangle);
            let somewhere = [b + (c - b) * random.next(), c + (a - c) * random.next()];
            targets.extend([(a + b) * 0.5, somewhere[0], somewhere[1], (a + b + c) / 3.0]);
        }
        let geometry = plan(|plan| plan.mesh(mesh, &[here()]));
        let from_middle = targets.iter().map(|&target| (Vec3::ZERO, target));
        let rays: Vec<Ray> = targets
            .iter()
            .map(|&target| (random.point() * 0.1 * size, target))
            .chain(from_middle)
            .map(|(origin, target)| {
                let direction = (target - origin).normalize();
                Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, skip: Id::NONE, time: None }
            })
            .collect();
        let mut hits = Hits::default();
        geometry.closest(rows(&rays).view(0.0), &mut hits, &mut Scratch::default());
        for (i, ray) in rays.iter().enumerate() {
            assert!(hits.get(i).id != Id::NONE, "size {size}: ray {i}, {ray:?}, slips through");
        }
        check("ball", &geometry, &rays.iter().step_by(50).copied().collect::<Vec<_>>());
    }
}

/// Rays that leave a convex shape as the shading sends them, out of each point that is seen, meet nothing: no specks.
#[test]
fn convex_shapes_cast_no_shadow_on_themselves_at_any_size() {
    let sizes = [1e-3f32, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6];
    for (size, away) in sizes.into_iter().flat_map(|size| [0.0, 3.0].map(|away| (size, away))) {
        let mut random = Random(11);
        let center = Vec3::new(1.0, -0.5, 0.7) * size * away;
        let at = DMat4::from_translation(center.as_dvec3());
        let mesh = ball(&mut random, 12, 0.0, size);
        let sphere = place(at * DMat4::from_scale(DVec3::splat(f64::from(size))));
        let geometries = [plan(|plan| plan.mesh(mesh, &[place(at)])), plan(|plan| plan.sphere(&sphere))];
        for geometry in &geometries {
            let seen = rays(&mut random, 1500, size, center);
            let seen: Vec<_> = seen.into_iter().filter(|ray| ray.origin.distance(center) > 1.5 * size).collect();
            let mut hits = Hits::default();
            geometry.closest(rows(&seen).view(0.0), &mut hits, &mut Scratch::default());
            let mut leaving = Vec::new();
            for (i, ray) in seen.iter().enumerate().filter(|(i, _)| hits.id.object[*i] != Id::NONE.object) {
                let hit = hits.get(i);
                let surface = geometry.surface(ray, &hit);
                let normal = surface.geometric * -surface.geometric.dot(ray.direction).signum();
                let origin = crate::math::offset(surface.point, normal);
                let skip = if geometry.is_flat(hit.id.object) { hit.id } else { Id::NONE };
                let side = (random.point() + normal * 1.8).normalize();
                for direction in [normal, side].into_iter().filter(|side| side.dot(normal) > 0.05) {
                    leaving.push(Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, skip, time: None });
                }
            }
            let mut blocked = Vec::new();
            geometry.occluded(rows(&leaving).view(0.0), &mut blocked, &mut Scratch::default());
            let specks = blocked.iter().filter(|&&blocked| blocked).count();
            assert!(leaving.len() > 300, "{} points are seen", leaving.len());
            assert_eq!(specks, 0, "of {} rays, size {size} at {center}", leaving.len());
        }
    }
}

#[test]
fn overlapping_and_enormous_scenes_are_met_as_by_brute_force() {
    let mut random = Random(31);
    let cube = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    let boxes = soup((0..2000).flat_map(|_| {
        let (center, half) = (random.point() * 0.3, random.point().abs() + 0.1);
        let corner =
            |i: u32| center + half * Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 }));
        cube.map(|face| face.map(corner))
    }));
    let geometry = plan(|plan| plan.mesh(boxes, &[here()]));
    check("boxes", &geometry, &rays(&mut random, 96, 1.0, Vec3::ZERO));
    for size in [1e-9, 1e9] {
        let mut mesh = random_soup(&mut random, 500, 0.3);
        mesh.points.iter_mut().for_each(|point| *point *= size);
        let geometry = plan(|plan| plan.mesh(mesh, &[here()]));
        check("enormous", &geometry, &rays(&mut random, 600, size, Vec3::ZERO));
    }
}

/// A ray that leaves a surface as the shading sends it does not meet the same place again.
#[test]
fn rays_that_leave_a_shape_with_a_formula_get_away_from_it() {
    use super::analytic::{Analytic, Banchoff, Cylinder, Flake, Julia, Torus};
    use std::sync::Arc;
    let c = glam::DVec4::new(-0.4, 0.2, 0.3, -0.2);
    let shapes: [Arc<dyn Analytic>; 5] = [
        Arc::new(Torus { tube: 0.25, ring: 1.0 }),
        Arc::new(Cylinder),
        Arc::new(Banchoff),
        Arc::new(Flake { level: 3, axis: DVec3::Y, radius: 0.6 }),
        Arc::new(Julia { c, iterations: 10, epsilon: 1e-5 }),
    ];
    for (shape, size) in shapes.iter().flat_map(|shape| [0.01, 1.0, 1000.0].map(|size| (shape, size))) {
        let at = DMat4::from_translation(DVec3::new(1.0, 2.0, -1.0) * size) * DMat4::from_scale(DVec3::splat(size));
        let geometry = plan(|plan| plan.analytic(shape.clone(), &[place(at)]));
        let mut random = Random(3);
        let (center, mut scratch) = (Vec3::new(1.0, 2.0, -1.0) * size as f32, Scratch::default());
        let (mut met, mut stuck) = (0, 0);
        for ray in rays(&mut random, 2000, size as f32, center) {
            let mut hit = Hit { t: f32::INFINITY, ..Hit::NONE };
            geometry.trace::<Portable>(&ray, false, &mut hit, &mut scratch);
            if hit.id == Id::NONE {
                continue;
            }
            let surface = geometry.surface(&ray, &hit);
            let side = if ray.direction.dot(surface.geometric) < 0.0 { surface.geometric } else { -surface.geometric };
            let origin = crate::math::offset(surface.point, side);
            let away =
                Ray { origin, direction: side, t_min: 0.0, t_max: 1e-3 * size as f32, skip: Id::NONE, time: None };
            let mut again = Hit { t: away.t_max, ..Hit::NONE };
            geometry.trace::<Portable>(&away, true, &mut again, &mut scratch);
            (met, stuck) = (met + 1, stuck + usize::from(again.id != Id::NONE));
        }
        // The folds of a Julia set come as near to each other as one likes.
        assert!(met > 200 && stuck * 100 <= met, "{shape:?} of size {size}: {stuck} of {met}");
    }
}

#[test]
fn what_a_ray_meets_does_not_depend_on_the_others_of_its_batch() {
    let mut random = Random(77);
    let geometry = plan(|plan| plan.mesh(random_soup(&mut random, 2000, 0.1), &[here()]));
    // From one place in all directions, as rays go that bounce off a surface; some end before they begin.
    let all: Vec<Ray> = (0..400)
        .map(|i| {
            let (origin, direction) = (Vec3::splat(0.1) + random.point() * 0.05, random.point().normalize());
            let t_max = if i % 11 == 0 { -1.0 } else { 0.3 + random.next() };
            Ray { origin, direction, t_min: 0.0, t_max, skip: Id::NONE, time: None }
        })
        .collect();
    let (mut scratch, mut hits, mut blocked) = (Scratch::default(), Hits::default(), Vec::new());
    let mut trace = |rays: &[Ray]| {
        let rows = rows(rays);
        blocked.clear();
        geometry.closest(rows.view(0.0), &mut hits, &mut scratch);
        geometry.occluded(rows.view(0.0), &mut blocked, &mut scratch);
        (0..rays.len()).map(|i| (bits(&hits.get(i)), blocked[i])).collect::<Vec<_>>()
    };
    let expected = trace(&all);
    let met = expected.iter().filter(|(hit, _)| hit.3 != Id::NONE).count();
    assert!((100..300).contains(&met), "{met} rays meet something");
    for first in [0, 5, 100] {
        for count in 1..80 {
            let batch = first..first + count;
            assert_eq!(trace(&all[batch.clone()]), expected[batch.clone()], "rays {batch:?}");
        }
    }
}

#[test]
fn nodes_know_their_children_from_the_farthest_to_the_nearest() {
    let mut random = Random(79);
    for count in 0..=8 {
        for scale in [1.0, 1e-30, 1e38] {
            let children: Vec<(Aabb, Child)> = (0..count)
                .map(|i| {
                    // Some lie in the same place.
                    let point = if i == 3 { Vec3::ZERO } else { (random.point() * 2.0).round() * 0.5 * scale };
                    (Aabb::around([point]), Child::node(i))
                })
                .collect();
            let node = Node::new(&children);
            for octant in (0..8).map(Octant) {
                let sign = Vec3::from_array([0, 1, 2].map(|axis| if octant.0 >> axis & 1 == 0 { 1.0 } else { -1.0 }));
                let slots = node.order.map(|slots| (slots >> octant.shift() & 7) as usize);
                let mut sorted = slots;
                sorted.sort_unstable();
                assert_eq!(sorted, [0, 1, 2, 3, 4, 5, 6, 7], "every slot has its place");
                assert!(slots[..8 - count].iter().all(|&slot| slot >= count), "what is not there comes first");
                let there = &slots[8 - count..];
                let distance = |slot: usize| (children[slot].0.min * sign).dot(Vec3::ONE);
                assert!(there.is_sorted_by(|&a, &b| distance(a) >= distance(b)), "{octant:?}: {there:?}");
            }
        }
    }
}

#[test]
fn neighbours_that_come_into_the_tree_by_one_gate_meet_what_they_meet_alone() {
    let mut random = Random(78);
    let bare = plan(|plan| plan.mesh(random_soup(&mut random, 2000, 0.05), &[here()]));
    let mut random = Random(78);
    let floored = plan(|plan| {
        plan.mesh(random_soup(&mut random, 2000, 0.05), &[here()]);
        plan.plane(Vec3::new(0.0, -1.5, 0.0), Vec3::Y, None, &here());
    });
    let (mut scratch, mut hits, mut blocked) = (Scratch::default(), Hits::default(), Vec::new());
    let (mut met, mut all) = (0, 0);
    for geometry in [&bare, &floored] {
        for width in [1e-3, 0.03, 0.3, 1.0] {
            // From a point, through a window that is beside everything at times; some end before they begin, and some
            // have been worked out wrong, which must not trouble the others.
            let (eye, target) = (random.point().normalize() * 4.0, random.point() * 1.5);
            let rays: Vec<Ray> = (0..300)
                .map(|i| {
                    let direction = (target + random.point() * width - eye).normalize();
                    let direction = if i % 13 == 5 { direction * f32::NAN } else { direction };
                    let origin = if i % 17 == 6 { eye * f32::NAN } else { eye };
                    let t_max = if i % 11 == 0 { -1.0 } else { 3.0 + 4.0 * random.next() };
                    Ray { origin, direction, t_min: 0.0, t_max, skip: Id::NONE, time: None }
                })
                .collect();
            let mut trace = |rays: &[Ray], level| {
                let rows = rows(rays);
                hits.resize(rays.len());
                blocked.resize(rays.len(), false);
                geometry.closest_at(level, rows.view(0.0), &mut hits, &mut scratch);
                geometry.occluded_at(level, rows.view(0.0), &mut blocked, &mut scratch);
                (0..rays.len()).map(|i| (bits(&hits.get(i)), blocked[i])).collect::<Vec<_>>()
            };
            let alone: Vec<_> = rays.iter().flat_map(|&ray| trace(&[ray], Level::Scalar)).collect();
            for level in simd::levels() {
                assert_eq!(trace(&rays, level), alone, "{level:?}, width {width}");
            }
            met += alone.iter().filter(|(hit, _)| hit.3 != Id::NONE).count();
            all += alone.len();
        }
    }
    assert!(met * 5 > all && met * 5 < all * 4, "{met} of {all} rays meet something");
}

/// Rays of whole groups: from a point, and towards one, as a camera and a light have them; the latter leave spheres.
fn bundles(random: &mut Random, geometry: &Geometry, scale: f32) -> Vec<Ray> {
    let mut rays = Vec::new();
    for bundle in 0..12 {
        let (point, target) = (random.point() * 4.0 * scale, random.point() * scale);
        let width = scale * [0.02, 0.2, 1.0][bundle % 3];
        // The second half of a group has another width, and the last group is not full.
        for i in 0..if bundle == 11 { 100 } else { 256 } {
            let end = target + random.point() * if i < 128 { width } else { width * 0.3 };
            let (direction, distance) = ((end - point).normalize(), (end - point).length());
            let mut ray =
                Ray { origin: point, direction, t_min: 0.0, t_max: f32::INFINITY, skip: Id::NONE, time: None };
            if bundle % 2 == 1 {
                let leaves = bundle as u32 % geometry.objects.len() as u32;
                (ray.origin, ray.direction, ray.t_max) = (end, -direction, distance);
                ray.skip = if bundle == 5 && i > 200 { Id::NONE } else { Id { object: leaves, index: 0 } };
                ray.t_max = if i % 7 == 0 { -1.0 } else { ray.t_max };
            }
            rays.push(ray);
        }
    }
    rays
}

#[test]
fn a_few_spheres_are_met_as_by_a_tree() {
    for count in 1..=10 {
        for (k, scale) in [1.0, 1e-2, 1e6].into_iter().enumerate() {
            let mut random = Random(1000 * count + k as u32);
            let geometry = plan(|plan| {
                for i in 0..count {
                    let size = f64::from(scale * (random.next() + 0.1)) * if i % 3 == 0 { 0.8 } else { 0.1 };
                    let at = DMat4::from_translation((random.point() * scale).as_dvec3());
                    plan.sphere(&place(at * DMat4::from_scale(DVec3::splat(size))));
                }
                if count % 4 == 0 {
                    plan.plane(Vec3::NEG_Y * scale, Vec3::Y, None, &here());
                }
            });
            assert_eq!(geometry.tree.root.is_node(), count > 8, "{count} spheres");
            let mut few = bundles(&mut random, &geometry, scale);
            few.extend(rays(&mut random, 600, scale, Vec3::ZERO));
            check(&format!("{count} spheres of size {scale}"), &geometry, &few);
        }
    }
}
