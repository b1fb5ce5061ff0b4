//! The procedural materials that shaders may name.

use jaspe_texture::declare::{Declaration, Kind, Parameter, Value};

const fn parameter(name: &'static str, kind: Kind, default: Value) -> Parameter {
    Parameter { name, kind, default, summary: "" }
}

const PARAMETERS: &[Parameter] = &[
    parameter("depth", Kind::Int { min: 1, max: 32 }, Value::Int(9)),
    parameter("diffuse_initial", Kind::Color, Value::Color([0.0; 3])),
    parameter("diffuse_final", Kind::Color, Value::Color([1.0; 3])),
    parameter("noise", Kind::Choice(&["improved", "classic", "lattice"]), Value::Choice("improved")),
    parameter("sum", Kind::Choice(&["plain", "absolute"]), Value::Choice("absolute")),
    parameter("space", Kind::Choice(&["local", "world", "uv"]), Value::Auto),
    parameter("seed", Kind::Int { min: 0, max: u32::MAX as i64 }, Value::Int(0)),
    parameter("scale", Kind::Float { min: 1e-6, max: 1e6 }, Value::Float(1.0)),
];

const fn material(name: &'static str) -> Declaration {
    Declaration { name, summary: "", parameters: PARAMETERS }
}

const ALL: &[&Declaration] = &[
    &material("fire"),
    &material("water"),
    &material("marble"),
    &material("stone"),
    &material("wood"),
    &material("organic"),
];

pub(super) fn procedural_declarations() -> &'static [&'static Declaration] {
    ALL
}
