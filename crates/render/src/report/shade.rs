//! Hits in the report's meaning: a chunk at a time, each coordinate in a row of its own, so that the loops over them
//! are vectorised.

use glam::Vec3;

use super::{MAX_BOUNCES, Report, ReportLight, T_MIN, UNLIT, triangle};
use crate::geometry::{Geometry, Hit, Id, Ray, Shape};
use crate::material::{Material, Response};
use crate::math;
use crate::wave::{Batch, Node, PathRay, Queues, RayKind, ShadowRay};

/// Hits that are shaded together.
pub(super) const CHUNK: usize = 64;

/// One coordinate of all hits of a chunk.
type Row = [f32; CHUNK];

/// Hits in the original's terms.
pub(super) struct Points {
    position: [Row; 3],
    /// Not of unit length for triangles and planes.
    normal: [Row; 3],
    /// What was hit, and which node gathers the light.
    pub ids: [(Id, u32); CHUNK],
}

impl Points {
    pub const NONE: Points =
        Points { position: [[0.0; CHUNK]; 3], normal: [[0.0; CHUNK]; 3], ids: [(Id::NONE, 0); CHUNK] };
}

/// A light as the points of a chunk see it.
struct Sight {
    direction: [Row; 3],
    distance: Row,
    /// Between the light and the normal.
    cosine: Row,
    /// The part of the light that reaches a matte surface: the cosine and the linear decay.
    share: Row,
}

impl Report {
    /// Positions and normals of a chunk.
    #[inline(always)]
    pub(super) fn locate(&self, chunk: &Batch<'_>, points: &mut Points) {
        let geometry = chunk.geometry;
        let mut curved = [false; CHUNK];
        for (i, (path, hit)) in chunk.iter().enumerate() {
            let position = path.ray.origin + path.ray.direction * hit.t;
            let normal = match geometry.objects[hit.id.object as usize].shape {
                Shape::Sphere { center, .. } => {
                    curved[i] = true;
                    position - center
                }
                Shape::Plane(index) => self.plane_normals[index as usize],
                _ => facing_normal(geometry, &path.ray, hit),
            };
            points.ids[i] = (hit.id, path.node);
            for axis in 0..3 {
                points.position[axis][i] = position[axis];
                points.normal[axis][i] = normal[axis];
            }
        }
        let [nx, ny, nz] = &mut points.normal;
        for i in 0..CHUNK {
            let length = (nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i]).sqrt();
            let scale = if curved[i] && length > 0.0 { 1.0 / length } else { 1.0 };
            (nx[i], ny[i], nz[i]) = (nx[i] * scale, ny[i] * scale, nz[i] * scale);
        }
    }

    /// Light from the lights; nothing in between may be hit, glass included.
    #[inline(always)]
    pub(super) fn direct(
        &self,
        chunk: &Batch<'_>,
        material: &Material,
        points: &Points,
        colors: &[Vec3],
        queues: &mut Queues,
    ) {
        let phong = match material.response {
            Response::Phong { specular, power, .. } => Some((specular, power)),
            _ => None,
        };
        if self.lights.is_empty() && phong.is_none() {
            for (&color, &(_, node)) in colors.iter().zip(&points.ids) {
                queues.nodes[node as usize].direct += UNLIT * color;
            }
        }
        for light in &self.lights {
            let sight = Sight::of(light, points);
            for (i, &color) in colors.iter().enumerate() {
                let contribution = match phong {
                    Some(lobe) => highlighted(light, lobe, &sight, points, (i, color, chunk.ray(i).direction)),
                    None => light.color * color * sight.share[i],
                };
                // Nothing for no light, and for points in the light itself.
                if contribution != Vec3::ZERO && contribution.is_finite() {
                    let (skip, node) = points.ids[i];
                    // A little longer, so that a surface through the light itself is in the way everywhere.
                    let t_max = sight.distance[i] * 1.000_01;
                    let (origin, direction) = (at(&points.position, i), at(&sight.direction, i));
                    let ray = Ray { origin, direction, t_min: T_MIN, t_max, skip };
                    queues.shadows.push(ShadowRay { ray, contribution, node });
                }
            }
        }
    }
}

/// What a light gives to point `i` of a glossy surface, seen along `along`. (The light's range has no part in it.)
fn highlighted(
    light: &ReportLight,
    (specular, power): (Vec3, f32),
    sight: &Sight,
    points: &Points,
    (i, color, along): (usize, Vec3, Vec3),
) -> Vec3 {
    let (normal, cosine) = (at(&points.normal, i), sight.cosine[i]);
    let mirrored = (normal * (2.0 * cosine) - at(&sight.direction, i)).normalize_or(normal);
    0.5 * color * cosine + specular * light.color * signed_power(mirrored.dot(along), power)
}

/// What a material makes of the light from around.
pub(super) struct Share {
    pub reflected: f32,
    pub refracted: f32,
    eta: f32,
    /// What the sum of all light is multiplied by.
    pub gain: f32,
}

