//! Light on its way back: what every ray of the report's dialect brings.

use glam::Vec3;

use super::{AMBIENT, MAX_BOUNCES};
use crate::film::Pixel;
use crate::geometry::simd::{self, Lanes, Simd, Vec3s};
use crate::geometry::{Rows, Run, group, put_group};
use crate::wave::Nodes;

/// Where light is gathered, in rows. The original adds up what a ray brings in a way of its own, so every ray has a node;
/// the nodes of a wave follow each other as its rays do.
#[derive(Debug, Default)]
pub(crate) struct Gathered {
    /// Light from lights.
    direct: Rows,
    /// Light from child nodes, by their shares.
    indirect: Rows,
    /// What the sum is multiplied by; zero where the ray met nothing.
    gain: Vec<f32>,
    /// Of the nodes that are not those of camera samples: which one gets their light, and how much of it.
    parent: Vec<u32>,
    share: Vec<f32>,
}

impl Nodes for Gathered {
    fn begin(&mut self, samples: usize) {
        // Direct light may be what it was: nothing is made of it before it is written.
        self.indirect.clear();
        self.gain.clear();
        self.parent.clear();
        self.share.clear();
        self.grow(samples);
    }
}

impl Gathered {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.gain.len()
    }

    fn grow(&mut self, more: usize) {
        let count = self.len() + more;
        self.direct.resize(count);
        self.indirect.resize(count);
        self.gain.resize(count, 0.0);
    }

    /// Makes nodes that give so much of their light to these.
    pub fn spawn(&mut self, parents: impl ExactSizeIterator<Item = u32>, share: f32) {
        self.grow(parents.len());
        self.share.resize(self.share.len() + parents.len(), share);
        self.parent.extend(parents);
    }

    /// Notes what the rays of some runs have met: light from lights, and what is to be made of all light. `first` is the
    /// node of the first ray of the wave.
    pub fn note(&mut self, first: usize, runs: &[Run], direct: &Rows, gain: f32) {
        let Rows { x, y, z } = &mut self.direct;
        let mut at = 0;
        for run in runs {
            let range = first + run.range().start..first + run.range().end;
            let part = at..at + range.len();
            at = part.end;
            x[range.clone()].copy_from_slice(&direct.x[part.clone()]);
            y[range.clone()].copy_from_slice(&direct.y[part.clone()]);
            z[range.clone()].copy_from_slice(&direct.z[part]);
            self.gain[range].fill(gain);
        }
    }

    /// Hands all light on, and writes that of the camera samples.
    pub fn resolve(&mut self, pixels: &mut [Pixel]) {
        let samples = pixels.len();
        // Parents come before their children: so each wave ends where its children's parents do.
        let mut ends = [samples; MAX_BOUNCES as usize + 2];
        for wave in 1..ends.len() {
            ends[wave] = samples + self.parent.partition_point(|&parent| (parent as usize) < ends[wave - 1]);
        }
        for wave in (1..ends.len()).rev() {
            let range = ends[wave - 1]..ends[wave];
            simd::run(Finish { nodes: self, range: range.clone(), samples });
            let Rows { x, y, z } = &mut self.indirect;
            for i in range {
                let parent = self.parent[i - samples] as usize;
                x[parent] += self.direct.x[i];
                y[parent] += self.direct.y[i];
                z[parent] += self.direct.z[i];
            }
        }
        simd::run(Resolve { nodes: self, pixels });
    }
}

impl Gathered {
    /// The light of nodes from `start` on whose children are complete.
    #[inline(always)]
    fn finish<L: Lanes>(&self, start: usize) -> Vec3s<L> {
        let (zero, one) = (Vec3s::splat(Vec3::ZERO), Vec3s::splat(Vec3::ONE));
        let direct = self.direct.group::<L>(start).max(zero).min(one);
        let sum = Vec3s::splat(Vec3::splat(AMBIENT)).add(direct).add(self.indirect.group(start));
        sum.scale(group(&self.gain, start, 0.0)).max(zero).min(one)
    }
}

/// Makes of the direct light of some nodes what they give to their parents.
struct Finish<'a> {
    nodes: &'a mut Gathered,
    range: std::ops::Range<usize>,
    /// Nodes without a parent.
    samples: usize,
}

impl simd::Kernel for Finish<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Finish { nodes, range, samples } = self;
        for start in range.clone().step_by(S::Wide::COUNT) {
            let share: S::Wide = group(&nodes.share, start - samples, 0.0);
            let Vec3s { x, y, z } = nodes.finish(start).scale(share);
            put_group(x, &mut nodes.direct.x[start..range.end]);
            put_group(y, &mut nodes.direct.y[start..range.end]);
            put_group(z, &mut nodes.direct.z[start..range.end]);
        }
    }
}

/// Writes the light of the camera samples.
struct Resolve<'a> {
    nodes: &'a Gathered,
    pixels: &'a mut [Pixel],
}

impl simd::Kernel for Resolve<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Resolve { nodes, pixels } = self;
        let mut start = 0;
        for pixels in pixels.chunks_mut(S::Wide::COUNT) {
            let [x, y, z] = nodes.finish::<S::Wide>(start).store();
            for (((pixel, x), y), z) in pixels.iter_mut().zip(x.as_ref()).zip(y.as_ref()).zip(z.as_ref()) {
                *pixel = [*x, *y, *z, 1.0];
            }
            start += S::Wide::COUNT;
        }
    }
}
