//! The examples of docs/format.md are what they claim to be.

use std::fs;
use std::io;
use std::path::Path;
use std::sync::Arc;

use jaspe_scene::{Loader, Severity, parse};

/// Whatever is included is an empty file.
struct Empty;

impl Loader for Empty {
    fn load(&self, _: &Path) -> io::Result<Arc<[u8]>> {
        Ok(Arc::from([]))
    }
}

fn page() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/format.md")).expect("the page exists")
}

/// The blocks that start with a fence of this kind, and the lines at which they start.
fn blocks<'a>(page: &'a str, fence: &str) -> Vec<(usize, &'a str)> {
    let mut found = Vec::new();
    let mut rest = page;
    let start = format!("\n{fence}\n");
    while let Some(at) = rest.find(&start) {
        let text = &rest[at + start.len()..];
        let length = text.find("\n```").expect("a fence is closed");
        found.push((page[..page.len() - text.len()].lines().count() + 1, &text[..length]));
        rest = &text[length..];
    }
    found
}

#[test]
fn every_example_is_read_without_error() {
    let page = page();
    let examples = blocks(&page, "```sc");
    assert!(examples.len() >= 15, "found only {} examples", examples.len());
    for (line, text) in examples {
        let (_, diagnostics) = parse(Path::new("example.sc"), text.as_bytes(), &Empty);
        assert_eq!(diagnostics.count(Severity::Error), 0, "the example at line {line}: {diagnostics:#?}");
        let warnings = if text.starts_with("% Read with five warnings") { 5 } else { 0 };
        assert_eq!(diagnostics.count(Severity::Warning), warnings, "the example at line {line}: {diagnostics:#?}");
    }
}

#[test]
fn every_mistake_is_one() {
    let page = page();
    let mistakes = blocks(&page, "```sc error");
    assert!(!mistakes.is_empty());
    for (line, text) in mistakes {
        let (_, diagnostics) = parse(Path::new("mistake.sc"), text.as_bytes(), &Empty);
        assert!(diagnostics.has_errors(), "the mistake at line {line} is none");
    }
}

#[test]
fn the_materials_are_described_as_they_are_declared() {
    use jaspe_texture::declare::{Kind, Value};
    let page = page();
    for declaration in jaspe_texture::Texture::ALL {
        let row = page.lines().find(|line| line.starts_with(&format!("| `{}` |", declaration.name)));
        let row = row.unwrap_or_else(|| panic!("no row for {}", declaration.name));
        let mut expected = String::new();
        for name in ["depth", "diffuse_initial", "diffuse_final"] {
            let parameter = declaration.parameter(name).expect("every material has it");
            expected += &match parameter.default {
                Value::Int(depth) => format!(" | {depth}"),
                Value::Color(rgb) => {
                    format!(" | {}", rgb.map(|x| ((x * 1000.0).round() / 1000.0).to_string()).join(" "))
                }
                other => panic!("{other:?}"),
            };
        }
        assert!(row.ends_with(&format!("{expected} |")), "{row}\nshould end with{expected}");
        for parameter in declaration.parameters {
            let described = page.lines().find(|line| line.starts_with(&format!("| `{}` |", parameter.name)));
            let described = described.unwrap_or_else(|| panic!("no row for {}", parameter.name));
            if let Kind::Choice(words) = parameter.kind {
                assert!(words.iter().all(|word| described.contains(&format!("`{word}`"))), "{described}");
            }
            if let Kind::Int { max: max @ ..1000, .. } = parameter.kind {
                assert!(described.contains(&max.to_string()), "{described}");
            }
        }
    }
}
