//! One axis of a grid as an octave sees it: the lattice points that it touches, and where each point lies between them.

use crate::basis::corners::Curve;
use crate::basis::{Basis, wrap};
use crate::noise::Noise;

/// Rows are padded to whole vectors of every width.
pub(super) const PADDING: usize = 16;

/// An axis of a grid, times the frequency of an octave.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    /// The lattice coordinates, wrapped at the period, from that below the first point to that above the last one.
    pub lattice: Vec<i32>,
    /// For each point the number of its lower lattice point among those.
    pub cell: Vec<usize>,
    /// The offset from the lower lattice point, and from the upper one.
    pub from_low: Vec<f32>,
    pub from_high: Vec<f32>,
    /// The curve from 0 to 1 between the two, and its slope.
    pub curve: Vec<f32>,
    pub slope: Vec<f32>,
}

impl Axis {
    /// That of these coordinates, if they pass no cell over and do not turn back.
    pub fn new(noise: &Noise, axis: usize, coordinates: &[f32], frequency: f64) -> Option<Axis> {
        let scaled: Vec<f32> = coordinates.iter().map(|coordinate| coordinate * frequency as f32).collect();
        let cells: Vec<f32> = scaled.iter().map(|coordinate| coordinate.floor()).collect();
        let (&first, &last) = (cells.first()?, cells.last()?);
        // (No number passes the first test; those past the second have no neighbours in single precision.)
        let in_reach = |cell: &f32| cell.abs() < 16_777_000.0;
        let step_is_small = |pair: &[f32]| pair[1] - pair[0] == 0.0 || pair[1] - pair[0] == 1.0;
        if !cells.iter().all(in_reach) || !cells.windows(2).all(step_is_small) {
            return None;
        }
        let period = noise.period()[axis] * frequency;
        let count = (last - first) as usize + 2;
        let wrapped = |number: usize| wrap(f64::from(first) + number as f64, period) as i64 as i32;
        let lattice = (0..count).map(wrapped).collect();
        let mut cell: Vec<usize> = cells.iter().map(|cell| (cell - first) as usize).collect();
        let from_low: Vec<f32> = scaled.iter().zip(&cells).map(|(coordinate, cell)| coordinate - cell).collect();
        let from_high = from_low.iter().map(|offset| offset - 1.0).collect();
        let (curve, slope) = from_low.iter().map(|&offset| curve(noise.basis(), offset)).unzip();
        let padded = cell.len().next_multiple_of(PADDING);
        let last_cell = *cell.last()?;
        cell.resize(padded, last_cell);
        let mut axis = Axis { lattice, cell, from_low, from_high, curve, slope };
        for numbers in [&mut axis.from_low, &mut axis.from_high, &mut axis.curve, &mut axis.slope] {
            numbers.resize(padded, 0.0);
        }
        Some(axis)
    }
}

/// The curve of a noise at an offset, and its slope.
fn curve(basis: Basis, offset: f32) -> (f32, f32) {
    let Curve { at: [at], slope: [slope] } = match basis {
        Basis::Improved | Basis::Value => Curve::quintic(&[offset]),
        _ => Curve::cubic(&[offset]),
    };
    (at, slope)
}
