//! The original's camera and where it places samples.

use glam::Vec3;

use crate::geometry::simd::{self, Lanes, Simd, Vec3s};
use crate::geometry::{Rows, group, put_group};
use crate::math;
use crate::sampler::{SampleKey, random_pair};
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
        samples.rays.resize(shots.count());
        samples.rays.t_max.fill(f32::INFINITY);
        samples.rays.origin.x.fill(self.eye.x);
        samples.rays.origin.y.fill(self.eye.y);
        samples.rays.origin.z.fill(self.eye.z);
        simd::run(Aim { camera: self, grid, shots, seed, samples });
    }

    /// Origin and unit direction of the ray through a position in pixels from the top left.
    pub fn ray(&self, x: f32, y: f32) -> (Vec3, Vec3) {
        let at = |v: f32| simd::Portable::splat(v);
        let [x, y, z] = self.directions(at(x), at(y)).store().map(|lanes| lanes[0]);
        (self.eye, Vec3::new(x, y, z))
    }

    /// Directions through positions on the image plane, of unit length.
    #[inline(always)]
    fn directions<L: Lanes>(&self, x: L, y: L) -> Vec3s<L> {
        let right = Vec3s::splat(self.right).scale(x.sub(L::splat(self.half[0])));
        let down = Vec3s::splat(self.down).scale(y.sub(L::splat(self.half[1])));
        let plane = Vec3s::splat(self.forward).add(right).add(down);
        // The position on the image plane is relative to the eye already, and the eye is taken off once more: it is
        // what the original did.
        plane.sub(Vec3s::splat(self.eye)).unit_or(Vec3s::splat(self.forward))
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
        let alone = grid.edge * grid.edge * grid.repeats == 1;
        let (rows, bits, each) = (&mut samples.rays.direction, &mut samples.bits, shots.indices.len());
        let count = rows.x.len();
        bits.resize(count, 0);
        let mut cells = Cells::new(grid, shots, 0);
        for (chunk, pixels) in shots.pixels.chunks(CHUNK).enumerate() {
            let (mut corner, mut hash) = ([[0.0; CHUNK]; 2], [0; CHUNK]);
            for (i, &[x, y]) in pixels.iter().enumerate() {
                (corner[0][i], corner[1][i]) = (x as f32, y as f32);
                hash[i] = SampleKey::new(x, y, 0, seed).pixel;
            }
            let start = chunk * CHUNK * each;
            if each == 1 {
                cells.write_one([&corner[0], &corner[1]], &hash, start, pixels.len(), rows, bits);
                continue;
            }
            for i in 0..pixels.len() {
                for first in (0..each).step_by(CHUNK) {
                    if each > CHUNK {
                        cells = Cells::new(grid, shots, first);
                    }
                    cells.write([corner[0][i], corner[1][i]], hash[i], start + i * each + first, rows, bits);
                }
            }
        }
        let half = S::Wide::splat(0.5);
        for start in (0..count).step_by(CHUNK) {
            let end = count.min(start + CHUNK);
            let mut jitter = [[0.5; CHUNK]; 2];
            if !alone {
                let mut own = [0; CHUNK];
                own[..end - start].copy_from_slice(&bits[start..end]);
                let [x, y] = &mut jitter;
                for i in 0..CHUNK {
                    [x[i], y[i]] = random_pair(own[i]);
                }
            }
            for i in (start..end).step_by(S::Wide::COUNT) {
                let (jx, jy) = (S::Wide::load(&jitter[0][i - start..]), S::Wide::load(&jitter[1][i - start..]));
                // Cells are not stratified: the jitter is as wide as the pixel.
                let x = group::<S::Wide>(&rows.x, i, 0.0).add(jx).sub(half);
                let y = group::<S::Wide>(&rows.y, i, 0.0).add(jy).sub(half);
                let Vec3s { x, y, z } = camera.directions(x, y);
                put_group(x, &mut rows.x[i..]);
                put_group(y, &mut rows.y[i..]);
                put_group(z, &mut rows.z[i..]);
            }
        }
    }
}

/// Where some of a pixel's samples lie, and what makes them differ: the same in all pixels.
struct Cells {
    size: usize,
    offset: [[f32; CHUNK]; 2],
    hash: [u32; CHUNK],
}

