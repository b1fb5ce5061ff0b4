//! The caustic photon map: a balanced tree of photons, and the light that they make of a point ([Jensen 2001],
//! "Realistic Image Synthesis Using Photon Mapping", ch. 6 and 7).

use glam::Vec3;
use rayon::prelude::*;

use super::photons::{self, Keep, Photon, Senders};

/// The photons as an implicit balanced tree: the middle of a range splits it, the halves on its sides are its children.
#[derive(Debug, Clone)]
pub(crate) struct CausticMap {
    photons: Vec<Photon>,
    /// Along which the middle of a range splits it, by the place of the middle.
    axes: Vec<u8>,
    gather: usize,
    radius: f32,
    crowds: Crowds,
}

/// How sharply near photons count more: Jensen's constant k.
const CONE: f32 = 1.1;
/// Fewer photons make no light.
const LEAST: usize = 8;
/// Photons that lie off the plane of the surface by more of the radius than this belong to another surface.
const FLAT: f32 = 0.1;
/// Most photons that one estimate takes.
const MOST: usize = 4096;

impl CausticMap {
    /// Sends photons, and keeps what comes by way of mirrors and glass; `None` if nothing does.
    pub fn send(senders: &Senders<'_>, emit: u32, gather: u32, radius: f32) -> Option<Self> {
        let mut photons = photons::send(senders, Keep::Caustics, 0, emit);
        let brightest = photons.iter().map(|photon| photon.power.max_element()).fold(0.0, f32::max);
        let gather = (gather as usize).clamp(1, MOST);
        let radius = radius.min(1.4 * (brightest * gather as f32).sqrt());
        let mut axes = vec![0; photons.len()];
        split(&mut photons, &mut axes);
        (!photons.is_empty() && radius > 0.0).then(|| {
            let crowds = Crowds::new(&photons, radius);
            CausticMap { photons, axes, gather, radius, crowds }
        })
    }

    /// Irradiance at a point of a surface. For one of the many `behind` another matte surface fewer photons will do.
    pub fn irradiance(&self, point: Vec3, normal: Vec3, behind: bool, nearest: &mut Nearest) -> Vec3 {
        if !self.crowds.is_near(point) {
            return Vec3::ZERO;
        }
        let gather = if behind { (self.gather / 8).max(2 * LEAST).min(self.gather) } else { self.gather };
        nearest.gather = gather;
        nearest.found.clear();
        nearest.reach = self.radius * self.radius;
        self.search(point, 0, self.photons.len(), nearest);
        let found = &nearest.found;
        if found.len() < LEAST {
            return Vec3::ZERO;
        }
        let radius2 = if found.len() < gather { self.radius * self.radius } else { found[0].0 };
        let radius = radius2.sqrt();
        // In the order of the tree, so that the sum does not depend on the order of the search.
        nearest.order.clear();
        nearest.order.extend(found.iter().map(|&(distance2, index)| (index, distance2)));
        nearest.order.sort_unstable_by_key(|&(index, _)| index);
        let mut total = Vec3::ZERO;
        for &(index, distance2) in &nearest.order {
            let photon = &self.photons[index as usize];
            let flat = (photon.point - point).dot(normal).abs() < FLAT * radius;
            if flat && photon.direction.dot(normal) < -0.001 {
                total += photon.power * (1.0 - distance2.sqrt() / (CONE * radius));
            }
        }
        total / ((1.0 - 2.0 / (3.0 * CONE)) * std::f32::consts::PI * radius2)
    }

    /// Looks for the nearest photons among those from `first` to `end`.
    fn search(&self, point: Vec3, first: usize, end: usize, nearest: &mut Nearest) {
        if first == end {
            return;
        }
        let middle = first + (end - first) / 2;
        let photon = &self.photons[middle];
        let axis = usize::from(self.axes[middle]);
        let side = point[axis] - photon.point[axis];
        let halves = [(first, middle), (middle + 1, end)];
        let (near, far) = if side < 0.0 { (halves[0], halves[1]) } else { (halves[1], halves[0]) };
        self.search(point, near.0, near.1, nearest);
        let distance2 = photon.point.distance_squared(point);
        if distance2 < nearest.reach {
            nearest.add(distance2, middle as u32);
        }
        if side * side < nearest.reach {
            self.search(point, far.0, far.1, nearest);
        }
    }
}

/// Where there may be enough photons to make light: most points of most scenes are done after one look.
#[derive(Debug, Clone)]
struct Crowds {
    /// The lowest corner, and cells per unit of length: their sides are the radius at least.
    corner: Vec3,
    per_unit: Vec3,
    size: [usize; 3],
    /// How many photons lie in each cell and those around it, up to [`LEAST`].
    near: Vec<u8>,
}

impl Crowds {
    /// Most cells along an axis.
    const MOST: f32 = 192.0;

    fn new(photons: &[Photon], radius: f32) -> Crowds {
        let bounds = photons
            .iter()
            .fold([photons[0].point; 2], |[min, max], Photon { point, .. }| [min.min(*point), max.max(*point)]);
        // One cell of nothing on each side.
        let (corner, extent) = (bounds[0] - radius, bounds[1] - bounds[0] + 2.0 * radius);
        let cells = (extent / radius).floor().min(Vec3::splat(Self::MOST)).max(Vec3::ONE);
        let cells = Vec3::select(cells.cmpge(Vec3::ONE), cells, Vec3::ONE);
        let size = cells.to_array().map(|count| count as usize);
        let mut crowds = Crowds { corner, per_unit: cells / extent, size, near: vec![0; size[0] * size[1] * size[2]] };
        for photon in photons {
            if let Some(cell) = crowds.cell(photon.point) {
                crowds.near[cell] = (crowds.near[cell] + 1).min(LEAST as u8);
            }
        }
        add_neighbours(&mut crowds.near, size);
        crowds
    }

