//! Reads Sunflow `.sc` scenes.
//!
//! ```text
//! bytes ──lex──▶ tokens ──parse──▶ Scene + Diagnostics
//! ```
//!
//! Lexing cannot fail; parsing always returns a [`Scene`], however broken the text, with everything there is to say
//! about it. This crate prints nothing and opens no file itself: bytes come from a [`Loader`].

pub mod description;
mod diagnostic;
mod lexer;
mod number;
mod parser;
mod source;
mod suggest;

pub use description::{Dialect, Scene};
pub use diagnostic::{Diagnostic, Diagnostics, Label, Severity};
pub use parser::{parse, read, set};
pub use source::{DiskLoader, Loader, MemoryLoader, Position, Source, Sources, Span, Spanned};
pub use suggest::nearest;
