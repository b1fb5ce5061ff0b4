//! From what was written to a material's arguments: names, kinds and ranges are checked here, once.

use std::fmt;

use jaspe_noise::{Basis, Combine};

use crate::declare::{Declaration, Kind, Parameter, Value};
use crate::space::Space;

/// Why a texture could not be built.
#[derive(Debug, Clone, PartialEq)]
pub enum BuildError {
    /// No material has this name.
    UnknownTexture {
        /// What was asked for.
        name: String,
    },
    /// The material has no such parameter.
    UnknownParameter {
        /// The material.
        texture: &'static str,
        /// What was asked for.
        name: String,
    },
    /// The value is of another kind than the parameter takes, or out of its range.
    Refused {
        /// The parameter.
        parameter: &'static str,
        /// What it takes.
        expected: Kind,
        /// What was given.
        found: String,
    },
}

impl fmt::Display for BuildError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BuildError::UnknownTexture { name } => write!(formatter, "unknown texture `{name}`"),
            BuildError::UnknownParameter { texture, name } => {
                write!(formatter, "`{texture}` has no parameter `{name}`")
            }
            BuildError::Refused { parameter, expected, found } => {
                write!(formatter, "`{parameter}` takes {expected}, found {found}")
            }
        }
    }
}

impl std::error::Error for BuildError {}

/// The arguments of a material: each parameter that was written, checked against the declaration.
pub(crate) struct Args {
    declaration: &'static Declaration,
    written: Vec<(&'static str, Value)>,
}

impl Args {
    /// Checks names, kinds and ranges. Of two values for the same parameter the later one counts.
    pub(crate) fn check(declaration: &'static Declaration, args: &[(&str, Value)]) -> Result<Self, BuildError> {
        let mut written = Vec::with_capacity(args.len());
        for &(name, value) in args {
            let parameter = declaration
                .parameter(name)
                .ok_or_else(|| BuildError::UnknownParameter { texture: declaration.name, name: name.to_owned() })?;
            written.push((parameter.name, parameter.check(value)?));
        }
        Ok(Args { declaration, written })
    }

    /// What was written, or the default.
    fn value(&self, name: &str) -> Value {
        let written = self.written.iter().rev().find(|(written, _)| *written == name).map(|&(_, value)| value);
        written.or_else(|| self.declaration.parameter(name).map(|parameter| parameter.default)).unwrap_or(Value::Auto)
    }

    /// Every parameter with its value, in the order of the declaration.
    pub(crate) fn all(&self) -> impl Iterator<Item = (&'static str, Value)> {
        self.declaration.parameters.iter().map(|parameter| (parameter.name, self.value(parameter.name)))
    }

    /// A whole number; 0 if the parameter is of another kind.
    pub(crate) fn int(&self, name: &str) -> i64 {
        if let Value::Int(value) = self.value(name) { value } else { 0 }
    }

    /// A number; 1 if the parameter is of another kind.
    pub(crate) fn float(&self, name: &str) -> f64 {
        if let Value::Float(value) = self.value(name) { value } else { 1.0 }
    }

    /// A colour; black if the parameter is of another kind.
    pub(crate) fn color(&self, name: &str) -> [f32; 3] {
        if let Value::Color(value) = self.value(name) { value.map(|component| component as f32) } else { [0.0; 3] }
    }

    /// A word; empty if the parameter is of another kind, or follows from its surroundings.
    fn choice(&self, name: &str) -> &'static str {
        if let Value::Choice(value) = self.value(name) { value } else { "" }
    }

    /// The parameter `noise`.
    pub(crate) fn basis(&self) -> Basis {
        Basis::from_name(self.choice("noise")).unwrap_or(Basis::Improved)
    }

    /// The parameter `sum`.
    pub(crate) fn combine(&self) -> Combine {
        Combine::from_name(self.choice("sum")).unwrap_or(Combine::Absolute)
    }

    /// The parameter `space`, if it was written.
    pub(crate) fn space(&self) -> Option<Space> {
        Space::from_name(self.choice("space"))
    }
}

impl Parameter {
    /// The value as this parameter takes it: a whole number where a number is expected becomes one.
    ///
    /// # Errors
    /// When the kind differs, or the value is out of range.
    pub fn check(&self, value: Value) -> Result<Value, BuildError> {
        let checked = match (self.kind, value) {
            (Kind::Int { min, max }, Value::Int(number)) if (min..=max).contains(&number) => Some(value),
            (Kind::Float { min, max }, Value::Float(number)) if (min..=max).contains(&number) => Some(value),
            (Kind::Float { min, max }, Value::Int(number)) if (min..=max).contains(&(number as f64)) => {
                Some(Value::Float(number as f64))
            }
            (Kind::Color, Value::Color(color)) if color.iter().all(|part| (0.0..=1.0).contains(part)) => Some(value),
            (Kind::Choice(words), Value::Choice(word)) => words.iter().find(|&&w| w == word).map(|&w| Value::Choice(w)),
            _ => None,
        };
        checked.ok_or_else(|| self.refused(value.to_string()))
    }

    /// Reads a value as written on a command line: a number, a word, or three numbers of a colour parted by spaces or
    /// commas.
    ///
    /// # Errors
    /// When the text is not of the parameter's kind, or the value is out of range.
    pub fn parse(&self, text: &str) -> Result<Value, BuildError> {
        let refused = || self.refused(format!("`{text}`"));
        let value = match self.kind {
            Kind::Int { .. } => Value::Int(text.trim().parse().map_err(|_| refused())?),
            Kind::Float { .. } => Value::Float(text.trim().parse().map_err(|_| refused())?),
            Kind::Color => {
                let parts = text.split([' ', ',']).filter(|part| !part.is_empty()).map(str::parse);
                let parts: Vec<f64> = parts.collect::<Result<_, _>>().map_err(|_| refused())?;
                Value::Color(parts.try_into().map_err(|_| refused())?)
            }
            Kind::Choice(words) => Value::Choice(words.iter().find(|&&word| word == text.trim()).ok_or_else(refused)?),
        };
        self.check(value).map_err(|_| refused())
    }

    fn refused(&self, found: String) -> BuildError {
        BuildError::Refused { parameter: self.name, expected: self.kind, found }
    }
}
