//! The page of the noises in the documentation, from their declarations. `JASPE_BLESS=1` writes it.

use std::fmt::Write as _;
use std::path::Path;

use jaspe_noise::{Basis, Combine, Declaration};

/// A noise or a sum on the page.
fn section<T>(page: &mut String, declaration: &Declaration<T>) {
    let Declaration { name, sentence, formula, source, statistics, .. } = declaration;
    writeln!(page, "\n### {name}\n\n{sentence}\n\n> {formula}\n\nSource: {source}.\n").unwrap();
    writeln!(page, "| dimensions | minimum | maximum | mean | variance |\n|---|---|---|---|---|").unwrap();
    for (i, s) in statistics.iter().enumerate() {
        writeln!(page, "| {} | {} | {} | {} | {} |", i + 1, s.least, s.largest, s.mean, s.variance).unwrap();
    }
}

fn page() -> String {
    let mut page = "# Noises\n\nWhat each noise and each sum is, where it comes from, and what its values are like. \
                    Minimum and maximum are bounds;\nmean and variance are measured over all points and seeds. This page is \
                    written from the declarations in\n`crates/noise/src/declaration.rs`, and a test holds it to them \
                    (`JASPE_BLESS=1 cargo test -p jaspe-noise --test page`).\n\n## Bases\n"
        .to_owned();
    for basis in Basis::ALL {
        section(&mut page, basis.declaration());
    }
    page += "\n## Sums\n\nn is the noise, l the lacunarity, g the gain, k counts octaves from 0. Statistics are those of five \
             octaves of improved noise\nwith l = 2 and g = ½.\n";
    for combine in Combine::ALL {
        section(&mut page, combine.declaration());
    }
    page
}

#[test]
fn the_page_is_that_of_the_declarations() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/noise.md");
    let expected = page();
    assert_eq!(expected.matches("\n### ").count(), Basis::ALL.len() + Combine::ALL.len());
    if std::env::var_os("JASPE_BLESS").is_some() {
        std::fs::write(&path, &expected).unwrap();
    }
    let found = std::fs::read_to_string(&path).expect("the page is there");
    assert!(found == expected, "docs/noise.md is not current: JASPE_BLESS=1 cargo test -p jaspe-noise --test page");
}
