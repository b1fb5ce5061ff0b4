//! `marble`: broad bands across the x axis, their borders feathered by noise.

use jaspe_noise::{Combine, Real, math};

use super::{Kind, parameters};
use crate::args::Args;
use crate::declare::Declaration;
use crate::finish::Finish;
use crate::space::{Frequencies, Space};

/// w = cos(X.x + T(X)), as the report's figures; with `sum plain` w = sin(X.x + T(X)), as its formula. Negative
/// coefficients extrapolate beyond the final colour, which makes the white bands.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Marble {
    combine: Combine,
}

impl Kind for Marble {
    const DECLARATION: Declaration = Declaration {
        name: "marble",
        summary: "Feathered bands of brown, pink and white.",
        parameters: &parameters(5, [0.466667, 0.34, 0.066666], [0.91372549, 0.705882353, 0.633333333]),
    };
    const FIGURE_SPACE: Space = Space::Local;
    // 10 · π is 31.
    const FREQUENCIES: Frequencies = Frequencies { local: 10.0, world: 10.0, uv: 30.0 };
    /// Polished: hardly any relief, and the white calcite a shade softer than the dark bands.
    const FINISH: Finish = Finish { relief: 0.03, roughness: [0.15, 0.08], emission: 0.0, tile: 2.0 };
    const BAND: Option<f64> = Some(std::f64::consts::TAU);

    fn build(args: &Args) -> Self {
        Marble { combine: args.combine() }
    }

    #[inline(always)]
    fn shape<R: Real>(&self, along: R, sum: R) -> R {
        match self.combine {
            Combine::Plain => math::sin(along + sum),
            _ => math::cos(along + sum),
        }
    }

    /// Over a footprint the argument spreads by the slope of the bands, 1, and by that of the noise, which is about as much:
    /// by a variance of 2 side² / 12, which takes exp(−variance / 2) of a wave.
    #[inline(always)]
    fn shape_seen<R: Real>(&self, along: R, sum: R, side: R) -> R {
        self.shape(along, sum) * math::exp(side * side * R::constant(-1.0 / 12.0))
    }

    fn coefficient_range(&self, _: [f32; 2]) -> [f32; 2] {
        [-1.000_001, 1.000_001]
    }
}
