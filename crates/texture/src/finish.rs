//! What a material is besides its colours: height, roughness and light of its own.

use jaspe_noise::simd::{self, Kernel};
use jaspe_noise::{Dual, PeriodError, Real, Sum};

use crate::material;
use crate::texture::{BLOCK, Texture};

/// How a material's surface is finished. All follows from the material's one scalar field: its height by a function of
/// its own, the others between a value where the coefficient is 0 and one where it is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finish {
    /// The height of the surface where the material's height function is 1, in cells of the first octave.
    pub relief: f64,
    /// The roughness where the coefficient is 0 and where it is 1: 0 is a mirror, 1 is matte (α = roughness²).
    pub roughness: [f64; 2],
    /// How much of its own colour the surface gives off as light.
    pub emission: f64,
    /// The side of a piece that shows the material well, in units of the object: what one tile of a bake holds if nothing
    /// else is asked for.
    pub tile: f64,
}

/// Many points of a surface, as [`Texture::reliefs`] gives them: one slice entry for each point.
pub struct Reliefs<'a, const D: usize> {
    /// The coefficient w.
    pub coefficients: &'a mut [f32],
    /// The height, in the unit of the points.
    pub heights: &'a mut [f32],
    /// The derivatives of the height along each axis: slopes, without unit.
    pub slopes: [&'a mut [f32]; D],
}

impl Texture {
    /// How the material's surface is finished.
    pub fn finish(&self) -> &'static Finish {
        self.material.finish()
    }

    /// The same texture with its points given in noise cells, and repeating after so many of them along each axis; 0 leaves
    /// an axis without a period. Where the material has bands of its own along x (marble), they are stretched a little, so
    /// that a whole number of them, at least one, fits.
    ///
    /// # Errors
    /// When a period is longer than a noise can have.
    pub fn in_cells(&self, period: [u32; 4]) -> Result<Texture, PeriodError> {
        let noise = self.sum.noise().clone().with_period(period)?;
        let mut texture = self.clone();
        texture.sum = Sum::new(noise, self.sum.combine(), self.sum.octaves());
        texture.cells_per_unit = Some(1.0);
        texture.stretch = match self.material.band() {
            Some(band) if period[0] > 0 => {
                let cells = f64::from(period[0]);
                (cells / band).round().max(1.0) * band / cells
            }
            _ => 1.0,
        };
        Ok(texture)
    }

    /// The noise cells per unit of the texture's space, with the parameter `scale` counted in.
    pub fn cells_per_unit(&self) -> f64 {
        self.factor()
    }

    /// How many bands of the material's own (marble's) lie in so many cells along x; `None` where it has none.
    pub fn bands(&self, cells: f64) -> Option<f64> {
        self.material.band().map(|band| cells * self.stretch / band)
    }

    /// The same texture with no more octaves than this; a part of an octave fades it in. For pictures that cannot resolve
    /// the finest ones.
    pub fn with_octaves(&self, most: f64) -> Texture {
        let mut texture = self.clone();
        if most < f64::from(self.sum.octaves()) {
            texture.sum = self.sum.clone().with_octaves(most);
        }
        texture
    }

    /// The height at a point of the texture's space, in the unit of the point. With [`Dual`] numbers this gives its exact
    /// slopes.
    #[inline(always)]
    pub fn height<R: Real, const D: usize>(&self, point: [R; D]) -> R {
        let (along, sum) = self.along_and_sum(point);
        self.material.height(along, sum) * R::constant(self.relief())
    }

    /// Coefficients, heights and their exact slopes at many points of the texture's space: one slice of coordinates per axis.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn reliefs<const D: usize>(&self, points: [&[f32]; D], mut reliefs: Reliefs<'_, D>) {
        let count = reliefs.coefficients.len();
        let outputs = reliefs.slopes.iter().map(|axis| axis.len());
        for length in points.iter().map(|axis| axis.len()).chain([reliefs.heights.len()]).chain(outputs) {
            assert_eq!(length, count, "all slices have the same length");
        }
        let level = simd::level();
        let relief = self.relief() as f32;
        // A height over a point's own unit, along an axis in that unit: the cells cancel out.
        let steepness = self.finish().relief as f32;
        let stretch = self.stretch as f32;
        let (mut along, mut moved) = ([0.0; BLOCK], [[0.0; BLOCK]; D]);
        let (mut sums, mut gradient) = ([0.0; BLOCK], [[0.0; BLOCK]; D]);
        let (mut by_along, mut by_sum) = ([0.0; BLOCK], [0.0; BLOCK]);
        for start in (0..count).step_by(BLOCK) {
            let size = BLOCK.min(count - start);
            let at = start..start + size;
            self.place(level, points, at.clone(), &mut along, &mut moved);
            let here = moved.each_ref().map(|axis| &axis[..size]);
            let slopes = gradient.each_mut().map(|axis| &mut axis[..size]);
            self.sum.fill_with_gradient_at(level, here, &mut sums[..size], slopes);
            let inputs = [&along[..size], &sums[..size]];
            self.material.shape_all(level, inputs, &mut reliefs.coefficients[at.clone()]);
            let heights = &mut reliefs.heights[at.clone()];
            self.material.height_all(level, inputs, [heights, &mut by_along[..size], &mut by_sum[..size]]);
            for height in heights {
                *height *= relief;
            }
            for (axis, slopes) in reliefs.slopes.iter_mut().enumerate() {
                for (i, slope) in slopes[at.clone()].iter_mut().enumerate() {
                    let direct = if axis == 0 { by_along[i] * stretch } else { 0.0 };
                    *slope = steepness * (direct + by_sum[i] * gradient[axis][i]);
                }
            }
        }
    }

    /// The heights alone at many points: the same bits as [`Texture::height`] in single precision.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn heights<const D: usize>(&self, points: [&[f32]; D], heights: &mut [f32]) {
        for coordinates in points {
            assert_eq!(coordinates.len(), heights.len(), "all slices have the same length");
        }
        let level = simd::level();
        let relief = self.relief() as f32;
        let (mut along, mut moved, mut sums) = ([0.0; BLOCK], [[0.0; BLOCK]; D], [0.0; BLOCK]);
        for (block, heights) in heights.chunks_mut(BLOCK).enumerate() {
            let (start, size) = (block * BLOCK, heights.len());
            self.place(level, points, start..start + size, &mut along, &mut moved);
            self.sum.fill_at(level, moved.each_ref().map(|axis| &axis[..size]), &mut sums[..size]);
            self.material.height_alone(level, [&along[..size], &sums[..size]], heights);
            for height in heights {
                *height *= relief;
            }
        }
    }

    /// The height where the material's function is 1, in the unit of the points.
    fn relief(&self) -> f64 {
        f64::from((self.finish().relief / self.factor()) as f32)
    }
}

/// A material's height, or one of its derivatives, as an evaluation over slices.
pub(crate) struct Height<'a, K> {
    pub kind: &'a K,
    pub part: Part,
}

/// Which number of a height is wanted.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Part {
    /// The height itself.
    Value,
    /// Its derivative by the first argument, or by the second.
    Derivative(usize),
}

impl<K: material::Kind> Kernel<2> for Height<'_, K> {
    #[inline(always)]
    fn run<R: Real>(&self, inputs: [R; 2]) -> R {
        match self.part {
            Part::Value => self.kind.height(inputs[0], inputs[1]),
            Part::Derivative(which) => {
                let [along, sum] = Dual::point(inputs);
                self.kind.height(along, sum).gradient[which]
            }
        }
    }
}
