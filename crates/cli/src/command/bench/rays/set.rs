//! The rays that are traced: those of a camera, and those that go on from what it sees.

use jaspe_render::{Answers, Hierarchy, MeshFile, RaySet};

use super::embree::Query;

/// Pixels along each edge of the picture.
const SIDE: u32 = 1024;

/// Rays of a call: as many as a renderer has at hand at a time, and few enough for the cache.
const BATCH: usize = 4096;

/// A kind of ray, in batches.
pub struct RayKind {
    pub name: &'static str,
    pub query: Query,
    pub batches: Vec<RaySet>,
}

type Point = [f32; 3];

fn map(a: Point, b: Point, f: impl Fn(f32, f32) -> f32) -> Point {
    std::array::from_fn(|k| f(a[k], b[k]))
}

fn add(a: Point, b: Point, scale: f32) -> Point {
    map(a, b, |a, b| a + b * scale)
}

fn dot(a: Point, b: Point) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn unit(v: Point) -> Point {
    let scale = 1.0 / dot(v, v).sqrt();
    v.map(|c| c * scale)
}

/// Reproducible numbers from 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    /// A point of the unit sphere.
    fn on_sphere(&mut self) -> Point {
        loop {
            let p = [(); 3].map(|()| self.next() * 2.0 - 1.0);
            if (0.01..1.0).contains(&dot(p, p)) {
                return unit(p);
            }
        }
    }
}

/// A picture of a mesh that fills most of it, from in front, above and a little to the right; a lamp stands to the left.
struct View {
    eye: Point,
    lamp: Point,
    /// Half the diagonal of the mesh's box.
    size: f32,
    right: Point,
    up: Point,
    forward: Point,
}

impl View {
    fn of(mesh: &MeshFile) -> View {
        let corner = |first: f32, f: fn(f32, f32) -> f32| mesh.points.iter().fold([first; 3], |a, &b| map(a, b, f));
        let (min, max) = (corner(f32::INFINITY, f32::min), corner(f32::NEG_INFINITY, f32::max));
        let center = map(min, max, |a, b| (a + b) * 0.5);
        let half = map(max, min, |a, b| (a - b) * 0.5);
        let size = dot(half, half).sqrt();
        let eye = add(center, unit([0.3, 0.6, 1.0]), 2.2 * size);
        let forward = unit(add(center, eye, -1.0));
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        View { eye, lamp: add(center, [-0.7, 1.5, 0.6], 1.5 * size), size, right, up: cross(right, forward), forward }
    }

    /// Rays through the middles of pixels, in squares of squares (the order of [Morton 1966]): neighbours in the order are
    /// neighbours in the picture.
    fn camera(&self) -> impl Iterator<Item = (Point, Point)> {
        (0..SIDE * SIDE).map(|i| {
            let [x, y] = [i, i >> 1].map(|bits| {
                let even = (0..16).fold(0, |sum, bit| sum | (bits >> (2 * bit) & 1) << bit);
                (even as f32 + 0.5) / SIDE as f32 - 0.5
            });
            (self.eye, unit(add(add(self.forward, self.right, x), self.up, -y)))
        })
    }
}

/// All kinds of rays for a mesh.
pub fn kinds(mesh: &MeshFile, hierarchy: &Hierarchy) -> Vec<RayKind> {
    let view = View::of(mesh);
    let camera: Vec<_> = view.camera().map(|(origin, direction)| (origin, direction, f32::INFINITY)).collect();
    let points = seen(mesh, hierarchy, &camera, view.size * 1e-4);
    let mut random = Random(1);
    // Cosine-distributed: a point of the unit sphere around the tip of the normal.
    let mut scattered = |end: f32| -> Vec<_> {
        let ray = |&(point, normal): &(Point, Point)| (point, unit(add(normal, random.on_sphere(), 0.999)), end);
        points.iter().map(ray).collect()
    };
    let (bounce, ambient) = (scattered(f32::INFINITY), scattered(0.5 * view.size));
    let mut shuffled = bounce.clone();
    for i in (1..shuffled.len()).rev() {
        shuffled.swap(i, ((random.next() * (i + 1) as f32) as usize).min(i));
    }
    let shadow = points.iter().map(|&(point, _)| (point, add(view.lamp, point, -1.0), 1.0)).collect();
    vec![
        kind("camera", Query::Closest, camera),
        kind("bounce", Query::Closest, bounce),
        kind("shuffled", Query::Closest, shuffled),
        kind("ambient occlusion", Query::Any, ambient),
        kind("shadow", Query::Any, shadow),
    ]
}

fn kind(name: &'static str, query: Query, rays: Vec<(Point, Point, f32)>) -> RayKind {
    let batch = |rays: &[(Point, Point, f32)]| {
        let mut set = RaySet::default();
        rays.iter().for_each(|&(origin, direction, end)| set.push(origin, direction, end));
        set
    };
    RayKind { name, query, batches: rays.chunks(BATCH).map(batch).collect() }
}

/// The points that the camera sees, a little off the surface, and their normals towards the camera.
fn seen(mesh: &MeshFile, hierarchy: &Hierarchy, camera: &[(Point, Point, f32)], off: f32) -> Vec<(Point, Point)> {
    let mut answers = Answers::default();
    let mut points = Vec::new();
    for batch in kind("camera", Query::Closest, camera.to_vec()).batches {
        hierarchy.closest(&batch, &mut answers);
        for i in 0..batch.len() {
            let (Some(hit), (origin, direction, _)) = (answers.hit(i), batch.get(i)) else { continue };
            let [a, b, c] = mesh.triangles[hit.triangle as usize].map(|corner| mesh.points[corner as usize]);
            let normal = unit(cross(add(b, a, -1.0), add(c, a, -1.0)));
            let normal = if dot(normal, direction) > 0.0 { normal.map(|c| -c) } else { normal };
            if normal.iter().all(|c| c.is_finite()) {
                points.push((add(add(origin, direction, hit.t), normal, off), normal));
            }
        }
    }
    points
}
