//! A triangle that shines to its front.

use glam::Vec3;

use super::fan::Shape;
use super::{Arrival, BEFORE, Receiver};
use crate::math;

/// The triangle; its corners run counter-clockwise as seen from the front.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shining {
    corners: [Vec3; 3],
    /// Of unit length.
    pub(super) normal: Vec3,
    pub(super) area: f32,
    pub(super) radiance: Vec3,
    /// The part of the area of its light that lies in the triangles up to this one.
    below: f32,
    /// Of all triangles of the light.
    total: f32,
}

/// Solid angles below which rounding spoils the angles of the spherical triangle, and samples are spread over the area
/// instead: [Pharr, Jakob, Humphreys 2023] "Physically Based Rendering", §6.5.4.
const SMALL: f32 = 3e-4;

impl Shining {
    /// `None` for triangles without area.
    pub fn new(corners: [Vec3; 3], radiance: Vec3) -> Option<Shining> {
        let [a, b, c] = corners;
        let cross = (b - a).cross(c - a);
        let normal = cross.try_normalize()?;
        Some(Shining { corners, normal, area: 0.5 * cross.length(), radiance, below: 1.0, total: 0.0 })
    }

    /// All triangles of a light, with their parts of its area.
    pub fn all(triangles: impl IntoIterator<Item = [Vec3; 3]>, radiance: Vec3) -> Vec<Shining> {
        let mut all: Vec<Shining> =
            triangles.into_iter().filter_map(|corners| Shining::new(corners, radiance)).collect();
        let total: f64 = all.iter().map(|triangle| f64::from(triangle.area)).sum();
        let mut below = 0.0;
        for triangle in &mut all {
            below += f64::from(triangle.area);
            triangle.below = (below / total) as f32;
            triangle.total = total as f32;
        }
        all
    }

    /// A point of it, evenly for two uniform numbers.
    pub fn point(&self, xi: [f32; 2]) -> Vec3 {
        point_of(self.corners, xi)
    }

    /// How a point sees the triangle, unless it sees its back, or lies above it.
    pub(super) fn seen_from(&self, at: &Receiver) -> Option<Seen> {
        let [a, b, c] = self.corners;
        let to = [a - at.point, b - at.point, c - at.point];
        let facing = to[0].dot(self.normal) < 0.0;
        if !facing || to[0].dot(at.normal) <= 0.0 && to[1].dot(at.normal) <= 0.0 && to[2].dot(at.normal) <= 0.0 {
            return None;
        }
        let (normal, height) = (self.normal, to[0].dot(self.normal));
        Some(match Spherical::new(to) {
            Some(spherical) => Seen::Wide(Wide { spherical, normal, height }),
            None => Seen::Small(Small { to, normal, area: self.area }),
        })
    }
}

/// A sample of a light of many triangles: one of them is chosen by its area.
pub(super) fn choose(triangles: &[Shining], at: &Receiver, xi: [f32; 2]) -> Arrival {
    let Some((triangle, place)) = by_area(triangles, xi) else { return Arrival::NONE };
    // By the area of all: as often as it is chosen it stands for the others.
    let seen =
        Small { to: triangle.corners.map(|corner| corner - at.point), normal: triangle.normal, area: triangle.total };
    let (direction, distance, weight) = seen.sample(place);
    Arrival { direction, distance, irradiance: triangle.radiance * weight.max(0.0) }
}

/// A triangle, the larger the likelier, and what is left of the two uniform numbers.
pub(super) fn by_area(triangles: &[Shining], [u, v]: [f32; 2]) -> Option<(&Shining, [f32; 2])> {
    let chosen = triangles.partition_point(|triangle| triangle.below <= u).min(triangles.len().checked_sub(1)?);
    let first = if chosen == 0 { 0.0 } else { triangles[chosen - 1].below };
    let rest = ((u - first) / (triangles[chosen].below - first)).clamp(0.0, 1.0);
    Some((&triangles[chosen], [rest, v]))
}

/// A point of a triangle, evenly for two uniform numbers ([Heitz 2019] "A Low-Distortion Map Between Triangle and Square").
#[inline(always)]
fn point_of([a, b, c]: [Vec3; 3], [u, v]: [f32; 2]) -> Vec3 {
    let (x, y) = if v > u { (u * 0.5, v - u * 0.5) } else { (u - v * 0.5, v * 0.5) };
    a * (1.0 - x - y) + b * x + c * y
}

