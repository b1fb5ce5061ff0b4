//! The gallery: every material on a page of its own, and all of them on one sheet, with names and parameters.

use jaspe_render::{Cancelled, Depth, Film, Format, Observer, encode};
use jaspe_texture::Texture;
use jaspe_texture::declare::{Declaration, Kind, Parameter, Value};
use serde_json::json;

use crate::bake::{Bake, Settings};
use crate::canvas::{Canvas, Ink, Style};
use crate::map::Map;
use crate::preview::{PREVIEW_SIZE, Silent, film, preview};
use crate::set::{GALLERY, SetError, SetFolder, Work, Written};

/// The side of a map on a page.
const TILE: usize = 304;
/// Between things.
const GAP: usize = 24;
/// The height of a line of text.
const LINE: usize = 20;
const PAPER: Ink = [250, 249, 246];
const INK: Ink = [28, 28, 30];
const FAINT: Ink = [110, 108, 104];

/// Draws these materials into a folder: `index.png`, the sheet; a page for each, by its name; and `gallery.json`, which lists
/// them.
///
/// # Errors
/// [`SetError`]; then the folder is as it was before.
pub fn write_gallery(
    materials: &[&'static Declaration],
    folder: SetFolder,
    observer: &dyn Observer,
) -> Result<Written, SetError> {
    let count = materials.len() as u64;
    let mut previews = Vec::new();
    let mut files = vec!["index.png".to_owned(), GALLERY.to_owned()];
    for (k, declaration) in materials.iter().enumerate() {
        let work = Work { observer, before: 100 * k as u64, most: 100, total: 100 * count };
        let texture = Texture::build(declaration.name, &[]).expect("defaults are within their ranges");
        let maps = Settings::maps_of(&texture);
        let bake = Bake::new(texture, Settings { size: 1024, maps, ..Settings::default() });
        let bake = bake.expect("a thousand pixels show every material");
        let picture = preview(&bake, 0, PREVIEW_SIZE, &work)?;
        let name = format!("{}.png", declaration.name);
        folder.write(&name, &png(&page(&bake, &picture, observer)?))?;
        files.push(name);
        previews.push((*declaration, half(&picture)));
    }
    folder.write("index.png", &png(&sheet(&previews)))?;
    files.sort();
    let names: Vec<&str> = materials.iter().map(|declaration| declaration.name).collect();
    let list = json!({ "generator": concat!("jaspe ", env!("CARGO_PKG_VERSION")), "materials": names, "files": files });
    folder.write(GALLERY, format!("{list:#}\n").as_bytes())?;
    folder.complete()
}

fn png(canvas: &Canvas) -> Vec<u8> {
    encode(&canvas.film(), Format::Png(Depth::Eight)).expect("pages fit PNG")
}

/// A film at half its size: light is averaged.
fn half(whole: &Film) -> Film {
    let mut half = Film::new(whole.width / 2, whole.height / 2, whole.encoding);
    let width = half.width as usize;
    for (i, pixel) in half.pixels.iter_mut().enumerate() {
        let corner = 2 * (i / width) * whole.width as usize + 2 * (i % width);
        for place in [corner, corner + 1, corner + whole.width as usize, corner + whole.width as usize + 1] {
            (0..4).for_each(|k| pixel[k] += 0.25 * whole.pixels[place][k]);
        }
    }
    half
}

/// A material's page: its picture, its maps, its parameters.
fn page(bake: &Bake, picture: &Film, observer: &dyn Observer) -> Result<Canvas, Cancelled> {
    let declaration = bake.texture().declaration();
    let maps = Settings::maps_of(bake.texture());
    let rows = maps.len().div_ceil(3);
    let width = PREVIEW_SIZE[0] as usize + 2 * GAP;
    let map_row = TILE + LINE + GAP;
    let top = GAP + 84 + PREVIEW_SIZE[1] as usize + GAP;
    let below = top + rows * map_row;
    let height = below + declaration.parameters.len() * 2 * LINE + GAP;
    let mut canvas = Canvas::new([width, height], PAPER);
    canvas.text([GAP, GAP], declaration.name, Style::Title, INK);
    canvas.text([GAP, GAP + 44], declaration.summary, Style::Text, FAINT);
    canvas.picture([GAP, GAP + 84], picture);

    let settings = Settings { size: TILE as u32, maps, ..bake.settings().clone() };
    let small = Bake::new(bake.texture().clone(), settings).expect("a tile of the page shows every material");
    let arrays = small.arrays(0, &Silent(observer))?;
    for (k, array) in arrays.maps.iter().enumerate() {
        let at = [GAP + k % 3 * (TILE + GAP), top + k / 3 * map_row];
        canvas.picture(at, &film(&arrays, array.map));
        canvas.text([at[0], at[1] + TILE + 2], &caption(array.map, &small), Style::Text, FAINT);
    }
    for (k, parameter) in declaration.parameters.iter().enumerate() {
        let y = below + 2 * k * LINE;
        let letters = Canvas::letters(width - 2 * GAP, Style::Text);
        parameter_line(&mut canvas, [GAP, y], parameter, INK);
        let note: String = parameter.summary.chars().take(letters).collect();
        canvas.text([GAP, y + LINE - 2], &note, Style::Text, FAINT);
    }
    Ok(canvas)
}

/// What stands below a map.
fn caption(map: Map, bake: &Bake) -> String {
    match map {
        Map::Color => format!("color, {} units wide", bake.tile()),
        other => other.name().to_owned(),
    }
}

/// All materials, three in a row.
fn sheet(materials: &[(&'static Declaration, Film)]) -> Canvas {
    let columns = 3;
    let picture = PREVIEW_SIZE.map(|side| side as usize / 2);
    let lines = materials.iter().map(|(declaration, _)| declaration.parameters.len()).max().unwrap_or(0);
    let cell = [picture[0] + GAP, picture[1] + 16 + 40 + 2 * LINE + 8 + lines * LINE + 2 * GAP];
    let rows = materials.len().div_ceil(columns);
    let mut canvas = Canvas::new([columns * cell[0] + GAP, rows * cell[1] + GAP], PAPER);
    for (k, (declaration, film)) in materials.iter().enumerate() {
        let [left, top] = [GAP + k % columns * cell[0], GAP + k / columns * cell[1]];
        canvas.picture([left, top], film);
        let mut y = top + picture[1] + 16;
        canvas.text([left, y], declaration.name, Style::Title, INK);
        y += 40;
        for line in wrap(declaration.summary, Canvas::letters(picture[0], Style::Text)).iter().take(2) {
            canvas.text([left, y], line, Style::Text, FAINT);
            y += LINE;
        }
        y = top + picture[1] + 16 + 40 + 2 * LINE + 8;
        for parameter in declaration.parameters {
            parameter_line(&mut canvas, [left, y], parameter, INK);
            y += LINE;
        }
    }
    canvas
}

/// A parameter, its default and what it takes; a colour as it looks.
fn parameter_line(canvas: &mut Canvas, [left, top]: [usize; 2], parameter: &Parameter, ink: Ink) {
    let name = 17;
    canvas.text([left, top], parameter.name, Style::Text, ink);
    let letter = |count: usize| left + count * PICA;
    match parameter.default {
        Value::Color(color) => {
            let bytes = color.map(|part| (255.0 * part + 0.5) as u8);
            canvas.fill([letter(name), top + 2], [4 * PICA, 14], bytes);
            let [red, green, blue] = color.map(|part| (1000.0 * part).round() / 1000.0);
            canvas.text([letter(name + 5), top], &format!("{red} {green} {blue}"), Style::Text, FAINT);
        }
        default => {
            canvas.text([letter(name), top], &default.to_string(), Style::Text, ink);
            canvas.text([letter(name + 10), top], &range(parameter.kind), Style::Text, FAINT);
        }
    }
}

/// The width of a letter of [`Style::Text`].
const PICA: usize = 8;

/// What a parameter takes, in few letters.
fn range(kind: Kind) -> String {
    match kind {
        Kind::Int { min, max } if max == i64::MAX => format!("{min} or more"),
        Kind::Int { min, max } => format!("{min} to {max}"),
        Kind::Float { min, max } => format!("{min} to {max}"),
        Kind::Color => String::new(),
        Kind::Choice(words) => words.join(" "),
    }
}

/// Words in lines of so many letters.
fn wrap(text: &str, letters: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last_mut().expect("there is a first line");
        if !last.is_empty() && last.chars().count() + 1 + word.chars().count() > letters {
            lines.push(word.to_owned());
        } else {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_no_longer_than_their_letters() {
        let lines = wrap("Deep blue patches with teal veins", 12);
        assert_eq!(lines, ["Deep blue", "patches with", "teal veins"]);
        assert_eq!(wrap("", 5), [""]);
    }

    #[test]
    fn half_a_film_has_the_same_light() {
        let mut whole = Film::new(4, 2, jaspe_render::Encoding::Linear);
        whole.pixels.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = [i as f32; 4]);
        let half = half(&whole);
        assert_eq!((half.width, half.height), (2, 1));
        assert_eq!(half.pixels, [[2.5; 4], [4.5; 4]]);
    }

    /// Whether a line of text stands on a canvas, in this ink.
    fn shows(canvas: &Canvas, text: &str, style: Style, ink: Ink) -> bool {
        let mut line = Canvas::new([text.chars().count() * 20, 32], PAPER);
        line.text([0, 0], text, style, ink);
        let (whole, line) = (canvas.film(), line.film());
        let row = |film: &Film, y: u32| film.pixels[(y * film.width) as usize..][..film.width as usize].to_vec();
        // The part of the line that has ink, row by row.
        let paper = line.pixels[line.pixels.len() - 1];
        let inked: Vec<u32> = (0..line.height).filter(|&y| row(&line, y).iter().any(|&p| p != paper)).collect();
        let (top, bottom) = (inked[0], inked[inked.len() - 1]);
        let width = (0..line.width).rev().find(|&x| (top..=bottom).any(|y| row(&line, y)[x as usize] != paper));
        let width = width.expect("it has ink") as usize + 1;
        let pattern: Vec<Vec<[f32; 4]>> = (top..=bottom).map(|y| row(&line, y)[..width].to_vec()).collect();
        (0..=whole.height - pattern.len() as u32).any(|y| {
            let first = row(&whole, y);
            first.windows(width).enumerate().filter(|(_, found)| *found == pattern[0]).any(|(x, _)| {
                let below = pattern.iter().zip(y..);
                below.skip(1).all(|(pattern, y)| row(&whole, y)[x..][..width] == pattern[..])
            })
        })
    }

    #[test]
    fn the_sheet_and_the_pages_name_every_material_with_its_parameters() {
        let film = || Film::new(PREVIEW_SIZE[0], PREVIEW_SIZE[1], jaspe_render::Encoding::Linear);
        let all: Vec<_> = Texture::ALL.iter().map(|declaration| (*declaration, half(&film()))).collect();
        let sheet = sheet(&all);
        assert!(!shows(&sheet, "granite floor", Style::Text, INK));
        for declaration in Texture::ALL {
            let texture = Texture::build(declaration.name, &[]).expect("defaults");
            let maps = Settings::maps_of(&texture);
            let bake = Bake::new(texture, Settings { maps, ..Settings::default() }).expect("it can be baked");
            let page = page(&bake, &film(), &()).expect("nobody stops it");
            for (place, canvas) in [("sheet", &sheet), ("page", &page)] {
                assert!(shows(canvas, declaration.name, Style::Title, INK), "{} on its {place}", declaration.name);
                for parameter in declaration.parameters {
                    let name = format!("{} of {} on its {place}", parameter.name, declaration.name);
                    assert!(shows(canvas, parameter.name, Style::Text, INK), "{name}");
                    if let Value::Int(default) = parameter.default {
                        assert!(shows(canvas, &default.to_string(), Style::Text, INK), "{name}");
                    }
                }
            }
            for map in &bake.settings().maps {
                assert!(shows(&page, &caption(*map, &bake), Style::Text, FAINT), "{map:?}");
            }
        }
    }

    #[test]
    fn every_letter_of_the_declarations_is_drawn() {
        for declaration in Texture::ALL {
            let parameters = declaration.parameters.iter().flat_map(|p| [p.name, p.summary]);
            for text in parameters.chain([declaration.name, declaration.summary]) {
                assert!(text.is_ascii(), "{text}");
            }
        }
    }
}
