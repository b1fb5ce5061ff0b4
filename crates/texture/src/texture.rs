//! A texture ready to evaluate, and the colours that its coefficient mixes.

use std::sync::Arc;

use jaspe_noise::simd::{self, Kernel, Level};
use jaspe_noise::{Noise, Real, Sum};

use crate::args::{Args, BuildError};
use crate::declare::{Declaration, Value};
use crate::material::Material;
use crate::space::{Frequencies, Space};

/// A procedural material with its arguments. Immutable; cheap to clone.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    arguments: Arc<[(&'static str, Value)]>,
    pub(crate) material: Material,
    pub(crate) sum: Sum,
    initial: [f32; 3],
    last: [f32; 3],
    scale: f64,
    written_space: Option<Space>,
    space: Space,
    as_figures: bool,
    /// In place of what the space and the scale say.
    pub(crate) cells_per_unit: Option<f64>,
    /// What the first coordinate is multiplied by where the material uses it itself.
    pub(crate) stretch: f64,
}

/// Points that are worked on at a time; their coordinates in texture space lie on the stack.
pub(crate) const BLOCK: usize = 256;

impl Texture {
    /// The declarations of all materials, in the order of the reference page.
    pub const ALL: &[&Declaration] = Material::DECLARATIONS;

    /// The material of this name with these arguments; the defaults stand for the parameters that are not among them.
    ///
    /// # Errors
    /// When no material or parameter has the name, or a value is of the wrong kind or out of range.
    pub fn build(name: &str, args: &[(&str, Value)]) -> Result<Texture, BuildError> {
        let index = Self::ALL.iter().position(|declaration| declaration.name == name);
        let index = index.ok_or_else(|| BuildError::UnknownTexture { name: name.to_owned() })?;
        let args = Args::check(Self::ALL[index], args)?;
        let noise = Noise::new(args.basis(), args.int("seed") as u64);
        Ok(Texture {
            arguments: args.all().collect(),
            material: Material::build(index, &args),
            sum: Sum::new(noise, args.combine(), args.int("depth") as u32),
            initial: args.color("diffuse_initial"),
            last: args.color("diffuse_final"),
            scale: args.float("scale"),
            written_space: args.space(),
            space: args.space().unwrap_or(Space::Local),
            as_figures: false,
            cells_per_unit: None,
            stretch: 1.0,
        })
    }

