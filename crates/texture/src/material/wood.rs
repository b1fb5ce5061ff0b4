//! `wood`: irregular rings in two browns, each with a sharp edge on one side and a smooth ramp on the other.

use jaspe_noise::Real;

use super::{Kind, parameters};
use crate::args::Args;
use crate::declare::Declaration;
use crate::finish::Finish;
use crate::space::{Frequencies, Space};

/// w = frac(15 T(X)), which jumps from 1 to 0 at the edge of each ring.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wood;

impl Kind for Wood {
    const DECLARATION: Declaration = Declaration {
        name: "wood",
        summary: "Closed rings in two browns; mirrors a tenth of the light.",
        parameters: &parameters(5, [0.392156863, 0.196078431, 0.0], [0.784313726, 0.392156863, 0.0]),
    };
    const FIGURE_SPACE: Space = Space::Local;
    // 0.3 · π is 0.94.
    const FREQUENCIES: Frequencies = Frequencies { local: 0.3, world: 0.3, uv: 1.0 };
    const REFLECTION: f32 = 0.1;
    /// The rings gather around the lattice point at the origin, where the noise of all octaves vanishes.
    const OFFSET: f64 = 0.0;
    const STEEPNESS: f64 = f64::INFINITY;
    /// Sawn and oiled: the light wood of spring is open, the dark of autumn is dense, takes a polish and stands out.
    const FINISH: Finish = Finish { relief: 0.003, roughness: [0.65, 0.35], emission: 0.0, tile: 7.0 };

    fn build(_: &Args) -> Self {
        Wood
    }

    #[inline(always)]
    fn shape<R: Real>(&self, _: R, sum: R) -> R {
        let rings = R::constant(15.0) * sum;
        rings - rings.floor()
    }

    /// Rings are averaged over the part of a ring that a footprint covers: T changes by about 0.8 per unit. The integral of the
    /// fractional part of r is (⌊r⌋ + frac(r)²) / 2.
    #[inline(always)]
    fn shape_seen<R: Real>(&self, along: R, sum: R, side: R) -> R {
        let half = side * R::constant(0.5 * 15.0 * 0.8);
        let rings = R::constant(15.0) * sum;
        // Twice the integral, from the ring in which the point lies.
        let base = rings.floor();
        let integral = |end: R| {
            let end = end - base;
            let whole = end.floor();
            let part = end - whole;
            whole + part * part
        };
        let average = (integral(rings + half) - integral(rings - half)) / (half * R::constant(4.0));
        R::select(half.less(R::constant(1e-3)), self.shape(along, sum), average)
    }

    /// p⁴ (1 − p)² of the part p of a ring, times what makes its maximum 1 (at p = 2/3): no jump at the ring's edge, and
    /// no crease.
    #[inline(always)]
    fn height<R: Real>(&self, along: R, sum: R) -> R {
        let part = self.shape(along, sum);
        let product = part * part * (R::constant(1.0) - part);
        R::constant(45.5625) * product * product
    }

    fn coefficient_range(&self, _: [f32; 2]) -> [f32; 2] {
        [0.0, 1.0]
    }
}
