//! Samples of a light that is seen under an angle, many at a time, so that the loop over them is vectorised.

use glam::Vec3;

use super::{Arrival, Receiver};
use crate::geometry::simd::{self, Simd};
use crate::sampler::SampleKey;

/// Samples that are worked out together.
const FAN: usize = 32;

/// A light as a point sees it. What `sample` calls must be `#[inline(always)]`.
pub(super) trait Shape {
    /// For two uniform numbers: the direction, how far the light is there, and the sample's irradiance on a surface that
    /// faces it, per radiance, times the number of samples; not above zero where nothing arrives.
    fn sample(&self, xi: [f32; 2]) -> (Vec3, f32, f32);
}

/// Samples of a light, in rows.
struct Fan {
    direction: [[f32; FAN]; 3],
    distance: [f32; FAN],
    weight: [f32; FAN],
}

/// Hands out the samples of a light of some radiance.
#[inline]
pub(super) fn spread(
    at: &Receiver,
    number: u32,
    samples: u32,
    shape: &impl Shape,
    radiance: Vec3,
    each: &mut impl FnMut(Arrival),
) {
    let count = at.count(samples);
    let part = radiance / count as f32;
    let mut fan = Fan { direction: [[0.0; FAN]; 3], distance: [0.0; FAN], weight: [0.0; FAN] };
    for first in (0..count).step_by(FAN) {
        let size = ((count - first) as usize).min(FAN);
        let key = at.key.nth(first, count);
        simd::run(Spread { key, dimension: at.dimension + number, shape, fan: &mut fan, size });
        for i in 0..size {
            if fan.weight[i] > 0.0 && fan.distance[i] > 0.0 && fan.distance[i] < f32::INFINITY {
                let direction = Vec3::new(fan.direction[0][i], fan.direction[1][i], fan.direction[2][i]);
                each(Arrival { direction, distance: fan.distance[i], irradiance: part * fan.weight[i] });
            }
        }
    }
}

/// Works out a fan.
struct Spread<'a, K> {
    /// Of the first sample; the others follow.
    key: SampleKey,
    dimension: u32,
    shape: &'a K,
    fan: &'a mut Fan,
    size: usize,
}

impl<K: Shape> simd::Kernel for Spread<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Spread { key, dimension, shape, fan, size } = self;
        let mut xi = [[0.0; FAN]; 2];
        // Whole registers: what lies past the end costs nothing, and means nothing.
        let size = size.next_multiple_of(8).min(FAN);
        let [u, v] = &mut xi;
        for (i, (u, v)) in u[..size].iter_mut().zip(&mut v[..size]).enumerate() {
            [*u, *v] = SampleKey { index: key.index.wrapping_add(i as u32), ..key }.pair(dimension);
        }
        let [x, y, z] = &mut fan.direction;
        for i in 0..size {
            let (direction, distance, weight) = shape.sample([u[i], v[i]]);
            (x[i], y[i], z[i]) = (direction.x, direction.y, direction.z);
            (fan.distance[i], fan.weight[i]) = (distance, weight);
        }
    }
}
