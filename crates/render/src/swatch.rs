//! A picture of one material, without light: its own colours on a plane.

use jaspe_texture::{Space, Texture};
use rayon::prelude::*;

use crate::film::{Encoding, Film, Pixel};
use jaspe_scene::srgb_decode;

/// Samples along each edge of a pixel: wood has sharp rings.
const SAMPLE_COUNT: usize = 3;

/// Not a whole number of cells at any material's frequency: there all gradient noises vanish.
const SLICE: f64 = 0.35;

/// Draws a material on the plane z = 0.35 of its space, two units across the shorter side of the picture, as a unit sphere
/// is, with the origin in the middle; in the space `uv`, u and v from 0 to 1 with the origin in the lower left corner.
/// Everything appears `scale` times as large. Each pixel is the mean light of nine samples.
pub fn swatch(material: &Texture, size: [u32; 2], scale: f64) -> Film {
    let [width, height] = size.map(|side| side as usize);
    let mut film = Film::new(size[0], size[1], Encoding::Linear);
    let columns = SAMPLE_COUNT * width;
    let plane = Plane::new(material.space(), size, scale);
    let x: Vec<f32> = (0..columns).map(|i| plane.x(i)).collect();
    let z = vec![(SLICE / scale) as f32; columns];
    let room = || (vec![0.0; columns], vec![[0.0; 3]; columns]);
    let rows = film.pixels.par_chunks_exact_mut(width.max(1)).take(height).enumerate();
    rows.for_each_init(room, |(y, colors), (row, pixels)| {
        for j in 0..SAMPLE_COUNT {
            y.fill(plane.y(row * SAMPLE_COUNT + j));
            match material.space() {
                Space::Uv => material.colors([&x, &*y], colors),
                Space::Local | Space::World => material.colors([&x, &*y, &z], colors),
            }
            for (pixel, samples) in pixels.iter_mut().zip(colors.chunks_exact(SAMPLE_COUNT)) {
                add(pixel, samples);
            }
        }
    });
    film
}

/// Adds the light of some of a pixel's samples.
fn add(pixel: &mut Pixel, samples: &[[f32; 3]]) {
    let share = 1.0 / (SAMPLE_COUNT * SAMPLE_COUNT) as f32;
    for sample in samples {
        (0..3).for_each(|i| pixel[i] += share * srgb_decode(f64::from(sample[i])) as f32);
    }
    pixel[3] = 1.0;
}

/// Where samples lie, y upwards.
struct Plane {
    step: f64,
    left: f64,
    top: f64,
}

impl Plane {
    fn new(space: Space, [width, height]: [u32; 2], scale: f64) -> Self {
        let across = if space == Space::Uv { 1.0 } else { 2.0 };
        let step = across / (f64::from(width.min(height)) * SAMPLE_COUNT as f64 * scale);
        let [width, height] = [width, height].map(|side| f64::from(side) * SAMPLE_COUNT as f64);
        match space {
            Space::Uv => Plane { step, left: 0.5, top: height - 0.5 },
            Space::Local | Space::World => Plane { step, left: 0.5 - 0.5 * width, top: 0.5 * height - 0.5 },
        }
    }

    fn x(&self, column: usize) -> f32 {
        (self.step * (self.left + column as f64)) as f32
    }

    fn y(&self, row: usize) -> f32 {
        (self.step * (self.top - row as f64)) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_means_of_the_materials_colors() {
        let marble = Texture::build("marble", &[]).expect("it exists");
        let film = swatch(&marble, [8, 4], 1.0);
        // The pixel in column 5 and row 1: the units are a half, the centre is at (0.75, 0.25).
        let mut expected = [0.0; 3];
        for (i, j) in (0..9).map(|k| (k % 3, k / 3)) {
            let at = |middle: f32, k: i32| [middle + (k - 1) as f32 / 6.0];
            let mut color = [[0.0; 3]];
            marble.colors([&at(0.75, i), &at(0.25, 2 - j), &[0.35]], &mut color);
            (0..3).for_each(|k| expected[k] += srgb_decode(f64::from(color[0][k])) as f32 / 9.0);
        }
        let pixel = film.pixels[8 + 5];
        for k in 0..3 {
            assert!((pixel[k] - expected[k]).abs() < 1e-4, "{pixel:?} is not {expected:?}");
        }
        assert_eq!(pixel[3], 1.0);
    }
}
