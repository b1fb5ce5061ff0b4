//! `jaspe textures`.

use std::fmt::Write as _;
use std::io::Write as _;

use clap::Args;
use clap::builder::PossibleValuesParser;
use jaspe_texture::Texture;
use jaspe_texture::declare::{Declaration, Kind, Parameter, Value};
use serde_json::json;

use crate::Outcome;
use crate::arguments::OutputFormat;
use crate::failure::Failure;
use crate::show::shortest;

/// List the procedural materials with their parameters.
///
/// Every parameter is optional: in a scene, a name and a type are enough.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe textures
  jaspe textures marble
  jaspe textures --format json | jq -r '.[].name'")]
pub struct Textures {
    /// Only this one
    #[arg(value_name = "NAME", value_parser = names())]
    name: Option<String>,

    /// How to print the list
    #[arg(long, value_enum, default_value_t = OutputFormat::Text)]
    format: OutputFormat,
}

/// The names of all materials.
pub fn names() -> PossibleValuesParser {
    PossibleValuesParser::new(Texture::ALL.iter().map(|declaration| declaration.name))
}

impl Textures {
    /// Prints the list.
    pub fn run(self) -> Result<Outcome, Failure> {
        let wanted = |declaration: &&&Declaration| self.name.as_deref().is_none_or(|name| name == declaration.name);
        let chosen = Texture::ALL.iter().filter(wanted).copied();
        let text = match self.format {
            OutputFormat::Text => chosen.map(text).collect::<Vec<_>>().join("\n"),
            OutputFormat::Json => format!("{:#}\n", json!(chosen.map(json).collect::<Vec<_>>())),
        };
        std::io::stdout().write_all(text.as_bytes())?;
        Ok(Outcome::Done)
    }
}

fn text(declaration: &Declaration) -> String {
    let rows: Vec<[String; 3]> = declaration
        .parameters
        .iter()
        .map(|parameter| [parameter.name.to_owned(), default(parameter), range(parameter.kind)])
        .collect();
    let head = ["PARAMETER", "DEFAULT", "TAKES"].map(str::to_owned);
    let column = |i: usize| rows.iter().chain([&head]).map(|row| row[i].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2].map(column);

    let mut text = format!("{}\n  {}\n\n", declaration.name, declaration.summary);
    let summaries = std::iter::once("").chain(declaration.parameters.iter().map(|parameter| parameter.summary));
    for (row, summary) in std::iter::once(&head).chain(&rows).zip(summaries) {
        let line = format!(
            "  {:name$}  {:default$}  {:takes$}  {summary}",
            row[0],
            row[1],
            row[2],
            name = widths[0],
            default = widths[1],
            takes = widths[2]
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

fn default(parameter: &Parameter) -> String {
    match parameter.default {
        Value::Color(color) => color.map(short_component).join(" "),
        Value::Float(value) => shortest(value),
        other => other.to_string(),
    }
}

/// Three digits tell a colour well enough; JSON has all of them.
fn short_component(value: f64) -> String {
    shortest((value * 1e3).round() / 1e3)
}

fn range(kind: Kind) -> String {
    match kind {
        Kind::Int { min, max } if max == i64::MAX => format!("{min} or more"),
        Kind::Int { min, max } => format!("{min} to {max}"),
        Kind::Float { min, max } => format!("{} to {}", shortest(min), shortest(max)),
        Kind::Color => "colour".to_owned(),
        Kind::Choice(words) => words.join("|"),
    }
}

fn json(declaration: &Declaration) -> serde_json::Value {
    let parameters = declaration.parameters.iter().map(parameter_json).collect::<Vec<_>>();
    json!({ "name": declaration.name, "summary": declaration.summary, "parameters": parameters })
}

fn parameter_json(parameter: &Parameter) -> serde_json::Value {
    let mut value = match parameter.kind {
        Kind::Int { min, max } => json!({ "kind": "int", "min": min, "max": max }),
        Kind::Float { min, max } => json!({ "kind": "float", "min": min, "max": max }),
        Kind::Color => json!({ "kind": "color" }),
        Kind::Choice(words) => json!({ "kind": "choice", "choices": words }),
    };
    value["name"] = json!(parameter.name);
    value["summary"] = json!(parameter.summary);
    value["default"] = match parameter.default {
        Value::Int(value) => json!(value),
        Value::Float(value) => json!(value),
        Value::Color(color) => json!(color),
        Value::Choice(word) => json!(word),
        Value::Auto => serde_json::Value::Null,
    };
    value
}
