//! `organic`: rounded olive blotches, parted by a bright web of veins, like mould.

use jaspe_noise::Real;

use super::{Kind, parameters};
use crate::args::Args;
use crate::declare::Declaration;
use crate::finish::Finish;
use crate::space::{Frequencies, Space};

/// w = T(X).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Organic;

impl Kind for Organic {
    const DECLARATION: Declaration = Declaration {
        name: "organic",
        summary: "Olive blotches parted by a bright web, like mould.",
        parameters: &parameters(9, [0.3, 0.3, 0.0], [1.0, 1.0, 1.0]),
    };
    const FIGURE_SPACE: Space = Space::World;
    // The figures show spheres of the radius 1.5, with one cell per unit of the scene.
    const FREQUENCIES: Frequencies = Frequencies { local: 1.5, world: 1.0, uv: 5.0 };
    /// Swollen, velvety blotches; the web between them lies low and is slightly damp.
    const FINISH: Finish = Finish { relief: 0.2, roughness: [0.6, 0.95], emission: 0.0, tile: 4.0 };

    fn build(_: &Args) -> Self {
        Organic
    }

    #[inline(always)]
    fn shape<R: Real>(&self, _: R, sum: R) -> R {
        sum
    }
}
