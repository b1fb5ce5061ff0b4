//! From places in the material to the numbers of the maps.

use glam::DVec3;
use jaspe_noise::math;
use jaspe_scene::{srgb_decode, srgb_encode};
use jaspe_texture::{Reliefs, Texture};

use crate::map::{Map, NormalConvention};
use crate::surface::Frame;

/// Samples along each edge of a pixel for what is averaged over it: wood has sharp rings.
const SAMPLES: usize = 3;

/// Directions in which occlusion looks for a horizon. (An odd number: only one runs along the lattice.)
const DIRECTIONS: usize = 7;

/// Distances at which it looks, from two pixels to a noise cell.
const DISTANCES: usize = 5;

/// The material as pixels of a certain size can show it.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    /// For what is averaged over several samples of a pixel.
    fine: Texture,
    /// For what is taken at the centre of a pixel.
    coarse: Texture,
    /// For occlusion: the distance in cells, and the octaves that matter there.
    horizon: Vec<(f64, Texture)>,
    directions: [[f64; 2]; DIRECTIONS],
    decode: DecodeTable,
}

/// Rows of numbers, one for each pixel, as the textures take them.
struct Columns<const D: usize>([Vec<f32>; D]);

impl<const D: usize> Columns<D> {
    fn new(count: usize, time: f32) -> Self {
        Columns(std::array::from_fn(|axis| vec![if axis == 3 { time } else { 0.0 }; count]))
    }

    fn set(&mut self, i: usize, point: DVec3) {
        for (axis, coordinate) in self.0.iter_mut().zip(point.to_array()) {
            axis[i] = coordinate as f32;
        }
    }

    fn slices(&self) -> [&[f32]; D] {
        self.0.each_ref().map(Vec::as_slice)
    }
}

/// How many octaves pixels of this size (in cells) can show: the cells of the last one are two and a half pixels wide.
fn octaves_shown(pixel: f64) -> f64 {
    (1.0 - math::ln(2.5 * pixel) / std::f64::consts::LN_2).max(0.5)
}

impl Field {
    /// The material (its points in cells) for pixels of this size in cells.
    pub fn new(texture: &Texture, pixel: f64) -> Field {
        let coarse = texture.with_octaves(octaves_shown(pixel));
        let (nearest, farthest) = (2.0 * pixel, (4.0 * pixel).max(1.0));
        let ratio = math::ln(farthest / nearest) / (DISTANCES - 1) as f64;
        let horizon = (0..DISTANCES).map(|k| {
            let distance = nearest * math::exp(ratio * k as f64);
            // What is much smaller than the distance cannot be told apart from its mean there.
            (distance, coarse.with_octaves((2.0 - math::ln(distance) / std::f64::consts::LN_2).max(1.0)))
        });
        let directions = std::array::from_fn(|k| {
            let angle = std::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
            [math::cos(angle), math::sin(angle)]
        });
        Field {
            fine: texture.with_octaves(octaves_shown(pixel / SAMPLES as f64)),
            horizon: horizon.collect(),
            coarse,
            directions,
            decode: DecodeTable::new(),
        }
    }

    /// The material with the octaves that height and normal have.
    pub fn shown(&self) -> &Texture {
        &self.coarse
    }

    /// The heights at the centres of pixels, in cells.
    pub fn heights<const D: usize>(&self, frames: &[Frame], time: f32) -> Vec<f32> {
        let mut points = Columns::<D>::new(frames.len(), time);
        for (i, frame) in frames.iter().enumerate() {
            points.set(i, frame.point);
        }
        let mut heights = vec![0.0; frames.len()];
        self.coarse.heights(points.slices(), &mut heights);
        heights
    }

    /// One row of every map: channels interleaved, colours display-encoded.
    pub fn row<const D: usize>(
        &self,
        frames: &[Frame],
        time: f32,
        maps: &[Map],
        convention: NormalConvention,
        range: [f32; 2],
    ) -> Vec<Vec<f32>> {
        let wants = |wanted: &[Map]| maps.iter().any(|map| wanted.contains(map));
        let mut values: Vec<Vec<f32>> = maps.iter().map(|_| Vec::new()).collect();
        let mut put = |map: Map, row: Vec<f32>| {
            if let Some(place) = maps.iter().position(|&wanted| wanted == map) {
                values[place] = row;
            }
        };
        if wants(&[Map::Color, Map::Roughness, Map::Emission]) {
            let [color, roughness, emission] = self.averages::<D>(frames, time);
            put(Map::Color, color);
            put(Map::Roughness, roughness);
            put(Map::Emission, emission);
        }
        if wants(&[Map::Height, Map::Normal]) {
            let relief = Relief::<D>::new(&self.coarse, frames, time);
            put(Map::Height, relief.heights.iter().map(|&height| within(range, height)).collect());
            put(Map::Normal, (0..frames.len()).flat_map(|i| normal(relief.slope(i, &frames[i]), convention)).collect());
        }
        if wants(&[Map::Occlusion]) {
            put(Map::Occlusion, self.occlusion::<D>(frames, time));
        }
        values
    }