    /// What this material declares.
    pub fn declaration(&self) -> &'static Declaration {
        self.material.declaration()
    }

    /// Every parameter with its value, written or default, in the order of the declaration.
    pub fn arguments(&self) -> &[(&'static str, Value)] {
        &self.arguments
    }

    /// The space that points are given in: the parameter `space`, or else local.
    pub fn space(&self) -> Space {
        self.space
    }

    /// The space that the parameter `space` asked for, if it was given.
    pub fn written_space(&self) -> Option<Space> {
        self.written_space
    }

    /// The space in which the report's figures show this material.
    pub fn figure_space(&self) -> Space {
        self.material.figure_space()
    }

    /// The same texture as the report's figures have it: in [`Texture::figure_space`], unless `space` was given, and
    /// with the noise where they had it, at the cost of streaks on planes through the origin.
    pub fn in_figure_space(mut self) -> Self {
        self.as_figures = true;
        self.space = self.written_space.unwrap_or(self.figure_space());
        self
    }

    /// The same texture without the octaves that a picture of bytes hardly shows: those that all together move no colour by
    /// a step of a byte. (Where the material's shape jumps, as wood's does at the edge of each ring, that is none.)
    pub fn in_bytes(mut self) -> Self {
        let difference = (0..3).map(|i| f64::from(self.initial[i] - self.last[i]).abs()).fold(0.0, f64::max);
        let [low, high] = self.sum.range();
        let some = |octaves: u32| self.sum.clone().with_octaves(f64::from(octaves));
        let shown = (0..self.sum.octaves()).map(some).find(|sum| {
            let left_out = (high - sum.range()[1]).max(sum.range()[0] - low);
            left_out * self.material.steepness() * difference <= 1.0 / 255.0
        });
        self.sum = shown.unwrap_or(self.sum);
        self
    }

    /// The part of the light that the material mirrors: 0.1 for wood, 0.2 for water, 0 for the others.
    pub fn reflection(&self) -> f32 {
        self.material.reflection()
    }

    /// The noise cells per unit of each space, before the parameter `scale`.
    pub fn frequencies(&self) -> Frequencies {
        self.material.frequencies()
    }

    /// The noise sum that the material shapes.
    pub fn sum(&self) -> &Sum {
        &self.sum
    }

    /// The least and the largest coefficient that the material can have.
    pub fn coefficient_range(&self) -> [f32; 2] {
        self.material.coefficient_range(&self.sum)
    }

    /// The coefficient w at a point of the texture's space (two coordinates for uv, three for the others).
    #[inline(always)]
    pub fn value<R: Real, const D: usize>(&self, point: [R; D]) -> R {
        let (along, sum) = self.along_and_sum(point);
        self.material.shape(along, sum)
    }

    /// What a material shapes: X.x and T(X).
    #[inline(always)]
    pub(crate) fn along_and_sum<R: Real, const D: usize>(&self, point: [R; D]) -> (R, R) {
        let factor = R::constant(self.factor());
        let scaled = point.map(|coordinate| coordinate * factor);
        let moved = scaled.map(|coordinate| coordinate + R::constant(self.offset::<D>()));
        (scaled[0] * R::constant(self.stretch), self.sum.value(moved))
    }

    /// The coefficients at many points of the texture's space: one slice of coordinates per axis (two for uv, three for
    /// the others), one slice for the coefficients. The same bits as [`Texture::value`] in single precision. Allocates
    /// nothing.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn evaluate<const D: usize>(&self, points: [&[f32]; D], coefficients: &mut [f32]) {
        self.evaluate_at(simd::level(), points, coefficients);
    }

    /// [`Texture::evaluate`] with the instructions of a level, at most those of the machine. For tests and measurements.
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn evaluate_at<const D: usize>(&self, level: Level, points: [&[f32]; D], coefficients: &mut [f32]) {
        self.fill(level, points, None, coefficients);
    }

    /// [`Texture::evaluate`], where each coefficient is an average over a footprint: a square or cube of that side, in units of
    /// the space. What is too fine to be seen fades to its mean, so that a far stone is grey and does not sparkle; a side
    /// of zero gives the same bits as [`Texture::evaluate`].
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn evaluate_seen<const D: usize>(&self, points: [&[f32]; D], footprints: &[f32], coefficients: &mut [f32]) {
        self.fill(simd::level(), points, Some(footprints), coefficients);
    }

    fn fill<const D: usize>(
        &self,
        level: Level,
        points: [&[f32]; D],
        footprints: Option<&[f32]>,
        coefficients: &mut [f32],
    ) {
        for row in points.into_iter().chain(footprints) {
            assert_eq!(row.len(), coefficients.len(), "all slices have the same length");
        }
        let factor = self.factor() as f32;
        let mut along = [0.0; BLOCK];
        let mut moved = [[0.0; BLOCK]; D];
        let mut sums = [0.0; BLOCK];
        for (block, coefficients) in coefficients.chunks_mut(BLOCK).enumerate() {
            let (start, count) = (block * BLOCK, coefficients.len());
            self.place(level, points, start..start + count, &mut along, &mut moved);
            let moved = moved.each_ref().map(|axis| &axis[..count]);
            let Some(footprints) = footprints else {
                self.sum.fill_at(level, moved, &mut sums[..count]);
                self.material.shape_all(level, [&along[..count], &sums[..count]], coefficients);
                continue;
            };
            let mut sides = [0.0; BLOCK];
            for (side, footprint) in sides.iter_mut().zip(&footprints[start..start + count]) {
                *side = footprint * factor;
            }
            self.sum.fill_faded_at(level, moved, &sides[..count], &mut sums[..count]);
            self.material.shape_seen_all(level, [&along[..count], &sums[..count], &sides[..count]], coefficients);
        }
    }

    /// X.x, and X where the noise is evaluated, of the points in a range, which is no longer than a block.
    pub(crate) fn place<const D: usize>(
        &self,
        level: Level,
        points: [&[f32]; D],
        range: std::ops::Range<usize>,
        along: &mut [f32; BLOCK],
        moved: &mut [[f32; BLOCK]; D],
    ) {
        let (factor, count) = (self.factor(), range.len());
        for (moved, axis) in moved.iter_mut().zip(points) {
            let place = Place { factor, offset: self.offset::<D>() };
            simd::map_at(level, &place, [&axis[range.clone()]], &mut moved[..count]);
        }
        simd::map_at(level, &Along { factor, stretch: self.stretch }, [&points[0][range]], &mut along[..count]);
    }

    /// The colour that a coefficient mixes: display-encoded red, green, blue within 0 and 1. (Black for NaN.)
    #[inline(always)]
    pub fn color(&self, coefficient: f32) -> [f32; 3] {
        let mix = |i: usize| coefficient * self.initial[i] + (1.0 - coefficient) * self.last[i];
        // `max` makes 0 of NaN, which `clamp` would keep.
        #[expect(clippy::manual_clamp)]
        let limit = |value: f32| value.max(0.0).min(1.0);
        [limit(mix(0)), limit(mix(1)), limit(mix(2))]
    }

    /// The colours at many points of the texture's space. See [`Texture::evaluate`] and [`Texture::color`].
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn colors<const D: usize>(&self, points: [&[f32]; D], colors: &mut [[f32; 3]]) {
        self.paint(points, None, colors);
    }

    /// The colours at many points, each over a footprint. See [`Texture::evaluate_seen`] and [`Texture::color`].
    ///
    /// # Panics
    /// When the slices differ in length.
    pub fn colors_seen<const D: usize>(&self, points: [&[f32]; D], footprints: &[f32], colors: &mut [[f32; 3]]) {
        self.paint(points, Some(footprints), colors);
    }

    fn paint<const D: usize>(&self, points: [&[f32]; D], footprints: Option<&[f32]>, colors: &mut [[f32; 3]]) {
        for row in points.into_iter().chain(footprints) {
            assert_eq!(row.len(), colors.len(), "all slices have the same length");
        }
        let level = simd::level();
        let mut coefficients = [0.0; BLOCK];
        for (block, colors) in colors.chunks_mut(BLOCK).enumerate() {
            let (start, count) = (block * BLOCK, colors.len());
            let points = points.map(|coordinates| &coordinates[start..start + count]);
            let footprints = footprints.map(|sides| &sides[start..start + count]);
            self.fill(level, points, footprints, &mut coefficients[..count]);
            for (color, &coefficient) in colors.iter_mut().zip(&coefficients) {
                *color = self.color(coefficient);
            }
        }
    }

    /// What is added to each coordinate for the noise. Two dimensions are left alone: they have no planes.
    #[inline(always)]
    fn offset<const D: usize>(&self) -> f64 {
        if D == 2 || self.as_figures { 0.0 } else { self.material.offset() }
    }

    /// What a coordinate is multiplied by, a number of single precision.
    pub(crate) fn factor(&self) -> f64 {
        let of_space = || f64::from(self.frequencies().of(self.space)) / self.scale;
        f64::from(self.cells_per_unit.unwrap_or_else(of_space) as f32)
    }
}

