//! What turns the normals of a surface: heights and normals from pictures, procedural textures and noise.
//!
//! Formulas and quirks follow the format reference, §3.11; procedural heights are ours.

mod perlin;

use std::sync::Arc;

use glam::{Vec2, Vec3};
use jaspe_noise::Dual;
use jaspe_texture::{Space, Texture};

use crate::affine::Affine;
use crate::material::{PictureMap, luminance};

/// A modifier, ready to use. Pictures hold what is stored in their files, undecoded: [`PictureMap::raw`].
#[derive(Debug, Clone)]
pub(crate) enum Modifier {
    /// Heights from a picture: `scale` multiplies the difference of neighbouring texels.
    Bump { picture: Arc<PictureMap>, scale: f32 },
    /// Heights from a procedural texture: `scale` multiplies its gradient in world units.
    BumpProcedural { texture: Box<Texture>, scale: f32 },
    /// Normals from the colours of a picture.
    NormalMap { picture: Arc<PictureMap> },
    /// Heights from Sunflow's noise.
    Perlin { function: i32, size: f32, scale: f32 },
}

/// Where a normal is to be turned.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place<'a> {
    /// In the world.
    pub point: Vec3,
    /// Unit vector in the world, on the geometric side.
    pub normal: Vec3,
    /// U and V of the shading basis: unit vectors in the world.
    pub tangent: [Vec3; 2],
    /// Texture coordinates.
    pub uv: Vec2,
    /// Takes world points to the object's own space.
    pub object_from_world: &'a Affine,
}

impl Modifier {
    /// The turned normal, a unit vector of the world; the old one where the modifier makes nothing usable.
    pub fn normal(&self, at: &Place) -> Vec3 {
        let turned = match self {
            Modifier::Bump { picture, scale } => bump(picture, *scale, at),
            Modifier::BumpProcedural { texture, scale } => at.normal - *scale * slope(texture, at),
            Modifier::NormalMap { picture } => at.world_from_tangent(2.0 * picture.smooth(at.uv) - Vec3::ONE),
            Modifier::Perlin { function, size, scale } => perlin(*function, *size, *scale, at),
        };
        turned.normalize_or(at.normal)
    }
}

impl Place<'_> {
    /// To the world, from the space where the normal is the third axis.
    fn world_from_tangent(&self, v: Vec3) -> Vec3 {
        let [tangent_u, tangent_v] = self.tangent;
        tangent_u * v.x + tangent_v * v.y + self.normal * v.z
    }
}

/// Sunflow: differences are taken to the next texel and not divided by its width, so that bumps are the flatter the larger
/// the picture (R24).
fn bump(picture: &PictureMap, scale: f32, at: &Place) -> Vec3 {
    let [width, height] = picture.size();
    let brightness = |du: f32, dv: f32| luminance(picture.smooth(at.uv + Vec2::new(du, dv)));
    let here = brightness(0.0, 0.0);
    let rise = [brightness(1.0 / width as f32, 0.0) - here, brightness(0.0, 1.0 / height as f32) - here];
    at.world_from_tangent(Vec3::new(-scale * rise[0], -scale * rise[1], 1.0))
}

/// The gradient of a texture's coefficient along the surface, per world unit. Textures in texture coordinates have it per
/// unit of u and v, whose lengths in the world are unknown here.
fn slope(texture: &Texture, at: &Place) -> Vec3 {
    let gradient = |point: Vec3| Vec3::from(texture.value(Dual::<f32, 3>::point(point.into())).gradient);
    let gradient = match texture.space() {
        Space::World => gradient(at.point),
        Space::Local => at.object_from_world.transposed(gradient(at.object_from_world.point(at.point))),
        Space::Uv => {
            let [along_u, along_v] = texture.value(Dual::<f32, 2>::point(at.uv.into())).gradient;
            return at.world_from_tangent(Vec3::new(along_u, along_v, 0.0));
        }
    };
    gradient - at.normal * gradient.dot(at.normal)
}

/// Sunflow: the normal is turned in the object's space, by the whole gradient there and not only its part along the
/// surface, and neither is rescaled: an object that has been enlarged has flatter bumps.
fn perlin(function: i32, size: f32, scale: f32, at: &Place) -> Vec3 {
    let point = at.object_from_world.point(at.point) * size;
    let gradient = perlin::height(function, Dual::<f32, 3>::point(point.into())).gradient;
    let normal = at.object_from_world.normal(at.normal) - scale * Vec3::from(gradient);
    at.object_from_world.transposed(normal.normalize_or_zero())
}

#[cfg(test)]
mod tests;
