//! The original's camera and where it places samples.

use glam::Vec3;

use crate::geometry::simd::{self, Simd};
use crate::math;
use crate::sampler::SampleKey;
use crate::wave::{Samples, Shots};

/// The camera. Its focal length is in pixels of the scene's own width, so that another output size crops.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReportCamera {
    eye: Vec3,
    forward: Vec3,
    right: Vec3,
    down: Vec3,
    /// Pixels left of and above the centre.
    half: [f32; 2],
}

impl ReportCamera {
    /// `fov` is horizontal, in degrees; `scene_width` as the scene says, `size` as the output is.
    pub fn new([eye, target, up]: [Vec3; 3], fov: f32, scene_width: u32, size: [u32; 2]) -> Self {
        let focal = (f64::from(scene_width / 2) / math::tan_degrees(f64::from(fov) * 0.5)) as f32;
        let forward = (target - eye).normalize_or(Vec3::NEG_Z);
        let down = -up.normalize_or(Vec3::Y);
        let right = down.cross(target - eye).normalize_or(Vec3::X);
        ReportCamera { eye, forward: forward * focal, right, down, half: size.map(|s| (s / 2) as f32) }
    }

    /// Aims the samples of a wave. (They need no keys: nothing that follows is random.)
    pub fn samples(&self, grid: Grid, shots: &Shots<'_>, seed: u64, samples: &mut Samples) {
        samples.resize(shots.count());
        samples.rays.t_max.fill(f32::INFINITY);
        samples.rays.origin.x.fill(self.eye.x);
        samples.rays.origin.y.fill(self.eye.y);
        samples.rays.origin.z.fill(self.eye.z);
        simd::run(Aim { camera: self, grid, shots, seed, samples });
    }

    /// Origin and unit direction of the ray through a position in pixels from the top left.
    #[inline(always)]
    pub fn ray(&self, x: f32, y: f32) -> (Vec3, Vec3) {
        let plane = self.forward + self.right * (x - self.half[0]) + self.down * (y - self.half[1]);
        // The position on the image plane is relative to the eye already, and the eye is taken off once more: it is
        // what the original did.
        (self.eye, (plane - self.eye).normalize_or(self.forward))
    }
}

/// How the samples of a pixel lie: `edge` × `edge` cells, a power of two, with `repeats` samples each.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
    pub edge: u32,
    pub repeats: u32,
}

impl Grid {
    /// Column and row of a sample's cell.
    fn cell(self, index: u32) -> [u32; 2] {
        let cell = index / self.repeats;
        [cell / self.edge, cell % self.edge]
    }
}

/// Samples that are aimed together.
const CHUNK: usize = 64;

/// [`ReportCamera::samples`] as a kernel.
struct Aim<'a> {
    camera: &'a ReportCamera,
    grid: Grid,
    shots: &'a Shots<'a>,
    seed: u64,
    samples: &'a mut Samples,
}

impl simd::Kernel for Aim<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Aim { camera, grid, shots, seed, samples } = self;
        let step = 0.5 / grid.edge as f32;
        let alone = grid.edge * grid.edge * grid.repeats == 1;
        // The cell of a sample is the same in all pixels: divided once, unless there are very many.
        let cells: [[u32; 2]; CHUNK] = std::array::from_fn(|index| grid.cell(index as u32));
        let count = samples.rays.len();
        let mut each = shots.iter();
        for start in (0..count).step_by(CHUNK) {
            let size = CHUNK.min(count - start);
            let (mut pixels, mut indices) = ([[0; CHUNK]; 2], [0; CHUNK]);
            let mut corners = [[0.0; CHUNK]; 2];
            for (i, (pixel, index)) in each.by_ref().take(size).enumerate() {
                let cell = cells.get(index as usize).copied().unwrap_or_else(|| grid.cell(index));
                indices[i] = index;
                for axis in 0..2 {
                    pixels[axis][i] = pixel[axis];
                    corners[axis][i] = pixel[axis] as f32 + (cell[axis] + 1) as f32 * step;
                }
            }
            let mut directions = [[0.0; CHUNK]; 3];
            for i in 0..CHUNK {
                let jitter = SampleKey::new(pixels[0][i], pixels[1][i], indices[i], seed).random_pair(0);
                // Cells are not stratified: the jitter is as wide as the pixel.
                let at = |axis: usize| corners[axis][i] + if alone { 0.5 } else { jitter[axis] } - 0.5;
                let (_, direction) = camera.ray(at(0), at(1));
                (directions[0][i], directions[1][i], directions[2][i]) = (direction.x, direction.y, direction.z);
            }
            let [x, y, z] = samples.rays.direction.slices_mut(count);
            for (row, directions) in [x, y, z].into_iter().zip(&directions) {
                row[start..start + size].copy_from_slice(&directions[..size]);
            }
        }
    }
}
