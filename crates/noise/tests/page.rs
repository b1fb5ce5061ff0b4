//! The page of the noises in the documentation and its pictures, from their declarations; and the picture of the crate's
//! front page. `JASPE_BLESS=1` writes them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use image::{GrayImage, ImageFormat};
use jaspe_noise::{Basis, Cellular, Combine, Declaration, Feature, Field, Grid, Noise, Sum};

/// A noise or a sum on the page. `caption`: what its picture shows.
fn section<T>(page: &mut String, declaration: &Declaration<T>, caption: &str) {
    let Declaration { name, sentence, formula, source, statistics, .. } = declaration;
    writeln!(page, "\n### {name}\n\n{sentence}\n\n![{caption}](noise/{name}.png)\n").unwrap();
    writeln!(page, "> {formula}\n\nSource: {source}.\n").unwrap();
    writeln!(page, "| dimensions | minimum | maximum | mean | variance |\n|---|---|---|---|---|").unwrap();
    for (i, s) in statistics.iter().enumerate() {
        writeln!(page, "| {} | {} | {} | {} | {} |", i + 1, s.least, s.largest, s.mean, s.variance).unwrap();
    }
}

fn page() -> String {
    let mut page = "# Noises\n\nWhat each noise and each sum is, where it comes from, and what its values are like. \
                    Minimum and maximum are bounds;\nmean and variance are measured over all points and seeds. This page \
                    and its pictures are made from the declarations in\n`crates/noise/src/declaration.rs`, and a test holds \
                    them to these (`JASPE_BLESS=1 cargo test -p jaspe-noise --test page`).\n\nA picture shows a plane \
                    through space; its grey is the mean, black and white are two and a half standard deviations away.\n\n\
                    ## Bases\n\nOn the left the noise, eight cells across; on the right the sum of five octaves.\n"
        .to_owned();
    for basis in Basis::ALL {
        section(&mut page, basis.declaration(), "The noise, and five octaves of it");
        if *basis == Basis::Cellular {
            page += "\nThe features: F1, F2, F2 − F1, and the random number of the nearest point.\n\n\
                     ![F1, F2, F2 − F1 and cell](noise/features.png)\n";
        }
    }
    page += "\n## Sums\n\nn is the noise, l the lacunarity, g the gain, k counts octaves from 0. Statistics and pictures are \
             those of five octaves of improved\nnoise with l = 2 and g = ½; the picture on the right has g = 0.7.\n";
    for combine in Combine::ALL {
        section(&mut page, combine.declaration(), "Five octaves, with gains of 0.5 and 0.7");
    }
    page
}

/// Pixels along the side of a square.
const SIDE: usize = 128;

/// The values of a field in a square of so many cells.
fn square(field: &Field, cells: f32) -> Vec<f32> {
    let at = |i: usize| (i as f32 + 0.5) * cells / SIDE as f32;
    let x: Vec<f32> = (0..SIDE * SIDE).map(|i| at(i % SIDE)).collect();
    let y: Vec<f32> = (0..SIDE * SIDE).map(|i| at(i / SIDE)).collect();
    let mut values = vec![0.0; SIDE * SIDE];
    field.fill([&x, &y, &[0.37; SIDE * SIDE]], &mut values);
    values
}

/// Squares side by side, each in greys around its own mean.
fn picture(squares: &[Vec<f32>]) -> GrayImage {
    let greys: Vec<Vec<u8>> = squares.iter().map(|values| greys(values)).collect();
    GrayImage::from_fn((squares.len() * SIDE) as u32, SIDE as u32, |x, y| {
        image::Luma([greys[x as usize / SIDE][y as usize * SIDE + x as usize % SIDE]])
    })
}

fn greys(values: &[f32]) -> Vec<u8> {
    let count = values.len() as f64;
    let mean = values.iter().map(|&value| f64::from(value)).sum::<f64>() / count;
    let variance = values.iter().map(|&value| (f64::from(value) - mean).powi(2)).sum::<f64>() / count;
    let scale = 127.5 / (2.5 * variance.sqrt());
    values.iter().map(|&value| (127.5 + scale * (f64::from(value) - mean)).round().clamp(0.0, 255.0) as u8).collect()
}