impl Cells {
    /// Those of `shots` from number `first` on.
    #[inline(always)]
    fn new(grid: Grid, shots: &Shots<'_>, first: usize) -> Cells {
        let step = 0.5 / grid.edge as f32;
        let size = CHUNK.min(shots.indices.len() - first);
        let mut cells = Cells { size, offset: [[0.0; CHUNK]; 2], hash: [0; CHUNK] };
        for i in 0..size {
            let index = shots.indices.start + (first + i) as u32;
            let [column, row] = grid.cell(index);
            cells.offset[0][i] = (column + 1) as f32 * step;
            cells.offset[1][i] = (row + 1) as f32 * step;
            cells.hash[i] = SampleKey::hash_index(index, 0);
        }
        cells
    }

    /// Writes the corners of a pixel's cells, from sample `start` on, and the bits that make their jitter. Some are
    /// written at a time, though pixels have fewer: the next pixel writes over what is too much.
    #[inline(always)]
    fn write(&self, [x, y]: [f32; 2], hash: u32, start: usize, rows: &mut Rows, bits: &mut [u32]) {
        for i in (0..self.size).step_by(STEP) {
            overwrite(&mut rows.x[start + i..], std::array::from_fn(|k| x + self.offset[0][i + k]));
            overwrite(&mut rows.y[start + i..], std::array::from_fn(|k| y + self.offset[1][i + k]));
            overwrite(&mut bits[start + i..], std::array::from_fn(|k| hash ^ self.hash[i + k]));
        }
    }

    /// The same for `count` pixels that have one sample each.
    #[inline(always)]
    fn write_one(
        &self,
        [x, y]: [&[f32; CHUNK]; 2],
        hash: &[u32; CHUNK],
        start: usize,
        count: usize,
        rows: &mut Rows,
        bits: &mut [u32],
    ) {
        let ([across, down], own) = (self.offset, self.hash[0]);
        rows.x[start..][..count].iter_mut().zip(x).for_each(|(to, x)| *to = x + across[0]);
        rows.y[start..][..count].iter_mut().zip(y).for_each(|(to, y)| *to = y + down[0]);
        bits[start..][..count].iter_mut().zip(hash).for_each(|(to, hash)| *to = hash ^ own);
    }
}

/// Samples of a pixel that are written together.
const STEP: usize = 4;

/// Writes values, as many as there is room for.
#[inline(always)]
fn overwrite<T>(row: &mut [T], values: [T; STEP]) {
    match row.first_chunk_mut() {
        Some(whole) => *whole = values,
        None => row.iter_mut().zip(values).for_each(|(to, from)| *to = from),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_aimed_together_as_alone() {
        let place = [Vec3::new(0.5, -1.0, 8.0), Vec3::new(0.1, 0.0, 0.0), Vec3::new(0.2, 1.0, 0.0)];
        let camera = ReportCamera::new(place, 60.0, 640, [640, 480]);
        let pixels: Vec<_> = (0..13).map(|i| [17 * i % 31, 5 * i % 23]).collect();
        let mut samples = Samples::default();
        for (edge, repeats, indices) in
            [(1, 1, 0..1), (2, 1, 0..4), (1, 3, 0..3), (2, 17, 0..68), (2, 17, 64..68), (4, 5, 0..80), (8, 3, 1..192)]
        {
            let (grid, of) = (Grid { edge, repeats }, edge * edge * repeats);
            let shots = Shots { pixels: &pixels, indices, of };
            camera.samples(grid, &shots, 9, &mut samples);
            for (i, ([x, y], index)) in shots.iter().enumerate() {
                let key = SampleKey::new(x, y, 0, 9);
                let jitter = random_pair(key.pixel ^ SampleKey::hash_index(index, 0));
                let cell = [index / repeats / edge, index / repeats % edge];
                let at = |axis: usize| {
                    let corner = [x, y][axis] as f32 + (cell[axis] + 1) as f32 * (0.5 / edge as f32);
                    corner + if of == 1 { 0.5 } else { jitter[axis] } - 0.5
                };
                let (origin, direction) = camera.ray(at(0), at(1));
                let ray = samples.rays.get(i);
                assert_eq!((ray.origin, ray.direction), (origin, direction), "sample {i} of {grid:?}");
            }
        }
    }
}
