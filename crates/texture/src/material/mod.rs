//! The materials: what each must say of itself, and the list of all.

mod fire;
mod marble;
mod organic;
mod stone;
mod water;
mod wood;

use jaspe_noise::simd::{self, Level};
use jaspe_noise::{Real, Sum};

use crate::args::Args;
use crate::declare::{self, Declaration, Parameter, Value};
use crate::finish::{Finish, Height, Part};
use crate::space::{Frequencies, Space};
use crate::texture::{Seen, Shape};

/// A material: its declaration, its constants, and the one function that is its own.
pub(crate) trait Kind: Sized {
    /// Name, parameters, a sentence each.
    const DECLARATION: Declaration;
    /// The space in which the report's figures show it.
    const FIGURE_SPACE: Space;
    /// Noise cells per unit of each space.
    const FREQUENCIES: Frequencies;
    /// The part of the light that it mirrors.
    const REFLECTION: f32 = 0.0;

    /// How far the noise of three dimensions is moved along each axis. Gradient noise is poorer on the planes of its
    /// lattice, above all where the lattices of all octaves meet: a floor at y = 0 would show straight streaks. With a
    /// third of a cell, every octave has those planes a third of its own cell away, since 2^k / 3 is never near a whole
    /// number.
    const OFFSET: f64 = 1.0 / 3.0;

    /// Height, roughness and light of its own.
    const FINISH: Finish;

    /// The period of [`Kind::shape`] in its first argument, where it uses it.
    const BAND: Option<f64> = None;

    /// By how much [`Kind::shape`] changes at most where its second argument changes by 1; infinite where it jumps.
    const STEEPNESS: f64 = 1.0;

    /// From arguments that are already checked against the declaration.
    fn build(args: &Args) -> Self;

    /// The coefficient w from X.x (`along`) and the noise sum T(X), with X the point in texture space.
    fn shape<R: Real>(&self, along: R, sum: R) -> R;

    /// The coefficient's average over a footprint of this side (in units of X): the sum is averaged already. A side of zero
    /// gives the same bits as [`Kind::shape`]. Enough where the shape is linear, as it is where nothing else is said.
    #[inline(always)]
    fn shape_seen<R: Real>(&self, along: R, sum: R, _side: R) -> R {
        self.shape(along, sum)
    }

    /// The height of the surface, without a jump, in parts of [`Finish::relief`]: the coefficient, if nothing else is said.
    #[inline(always)]
    fn height<R: Real>(&self, along: R, sum: R) -> R {
        self.shape(along, sum)
    }

    /// The range of the coefficient, from the bounds of the sum.
    fn coefficient_range(&self, sum: [f32; 2]) -> [f32; 2] {
        sum
    }
}