/// A coordinate where the noise is evaluated.
struct Place {
    factor: f64,
    offset: f64,
}

impl Kernel<1> for Place {
    #[inline(always)]
    fn run<R: Real>(&self, [coordinate]: [R; 1]) -> R {
        coordinate * R::constant(self.factor) + R::constant(self.offset)
    }
}

/// The first coordinate where the material uses it itself.
struct Along {
    factor: f64,
    stretch: f64,
}

impl Kernel<1> for Along {
    #[inline(always)]
    fn run<R: Real>(&self, [coordinate]: [R; 1]) -> R {
        coordinate * R::constant(self.factor) * R::constant(self.stretch)
    }
}

/// A material's shape over footprints as an evaluation over slices.
pub(crate) struct Seen<'a, K>(pub(crate) &'a K);

impl<K: crate::material::Kind> Kernel<3> for Seen<'_, K> {
    #[inline(always)]
    fn run<R: Real>(&self, [along, sum, side]: [R; 3]) -> R {
        self.0.shape_seen(along, sum, side)
    }
}

/// A material's shape as an evaluation over slices.
pub(crate) struct Shape<'a, K>(pub(crate) &'a K);

impl<K: crate::material::Kind> Kernel<2> for Shape<'_, K> {
    #[inline(always)]
    fn run<R: Real>(&self, [along, sum]: [R; 2]) -> R {
        self.0.shape(along, sum)
    }
}
