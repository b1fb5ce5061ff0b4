//! What the command line and the Python package share, where they meet their users: messages with excerpts of the
//! scene ([`message`]), and files that appear whole or not at all ([`mod@file`]). Nothing is printed here.

pub mod file;
mod locate;
pub mod message;
mod refusal;

pub use locate::{Excerpt, Locator};
pub use refusal::{Refusal, plain};
