//! `stone`: fine, even granite speckle, dark grains on light grey.

use jaspe_noise::Real;

use super::{Kind, parameters};
use crate::args::Args;
use crate::declare::Declaration;
use crate::finish::Finish;
use crate::space::{Frequencies, Space};

/// w = T(X).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stone;

impl Kind for Stone {
    const DECLARATION: Declaration = Declaration {
        name: "stone",
        summary: "Fine granite speckle, dark grains on light grey.",
        parameters: &parameters(4, [0.2, 0.2, 0.2], [1.0, 1.0, 1.0]),
    };
    const FIGURE_SPACE: Space = Space::Local;
    // 50 · π is 157.
    const FREQUENCIES: Frequencies = Frequencies { local: 50.0, world: 50.0, uv: 160.0 };
    /// Hewn: light feldspar stands above the dark grains, whose faces catch a little more light.
    const FINISH: Finish = Finish { relief: 0.15, roughness: [0.9, 0.6], emission: 0.0, tile: 0.5 };

    fn build(_: &Args) -> Self {
        Stone
    }

    #[inline(always)]
    fn shape<R: Real>(&self, _: R, sum: R) -> R {
        sum
    }

    /// Light grains stand above dark ones.
    #[inline(always)]
    fn height<R: Real>(&self, _: R, sum: R) -> R {
        -sum
    }
}
