//! Reads Sunflow `.sc` scenes.
//!
//! ```text
//! bytes ──lex──▶ tokens ──parse──▶ Scene + Diagnostics
//! ```
//!
//! Lexing cannot fail; parsing always returns a [`Scene`], however broken the text, with everything there is to say
//! about it. This crate prints nothing and opens no file itself: bytes come from a [`Loader`].
//!
//! ```
//! use std::path::Path;
//! use jaspe_scene::{MemoryLoader, parse, set};
//!
//! let text = "shader { name wood type wood } object { shader wood type sphere c 0 0 0 r 1 }";
//! let (mut scene, diagnostics) = parse(Path::new("ball.sc"), text.as_bytes(), &MemoryLoader::default());
//! assert!(!diagnostics.has_errors());
//! assert_eq!(scene.objects[0].shaders[0].value, "wood");
//!
//! set(&mut scene, "wood.depth=7").expect("`depth` is a parameter of `wood`");
//!
//! let (_, diagnostics) = parse(Path::new("slip.sc"), *b"shader { name a type wod }", &MemoryLoader::default());
//! let slip = diagnostics.iter().next().expect("a message");
//! assert_eq!(slip.message, "unknown shader type `wod`");
//! assert_eq!(slip.hints, ["did you mean `wood`?"]);
//! ```
//!
//! The format itself is described in `docs/format.md`.

pub mod description;
mod diagnostic;
mod lexer;
mod number;
mod parameters;
mod parser;
mod source;
mod srgb;
mod suggest;
mod writer;

pub use description::{Dialect, Scene};
pub use diagnostic::{Diagnostic, Diagnostics, Label, Severity};
pub use parameters::{Parameter, parameters};
pub use parser::{parse, read, set};
pub use source::{DiskLoader, Loader, MemoryLoader, Position, Source, Sources, Span, Spanned};
pub use srgb::{srgb_decode, srgb_encode};
pub use suggest::nearest;
pub use writer::{Includes, write};
