//! What moves while the shutter is open (format reference, §1.8 and §3.2).

use glam::DMat4;
use jaspe_scene::description::{Camera, TransformKind};

use crate::affine;

/// The time of the exposure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shutter {
    open: f64,
    close: f64,
}

impl Shutter {
    /// That of a camera; without one, the moment 0.
    pub fn of(camera: Option<&Camera>) -> Self {
        let [open, close] =
            camera.and_then(|camera| camera.shutter).map_or([0.0; 2], |shutter| shutter.value.map(f64::from));
        Shutter { open, close: close.max(open) }
    }

    /// Whether it is open for more than a moment.
    pub fn has_duration(&self) -> bool {
        self.close > self.open
    }

    /// The middle of the exposure.
    pub fn middle(&self) -> f64 {
        0.5 * (self.open + self.close)
    }

    /// A moment for a number from 0 to 1: the shutter lets the more light in the nearer the middle is, as a tent.
    pub fn moment(&self, u: f64) -> f64 {
        let y = if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() };
        let s = 0.5 * (y + 1.0);
        (1.0 - s) * self.open + s * self.close
    }
}

/// A transform over time: one or more matrices, evenly spaced between two times and blended element by element.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    times: [f64; 2],
    steps: Vec<DMat4>,
}

impl Motion {
    pub fn new(kind: &TransformKind) -> Self {
        match kind {
            TransformKind::Steps { times, steps } if times[0] < times[1] => {
                Motion { times: times.map(f64::from), steps: steps.iter().map(affine::matrix).collect() }
            }
            still => Motion::still(affine::matrix(still)),
        }
    }

    /// No motion.
    pub fn still(matrix: DMat4) -> Self {
        Motion { times: [0.0; 2], steps: vec![matrix] }
    }

    /// The same motion of what `base` has placed.
    pub fn of(mut self, base: DMat4) -> Self {
        self.steps.iter_mut().for_each(|step| *step *= base);
        self
    }

    /// Matrices between which all those of an exposure lie, element by element.
    pub fn during(&self, shutter: Shutter) -> Vec<DMat4> {
        let mut matrices = vec![self.at(shutter.open), self.at(shutter.close)];
        matrices.extend_from_slice(&self.steps);
        matrices
    }

    /// Whether it is the same at all times.
    pub fn is_still(&self) -> bool {
        self.steps.windows(2).all(|pair| pair[0] == pair[1])
    }

    /// The matrix at a time; before the first and after the last time, nothing moves.
    pub fn at(&self, time: f64) -> DMat4 {
        let last = self.steps.len().saturating_sub(1);
        let Some(end) = self.steps.get(last) else { return DMat4::IDENTITY };
        let [start, stop] = self.times;
        let position = (time - start) / (stop - start) * last as f64;
        // Also where the times are one, and the position no number.
        if position.is_nan() || position <= 0.0 {
            return self.steps[0];
        }
        let step = position as usize;
        match self.steps.get(step + 1) {
            Some(next) => self.steps[step] + (*next - self.steps[step]) * (position - step as f64),
            None => *end,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use jaspe_scene::description::Op;

    fn along(times: [f32; 2], places: &[f64]) -> Motion {
        let steps = places.iter().map(|x| TransformKind::Ops(vec![Op::Translate([*x, 0.0, 0.0])])).collect();
        Motion::new(&TransformKind::Steps { times, steps })
    }

    #[test]
    fn matrices_are_blended_between_their_times() {
        let motion = along([1.0, 3.0], &[0.0, 10.0, 30.0]);
        let x = |time: f64| motion.at(time).transform_point3(DVec3::ZERO).x;
        for (time, expected) in
            [(-5.0, 0.0), (1.0, 0.0), (1.5, 5.0), (2.0, 10.0), (2.5, 20.0), (3.0, 30.0), (9.0, 30.0)]
        {
            assert_eq!(x(time), expected, "at {time}");
        }
        assert!(!motion.is_still() && along([0.0, 1.0], &[2.0, 2.0]).is_still());
        assert_eq!(along([1.0, 1.0], &[5.0, 6.0]).at(7.0).transform_point3(DVec3::ZERO).x, 5.0);
    }

    #[test]
    fn the_middle_of_the_exposure_counts_most() {
        let shutter = Shutter { open: 2.0, close: 4.0 };
        assert_eq!([0.0, 0.5, 1.0].map(|u| shutter.moment(u)), [2.0, 3.0, 4.0]);
        // A tent holds half of its light in the middle (2 − √2) / 2 of each side.
        let share =
            (0..1000).filter(|i| (shutter.moment(f64::from(*i) / 1000.0) - 3.0).abs() < 1.0 - 0.5f64.sqrt()).count();
        assert!((490..510).contains(&share), "{share}");
    }
}
