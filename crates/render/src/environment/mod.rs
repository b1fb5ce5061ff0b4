//! Light from infinitely far away, out of every direction: a sky, or a picture of the surroundings.
//!
//! Both are unfolded to the unit square. A table of brightness there chooses directions to the light.

mod distribution;
mod panorama;
mod sky;
mod sun;
mod table;

pub(crate) use sun::sun;
pub(crate) use table::Table;

use std::sync::Arc;

use glam::Vec3;

use crate::material::PictureMap;
use distribution::Distribution2d;
use panorama::Panorama;
use sky::Sky;

/// What surrounds the scene.
#[derive(Debug)]
pub(crate) struct Environment {
    surroundings: Surroundings,
    distribution: Distribution2d,
}

#[derive(Debug)]
enum Surroundings {
    Sky(Sky),
    Panorama(Panorama),
}

/// What lies at a point of the unfolded surroundings.
struct Sight {
    /// Unit vector.
    direction: Vec3,
    radiance: Vec3,
    /// Solid angle per area of the unit square.
    stretch: f32,
}

impl Environment {
    /// A clear sky after Preetham without its sun, which stands in the direction `sundir` of the world. Without a colour
    /// for the ground, the sky of the horizon goes on below it.
    pub fn sky(up: Vec3, east: Vec3, sundir: Vec3, turbidity: f32, ground: Option<Vec3>) -> Environment {
        let sky = Sky::new(up, east, sundir, turbidity, ground);
        let distribution = sky.distribution();
        Environment { surroundings: Surroundings::Sky(sky), distribution }
    }

    /// A picture by longitude and latitude: `center` points to its middle, `up` to its top edge.
    pub fn picture(map: Arc<PictureMap>, center: Vec3, up: Vec3) -> Environment {
        let panorama = Panorama::new(map, center, up);
        let distribution = panorama.distribution();
        Environment { surroundings: Surroundings::Panorama(panorama), distribution }
    }

    /// What is seen in a direction, a unit vector.
    #[inline]
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        match &self.surroundings {
            Surroundings::Sky(sky) => sky.seen(direction),
            Surroundings::Panorama(panorama) => panorama.radiance(direction),
        }
    }

    /// A unit vector towards the light, for two uniform numbers from 0 to 1, and the radiance from there divided by the
    /// density of such vectors over solid angle, so that its mean is the integral over the sphere. `None` where no light
    /// comes from; that counts as zero.
    ///
    /// As a light, a sky is not [`constrained`](sky::constrain): colours out of gamut add up to colours within.
    #[inline]
    pub fn sample(&self, xi: [f32; 2]) -> Option<(Vec3, Vec3)> {
        let (uv, density) = self.distribution.sample(xi);
        let Sight { direction, radiance, stretch } = match &self.surroundings {
            Surroundings::Sky(sky) => sky.unfold(uv),
            Surroundings::Panorama(panorama) => panorama.unfold(uv),
        };
        let weighted = radiance * (stretch / density);
        (weighted != Vec3::ZERO && weighted.is_finite()).then_some((direction, weighted))
    }
}

#[cfg(test)]
mod tests;
