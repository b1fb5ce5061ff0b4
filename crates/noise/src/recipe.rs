//! What a user may ask of a noise in so many words and numbers, and the field that it means: the command line and the
//! language bindings read their arguments into a [`Recipe`].

use std::fmt;

use crate::basis::Basis;
use crate::basis::cellular::Cellular;
use crate::noise::Noise;
use crate::sum::{Combine, Sum};
use crate::warp::{Field, Warp};

/// A noise, or a sum of its octaves, perhaps warped by itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// The noise.
    pub basis: Basis,
    /// Its seed; 0 is the published table.
    pub seed: u64,
    /// After how many cells it repeats along each axis; 0 leaves an axis alone.
    pub period: [u32; 4],
    /// The parameters of cellular noise.
    pub cellular: Cellular,
    /// How octaves add up; `None` stands for one octave, or plainly if there are several.
    pub sum: Option<Combine>,
    /// How many octaves, from 1 to 64; `None` stands for [`Recipe::OCTAVES`] of a sum.
    pub octaves: Option<f64>,
    /// The ratio between the frequencies of neighbouring octaves, from 0 to 64.
    pub lacunarity: f64,
    /// The ratio between the amplitudes of neighbouring octaves, from 0 to 64.
    pub gain: f64,
    /// How far the point is displaced by the same field first, in the units of the point; again for each entry.
    pub warp: Vec<f64>,
}

/// What of a [`Recipe`] cannot be had.
#[derive(Debug, Clone, PartialEq)]
pub struct RecipeError {
    /// The parameter: `octaves`.
    pub parameter: &'static str,
    /// What was expected, and what was found.
    pub reason: String,
}

impl fmt::Display for RecipeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.parameter, self.reason)
    }
}

impl std::error::Error for RecipeError {}

/// Each warp evaluates the field once more for every axis.
const MOST_WARPS: usize = 8;

impl Recipe {
    /// The octaves of a sum of which nothing else is said: the default depth of the materials.
    pub const OCTAVES: f64 = 9.0;

    /// One octave of a noise.
    pub fn new(basis: Basis) -> Self {
        Recipe {
            basis,
            seed: 0,
            period: [0; 4],
            cellular: Cellular::default(),
            sum: None,
            octaves: None,
            lacunarity: 2.0,
            gain: 0.5,
            warp: Vec::new(),
        }
    }

    /// The field that it means.
    ///
    /// # Errors
    /// When a parameter is out of its range, and for periods that the noise cannot have.
    pub fn field(&self) -> Result<Field, RecipeError> {
        let octaves = self.octaves.unwrap_or(if self.sum.is_some() { Self::OCTAVES } else { 1.0 });
        within("octaves", octaves, [1.0, 64.0])?;
        within("lacunarity", self.lacunarity, [0.0, 64.0])?;
        within("gain", self.gain, [0.0, 64.0])?;
        within("jitter", self.cellular.jitter, [0.0, 1.0])?;
        let refuse = |parameter, reason| RecipeError { parameter, reason };
        if self.warp.len() > MOST_WARPS {
            return Err(refuse("warp", format!("expected up to {MOST_WARPS} amounts, found {}", self.warp.len())));
        }
        if let Some(amount) = self.warp.iter().find(|amount| !amount.is_finite()) {
            return Err(refuse("warp", format!("expected a finite number, found {amount}")));
        }
        let noise = Noise::new(self.basis, self.seed).with_cellular(self.cellular);
        let noise = noise.with_period(self.period).map_err(|error| refuse("period", error.to_string()))?;
        let combine = self.sum.unwrap_or(Combine::Plain);
        let field: Field = if combine == Combine::Plain && octaves == 1.0 {
            noise.into()
        } else {
            let sum = Sum::new(noise, combine, 0).with_octaves(octaves);
            sum.with_lacunarity(self.lacunarity).with_gain(self.gain).into()
        };
        let warp = |source, &amount: &f64| Warp { source, by: field.clone(), amount }.into();
        Ok(self.warp.iter().fold(field.clone(), warp))
    }
}

fn within(parameter: &'static str, value: f64, [least, most]: [f64; 2]) -> Result<(), RecipeError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(RecipeError { parameter, reason: format!("expected a number from {least} to {most}, found {value}") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bare_recipe_is_the_noise_itself() {
        let point = [0.3, 1.7, -2.4];
        for &basis in Basis::ALL {
            let field = Recipe { seed: 7, ..Recipe::new(basis) }.field().expect("in range");
            assert_eq!(field.value(point), Noise::new(basis, 7).value(point), "{basis:?}");
        }
    }

    #[test]
    fn a_sum_has_nine_octaves_unless_told() {
        let recipe = Recipe { sum: Some(Combine::Absolute), ..Recipe::new(Basis::Improved) };
        let sum = Sum::new(Noise::new(Basis::Improved, 0), Combine::Absolute, 9);
        assert_eq!(recipe.field(), Ok(sum.into()));
    }

    #[test]
    fn what_is_out_of_range_is_named() {
        let good = Recipe::new(Basis::Simplex);
        let refused = |recipe: Recipe| recipe.field().expect_err("out of range").to_string();
        assert_eq!(
            refused(Recipe { octaves: Some(f64::NAN), ..good.clone() }),
            "octaves: expected a number from 1 to 64, found NaN"
        );
        assert!(refused(Recipe { gain: -0.5, ..good.clone() }).starts_with("gain: "));
        assert!(
            refused(Recipe { period: [0, 1 << 24, 0, 0], ..good.clone() })
                .starts_with("period: expected a period up to")
        );
        assert!(refused(Recipe { warp: vec![0.1; 100], ..good.clone() }).starts_with("warp: expected up to 8"));
        assert!(refused(Recipe { warp: vec![f64::INFINITY], ..good }).starts_with("warp: expected a finite"));
    }
}