    /// Colour, roughness and emission, averaged over each pixel, as light is.
    fn averages<const D: usize>(&self, frames: &[Frame], time: f32) -> [Vec<f32>; 3] {
        let per_row = SAMPLES * frames.len();
        let mut points = Columns::<D>::new(per_row, time);
        let mut coefficients = vec![0.0; per_row];
        let mut light = vec![[0.0f32; 3]; frames.len()];
        let mut roughness = vec![0.0f32; frames.len()];
        let finish = self.fine.finish();
        let [rough, smooth] = finish.roughness.map(|end| end as f32);
        let offset = |k: usize| (k as f64 + 0.5) / SAMPLES as f64 - 0.5;
        for row in 0..SAMPLES {
            for (i, frame) in frames.iter().enumerate() {
                let start = frame.point + offset(row) * frame.up;
                for column in 0..SAMPLES {
                    points.set(SAMPLES * i + column, start + offset(column) * frame.right);
                }
            }
            self.fine.evaluate(points.slices(), &mut coefficients);
            for (i, samples) in coefficients.chunks_exact(SAMPLES).enumerate() {
                for &coefficient in samples {
                    let color = self.fine.color(coefficient);
                    for (light, part) in light[i].iter_mut().zip(color) {
                        *light += self.decode.get(part);
                    }
                    let share = coefficient.clamp(0.0, 1.0);
                    roughness[i] += rough + share * (smooth - rough);
                }
            }
        }
        let share = 1.0 / (SAMPLES * SAMPLES) as f32;
        let encode = |light: f32| srgb_encode(f64::from(light)) as f32;
        let color = light.iter().flatten().map(|light| encode(share * light)).collect();
        let glow = share * finish.emission as f32;
        let emission = light.iter().flatten().map(|light| encode(glow * light)).collect();
        roughness.iter_mut().for_each(|value| *value *= share);
        [color, roughness, emission]
    }

    /// The share of the sky over each pixel that the relief leaves free: for each direction the steepest rise of the surface
    /// over the pixel's own tangent plane is its horizon, which hides sin² of its angle. (Each distance compares heights of the
    /// octaves that matter there. Source: L. Bavoil, M. Sainz, R. Dimitrov, "Image-space horizon-based ambient occlusion",
    /// SIGGRAPH 2008 talks.)
    fn occlusion<const D: usize>(&self, frames: &[Frame], time: f32) -> Vec<f32> {
        let mut points = Columns::<D>::new(frames.len(), time);
        let mut heights = vec![0.0; frames.len()];
        let mut steepest = vec![[0.0f32; DIRECTIONS]; frames.len()];
        for (distance, texture) in &self.horizon {
            let relief = Relief::<D>::new(texture, frames, time);
            for (which, [along, across]) in self.directions.iter().enumerate() {
                for (i, frame) in frames.iter().enumerate() {
                    let way = *along * frame.tangent + *across * frame.bitangent;
                    points.set(i, frame.point + *distance * way);
                }
                texture.heights(points.slices(), &mut heights);
                for (i, frame) in frames.iter().enumerate() {
                    let [slope, rise] = relief.slope(i, frame);
                    let plane = slope * *along as f32 + rise * *across as f32;
                    let over = (heights[i] - relief.heights[i]) / *distance as f32 - plane;
                    steepest[i][which] = steepest[i][which].max(over);
                }
            }
        }
        let free = |slopes: &[f32; DIRECTIONS]| {
            slopes.iter().map(|slope| 1.0 / (1.0 + slope * slope)).sum::<f32>() / DIRECTIONS as f32
        };
        steepest.iter().map(free).collect()
    }
}

/// Heights in cells and their gradients, at the centres of pixels.
struct Relief<const D: usize> {
    heights: Vec<f32>,
    gradient: [Vec<f32>; D],
}

impl<const D: usize> Relief<D> {
    fn new(texture: &Texture, frames: &[Frame], time: f32) -> Self {
        let count = frames.len();
        let mut points = Columns::<D>::new(count, time);
        for (i, frame) in frames.iter().enumerate() {
            points.set(i, frame.point);
        }
        let (mut coefficients, mut heights) = (vec![0.0; count], vec![0.0; count]);
        let mut gradient: [Vec<f32>; D] = std::array::from_fn(|_| vec![0.0; count]);
        let slopes = gradient.each_mut().map(Vec::as_mut_slice);
        texture.reliefs(points.slices(), Reliefs { coefficients: &mut coefficients, heights: &mut heights, slopes });
        Relief { heights, gradient }
    }

    /// The slopes along tangent and bitangent.
    fn slope(&self, i: usize, frame: &Frame) -> [f32; 2] {
        [frame.tangent, frame.bitangent]
            .map(|direction| (0..3).fold(0.0, |sum, axis| sum + direction[axis] as f32 * self.gradient[axis][i]))
    }
}

/// A number's place between two others: 0 at the first, 1 at the second.
fn within([low, high]: [f32; 2], value: f32) -> f32 {
    if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 }
}

/// The direction of a surface with these slopes, mapped to 0…1.
fn normal([slope, rise]: [f32; 2], convention: NormalConvention) -> [f32; 3] {
    let length = (slope * slope + rise * rise + 1.0).sqrt();
    let green = match convention {
        NormalConvention::OpenGl => -rise,
        NormalConvention::DirectX => rise,
    };
    [-slope, green, 1.0].map(|part| 0.5 + 0.5 * (part / length))
}

/// The display curve's inverse by interpolation: within 1e-7 of the curve, and much sooner.
#[derive(Debug, Clone)]
struct DecodeTable(Vec<f32>);

impl DecodeTable {
    const STEPS: usize = 4096;

    fn new() -> Self {
        DecodeTable((0..=Self::STEPS + 1).map(|i| srgb_decode(i as f64 / Self::STEPS as f64) as f32).collect())
    }

    /// The light of a display value from 0 to 1.
    fn get(&self, display: f32) -> f32 {
        let place = display * Self::STEPS as f32;
        let index = (place as usize).min(Self::STEPS);
        let (low, high) = (self.0[index], self.0[index + 1]);
        low + (place - index as f32) * (high - low)
    }
}
