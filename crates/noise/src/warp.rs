//! Domain warp: a field evaluated at points that other fields have displaced.
//!
//! Source: D. S. Ebert et al., "Texturing and Modeling: A Procedural Approach" (domain distortion in F. K. Musgrave's
//! chapters); nested, as I. Quilez describes it in "Domain Warping", 2002.

use crate::noise::Noise;
use crate::number::Real;
use crate::simd::{self, Level};
use crate::sum::Sum;

/// A noise, a sum of its octaves, or a warp of those: what has a value at each point.
#[derive(Debug, Clone, PartialEq)]
pub enum Field {
    /// A noise.
    Noise(Noise),
    /// A sum.
    Sum(Sum),
    /// A warp, perhaps of warps.
    Warp(Box<Warp>),
}

/// The field `source` at p + amount · (b(p + s₁), b(p + s₂), …): each coordinate is displaced by the field b, which is `by`,
/// seen from another place.
#[derive(Debug, Clone, PartialEq)]
pub struct Warp {
    /// What is seen.
    pub source: Field,
    /// What displaces it.
    pub by: Field,
    /// How far, in the units of the point.
    pub amount: f64,
}

/// How far the displacements of neighbouring axes are seen apart: no whole numbers, so that they share no lattice points.
const SHIFT: [f64; 4] = [17.31, 59.77, 91.13, 41.57];

/// How many points at a time.
const CHUNK: usize = 256;

impl From<Noise> for Field {
    fn from(noise: Noise) -> Field {
        Field::Noise(noise)
    }
}

impl From<Sum> for Field {
    fn from(sum: Sum) -> Field {
        Field::Sum(sum)
    }
}

impl From<Warp> for Field {
    fn from(warp: Warp) -> Field {
        Field::Warp(Box::new(warp))
    }
}

impl Field {
    /// The value at a point of one to four dimensions.
    pub fn value<R: Real, const D: usize>(&self, point: [R; D]) -> R {
        match self {
            Field::Noise(noise) => noise.value(point),
            Field::Sum(sum) => sum.value(point),
            Field::Warp(warp) => {
                let displaced: [R; D] = std::array::from_fn(|axis| {
                    point[axis] + R::constant(warp.amount) * warp.by.value(seen_from(axis, point))
                });
                warp.source.value(displaced)
            }
        }
    }

    /// The value at a point, and its exact derivative along each axis.
    pub fn value_and_gradient<R: Real, const D: usize>(&self, point: [R; D]) -> (R, [R; D]) {
        match self {
            Field::Noise(noise) => noise.value_and_gradient(point),
            Field::Sum(sum) => sum.value_and_gradient(point),
            Field::Warp(warp) => {
                let (mut displaced, mut bends) = (point, [point; D]);
                for axis in 0..D {
                    let (by, gradient) = warp.by.value_and_gradient(seen_from(axis, point));
                    displaced[axis] = point[axis] + R::constant(warp.amount) * by;
                    bends[axis] = gradient;
                }
                let (value, gradient) = warp.source.value_and_gradient(displaced);
                (value, bend(R::constant(warp.amount), gradient, &bends))
            }
        }
    }

