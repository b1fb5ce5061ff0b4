//! What surfaces are made of: a colour from somewhere, and a response to light.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use jaspe_texture::{Space, Texture};

use crate::geometry::Rows;
use crate::geometry::simd::{self, Simd};
use crate::modifier::Modifier;
use crate::options::Look;
use crate::picture::{Picture, PicturePixels};

/// The material of objects whose shader is missing: black, as in Sunflow.
pub(crate) const BLACK: u32 = 0;

/// Colour and response.
#[derive(Debug, Clone)]
pub(crate) struct Material {
    pub albedo: Albedo,
    pub response: Response,
    /// What turns the normals.
    pub modifier: Option<Arc<Modifier>>,
}

impl Material {
    pub fn new(albedo: Albedo, response: Response) -> Self {
        Material { albedo, response, modifier: None }
    }

    /// See [`BLACK`].
    pub fn black() -> Self {
        Material::new(Albedo::Color(Vec3::ZERO), Response::Constant)
    }
}

/// Where a surface's colour comes from.
#[derive(Debug, Clone)]
pub(crate) enum Albedo {
    Color(Vec3),
    Picture(Arc<PictureMap>),
    Procedural(Box<Procedural>),
    /// A colour, and so much of another over it.
    Blend {
        color: Vec3,
        over: Box<Albedo>,
        amount: f32,
    },
}

/// What a surface does with light. Colours are in the dialect's working space.
#[derive(Debug, Clone)]
pub(crate) enum Response {
    /// Shines by itself (Sunflow), or matte (report).
    Constant,
    /// Shines by itself to its front, black from behind; seen by rays that are not blurred.
    Emitter,
    /// Matte, with something over it.
    Matte(Coat),
    /// A mirror tinted by the albedo.
    Mirror,
    /// Clear glass tinted by the albedo; `absorption` per world unit.
    Glass { eta: f32, absorption: Vec3 },
    /// How much of the surroundings is open: the albedo where it is, `dark` where something stands nearer than
    /// `distance`.
    AmbientOcclusion { dark: Vec3, samples: u32, distance: f32 },
    /// Lines along the edges of triangles, up to `width` radians from them as seen from the camera.
    Wireframe { line: Vec3, width: f32 },
    /// The indirect light that arrives.
    ViewIrradiance,
    /// The caustic light that arrives.
    ViewCaustics,
    /// A quick look.
    Look(Look),
}

/// What lies over a matte surface.
#[derive(Debug, Clone)]
pub(crate) enum Coat {
    None,
    /// A glossy lobe around the mirror direction, and so many rays into it.
    Phong {
        specular: Gloss,
        power: f32,
        samples: u32,
    },
    /// Ward's anisotropic highlight.
    Ward {
        specular: Gloss,
        roughness: [f32; 2],
        samples: u32,
    },
    /// A mirror, clearer at grazing angles.
    Mirror {
        specular: Gloss,
    },
    /// One of the six: a touch of reflection.
    Touch {
        reflection: f32,
        transmission: f32,
    },
}

/// The colour of a coat.
#[derive(Debug, Clone)]
pub(crate) enum Gloss {
    Color(Vec3),
    /// So many times the albedo.
    Albedo(f32),
    /// A colour that varies.
    Painted(Box<Albedo>),
}

/// A procedural texture and how the renderer uses it.
#[derive(Debug, Clone)]
pub(crate) struct Procedural {
    pub texture: Texture,
    /// Turns the texture's display values into the dialect's working space.
    pub decode: bool,
}

impl Procedural {
    /// Colours at all points, in the dialect's working space. The third coordinate of points in texture coordinates
    /// means nothing. With footprints, sides in the texture's space, each colour is the mean over one.
    pub fn evaluate(&self, points: &Rows, footprints: Option<&[f32]>, colors: &mut Vec<[f32; 3]>) {
        let count = points.x.len();
        colors.resize(count, [0.0; 3]);
        let [x, y, z] = points.slices(count);
        match (self.texture.space(), footprints) {
            (Space::Uv, None) => self.texture.colors([x, y], colors),
            (Space::Uv, Some(footprints)) => self.texture.colors_seen([x, y], footprints, colors),
            (_, None) => self.texture.colors([x, y, z], colors),
            (_, Some(footprints)) => self.texture.colors_seen([x, y, z], footprints, colors),
        }
        if self.decode {
            colors.iter_mut().for_each(|color| *color = color.map(decode_display));
        }
    }
}

impl Procedural {
    /// Display values at all points, in rows; `coefficients` is room for those that mix them.
    pub fn paint(&self, points: &Rows, coefficients: &mut Vec<f32>, colors: &mut Rows) {
        let count = points.x.len();
        coefficients.resize(count, 0.0);
        colors.resize(count);
        let [x, y, z] = points.slices(count);
        match self.texture.space() {
            Space::Uv => self.texture.evaluate([x, y], coefficients),
            Space::World | Space::Local => self.texture.evaluate([x, y, z], coefficients),
        }
        simd::run(Mix { texture: &self.texture, coefficients, colors });
    }
}