/// Makes the enum of all materials, and its dispatch, from the list.
macro_rules! materials {
    ($($module:ident::$kind:ident)*) => {
        #[derive(Debug, Clone, PartialEq)]
        pub(crate) enum Material {
            $($kind($module::$kind),)*
        }

        impl Material {
            pub(crate) const DECLARATIONS: &'static [&'static Declaration] = &[$(&$module::$kind::DECLARATION,)*];

            /// The material at this place of the list; the last one past its end.
            pub(crate) fn build(index: usize, args: &Args) -> Self {
                let builders: &[fn(&Args) -> Material] = &[$(|args| Material::$kind($module::$kind::build(args)),)*];
                builders[index.min(builders.len() - 1)](args)
            }

            pub(crate) fn declaration(&self) -> &'static Declaration {
                match self { $(Material::$kind(_) => &$module::$kind::DECLARATION,)* }
            }

            pub(crate) fn figure_space(&self) -> Space {
                match self { $(Material::$kind(_) => $module::$kind::FIGURE_SPACE,)* }
            }

            pub(crate) fn frequencies(&self) -> Frequencies {
                match self { $(Material::$kind(_) => $module::$kind::FREQUENCIES,)* }
            }

            pub(crate) fn reflection(&self) -> f32 {
                match self { $(Material::$kind(_) => $module::$kind::REFLECTION,)* }
            }

            pub(crate) fn finish(&self) -> &'static Finish {
                match self { $(Material::$kind(_) => &$module::$kind::FINISH,)* }
            }

            pub(crate) fn band(&self) -> Option<f64> {
                match self { $(Material::$kind(_) => $module::$kind::BAND,)* }
            }

            pub(crate) fn steepness(&self) -> f64 {
                match self { $(Material::$kind(_) => $module::$kind::STEEPNESS,)* }
            }

            #[inline(always)]
            pub(crate) fn offset(&self) -> f64 {
                match self { $(Material::$kind(_) => $module::$kind::OFFSET,)* }
            }

            pub(crate) fn coefficient_range(&self, sum: &Sum) -> [f32; 2] {
                let bounds = sum.range().map(|end| end as f32);
                match self { $(Material::$kind(kind) => kind.coefficient_range(bounds),)* }
            }

            #[inline(always)]
            pub(crate) fn shape<R: Real>(&self, along: R, sum: R) -> R {
                match self { $(Material::$kind(kind) => kind.shape(along, sum),)* }
            }

            #[inline(always)]
            pub(crate) fn height<R: Real>(&self, along: R, sum: R) -> R {
                match self { $(Material::$kind(kind) => kind.height(along, sum),)* }
            }

            pub(crate) fn height_alone(&self, level: Level, inputs: [&[f32]; 2], heights: &mut [f32]) {
                match self {
                    $(Material::$kind(kind) => {
                        simd::map_at(level, &Height { kind, part: Part::Value }, inputs, heights);
                    })*
                }
            }

            /// The heights, and their derivatives by both arguments.
            pub(crate) fn height_all(&self, level: Level, inputs: [&[f32]; 2], outputs: [&mut [f32]; 3]) {
                let parts = [Part::Value, Part::Derivative(0), Part::Derivative(1)];
                for (part, output) in parts.into_iter().zip(outputs) {
                    match self {
                        $(Material::$kind(kind) => simd::map_at(level, &Height { kind, part }, inputs, output),)*
                    }
                }
            }

            pub(crate) fn shape_seen_all(&self, level: Level, inputs: [&[f32]; 3], coefficients: &mut [f32]) {
                match self { $(Material::$kind(kind) => simd::map_at(level, &Seen(kind), inputs, coefficients),)* }
            }

            pub(crate) fn shape_all(&self, level: Level, inputs: [&[f32]; 2], coefficients: &mut [f32]) {
                match self { $(Material::$kind(kind) => simd::map_at(level, &Shape(kind), inputs, coefficients),)* }
            }
        }
    };
}

materials! {
    fire::Fire
    water::Water
    organic::Organic
    wood::Wood
    marble::Marble
    stone::Stone
}

/// The parameters that all materials of the report have, with the defaults of one of them.
const fn parameters(depth: i64, initial: [f64; 3], last: [f64; 3]) -> [Parameter; 8] {
    use declare::Kind::{Choice, Color, Float, Int};
    [
        Parameter {
            name: "depth",
            kind: Int { min: 0, max: 32 },
            default: Value::Int(depth),
            summary: "Octaves of noise: each one adds detail of half the size.",
        },
        Parameter {
            name: "diffuse_initial",
            kind: Color,
            default: Value::Color(initial),
            summary: "The colour where the coefficient is 1.",
        },
        Parameter {
            name: "diffuse_final",
            kind: Color,
            default: Value::Color(last),
            summary: "The colour where the coefficient is 0.",
        },
        Parameter {
            name: "noise",
            kind: Choice(&["improved", "classic", "lattice"]),
            default: Value::Choice("improved"),
            summary: "The noise: Perlin's of 2002, Perlin's of 1985, or interpolated random values.",
        },
        Parameter {
            name: "sum",
            kind: Choice(&["plain", "absolute"]),
            default: Value::Choice("absolute"),
            summary: "How octaves add up: by their absolute value as in the report's figures, or plainly as in its formulas.",
        },
        Parameter {
            name: "seed",
            kind: Int { min: 0, max: i64::MAX },
            default: Value::Int(0),
            summary: "Another number gives another piece of the same material; 0 has the published table.",
        },
        Parameter {
            name: "scale",
            kind: Float { min: 1e-6, max: 1e6 },
            default: Value::Float(1.0),
            summary: "The size of one texture unit, in units of the space: 2 makes everything twice as large.",
        },
        Parameter {
            name: "space",
            kind: Choice(Space::NAMES),
            default: Value::Auto,
            summary: "What the texture is fixed to: the object (local, the default), the scene (world) or the texture \
                      coordinates (uv).",
        },
    ]
}
