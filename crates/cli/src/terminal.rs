//! A picture in the terminal: two pixels per character, as the upper half block's two colours.

use std::fmt::Write as _;

use jaspe_render::{Alpha, Depth, Film, Samples, develop};

/// Widest picture, in characters: more helps nobody.
const MAX_COLUMNS: usize = 160;

/// The picture as text for a terminal of that many columns and rows. Ends with a line end.
pub fn draw(film: &Film, columns: usize, rows: usize) -> String {
    let image = develop(film, Depth::Eight, Alpha::OnBlack);
    let (width, height) = (image.width as usize, image.height as usize);
    let Samples::Eight(samples) = &image.samples else { return String::new() };
    let columns = columns.clamp(1, MAX_COLUMNS).min(width);
    // One row is left for the prompt. Halves of characters are about square.
    let halves = (columns * height).div_ceil(width).clamp(1, 2 * rows.saturating_sub(1).max(1));
    let columns = columns.min((halves * width).div_ceil(height)).max(1);
    let average = |column: usize, half: usize| -> [u8; 3] {
        let (x0, x1) = (column * width / columns, ((column + 1) * width / columns).max(column * width / columns + 1));
        let (y0, y1) = (half * height / halves, ((half + 1) * height / halves).max(half * height / halves + 1));
        let mut sum = [0_usize; 3];
        for y in y0..y1 {
            for pixel in samples[3 * (y * width + x0)..3 * (y * width + x1)].chunks_exact(3) {
                (0..3).for_each(|i| sum[i] += usize::from(pixel[i]));
            }
        }
        sum.map(|channel| (channel / ((x1 - x0) * (y1 - y0))) as u8)
    };
    let mut text = String::new();
    for row in 0..halves.div_ceil(2) {
        for column in 0..columns {
            let [r, g, b] = average(column, 2 * row);
            let _ = write!(text, "\x1b[38;2;{r};{g};{b}m");
            let lower = if 2 * row + 1 < halves { average(column, 2 * row + 1) } else { [0; 3] };
            let [r, g, b] = lower;
            let _ = write!(text, "\x1b[48;2;{r};{g};{b}m▀");
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

/// Draws the picture on standard error, where it cannot end up in anybody's results.
pub fn show(film: &Film) {
    let (columns, rows) = terminal_size::terminal_size_of(std::io::stderr())
        .map_or((80, 24), |(width, height)| (usize::from(width.0), usize::from(height.0)));
    anstream::eprint!("{}", draw(film, columns, rows));
}

#[cfg(test)]
mod tests {
    use super::*;
    use jaspe_render::Encoding;

    #[test]
    fn pictures_fit_the_terminal() {
        for (width, height) in [(640, 480), (1, 1), (3, 2000), (2000, 3), (81, 7)] {
            let film = Film::new(width, height, Encoding::Linear);
            let text = draw(&film, 80, 24);
            assert!((1..=23).contains(&text.lines().count()), "{width} x {height}");
            assert!(text.lines().all(|line| (1..=80).contains(&line.matches('▀').count())), "{width} x {height}");
        }
    }

    #[test]
    fn halves_have_the_colours_of_their_pixels() {
        let mut film = Film::new(1, 2, Encoding::Display);
        film.pixels = vec![[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]];
        assert_eq!(draw(&film, 80, 24), "\x1b[38;2;255;0;0m\x1b[48;2;0;0;255m▀\x1b[0m\n");
    }
}
