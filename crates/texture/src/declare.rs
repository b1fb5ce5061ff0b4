//! How a texture (and every block of a scene) says what it is: a keyword, its parameters with kind, default, range
//! and one sentence each. Parser, help texts, reference pages and language bindings walk these lists and keep none
//! of their own.

use std::fmt;

/// What a declared thing is called, what it is, and which parameters it takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Declaration {
    /// The keyword, as written in a scene (`marble`).
    pub name: &'static str,
    /// One sentence for lists and help texts.
    pub summary: &'static str,
    /// The parameters, in the order of the reference page.
    pub parameters: &'static [Parameter],
}

impl Declaration {
    /// The parameter called `name`, if there is one.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }
}

/// One parameter of a [`Declaration`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// The keyword, as written in a scene (`depth`).
    pub name: &'static str,
    /// What may be written, and within which range.
    pub kind: Kind,
    /// What stands when nothing is written.
    pub default: Value,
    /// One sentence, with the unit where there is one.
    pub summary: &'static str,
}

/// What a parameter takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A whole number from `min` to `max`.
    Int {
        /// The smallest value allowed.
        min: i64,
        /// The largest value allowed.
        max: i64,
    },
    /// A finite number from `min` to `max`.
    Float {
        /// The smallest value allowed.
        min: f64,
        /// The largest value allowed.
        max: f64,
    },
    /// A colour; three display-encoded (sRGB) components from 0 to 1.
    Color,
    /// One of these words.
    Choice(&'static [&'static str]),
}

/// The value of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// Of a [`Kind::Int`].
    Int(i64),
    /// Of a [`Kind::Float`].
    Float(f64),
    /// Of a [`Kind::Color`]: display-encoded red, green, blue.
    Color([f64; 3]),
    /// Of a [`Kind::Choice`].
    Choice(&'static str),
    /// The default of a parameter whose value follows from its surroundings; never written.
    Auto,
}

impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kind::Int { min, max } => write!(formatter, "a whole number from {min} to {max}"),
            Kind::Float { min, max } => write!(formatter, "a number from {min} to {max}"),
            Kind::Color => formatter.write_str("a colour of three components from 0 to 1"),
            Kind::Choice(words) => write!(formatter, "one of `{}`", words.join("`, `")),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Int(value) => write!(formatter, "{value}"),
            Value::Float(value) => write!(formatter, "{value}"),
            Value::Color([red, green, blue]) => write!(formatter, "{red} {green} {blue}"),
            Value::Choice(word) => formatter.write_str(word),
            Value::Auto => formatter.write_str("auto"),
        }
    }
}
