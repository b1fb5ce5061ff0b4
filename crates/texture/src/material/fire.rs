//! `fire`: cloud-like yellow patches cut by sharp, branching red veins.

use jaspe_noise::Real;

use super::{Kind, parameters};
use crate::args::Args;
use crate::declare::Declaration;
use crate::finish::Finish;
use crate::space::{Frequencies, Space};

/// w = T(X). The veins are the zeros of the noise.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fire;

impl Kind for Fire {
    const DECLARATION: Declaration = Declaration {
        name: "fire",
        summary: "Yellow patches cut by branching red veins.",
        parameters: &parameters(5, [1.0, 1.0, 0.0], [1.0, 0.15, 0.0]),
    };
    const FIGURE_SPACE: Space = Space::Uv;
    // The figure has 10 cells per unit of v, which are 10/π per unit of length on the unit sphere, and 2.5 along x.
    const FREQUENCIES: Frequencies = Frequencies { local: 3.0, world: 3.0, uv: 10.0 };
    /// Embers: the yellow patches swell between cracks, and all of it glows. Soot mirrors nothing.
    const FINISH: Finish = Finish { relief: 0.15, roughness: [0.95, 0.8], emission: 1.0, tile: 4.0 };

    fn build(_: &Args) -> Self {
        Fire
    }

    #[inline(always)]
    fn shape<R: Real>(&self, _: R, sum: R) -> R {
        sum
    }
}
