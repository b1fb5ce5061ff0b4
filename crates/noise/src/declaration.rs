//! What each noise and each sum says of itself: the documentation, the tests and the command line walk these lists.

use crate::basis::Basis;
use crate::sum::Combine;

/// What the values of a noise are like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// No value is below.
    pub least: f64,
    /// No value is above.
    pub largest: f64,
    /// The mean over all points and seeds.
    pub mean: f64,
    /// The mean square of the difference from it.
    pub variance: f64,
}

/// A noise, or a way to sum its octaves, as it presents itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Declaration<T> {
    /// What is declared.
    pub of: T,
    /// The word for it in scenes and on the command line.
    pub name: &'static str,
    /// The word for it elsewhere in the field, which stands for it as well; often the same.
    pub term: &'static str,
    /// What it looks like.
    pub sentence: &'static str,
    /// What it is, at the point p.
    pub formula: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// In one to four dimensions. (Of sums: five octaves of improved noise.)
    pub statistics: [Statistics; 4],
}

const fn statistics(least: f64, largest: f64, mean: f64, variance: f64) -> Statistics {
    Statistics { least, largest, mean, variance }
}

/// Every noise.
pub(crate) const BASES: &[Declaration<Basis>] = &[
    Declaration {
        of: Basis::Improved,
        name: "improved",
        term: "perlin",
        sentence: "Gradient noise on cubes: smooth, without visible lattice, the default of the materials.",
        formula: "Σ over the 2ᴰ corners of w(x) w(y) w(z) · g·(p − corner), with w from 6t⁵ − 15t⁴ + 10t³ and twelve gradients g",
        source: "K. Perlin, “Improving Noise”, SIGGRAPH 2002, and the listing published with it; in four dimensions his `ImprovedNoise4D`",
        statistics: [
            statistics(-0.5, 0.5, 0.0, 0.037),
            statistics(-1.0, 1.0, 0.0, 0.0642),
            statistics(-1.04, 1.04, 0.0, 0.0732),
            statistics(-1.6, 1.6, 0.0, 0.0854),
        ],
    },
    Declaration {
        of: Basis::Classic,
        name: "classic",
        term: "classic",
        sentence: "Gradient noise on cubes with random unit gradients: the original, softer and with a trace of the lattice.",
        formula: "Σ over the 2ᴰ corners of w(x) w(y) w(z) · g·(p − corner), with w from 3t² − 2t³ and 256 random gradients g",
        source: "K. Perlin, “An Image Synthesizer”, SIGGRAPH 1985",
        statistics: [
            statistics(-0.5, 0.5, 0.0, 0.0203),
            statistics(-0.71, 0.71, 0.0, 0.03),
            statistics(-0.87, 0.87, 0.0, 0.0331),
            statistics(-1.04, 1.04, 0.0, 0.0246),
        ],
    },
    Declaration {
        of: Basis::Lattice,
        name: "lattice",
        term: "lattice",
        sentence: "Values of a table at the lattice points, interpolated: blotches.",
        formula: "Σ over the 2ᴰ corners of w(x) w(y) w(z) · v(corner), with w from 3t² − 2t³ and v from a permutation",
        source: "the random noise of the 2010 report",
        statistics: [
            statistics(-1.0, 1.0, 0.0, 0.2488),
            statistics(-1.0, 1.0, 0.0, 0.1845),
            statistics(-1.0, 1.0, 0.0, 0.1371),
            statistics(-1.0, 1.0, 0.0, 0.1018),
        ],
    },
    Declaration {
        of: Basis::Value,
        name: "value",
        term: "value",
        sentence: "Random values at the lattice points, interpolated: blotches that never repeat.",
        formula: "Σ over the 2ᴰ corners of w(x) w(y) w(z) · v(corner), with w from 6t⁵ − 15t⁴ + 10t³ and v from a hash",
        source: "K. Perlin, “An Image Synthesizer”, SIGGRAPH 1985 (his first examples)",
        statistics: [
            statistics(-1.0, 1.0, 0.0, 0.2591),
            statistics(-1.0, 1.0, 0.0, 0.2045),
            statistics(-1.0, 1.0, 0.0, 0.1603),
            statistics(-1.0, 1.0, 0.0, 0.1257),
        ],
    },
    Declaration {
        of: Basis::Simplex,
        name: "simplex",
        term: "simplex",
        sentence: "Gradient noise on tetrahedra: rounder than that on cubes, and cheap in many dimensions.",
        formula: "Σ over the D + 1 corners of max(0, ½ − r²)⁴ · g·(p − corner), scaled",
        source: "K. Perlin, “Noise Hardware”, SIGGRAPH 2001; S. Gustavson, “Simplex Noise Demystified”, 2005",
        statistics: [
            statistics(-1.0, 1.0, 0.0, 0.1956),
            statistics(-1.0, 1.0, 0.0, 0.1541),
            statistics(-1.0, 1.0, 0.0, 0.1539),
            statistics(-1.0, 1.0, 0.0, 0.0588),
        ],
    },
    Declaration {
        of: Basis::Cellular,
        name: "cellular",
        term: "cellular",
        sentence: "Distances to random feature points, one in each cell: cells, scales, stones. F1, Euclidean, unless parameters say otherwise.",
        formula: "F1 = the distance to the nearest feature point, F2 = that to the second nearest, F2 − F1, or a random number of the nearest one",
        source: "S. Worley, “A Cellular Texture Basis Function”, SIGGRAPH 1996",
        statistics: [
            statistics(0.0, 1.0, 0.291, 0.0398),
            statistics(0.0, 1.42, 0.43, 0.036),
            statistics(0.0, 1.74, 0.52, 0.0297),
            statistics(0.0, 2.0, 0.59, 0.0245),
        ],
    },
    Declaration {
        of: Basis::White,
        name: "white",
        term: "white",
        sentence: "A random number in each cell.",
        formula: "v(floor(p)), with v from a hash",
        source: "a random number per cell: as old as random numbers",
        statistics: [
            statistics(-1.0, 1.0, 0.0, 0.3303),
            statistics(-1.0, 1.0, 0.0, 0.3333),
            statistics(-1.0, 1.0, 0.0, 0.3333),
            statistics(-1.0, 1.0, 0.0, 0.3334),
        ],
    },
];