impl Share {
    pub fn of(material: &Material) -> Share {
        let (reflected, refracted, eta) = match material.response {
            Response::Mirror => (1.0, 0.0, 0.0),
            Response::Glass { eta, .. } => (0.0, 1.0, eta),
            // The original never set an index for the one material of these that refracts.
            Response::Procedural { reflection, transmission } => (reflection, transmission, 0.0),
            _ => (0.0, 0.0, 0.0),
        };
        Share { reflected, refracted, eta, gain: 1.0 / (1.0 + reflected + refracted) }
    }
}

impl Sight {
    #[inline(always)]
    fn of(light: &ReportLight, points: &Points) -> Sight {
        let row = [0.0; CHUNK];
        let mut sight = Sight { direction: [row; 3], distance: row, cosine: row, share: row };
        let ([px, py, pz], [nx, ny, nz]) = (&points.position, &points.normal);
        let [dx, dy, dz] = &mut sight.direction;
        for i in 0..CHUNK {
            let (x, y, z) = (light.position.x - px[i], light.position.y - py[i], light.position.z - pz[i]);
            let distance = (x * x + y * y + z * z).sqrt();
            let inverse = 1.0 / distance;
            (dx[i], dy[i], dz[i]) = (x * inverse, y * inverse, z * inverse);
            sight.distance[i] = distance;
            let cosine = nx[i] * dx[i] + ny[i] * dy[i] + nz[i] * dz[i];
            sight.cosine[i] = cosine;
            let reached = cosine > 0.0 && distance <= light.range;
            sight.share[i] = if reached { cosine * (1.0 - distance / light.range) } else { 0.0 };
        }
        sight
    }
}

/// Point `i` of three rows.
#[inline(always)]
fn at(rows: &[Row; 3], i: usize) -> Vec3 {
    Vec3::new(rows[0][i], rows[1][i], rows[2][i])
}

/// The normal of a triangle towards the ray, as long as its edges make it; of other shapes their own.
fn facing_normal(geometry: &Geometry, ray: &Ray, hit: &Hit) -> Vec3 {
    match triangle(geometry, hit) {
        Some([a, b, c]) => {
            let normal = (b - a).cross(c - a);
            if normal.dot(ray.direction) > 0.0 { -normal } else { normal }
        }
        None => geometry.surface(ray, hit).geometric,
    }
}

/// Queues the secondary rays of a chunk.
#[inline(always)]
pub(super) fn spawn_all(chunk: &Batch<'_>, share: &Share, points: &Points, queues: &mut Queues) {
    for (i, (path, hit)) in chunk.iter().enumerate() {
        if path.depth.total() >= MAX_BOUNCES {
            continue;
        }
        let (d, normal) = (path.ray.direction, at(&points.normal, i));
        let from = |direction| Ray {
            origin: at(&points.position, i),
            direction,
            t_min: T_MIN,
            t_max: f32::INFINITY,
            skip: hit.id,
        };
        if share.reflected > 0.0 {
            let mirrored = d - normal * (2.0 * normal.dot(d));
            spawn(path, from(mirrored.normalize_or(d)), share.reflected, RayKind::Reflection, queues);
        }
        if share.refracted > 0.0
            && let Some(direction) = refract(d, normal, share.eta)
        {
            spawn(path, from(direction), share.refracted, RayKind::Refraction, queues);
        }
    }
}

/// Queues a secondary ray with a node of its own.
#[inline(always)]
fn spawn(path: &PathRay, ray: Ray, weight: f32, kind: RayKind, queues: &mut Queues) {
    let node = queues.nodes.len() as u32;
    queues.nodes.push(Node { direct: Vec3::ZERO, indirect: Vec3::ZERO, parent: path.node, weight, gain: 0.0 });
    let depth = if kind == RayKind::Refraction { path.depth.refracted() } else { path.depth.reflected() };
    queues.rays.push(PathRay { ray, weight: Vec3::ONE, node, key: path.key, kind, depth });
}

/// The refracted direction. (Snell's law has `m |h|` where the original has `m`.)
fn refract(d: Vec3, normal: Vec3, eta: f32) -> Option<Vec3> {
    let h = normal.dot(d);
    let (m, n) = if h < 0.0 { (1.0 / eta, normal) } else { (eta, -normal) };
    let sine2 = (1.0 - h * h) * m * m;
    if !m.is_finite() || sine2 > 1.0 {
        return None;
    }
    (d * m - n * (m + (1.0 - sine2).sqrt())).try_normalize()
}

/// `base` to a power; negative bases keep their sign for odd whole exponents, and give nothing for broken ones.
fn signed_power(base: f32, exponent: f32) -> f32 {
    let power = math::pow(base.abs().min(1.0), exponent.max(0.0));
    match exponent % 2.0 {
        _ if base >= 0.0 => power,
        0.0 => power,
        rest if rest.abs() == 1.0 => -power,
        _ => 0.0,
    }
}
