//! The film: what rendering leaves behind. No display curve has been applied yet.

use jaspe_scene::srgb_decode;

/// How the numbers of a [`Film`] relate to light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Encoding {
    /// Linear light, Rec. 709 primaries, unbounded; to be encoded for display.
    #[default]
    Linear,
    /// Display values from 0 to 1, as the report's dialect computes throughout.
    Display,
}

/// One pixel: red, green, blue and the share of it that is covered (not premultiplied by anything but the sampling).
pub type Pixel = [f32; 4];

/// A rendered picture, row by row from the top left.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width × height` pixels.
    pub pixels: Vec<Pixel>,
    /// What the numbers mean.
    pub encoding: Encoding,
}

impl Film {
    /// A black, empty film.
    pub fn new(width: u32, height: u32, encoding: Encoding) -> Self {
        Film { width, height, pixels: vec![[0.0; 4]; width as usize * height as usize], encoding }
    }

    /// A pixel of this film as linear light, whatever it holds.
    pub fn linear(&self, pixel: &Pixel) -> Pixel {
        match self.encoding {
            Encoding::Linear => *pixel,
            Encoding::Display => {
                let [red, green, blue, alpha] = *pixel;
                let decode = |v: f32| srgb_decode(f64::from(v)) as f32;
                [decode(red), decode(green), decode(blue), alpha]
            }
        }
    }
}