/// Mixes a texture's colours.
struct Mix<'a> {
    texture: &'a Texture,
    coefficients: &'a [f32],
    colors: &'a mut Rows,
}

impl simd::Kernel for Mix<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Mix { texture, coefficients, colors } = self;
        let count = coefficients.len();
        let [red, green, blue] = colors.slices_mut(count);
        for i in 0..count {
            [red[i], green[i], blue[i]] = texture.color(coefficients[i]);
        }
    }
}

/// Display value to linear light by a table of 4096 steps with linear interpolation; error below 1e-6.
#[inline]
fn decode_display(value: f32) -> f32 {
    use std::sync::LazyLock;
    const STEPS: usize = 4096;
    static TABLE: LazyLock<Vec<f32>> =
        LazyLock::new(|| (0..=STEPS + 1).map(|i| jaspe_scene::srgb_decode(i as f64 / STEPS as f64) as f32).collect());
    let at = value.clamp(0.0, 1.0) * STEPS as f32;
    let i = at as usize;
    let table = &*TABLE;
    table[i] + (table[i + 1] - table[i]) * (at - i as f32)
}

/// A picture as a texture.
#[derive(Debug)]
pub(crate) struct PictureMap {
    width: usize,
    height: usize,
    pixels: PicturePixels,
    /// Display value of a byte in the dialect's working space.
    decode: [f32; 256],
}

impl PictureMap {
    /// For Sunflow's meaning: bytes are decoded to linear light, except in grayscale files, whose bytes Sunflow takes
    /// as linear already.
    pub fn linear(picture: Picture) -> Self {
        let decode = |i: usize| {
            let value = i as f64 / 255.0;
            (if picture.grayscale { value } else { jaspe_scene::srgb_decode(value) }) as f32
        };
        PictureMap::new(std::array::from_fn(decode), picture)
    }

    /// For the report's meaning: display values as they are.
    pub fn display(picture: Picture) -> Self {
        PictureMap::new(std::array::from_fn(|i| i as f32 / 255.0), picture)
    }

    /// For modifiers: display values as they are. Sunflow: a single channel counts as linear light, which is encoded on
    /// reading, to eight bits (R12).
    pub fn raw(picture: Picture) -> Self {
        let decode = |i: usize| {
            let value = i as f64 / 255.0;
            let encoded = || (jaspe_scene::srgb_encode(value) * 255.0).round() / 255.0;
            (if picture.grayscale { encoded() } else { value }) as f32
        };
        PictureMap::new(std::array::from_fn(decode), picture)
    }

    fn new(decode: [f32; 256], picture: Picture) -> Self {
        let (width, height) = (picture.width as usize, picture.height as usize);
        PictureMap { width, height, pixels: picture.pixels, decode }
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The pixel of a column and a row counted from the top.
    pub fn texel(&self, column: usize, row: usize) -> Vec3 {
        let at = row * self.width + column;
        match &self.pixels {
            PicturePixels::Bytes(bytes) => Vec3::from_array(bytes[at].map(|byte| self.decode[byte as usize])),
            PicturePixels::Floats(floats) => Vec3::from_array(floats[at]),
        }
    }

    /// Sunflow's look-up: v = 0 is the bottom edge, neighbours wrap, weights are eased (format reference, §3.12).
    pub fn smooth(&self, uv: Vec2) -> Vec3 {
        let axis = |t: f32, size: usize| {
            let t = t - t.floor();
            let at = if t.is_finite() { t * (size - 1) as f32 } else { 0.0 };
            let low = (at as usize).min(size - 1);
            let f = at - low as f32;
            (low, (low + 1) % size, f * f * (3.0 - 2.0 * f))
        };
        let (x0, x1, fx) = axis(uv.x, self.width);
        let (y0, y1, fy) = axis(uv.y, self.height);
        let row = |y: usize| {
            let y = self.height - 1 - y;
            self.texel(x0, y).lerp(self.texel(x1, y), fx)
        };
        row(y0).lerp(row(y1), fy)
    }

    /// The report's look-up: the nearest pixel, v = 0 at the top, coordinates from 0 to 1.
    pub fn nearest(&self, uv: Vec2) -> Vec3 {
        let axis = |t: f32, size: usize| ((t * size as f32).max(0.0) as usize).min(size - 1);
        self.texel(axis(uv.x, self.width), axis(uv.y, self.height))
    }
}

/// Sunflow's brightness of a linear colour.
pub(crate) fn luminance(color: Vec3) -> f32 {
    color.dot(Vec3::new(0.2989, 0.5866, 0.1145))
}
