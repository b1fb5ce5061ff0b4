//! Procedural materials.
pub mod declare;
