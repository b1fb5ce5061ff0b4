//! Procedural materials: a scalar field from noise, and two colours that it mixes.
//!
//! ```
//! use jaspe_texture::declare::Value;
//! use jaspe_texture::Texture;
//!
//! let marble = Texture::build("marble", &[("depth", Value::Int(6)), ("seed", Value::Int(7))])?;
//! let (x, y, z) = ([0.1, 0.2, 0.3], [0.0; 3], [-0.5; 3]);
//! let mut colors = [[0.0; 3]; 3];
//! marble.colors([&x, &y, &z], &mut colors);
//! assert!(colors.iter().flatten().all(|component| (0.0..=1.0).contains(component)));
//! # Ok::<(), jaspe_texture::BuildError>(())
//! ```
//!
//! A material is declared once, beside its code ([`declare`]): keyword, parameters, ranges, a sentence each.
//! [`Texture::ALL`] lists them. [`Texture::build`] makes one from checked arguments; it is immutable then.
//!
//! Points are given in the texture's [`Space`] ([`Texture::space`]) and in its units: the caller transforms them there, the
//! texture scales them. With the texture's `frequency` and `scale`, the noise is evaluated at
//! X = frequency · point / scale (moved by a third of a cell in three dimensions, so that no floor or wall of a scene lies
//! in the noise's lattice; wood needs the lattice point at its centre, and [`Texture::in_figure_space`] is without). Each material turns X and the noise sum T(X) into a
//! coefficient w, and clamp(w · initial + (1 − w) · final) is the colour. Colours are display-encoded, and mixed so, as the report's figures
//! were; who needs light decodes the result.

#![forbid(unsafe_code)]

mod args;
pub mod declare;
mod finish;
mod material;
mod space;
mod texture;

pub use args::BuildError;
pub use finish::{Finish, Reliefs};
pub use space::{Frequencies, Space};
pub use texture::Texture;
