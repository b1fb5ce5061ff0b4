//! What matte and coated surfaces do with light from a direction, and rays into glossy lobes (format reference, §3.10).

use glam::Vec3;

use super::point::{Point, Which};
use super::{Queues, Sunflow};
use crate::math;
use crate::wave::{Path, RayKind};

/// How much light a surface sends to the viewer, per light that arrives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bsdf {
    matte: Vec3,
    lobe: Lobe,
}

#[derive(Debug, Clone, Copy)]
enum Lobe {
    None,
    /// Around the mirror direction; the scale makes its energy that of the specular colour.
    Phong {
        specular: Vec3,
        mirrored: Vec3,
        power: f32,
    },
    /// In the axes of the surface; `back` points to the viewer.
    Ward {
        specular: Vec3,
        frame: [Vec3; 3],
        back: Vec3,
        roughness: [f32; 2],
    },
}

impl Bsdf {
    /// A matte surface of a colour.
    pub fn matte(color: Vec3) -> Bsdf {
        Bsdf { matte: color * std::f32::consts::FRAC_1_PI, lobe: Lobe::None }
    }

    pub fn with_phong(self, point: &Point<'_>, power: f32) -> Bsdf {
        let specular = point.gloss * ((power + 2.0) * 0.5 * std::f32::consts::FRAC_1_PI);
        let lobe = Lobe::Phong { specular, mirrored: point.mirrored(), power };
        if specular == Vec3::ZERO { self } else { Bsdf { lobe, ..self } }
    }

    pub fn with_ward(self, point: &Point<'_>, frame: [Vec3; 3], roughness: [f32; 2]) -> Bsdf {
        let lobe = Lobe::Ward { specular: point.gloss, frame, back: -point.direction, roughness };
        if point.gloss == Vec3::ZERO { self } else { Bsdf { lobe, ..self } }
    }

    pub fn is_black(&self) -> bool {
        self.matte == Vec3::ZERO && matches!(self.lobe, Lobe::None)
    }

    /// What it is for light from anywhere in front, where that is all the same.
    pub fn matte_only(&self) -> Option<Vec3> {
        matches!(self.lobe, Lobe::None).then_some(self.matte)
    }

    /// For light from a direction.
    #[inline]
    pub fn value(&self, direction: Vec3) -> Vec3 {
        match self.lobe {
            Lobe::None => self.matte,
            Lobe::Phong { specular, mirrored, power } => {
                self.matte + specular * math::pow(direction.dot(mirrored).clamp(0.0, 1.0), power)
            }
            Lobe::Ward { specular, frame, back, roughness } => {
                self.matte + specular * ward(frame, back, direction, roughness)
            }
        }
    }
}

/// [Ward 1992] "Measuring and Modeling Anisotropic Reflection", eq. 5a, by the half vector.
fn ward([u, v, w]: [Vec3; 3], back: Vec3, light: Vec3, [ax, ay]: [f32; 2]) -> f32 {
    let grazing = back.dot(w) * light.dot(w);
    if grazing <= 0.0 {
        return 0.0;
    }
    let half = back + light;
    let (x, y, z) = (half.dot(u) / ax, half.dot(v) / ay, half.dot(w));
    let falls = jaspe_noise::math::exp(-f64::from((x * x + y * y) / (z * z))) as f32;
    falls / (4.0 * std::f32::consts::PI * ax * ay * grazing.sqrt())
}

impl Sunflow {
    /// Rays into the Phong lobe around the mirror direction.
    pub(super) fn glossy_phong(&self, point: &Point<'_>, power: f32, samples: u32, queues: &mut Queues<Vec<Vec3>>) {
        let count = self.glossy_count(point, samples);
        let around = point.mirrored();
        let scale = (power + 2.0) / (power + 1.0) / count as f32;
        for i in 0..count {
            let [turn, height] = point.key.nth(i, count).pair(point.dimension(Which::Glossy));
            let cosine = math::pow(1.0 - height, 1.0 / (power + 1.0));
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let direction = math::around(around, turn, sine, cosine);
            self.glossy(point, direction, scale * direction.dot(point.surface.normal), [i, count], queues);
        }
    }

    /// Rays into Ward's lobe ([Walter 2005] "Notes on the Ward BRDF", eq. 6 and 7, and Sunflow's weight).
    pub(super) fn glossy_ward(
        &self,
        point: &Point<'_>,
        frame: [Vec3; 3],
        [ax, ay]: [f32; 2],
        samples: u32,
        queues: &mut Queues<Vec<Vec3>>,
    ) {
        let count = self.glossy_count(point, samples);
        let ([u, v, w], back) = (frame, -point.direction);
        for i in 0..count {
            let [turn, height] = point.key.nth(i, count).pair(point.dimension(Which::Glossy));
            // The angle whose tangent is the circle's, stretched.
            let (sin, cos) = math::sin_cos_turns(turn);
            let stretched = Vec3::new(ax * cos, ay * sin, 0.0).normalize_or(Vec3::X);
            let (cos_phi, sin_phi) = (stretched.x, stretched.y);
            let spread = cos_phi * cos_phi / (ax * ax) + sin_phi * sin_phi / (ay * ay);
            let tangent2 = -(jaspe_noise::math::ln(f64::from(1.0 - height)) as f32) / spread;
            let cosine = 1.0 / (1.0 + tangent2).sqrt();
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let half = u * (sine * cos_phi) + v * (sine * sin_phi) + w * cosine;
            let toward = half.dot(back);
            let direction = (half * (2.0 * toward) - back).normalize_or(w);
            let weight = toward * cosine * cosine * cosine * (direction.dot(w) / back.dot(w)).abs().sqrt();
            self.glossy(point, direction, weight / count as f32, [i, count], queues);
        }
    }

    /// How many rays go into a lobe: the deeper the fewer.
    fn glossy_count(&self, point: &Point<'_>, samples: u32) -> u32 {
        let depth = point.path.depth;
        match depth.total() {
            _ if depth.reflection >= self.max_reflection || depth.diffuse > 0 || point.gloss == Vec3::ZERO => 0,
            0 => point.count(samples),
            _ => samples.min(1),
        }
    }

    fn glossy(
        &self,
        point: &Point<'_>,
        direction: Vec3,
        weight: f32,
        [i, count]: [u32; 2],
        queues: &mut Queues<Vec<Vec3>>,
    ) {
        if weight <= 0.0 || direction.dot(point.surface.geometric) <= 0.0 {
            return;
        }
        let path = Path {
            weight: point.path.weight * point.gloss * weight,
            index: point.key.nth(i, count).index,
            kind: RayKind::Glossy,
            depth: point.path.depth.reflected(),
            ..*point.path
        };
        self.queue(point, [point.front, direction], path, queues);
    }
}
