//! Lattice noises and fractal sums: points in, numbers out, the same bits on every machine.
//!
//! The first picture, a grey map of clouds:
//!
//! ```
//! use jaspe_noise::{Basis, Combine, Grid, Noise, Sum};
//!
//! let clouds = Sum::new(Noise::new(Basis::Improved, 0), Combine::Plain, 6);
//! let grid = Grid { origin: [0.0; 2], step: [1.0 / 32.0; 2], count: [128; 2] };
//! let mut values = vec![0.0; grid.len()];
//! clouds.fill_grid(&grid, &mut values);
//! let mut picture = b"P5 128 128 255\n".to_vec();
//! picture.extend(values.iter().map(|value| (127.5 + 90.0 * value) as u8));
//! // std::fs::write("clouds.pgm", picture)?;
//! # assert_eq!(picture.len(), 15 + 128 * 128);
//! ```
//!
#![doc = concat!("![clouds](data:image/png;base64,", include_str!("clouds.base64"), ")")]
//!
//! Single points, gradients and slices of points:
//!
//! ```
//! use jaspe_noise::{Basis, Combine, Noise, Sum};
//!
//! // One value in double precision, with its exact gradient.
//! let noise = Noise::new(Basis::Improved, 0);
//! assert_eq!(noise.value([0.5, 0.25, 0.5]), -0.262939453125);
//! let (value, gradient) = noise.value_and_gradient([3.14f64, 42.0, 7.0]);
//! assert_eq!(value, 0.13691995878400012);
//! assert!((gradient[1] + 0.956).abs() < 1e-5);
//!
//! // Many values: slices of coordinates in, a slice of values out, on the widest registers of the machine.
//! let x: Vec<f32> = (0..1000).map(|i| 0.01 * i as f32).collect();
//! let turbulence = Sum::new(noise, Combine::Absolute, 5);
//! let mut values = vec![0.0; 1000];
//! turbulence.fill([&x, &x, &x], &mut values);
//! assert_eq!(values[0], 0.0);
//! ```
//!
//! # The noises
//!
//! | [`Basis`] | what | range in 3-D | mean | variance |
//! |---|---|---|---|---|
//! | `Improved` | gradient noise of \[Perlin 2002\], exactly his listing | within [-1.04, 1.04] | 0 | 0.073 |
//! | `Classic` | gradient noise of \[Perlin 1985\]: unit gradients, cubic curve | within [-0.87, 0.87] | 0 | 0.033 |
//! | `Lattice` | random values of a table at the lattice points, cubic curve | [-1, 1] | 0 | 0.137 |
//! | `Value` | random values of a hash at the lattice points, curve of degree five | [-1, 1] | 0 | 0.160 |
//! | `Simplex` | gradient noise on tetrahedra | [-1, 1] | 0 | 0.154 |
//! | `Cellular` | distances to feature points, \[Worley 1996\]: see [`Cellular`] | [0, 1.74] for F1 | 0.52 | 0.030 |
//! | `White` | a random value per cell | [-1, 1] | 0 | 0.333 |
//!
//! Formulas, sources and statistics of all of them and of the sums: [`Basis::declaration`], [`Combine::declaration`].
//!
//! All have one to four dimensions (one and two are slices of three at zero; cellular noise has its feature points in the
//! dimensions of the point), a seed (0 is the published table), and any integer period along each axis:
//! [`Noise::with_period`]. The first three repeat after 256 cells in any case.
//!
//! Sums add octaves plainly, by their absolute value, or as multifractals ([`Combine`]), with any lacunarity and gain; the
//! last octave may fade in ([`Sum::with_octaves`]), and [`Sum::fill_filtered`] fades what a sample's footprint cannot resolve.
//! [`Noise::fill_with_gradient`], [`Sum::fill_with_gradient`] and [`Sum::fill_filtered_with_gradient`] give exact gradients
//! with the values. [`Noise::fill_grid`] and [`Sum::fill_grid`] are made for uniform grids (and have their likes for
//! gradients and footprints), a [`Raster`] for other grids and for several threads. A [`Warp`] displaces the points of one
//! [`Field`] by another.
//!
//! # Promises
//!
//! * One evaluation, [`Noise::value`] and [`Sum::value`], generic over the number type ([`Real`]): `f64`, `f32`,
//!   vectors of `f32`, and [`Dual`] numbers, which carry exact gradients.
//! * [`Noise::fill`] and [`Sum::fill`] give the same bits as the `f32` evaluation, whatever the instruction set and the
//!   length of the slices. A zero is always `+0`. (`JASPE_SIMD=scalar|sse|avx2|avx512` caps the instruction set.)
//! * Improved noise equals Perlin's listing: exactly in double precision, to within 2e-6 in single precision.
//! * No input panics. A coordinate that is infinite or NaN gives NaN. Far from the origin, where neighbouring numbers
//!   are a whole unit apart, every point is a lattice point.
//! * Nothing is allocated while evaluating, but for the rows of a grid.
//! * Filtered sums are within 0.02 (root mean square) of the average over the footprint: [`Sum::value_filtered`].
//!
//! # Sources
//!
//! * \[Perlin 1985\]: K. Perlin, "An Image Synthesizer", SIGGRAPH 1985.
//! * \[Worley 1996\]: S. Worley, "A Cellular Texture Basis Function", SIGGRAPH 1996.
//! * \[Perlin 2001\]: K. Perlin, "Noise Hardware", SIGGRAPH 2001 course notes; \[Gustavson 2005\]: S. Gustavson, "Simplex
//!   Noise Demystified".
//! * \[Perlin 2002\]: K. Perlin, "Improving Noise", SIGGRAPH 2002, and the listing that he published with it.

#![deny(unsafe_code)]
// (Without kernels made by hand, what is there for them is unused.)
#![cfg_attr(not(target_arch = "x86_64"), allow(dead_code, unused_imports, unused_variables, unused_mut))]

mod basis;
mod declaration;
mod dispatch;
mod filter;
mod grid;
pub mod math;
mod noise;
mod number;
mod recipe;
mod seed;
#[allow(unsafe_code, reason = "intrinsics, behind types that exist only on machines that have the instructions")]
pub mod simd;
mod sum;
mod table;
mod warp;

pub use basis::Basis;
pub use basis::cellular::{Cellular, Feature, Metric};
pub use declaration::{Declaration, Statistics};
pub use grid::{Grid, Raster};
pub use noise::{Noise, PeriodError};
pub use number::{Dual, Integer, Mask, Real};
pub use recipe::{Recipe, RecipeError};
pub use seed::permutation;
pub use sum::{Combine, Sum};
pub use table::{ByteTable, FloatTable, PairTable};
pub use warp::{Field, Warp};
