//! `water`: the figure of [`super::fire`] in blue and teal, with a touch of reflection.

use jaspe_noise::Real;

use super::{Kind, parameters};
use crate::args::Args;
use crate::declare::Declaration;
use crate::finish::Finish;
use crate::space::{Frequencies, Space};

/// w = T(X).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Water;

impl Kind for Water {
    const DECLARATION: Declaration = Declaration {
        name: "water",
        summary: "Deep blue patches with teal veins; mirrors a fifth of the light.",
        parameters: &parameters(4, [0.0, 0.0, 0.5], [0.0, 0.5, 0.5]),
    };
    const FIGURE_SPACE: Space = Space::Uv;
    // As for fire.
    const FREQUENCIES: Frequencies = Frequencies { local: 3.0, world: 3.0, uv: 10.0 };
    const REFLECTION: f32 = 0.2;
    /// Wet all over, and a little less smooth where the crests break.
    const FINISH: Finish = Finish { relief: 0.12, roughness: [0.12, 0.03], emission: 0.0, tile: 4.0 };

    fn build(_: &Args) -> Self {
        Water
    }

    #[inline(always)]
    fn shape<R: Real>(&self, _: R, sum: R) -> R {
        sum
    }

    /// The veins, where the noise vanishes, are the crests of waves: sharp above and round below.
    #[inline(always)]
    fn height<R: Real>(&self, _: R, sum: R) -> R {
        -sum
    }
}
