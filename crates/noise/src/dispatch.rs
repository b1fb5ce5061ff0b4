//! From slices of any number of dimensions to evaluations of one to four. Those are compiled here, once, and not again in
//! each crate that evaluates noise: hence functions over slices of slices, without type parameters.

use crate::number::{Dual, Real};
use crate::simd::Level;

/// An evaluation in one to four dimensions.
pub(crate) trait Evaluate {
    /// The value at a point and, with `G`, its gradient.
    fn evaluate<R: Real, const D: usize, const G: bool>(&self, point: [R; D]) -> Dual<R, D>;
}

/// An evaluation over slices, of any number of dimensions.
pub(crate) trait OverSlices {
    /// The values at many points.
    fn values(&self, level: Level, points: &[&[f32]], values: &mut [f32]);
    /// The values at many points, and their derivatives along each axis.
    fn gradients(&self, level: Level, points: &[&[f32]], values: &mut [f32], gradient: &mut [&mut [f32]]);
}

/// The value alone.
pub(crate) struct Value<'a, E>(pub &'a E);

/// The value and the gradient.
pub(crate) struct Gradient<'a, E>(pub &'a E);

impl<E: Evaluate, const D: usize> crate::simd::Outputs<D, 1> for Value<'_, E> {
    #[inline(always)]
    fn run<R: Real>(&self, point: [R; D]) -> [R; 1] {
        [self.0.evaluate::<R, D, false>(point).value]
    }
}

/// The array of a slice whose length is known.
pub(crate) fn sized<'a, const D: usize>(slices: &[&'a [f32]]) -> [&'a [f32]; D] {
    slices.try_into().expect("the number of dimensions was asked for")
}

macro_rules! gradients {
    ($($dimensions:literal $outputs:literal)*) => {$(
        impl<E: Evaluate> crate::simd::Outputs<$dimensions, $outputs> for Gradient<'_, E> {
            #[inline(always)]
            fn run<R: Real>(&self, point: [R; $dimensions]) -> [R; $outputs] {
                let sample = self.0.evaluate::<R, $dimensions, true>(point);
                let mut outputs = [sample.value; $outputs];
                for axis in 0..$dimensions {
                    outputs[axis + 1] = sample.gradient[axis];
                }
                outputs
            }
        }
    )*};
}
gradients! { 1 2 2 3 3 4 4 5 }

/// Compiles an [`Evaluate`] over slices, for each number of dimensions and every set of instructions.
macro_rules! over_slices {
    ($type:ty) => {
        impl crate::dispatch::OverSlices for $type {
            #[inline(never)]
            fn values(&self, level: crate::simd::Level, points: &[&[f32]], values: &mut [f32]) {
                use crate::dispatch::{Value, sized};
                use crate::simd::map_outputs;
                match points.len() {
                    1 => map_outputs(level, &Value(self), sized::<1>(points), [values]),
                    2 => map_outputs(level, &Value(self), sized::<2>(points), [values]),
                    3 => map_outputs(level, &Value(self), sized::<3>(points), [values]),
                    _ => map_outputs(level, &Value(self), sized::<4>(points), [values]),
                }
            }

            #[inline(never)]
            fn gradients(
                &self,
                level: crate::simd::Level,
                points: &[&[f32]],
                values: &mut [f32],
                gradient: &mut [&mut [f32]],
            ) {
                use crate::dispatch::{Gradient, sized};
                use crate::simd::map_outputs;
                match gradient {
                    [x] => map_outputs(level, &Gradient(self), sized::<1>(points), [values, x]),
                    [x, y] => map_outputs(level, &Gradient(self), sized::<2>(points), [values, x, y]),
                    [x, y, z] => map_outputs(level, &Gradient(self), sized::<3>(points), [values, x, y, z]),
                    [x, y, z, w] => map_outputs(level, &Gradient(self), sized::<4>(points), [values, x, y, z, w]),
                    _ => unreachable!("there are one to four dimensions"),
                }
            }
        }
    };
}
pub(crate) use over_slices;
