//! The commands, one file each: their arguments, help texts and what they do.

pub mod bake;
pub mod bench;
pub mod check;
pub mod compare;
pub mod convert;
pub mod gallery;
pub mod noise;
pub mod render;
pub mod texture;
pub mod textures;
