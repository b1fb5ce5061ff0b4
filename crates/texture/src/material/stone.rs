//! `stone`: fine, even granite speckle, dark grains on light grey.

use jaspe_noise::Real;

use super::{Kind, parameters};
use crate::args::Args;
use crate::declare::Declaration;
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

    fn build(_: &Args) -> Self {
        Stone
    }

    #[inline(always)]
    fn shape<R: Real>(&self, _: R, sum: R) -> R {
        sum
    }
}