/// A triangle as a point sees it.
pub(super) enum Seen {
    Wide(Wide),
    Small(Small),
}

/// Under a wide angle.
pub(super) struct Wide {
    spherical: Spherical,
    normal: Vec3,
    /// Of the triangle's plane above the point, along its normal.
    height: f32,
}

impl Shape for Wide {
    /// Spread evenly over the solid angle.
    #[inline(always)]
    fn sample(&self, xi: [f32; 2]) -> (Vec3, f32, f32) {
        let direction = self.spherical.direction(xi);
        (direction, self.height / direction.dot(self.normal) * BEFORE, self.spherical.solid_angle)
    }
}

/// Under so small an angle that its area will do.
pub(super) struct Small {
    /// From the point to the corners.
    to: [Vec3; 3],
    normal: Vec3,
    area: f32,
}

impl Shape for Small {
    /// Spread evenly over the area.
    #[inline(always)]
    fn sample(&self, xi: [f32; 2]) -> (Vec3, f32, f32) {
        let to = point_of(self.to, xi);
        let distance2 = to.dot(to);
        let distance = distance2.sqrt();
        let direction = to * (1.0 / distance);
        (direction, distance * BEFORE, -direction.dot(self.normal) * self.area / distance2)
    }
}

/// A triangle on the unit sphere.
struct Spherical {
    a: Vec3,
    b: Vec3,
    /// Of c, at right angles to a, of unit length.
    c_from_a: Vec3,
    cos_ab: f32,
    alpha: f32,
    sin_alpha: f32,
    cos_alpha: f32,
    solid_angle: f32,
}

impl Spherical {
    /// `None` where the triangle is seen too small for the angles to be exact.
    fn new([a, b, c]: [Vec3; 3]) -> Option<Self> {
        let (a, b, c) = (a.normalize_or_zero(), b.normalize_or_zero(), c.normalize_or_zero());
        let (ab, bc, ca) = (a.cross(b).try_normalize()?, b.cross(c).try_normalize()?, c.cross(a).try_normalize()?);
        let cos_alpha = (-ab.dot(ca)).clamp(-1.0, 1.0);
        let angle = |cosine: f32| math::acos(cosine.clamp(-1.0, 1.0));
        let (alpha, beta, gamma) = (math::acos(cos_alpha), angle(-bc.dot(ab)), angle(-ca.dot(bc)));
        let solid_angle = alpha + beta + gamma - std::f32::consts::PI;
        let c_from_a = (c - a * a.dot(c)).normalize_or_zero();
        let sin_alpha = (1.0 - cos_alpha * cos_alpha).sqrt();
        (solid_angle >= SMALL).then(|| Spherical {
            a,
            b,
            c_from_a,
            cos_ab: a.dot(b),
            alpha,
            sin_alpha,
            cos_alpha,
            solid_angle,
        })
    }

    /// A direction evenly spread over it ([Arvo 1995] "Stratified Sampling of Spherical Triangles").
    #[inline(always)]
    fn direction(&self, [u, v]: [f32; 2]) -> Vec3 {
        let Spherical { a, b, sin_alpha, cos_alpha, .. } = *self;
        let (s, t) = math::sin_cos_turns((u * self.solid_angle - self.alpha) * (0.5 * std::f32::consts::FRAC_1_PI));
        // Where the arc from b cuts off the part u of the triangle.
        let (p, q) = (t - cos_alpha, s + sin_alpha * self.cos_ab);
        let cosine = ((q * t - p * s) * cos_alpha - q) / ((q * s + p * t) * sin_alpha);
        let cosine = if cosine.is_nan() { 1.0 } else { cosine.clamp(-1.0, 1.0) };
        let cut = a * cosine + self.c_from_a * (1.0 - cosine * cosine).sqrt();
        let height = 1.0 - v * (1.0 - cut.dot(b));
        let across = cut - b * b.dot(cut);
        let scale = 1.0 / across.dot(across).sqrt();
        let across = across * if scale < f32::INFINITY { scale } else { 0.0 };
        b * height + across * (1.0 - height * height).max(0.0).sqrt()
    }
}
