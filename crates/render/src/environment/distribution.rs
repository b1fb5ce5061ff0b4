//! Random points of the unit square, the denser the brighter a place of it is.

/// A density that is constant within each cell of a grid of rows and columns.
#[derive(Debug, Clone)]
pub(crate) struct Distribution2d {
    columns: usize,
    /// For each row, the share of it that lies up to the end of each cell.
    within_rows: Vec<f32>,
    /// The share of everything that lies up to the end of each row.
    rows: Vec<f32>,
}

/// The largest number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

impl Distribution2d {
    /// From the cells' weights, row by row. Weights that are negative or not finite count as 0; where all are 0, all cells
    /// are alike.
    ///
    /// # Panics
    /// When `weights` is not a whole number of rows, or empty.
    pub fn new(columns: usize, weights: &[f32]) -> Self {
        assert!(columns > 0 && !weights.is_empty() && weights.len().is_multiple_of(columns), "whole rows of cells");
        let mut within_rows = Vec::with_capacity(weights.len());
        let totals: Vec<f64> = weights
            .chunks(columns)
            .map(|row| accumulate(row.iter().map(|&weight| f64::from(weight)), &mut within_rows))
            .collect();
        let mut rows = Vec::with_capacity(totals.len());
        accumulate(totals.into_iter(), &mut rows);
        Distribution2d { columns, within_rows, rows }
    }

    /// The point (u along a row, v across the rows) for two uniform numbers from 0 to 1, and the density there; its mean
    /// over the unit square is 1.
    #[inline]
    pub fn sample(&self, xi: [f32; 2]) -> ([f32; 2], f32) {
        let (row, v, row_density) = invert(&self.rows, xi[1]);
        let (_, u, density) = invert(&self.within_rows[row * self.columns..][..self.columns], xi[0]);
        ([u, v], density * row_density)
    }
}

/// Appends the running sums of the weights, as shares of their total, which is returned.
fn accumulate(weights: impl ExactSizeIterator<Item = f64>, shares: &mut Vec<f32>) -> f64 {
    let mut total = 0.0;
    let sums: Vec<f64> = weights
        .map(|weight| {
            total += if weight > 0.0 && weight < f64::INFINITY { weight } else { 0.0 };
            total
        })
        .collect();
    let count = sums.len() as f64;
    // The last sum is the total itself, so that the last share is exactly 1, and so is that of any empty cells before it.
    let share = |(i, sum)| (if total > 0.0 { sum / total } else { (i + 1) as f64 / count }) as f32;
    shares.extend(sums.into_iter().enumerate().map(share));
    total
}

/// The cell that `xi` falls into, the position of `xi` on the whole axis of cells, and the density there.
#[inline]
fn invert(shares: &[f32], xi: f32) -> (usize, f32, f32) {
    let xi = xi.min(BELOW_ONE);
    // The first share beyond `xi`: an empty cell, which ends where it starts, is never hit.
    let cell = shares.partition_point(|&share| share <= xi).min(shares.len() - 1);
    let start = if cell == 0 { 0.0 } else { shares[cell - 1] };
    let probability = shares[cell] - start;
    let t = ((xi - start) / probability).clamp(0.0, BELOW_ONE);
    (cell, (cell as f32 + t) / shares.len() as f32, probability * shares.len() as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_hit_as_often_as_they_weigh_and_densities_say_so() {
        let weights = [0.0, 1.0, 3.0, 0.0, 4.0, 0.0, 0.0, 8.0, f32::NAN, -3.0, 0.0, 0.0];
        let distribution = Distribution2d::new(4, &weights);
        let mut counts = [0.0; 12];
        let n = 256;
        for i in 0..n * n {
            let ([u, v], density) = distribution.sample([i % n, i / n].map(|i| (i as f32 + 0.5) / n as f32));
            let cell = (v * 3.0) as usize * 4 + (u * 4.0) as usize;
            counts[cell] += 1.0;
            assert!((density - weights[cell] / 16.0 * 12.0).abs() < 1e-5, "cell {cell}: {density}");
        }
        for (count, weight) in counts.iter().zip(weights) {
            assert!((count / (n * n) as f32 - weight.max(0.0) / 16.0).abs() < 0.005, "{counts:?}");
        }
    }

    #[test]
    fn without_weights_all_cells_are_alike() {
        let distribution = Distribution2d::new(3, &[0.0; 6]);
        for xi in [[0.0, 0.0], [0.25, 0.75], [0.99, 0.01]] {
            let ([u, v], density) = distribution.sample(xi);
            assert!((u - xi[0]).abs() < 1e-6 && (v - xi[1]).abs() < 1e-6 && (density - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn numbers_at_the_ends_and_beyond_land_in_cells_that_weigh_something() {
        let distribution = Distribution2d::new(2, &[0.0, 5.0, 0.0, 0.0]);
        for xi in [0.0, 1.0, 2.0, f32::NAN, f32::INFINITY] {
            let ([u, v], density) = distribution.sample([xi, xi]);
            assert!((0.5..=1.0).contains(&u) && (0.0..=0.5).contains(&v) && density == 4.0, "{xi}: {u} {v} {density}");
        }
    }
}
