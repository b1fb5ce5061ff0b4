//! Materials outside the renderer: maps for game engines, modellers and pipelines.
//!
//! ```text
//! Texture + Settings ──new──▶ Bake ──bands──▶ rows of every map ──encode──▶ a folder of files
//!                                  └─arrays─▶ whole maps in memory
//! ```
//!
//! ```
//! use jaspe_bake::{Bake, Map, Settings};
//! use jaspe_texture::Texture;
//!
//! let marble = Texture::build("marble", &[])?;
//! let bake = Bake::new(marble, Settings { size: 64, maps: vec![Map::Color, Map::Normal], ..Settings::default() })?;
//! let arrays = bake.arrays(0, &())?;
//! assert_eq!((arrays.width, arrays.height), (64, 64));
//! assert_eq!(arrays.maps[0].map, Map::Color);
//! assert_eq!(arrays.maps[0].values.len(), 64 * 64 * 3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Promises
//!
//! * A tile of a plane repeats exactly: the noise has an integer period along both sides, and a material's own bands are
//!   stretched so that a whole number fits. Nothing is blended. The pixel left of the first is the last, to the bit.
//! * Normals follow from exact derivatives of the height, not from differences of pixels.
//! * The maps depend on the texture and the settings: not on threads or instruction sets.
//! * Memory is bounded by some rows of the maps, whatever their size ([`Bake::bands`]).

#![forbid(unsafe_code)]

mod bake;
mod canvas;
mod encode;
mod field;
mod gallery;
mod gltf;
mod layout;
mod manifest;
mod map;
mod materialx;
mod model;
mod preview;
mod set;
mod surface;

pub use bake::{Arrays, Bake, BakeError, Band, Loop, MapArray, Settings};
pub use encode::MapFormat;
pub use gallery::write_gallery;
pub use map::{ColorSpace, Map, MapDeclaration, NormalConvention};
pub use model::{Model, ModelError};
pub use preview::{PREVIEW_SIZE, preview};
pub use set::{Preview, SetError, SetFolder, SetOptions, Written, write_set};
pub use surface::Surface;
