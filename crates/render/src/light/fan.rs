//! Light that may arrive, in rows, so that the loops over it are vectorised.

use glam::Vec3;

use super::Arrival;
use crate::geometry::simd::{self, Simd};
use crate::sampler::SampleKey;

/// Arrivals that are worked out together.
pub(crate) const FAN: usize = 32;

/// Arrivals at a point from many directions, or at many points: see [`Arrival`] for what the rows mean.
#[derive(Debug, Clone)]
pub(crate) struct Fan {
    pub size: usize,
    pub direction: [[f32; FAN]; 3],
    pub distance: [f32; FAN],
    pub irradiance: [[f32; FAN]; 3],
}

/// A light as a point sees it. What `sample` calls must be `#[inline(always)]`.
pub(crate) trait Shape {
    /// For two uniform numbers: the direction, how far the light is there, and the sample's irradiance on a surface that
    /// faces it, per radiance, times the number of samples; not above zero where nothing arrives.
    fn sample(&self, xi: [f32; 2]) -> (Vec3, f32, f32);
}

impl Default for Fan {
    fn default() -> Self {
        Fan { size: 0, direction: [[0.0; FAN]; 3], distance: [0.0; FAN], irradiance: [[0.0; FAN]; 3] }
    }
}

impl Fan {
    #[inline(always)]
    pub fn direction(&self, i: usize) -> Vec3 {
        Vec3::new(self.direction[0][i], self.direction[1][i], self.direction[2][i])
    }

    #[inline(always)]
    pub fn set(&mut self, i: usize, Arrival { direction, distance, irradiance }: Arrival) {
        self.distance[i] = distance;
        for axis in 0..3 {
            self.direction[axis][i] = direction[axis];
            self.irradiance[axis][i] = irradiance[axis];
        }
    }

    /// Hands out `count` samples of a light of some radiance, a fan of them after the other.
    #[inline]
    pub fn spread(
        &mut self,
        key: SampleKey,
        dimension: u32,
        count: u32,
        shape: &impl Shape,
        radiance: Vec3,
        each: &mut impl FnMut(&mut Fan),
    ) {
        let part = radiance / count as f32;
        for first in (0..count).step_by(FAN) {
            self.size = ((count - first) as usize).min(FAN);
            simd::run(Spread { key: key.nth(first, count), dimension, shape, part, fan: self });
            each(self);
        }
    }

    /// Hands out `count` samples of a light, each of which is looked for on its own.
    #[inline]
    pub fn choose(
        &mut self,
        key: SampleKey,
        dimension: u32,
        count: u32,
        look: impl Fn([f32; 2]) -> Arrival,
        each: &mut impl FnMut(&mut Fan),
    ) {
        for first in (0..count).step_by(FAN) {
            self.size = ((count - first) as usize).min(FAN);
            let [u, v] = simd::run(Uniform { key: key.nth(first, count), dimension, size: self.size });
            for i in 0..self.size {
                let arrival = look([u[i], v[i]]);
                self.set(i, Arrival { irradiance: arrival.irradiance / count as f32, ..arrival });
            }
            each(self);
        }
    }
}

/// Pairs of uniform numbers: of sample `key` and those that follow.
struct Uniform {
    key: SampleKey,
    dimension: u32,
    size: usize,
}

impl simd::Kernel for Uniform {
    type Output = [[f32; FAN]; 2];

    #[inline(always)]
    fn run<S: Simd>(self) -> [[f32; FAN]; 2] {
        let Uniform { key, dimension, size } = self;
        let mut xi = [[0.0; FAN]; 2];
        // Whole registers: what lies past the end costs nothing, and means nothing.
        let size = size.next_multiple_of(8).min(FAN);
        let [u, v] = &mut xi;
        for (i, (u, v)) in u[..size].iter_mut().zip(&mut v[..size]).enumerate() {
            [*u, *v] = SampleKey { index: key.index.wrapping_add(i as u32), ..key }.pair(dimension);
        }
        xi
    }
}

/// Works out a fan.
struct Spread<'a, K> {
    /// Of the first sample; the others follow.
    key: SampleKey,
    dimension: u32,
    shape: &'a K,
    /// What a sample of weight 1 brings.
    part: Vec3,
    fan: &'a mut Fan,
}

impl<K: Shape> simd::Kernel for Spread<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Spread { key, dimension, shape, part, fan } = self;
        let [u, v] = Uniform { key, dimension, size: fan.size }.run::<S>();
        let ([x, y, z], [red, green, blue]) = (&mut fan.direction, &mut fan.irradiance);
        for i in 0..fan.size.next_multiple_of(8).min(FAN) {
            let (direction, distance, weight) = shape.sample([u[i], v[i]]);
            let arrives = (weight > 0.0) & (distance > 0.0) & (distance < f32::INFINITY);
            let light = part * if arrives { weight } else { 0.0 };
            (x[i], y[i], z[i]) = (direction.x, direction.y, direction.z);
            fan.distance[i] = distance;
            (red[i], green[i], blue[i]) = (light.x, light.y, light.z);
        }
    }
}