/// Every picture of the page, by its name.
fn pictures() -> Vec<(&'static str, GrayImage)> {
    let octaves = |noise: &Noise, combine, gain| Field::from(Sum::new(noise.clone(), combine, 5).with_gain(gain));
    let of_basis = |&basis: &Basis| {
        let noise = Noise::new(basis, 0);
        let sum = square(&octaves(&noise, Combine::Plain, 0.5), 4.0);
        (basis.name(), picture(&[square(&noise.into(), 8.0), sum]))
    };
    let improved = Noise::new(Basis::Improved, 0);
    let of_sum = |&combine: &Combine| {
        let [smooth, rough] = [0.5, 0.7].map(|gain| square(&octaves(&improved, combine, gain), 4.0));
        (combine.name(), picture(&[smooth, rough]))
    };
    let of_feature = |feature| {
        let cellular = Cellular { feature, ..Cellular::default() };
        square(&Noise::new(Basis::Cellular, 0).with_cellular(cellular).into(), 8.0)
    };
    let features = [Feature::First, Feature::Second, Feature::Difference, Feature::Cell].map(of_feature);
    let mut pictures: Vec<_> = Basis::ALL.iter().map(of_basis).chain(Combine::ALL.iter().map(of_sum)).collect();
    pictures.push(("features", picture(&features)));
    pictures
}

/// The picture of the example on the front page.
fn front_page_picture() -> GrayImage {
    let clouds = Sum::new(Noise::new(Basis::Improved, 0), Combine::Plain, 6);
    let grid = Grid { origin: [0.0; 2], step: [1.0 / 32.0; 2], count: [SIDE; 2] };
    let mut values = vec![0.0; grid.len()];
    clouds.fill_grid(&grid, &mut values);
    let greys = values.iter().map(|value| (127.5 + 90.0 * value) as u8).collect();
    GrayImage::from_raw(SIDE as u32, SIDE as u32, greys).unwrap()
}

fn in_repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

fn is_blessed() -> bool {
    std::env::var_os("JASPE_BLESS").is_some()
}

const COMMAND: &str = "JASPE_BLESS=1 cargo test -p jaspe-noise --test page";

#[test]
fn the_page_is_that_of_the_declarations() {
    let path = in_repository("docs/noise.md");
    let expected = page();
    assert_eq!(expected.matches("\n### ").count(), Basis::ALL.len() + Combine::ALL.len());
    if is_blessed() {
        std::fs::write(&path, &expected).unwrap();
    }
    let found = std::fs::read_to_string(&path).expect("the page is there");
    assert!(found == expected, "docs/noise.md is not current: {COMMAND}");
}

#[test]
fn the_pictures_are_those_of_the_noises() {
    let folder = in_repository("docs/noise");
    let pictures = pictures();
    if is_blessed() {
        std::fs::create_dir_all(&folder).unwrap();
    }
    for (name, expected) in &pictures {
        let path = folder.join(name).with_extension("png");
        if is_blessed() {
            expected.save(&path).unwrap();
        }
        let found = image::open(&path).unwrap_or_else(|error| panic!("{name}: {error}; {COMMAND}")).into_luma8();
        assert!(found == *expected, "the picture {name} is not current: {COMMAND}");
    }
    let files = std::fs::read_dir(&folder).unwrap().count();
    assert_eq!(files, pictures.len(), "there is a picture of no noise in docs/noise");
}

#[test]
fn the_front_page_shows_its_picture() {
    let path = in_repository("crates/noise/src/clouds.base64");
    let expected = front_page_picture();
    if is_blessed() {
        let mut png = std::io::Cursor::new(Vec::new());
        expected.write_to(&mut png, ImageFormat::Png).unwrap();
        std::fs::write(&path, base64(png.get_ref())).unwrap();
    }
    let text = std::fs::read_to_string(&path).unwrap();
    let found = image::load_from_memory(&from_base64(&text)).expect("a picture").into_luma8();
    assert!(found == expected, "the front page's picture is not current: {COMMAND}");
}

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// RFC 4648, filled up with `=`.
fn base64(bytes: &[u8]) -> String {
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0, |bits, i| bits << 8 | u32::from(three.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= three.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

fn from_base64(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    for four in text.trim_end().as_bytes().chunks(4) {
        let digit = |c: &u8| DIGITS.iter().position(|digit| digit == c).unwrap_or(0) as u32;
        let bits = four.iter().fold(0, |bits, c| bits << 6 | digit(c)) << (6 * (4 - four.len()));
        let count = 3 - four.iter().filter(|&&c| c == b'=').count();
        bytes.extend(&bits.to_be_bytes()[1..][..count]);
    }
    bytes
}