    /// The values at many points: the same bits as [`Field::value`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill<const D: usize>(&self, points: [&[f32]; D], values: &mut [f32]) {
        self.fill_at(simd::level(), points, values);
    }

    /// [`Field::fill`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_at<const D: usize>(&self, level: Level, points: [&[f32]; D], values: &mut [f32]) {
        let warp = match self {
            Field::Noise(noise) => return noise.fill_at(level, points, values),
            Field::Sum(sum) => return sum.fill_at(level, points, values),
            Field::Warp(warp) => warp,
        };
        simd::assert_lengths(&points, values.len());
        let (mut shifted, mut displaced) = ([[0.0; CHUNK]; D], [[0.0; CHUNK]; D]);
        for (chunk, values) in values.chunks_mut(CHUNK).enumerate() {
            let count = values.len();
            let points = points.map(|axis| &axis[chunk * CHUNK..][..count]);
            for axis in 0..D {
                shift(axis, points, &mut shifted);
                let by = &mut displaced[axis][..count];
                warp.by.fill_at(level, shifted.each_ref().map(|axis| &axis[..count]), by);
                displace(warp.amount as f32, points[axis], by);
            }
            warp.source.fill_at(level, displaced.each_ref().map(|axis| &axis[..count]), values);
        }
    }

    /// The values at many points in space as most programs hold them, x y z x y z …: the same bits as [`Field::value`] in single
    /// precision.
    ///
    /// # Panics
    /// When there is not a value for each point.
    pub fn fill_points(&self, points: &[[f32; 3]], values: &mut [f32]) {
        self.fill_points_at(simd::level(), points, values);
    }

    /// [`Field::fill_points`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When there is not a value for each point.
    pub fn fill_points_at(&self, level: Level, points: &[[f32; 3]], values: &mut [f32]) {
        assert_eq!(points.len(), values.len(), "there is a value for each point");
        let done = match self {
            Field::Noise(noise) => noise.fill_points_fast(level, points, values),
            _ => 0,
        };
        let mut columns = [[0.0; 2 * CHUNK]; 3];
        for (points, values) in points[done..].chunks(2 * CHUNK).zip(values[done..].chunks_mut(2 * CHUNK)) {
            simd::deinterleave_at(level, points, columns.each_mut().map(|column| &mut column[..points.len()]));
            self.fill_at(level, columns.each_ref().map(|column| &column[..points.len()]), values);
        }
    }

    /// The values at many points, and the exact derivatives along each axis: the same bits as
    /// [`Field::value_and_gradient`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_with_gradient<const D: usize>(
        &self,
        points: [&[f32]; D],
        values: &mut [f32],
        gradient: [&mut [f32]; D],
    ) {
        self.fill_with_gradient_at(simd::level(), points, values, gradient);
    }

    /// [`Field::fill_with_gradient`] with the instructions of a level, at most those of the machine. For tests and
    /// measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn fill_with_gradient_at<const D: usize>(
        &self,
        level: Level,
        points: [&[f32]; D],
        values: &mut [f32],
        mut gradient: [&mut [f32]; D],
    ) {
        let warp = match self {
            Field::Noise(noise) => return noise.fill_with_gradient_at(level, points, values, gradient),
            Field::Sum(sum) => return sum.fill_with_gradient_at(level, points, values, gradient),
            Field::Warp(warp) => warp,
        };
        simd::assert_lengths(&points, values.len());
        simd::assert_lengths(&gradient, values.len());
        let (mut shifted, mut displaced) = ([[0.0; CHUNK]; D], [[0.0; CHUNK]; D]);
        let mut bends = [[[0.0; CHUNK]; D]; D];
        for (chunk, values) in values.chunks_mut(CHUNK).enumerate() {
            let (start, count) = (chunk * CHUNK, values.len());
            let points = points.map(|axis| &axis[start..][..count]);
            for axis in 0..D {
                shift(axis, points, &mut shifted);
                let by = &mut displaced[axis][..count];
                let bends = bends[axis].each_mut().map(|bend| &mut bend[..count]);
                warp.by.fill_with_gradient_at(level, shifted.each_ref().map(|axis| &axis[..count]), by, bends);
                displace(warp.amount as f32, points[axis], by);
            }
            let displaced = displaced.each_ref().map(|axis| &axis[..count]);
            let mut gradient = gradient.each_mut().map(|axis| &mut axis[start..][..count]);
            warp.source.fill_with_gradient_at(level, displaced, values, gradient.each_mut().map(|axis| &mut **axis));
            for i in 0..count {
                let bends = bends.each_ref().map(|bend| bend.each_ref().map(|axis| axis[i]));
                let bent = bend(warp.amount as f32, gradient.each_ref().map(|axis| axis[i]), &bends);
                for (axis, part) in gradient.iter_mut().zip(bent) {
                    axis[i] = part;
                }
            }
        }
    }
}

/// The point from which the displacement along an axis is seen.
fn seen_from<R: Real, const D: usize>(axis: usize, point: [R; D]) -> [R; D] {
    let mut along = 0;
    point.map(|coordinate| {
        along += 1;
        coordinate + R::constant(axis as f64 * SHIFT[along - 1])
    })
}

/// [`seen_from`] for many points.
fn shift<const D: usize>(axis: usize, points: [&[f32]; D], shifted: &mut [[f32; CHUNK]; D]) {
    for ((shifted, point), shift) in shifted.iter_mut().zip(points).zip(SHIFT) {
        for (shifted, coordinate) in shifted.iter_mut().zip(point) {
            *shifted = coordinate + (axis as f64 * shift) as f32;
        }
    }
}

/// Makes the displacements of coordinates the displaced coordinates.
fn displace(amount: f32, coordinates: &[f32], by: &mut [f32]) {
    for (by, coordinate) in by.iter_mut().zip(coordinates) {
        *by = coordinate + amount * *by;
    }
}

/// The chain rule: the gradient of the source, along the axes of the point before it was displaced.
fn bend<R: Real, const D: usize>(amount: R, gradient: [R; D], bends: &[[R; D]; D]) -> [R; D] {
    std::array::from_fn(|along| {
        let mut sum = gradient[along];
        for axis in 0..D {
            sum = sum + amount * gradient[axis] * bends[axis][along];
        }
        sum
    })
}