    fn cell(&self, point: Vec3) -> Option<usize> {
        let at = (point - self.corner) * self.per_unit;
        let inside = at.cmpge(Vec3::ZERO).all();
        let [x, y, z] = at.to_array().map(|at| at as usize);
        let [columns, rows, layers] = self.size;
        (inside && x < columns && y < rows && z < layers).then(|| (z * rows + y) * columns + x)
    }

    /// Whether enough photons may lie within the radius.
    fn is_near(&self, point: Vec3) -> bool {
        self.cell(point).is_some_and(|cell| usize::from(self.near[cell]) >= LEAST)
    }
}

/// Adds to every cell's count those of the cells around it: along its row, across the rows of its layer, and from layer to layer.
fn add_neighbours(near: &mut [u8], [columns, rows, _]: [usize; 3]) {
    let layer = columns * rows;
    near.par_chunks_mut(layer).for_each(|near| {
        let mut before = near.to_vec();
        near.chunks_mut(columns).zip(before.chunks(columns)).for_each(|(near, before)| widen(near, before, 1));
        before.copy_from_slice(near);
        widen(near, &before, columns);
    });
    let before = near.to_vec();
    near.par_chunks_mut(layer).enumerate().for_each(|(z, near)| {
        let others = [z.checked_sub(1), Some(z + 1)].into_iter().flatten();
        others.filter_map(|z| before.chunks(layer).nth(z)).for_each(|other| add(near, other));
    });
}

/// Adds to every cell of a row or layer those a step before and after it, as they were.
fn widen(near: &mut [u8], before: &[u8], step: usize) {
    add(&mut near[step..], before);
    add(near, &before[step..]);
}

/// Adds counts, up to [`LEAST`].
fn add(near: &mut [u8], others: &[u8]) {
    near.iter_mut().zip(others).for_each(|(near, other)| *near = (*near + other).min(LEAST as u8));
}

/// Sorts photons into a balanced tree, split along the longest side of each range.
fn split(photons: &mut [Photon], axes: &mut [u8]) {
    if photons.is_empty() {
        return;
    }
    let (mut min, mut max) = (photons[0].point, photons[0].point);
    for photon in photons.iter() {
        (min, max) = (min.min(photon.point), max.max(photon.point));
    }
    let extent = max - min;
    let axis = if extent.x >= extent.y && extent.x >= extent.z { 0 } else { 1 + usize::from(extent.z > extent.y) };
    let middle = photons.len() / 2;
    photons.select_nth_unstable_by(middle, |a, b| a.point[axis].total_cmp(&b.point[axis]));
    axes[middle] = axis as u8;
    let ((left, right), (left_axes, right_axes)) = (photons.split_at_mut(middle), axes.split_at_mut(middle));
    rayon::join(|| split(left, left_axes), || split(&mut right[1..], &mut right_axes[1..]));
}

/// The nearest photons that a search has found, and room for them.
#[derive(Debug, Default)]
pub(crate) struct Nearest {
    /// A heap, the farthest first: squared distance and photon.
    found: Vec<(f32, u32)>,
    order: Vec<(u32, f32)>,
    /// How many are wanted.
    gather: usize,
    /// Squared distance beyond which nothing is looked for.
    reach: f32,
}

impl Nearest {
    fn add(&mut self, distance2: f32, index: u32) {
        let (found, most) = (&mut self.found, self.gather);
        if found.len() < most {
            found.push((distance2, index));
            let mut at = found.len() - 1;
            while at > 0 && found[(at - 1) / 2].0 < found[at].0 {
                found.swap(at, (at - 1) / 2);
                at = (at - 1) / 2;
            }
        } else {
            found[0] = (distance2, index);
            let mut at = 0;
            loop {
                let (left, right) = (2 * at + 1, 2 * at + 2);
                let mut farthest = at;
                for child in [left, right] {
                    if child < found.len() && found[child].0 > found[farthest].0 {
                        farthest = child;
                    }
                }
                if farthest == at {
                    break;
                }
                found.swap(at, farthest);
                at = farthest;
            }
        }
        if found.len() == most {
            self.reach = found[0].0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crowd_is_what_lies_in_a_cell_and_those_around_it() {
        for size in [[7, 5, 4], [1, 1, 1], [1, 6, 2], [9, 1, 3], [4, 4, 1]] {
            let [columns, rows, layers] = size;
            let counts: Vec<u8> = (0..columns * rows * layers).map(|i| (i * i % 11 / 7) as u8).collect();
            let mut near = counts.clone();
            add_neighbours(&mut near, size);
            let around = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
            for (i, &near) in near.iter().enumerate() {
                let [x, y, z] = [i % columns, i / columns % rows, i / columns / rows];
                let cells = around(z, layers).flat_map(|z| around(y, rows).map(move |y| (y, z)));
                let row = |(y, z): (usize, usize)| around(x, columns).map(move |x| (z * rows + y) * columns + x);
                let total: usize = cells.flat_map(row).map(|cell| usize::from(counts[cell])).sum();
                assert_eq!(usize::from(near), total.min(LEAST), "{size:?}, {x} {y} {z}");
            }
        }
    }
}