/// Every sum.
pub(crate) const SUMS: &[Declaration<Combine>] = &[
    Declaration {
        of: Combine::Plain,
        name: "plain",
        term: "fbm",
        sentence: "The noise itself: fractional Brownian motion.",
        formula: "Σ gᵏ n(lᵏ p)",
        source: "K. Perlin, “An Image Synthesizer”, SIGGRAPH 1985",
        statistics: [
            statistics(-0.969, 0.969, 0.0, 0.0495),
            statistics(-1.938, 1.938, 0.0, 0.0855),
            statistics(-2.015, 2.015, 0.0, 0.0975),
            statistics(-3.1, 3.1, 0.0, 0.1137),
        ],
    },
    Declaration {
        of: Combine::Absolute,
        name: "absolute",
        term: "turbulence",
        sentence: "Its absolute value: turbulence, with creases where the noise passes zero.",
        formula: "Σ gᵏ |n(lᵏ p)|",
        source: "K. Perlin, “An Image Synthesizer”, SIGGRAPH 1985",
        statistics: [
            statistics(0.0, 0.969, 0.273, 0.0243),
            statistics(0.0, 1.938, 0.398, 0.03),
            statistics(0.0, 2.015, 0.428, 0.0328),
            statistics(0.0, 3.1, 0.459, 0.039),
        ],
    },
    Declaration {
        of: Combine::Ridged,
        name: "ridged",
        term: "ridged",
        sentence: "Sharp ridges where the noise passes zero, smooth slopes and rough ridges.",
        formula: "Σ gᵏ sₖ, with sₖ = wₖ (1 − |n(lᵏ p)|)², wₖ₊₁ = min(1, 2 sₖ)",
        source: "F. K. Musgrave in D. S. Ebert et al., “Texturing and Modeling: A Procedural Approach”",
        statistics: [
            statistics(0.25, 1.938, 1.435, 0.0846),
            statistics(0.0, 1.938, 1.207, 0.1057),
            statistics(0.0, 1.938, 1.153, 0.1145),
            statistics(0.0, 1.938, 1.096, 0.1336),
        ],
    },
    Declaration {
        of: Combine::Hybrid,
        name: "hybrid",
        term: "hybrid",
        sentence: "Smooth valleys and rough heights.",
        formula: "Σ wₖ sₖ, with sₖ = gᵏ (n(lᵏ p) + 0.7), wₖ₊₁ = min(1, wₖ sₖ)",
        source: "F. K. Musgrave in D. S. Ebert et al., “Texturing and Modeling: A Procedural Approach”",
        statistics: [
            statistics(0.2, 2.325, 0.989, 0.0783),
            statistics(-3.294, 3.294, 0.986, 0.1332),
            statistics(-3.371, 3.371, 0.984, 0.151),
            statistics(-4.457, 4.457, 0.982, 0.1741),
        ],
    },
];

impl Basis {
    /// What this noise says of itself.
    pub fn declaration(self) -> &'static Declaration<Basis> {
        BASES.iter().find(|declaration| declaration.of == self).expect("every noise is declared")
    }
}

impl Combine {
    /// What this sum says of itself.
    pub fn declaration(self) -> &'static Declaration<Combine> {
        SUMS.iter().find(|declaration| declaration.of == self).expect("every sum is declared")
    }
}

impl<T: Copy> Declaration<T> {
    /// What is declared under this name or term.
    pub(crate) fn find(list: &[Declaration<T>], name: &str) -> Option<T> {
        list.iter().find(|declaration| declaration.name == name || declaration.term == name).map(|found| found.of)
    }
}
