//! A picture that pictures and words are put on.

use jaspe_render::{Alpha, Depth, Encoding, Film, Samples, develop};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Display values: red, green, blue.
pub(crate) type Ink = [u8; 3];

/// Rows of display values.
pub(crate) struct Canvas {
    width: usize,
    pixels: Vec<Ink>,
}

/// How words look.
#[derive(Clone, Copy)]
pub(crate) enum Style {
    /// 32 pixels high, bold.
    Title,
    /// 16 pixels high.
    Text,
}

impl Style {
    fn font(self) -> (FontWeight, RasterHeight) {
        match self {
            Style::Title => (FontWeight::Bold, RasterHeight::Size32),
            Style::Text => (FontWeight::Regular, RasterHeight::Size16),
        }
    }
}

impl Canvas {
    /// An empty one.
    pub fn new([width, height]: [usize; 2], ink: Ink) -> Canvas {
        Canvas { width, pixels: vec![ink; width * height] }
    }

    fn height(&self) -> usize {
        self.pixels.len() / self.width
    }

    /// Puts a film here, as a display shows it; what is outside is cut off.
    pub fn picture(&mut self, [left, top]: [usize; 2], film: &Film) {
        let image = develop(film, Depth::Eight, Alpha::OnBlack);
        let Samples::Eight(samples) = &image.samples else { return };
        let rows = samples.chunks_exact(3 * film.width as usize);
        for (y, row) in rows.enumerate().take(self.height().saturating_sub(top)) {
            let count = (film.width as usize).min(self.width.saturating_sub(left));
            let place = (top + y) * self.width + left;
            for (pixel, ink) in self.pixels[place..place + count].iter_mut().zip(row.chunks_exact(3)) {
                *pixel = [ink[0], ink[1], ink[2]];
            }
        }
    }

    /// Fills a rectangle.
    pub fn fill(&mut self, [left, top]: [usize; 2], [width, height]: [usize; 2], ink: Ink) {
        for y in top..(top + height).min(self.height()) {
            for x in left..(left + width).min(self.width) {
                self.pixels[y * self.width + x] = ink;
            }
        }
    }

    /// Writes a line from here on to the right; letters that the font does not have are left blank.
    pub fn text(&mut self, [left, top]: [usize; 2], text: &str, style: Style, ink: Ink) {
        let (weight, height) = style.font();
        let step = get_raster_width(weight, height);
        for (k, glyph) in text.chars().map(|letter| get_raster(letter, weight, height)).enumerate() {
            let Some(glyph) = glyph else { continue };
            for (y, row) in glyph.rows().enumerate() {
                for (x, &cover) in row.iter().enumerate() {
                    let (x, y) = (left + k * step + x, top + y);
                    if x < self.width && y < self.height() {
                        blend(&mut self.pixels[y * self.width + x], ink, cover);
                    }
                }
            }
        }
    }

    /// How many letters of a style fit into a width.
    pub fn letters(width: usize, style: Style) -> usize {
        let (weight, height) = style.font();
        width / get_raster_width(weight, height)
    }

    /// As a film of display values.
    pub fn film(&self) -> Film {
        let mut film = Film::new(self.width as u32, self.height() as u32, Encoding::Display);
        for (pixel, ink) in film.pixels.iter_mut().zip(&self.pixels) {
            let [red, green, blue] = ink.map(|part| f32::from(part) / 255.0);
            *pixel = [red, green, blue, 1.0];
        }
        film
    }
}

fn blend(pixel: &mut Ink, ink: Ink, cover: u8) {
    for (below, above) in pixel.iter_mut().zip(ink) {
        let (below_part, above_part) =
            (u32::from(*below) * u32::from(255 - cover), u32::from(above) * u32::from(cover));
        *below = ((below_part + above_part + 127) / 255) as u8;
    }
}
