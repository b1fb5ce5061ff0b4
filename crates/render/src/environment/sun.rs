//! Sunlight that has come through the atmosphere, after [Preetham 1999] (see [`super::sky`]), appendix A.1.

use glam::Vec3;
use jaspe_noise::math::{exp, pow};
use jaspe_scene::description::{rgb_from_xyz, xyz_from_spectrum};

use super::sky::constrain;
use crate::math;

/// The sun's radiance outside of the atmosphere, from 380 to 750 nm in steps of 10 nm.
const RADIANCE: [f64; 38] = [
    165.5, 162.3, 211.2, 258.8, 258.2, 242.3, 267.6, 296.6, 305.4, 300.6, 306.6, 288.3, 287.1, 278.2, 271.0, 272.3,
    263.6, 255.0, 250.6, 253.1, 253.5, 251.3, 246.3, 241.7, 236.8, 232.1, 228.2, 223.4, 219.7, 215.3, 211.0, 207.3,
    202.4, 198.7, 194.3, 190.7, 186.3, 182.6,
];

/// Absorption by ozone: wavelength in nanometres, coefficient.
#[rustfmt::skip]
const OZONE: &[[f64; 2]] = &[
    [355.0, 0.0], [445.0, 0.003], [450.0, 0.003], [455.0, 0.004], [460.0, 0.006], [465.0, 0.008], [470.0, 0.009],
    [475.0, 0.012], [480.0, 0.014], [485.0, 0.017], [490.0, 0.021], [495.0, 0.025], [500.0, 0.03], [505.0, 0.035],
    [510.0, 0.04], [515.0, 0.045], [520.0, 0.048], [525.0, 0.057], [530.0, 0.063], [535.0, 0.07], [540.0, 0.075],
    [545.0, 0.08], [550.0, 0.085], [555.0, 0.095], [560.0, 0.103], [565.0, 0.11], [570.0, 0.12], [575.0, 0.122],
    [580.0, 0.12], [585.0, 0.118], [590.0, 0.115], [595.0, 0.12], [600.0, 0.125], [605.0, 0.13], [610.0, 0.12],
    [620.0, 0.105], [630.0, 0.09], [640.0, 0.079], [650.0, 0.067], [660.0, 0.057], [670.0, 0.048], [680.0, 0.036],
    [690.0, 0.028], [700.0, 0.023], [710.0, 0.018], [720.0, 0.014], [730.0, 0.011], [740.0, 0.01], [750.0, 0.009],
];

/// Absorption by water vapour. (That of the other gases begins at 759 nm, where [`RADIANCE`] has ended.)
const WATER: &[[f64; 2]] = &[
    [689.0, 0.0],
    [690.0, 0.016],
    [700.0, 0.024],
    [710.0, 0.0125],
    [720.0, 1.0],
    [730.0, 0.87],
    [740.0, 0.061],
    [750.0, 0.001],
];

/// The unit vector towards the sun, and the irradiance on a surface that faces it. `None` when it has set.
///
/// (Sunflow leaves a sun below the horizon as bright as at its defaults, R19.)
pub(crate) fn sun(up: Vec3, sundir: Vec3, turbidity: f32) -> Option<(Vec3, Vec3)> {
    let direction = sundir.try_normalize()?;
    let height = direction.dot(up.normalize_or(Vec3::Z)).min(1.0);
    if height <= 0.0 {
        return None;
    }
    let atmosphere = Atmosphere::new(height, f64::from(turbidity));
    let xyz = xyz_from_spectrum(|wavelength| radiance(wavelength) * atmosphere.transmittance(wavelength));
    let irradiance = constrain(rgb_from_xyz(xyz.map(|component| 1e-4 * component)).into());
    irradiance.is_finite().then_some((direction, irradiance))
}

/// What the light goes through.
struct Atmosphere {
    /// Length of the way, relative to that from the zenith.
    mass: f64,
    /// Ångström's turbidity coefficient.
    beta: f64,
}

impl Atmosphere {
    /// For the cosine of the sun's angle from the zenith.
    fn new(height: f32, turbidity: f64) -> Atmosphere {
        let angle = f64::from(math::acos(height));
        Atmosphere {
            mass: 1.0 / (f64::from(height) + 0.000940 * pow(1.6386 - angle, -1.253)),
            beta: 0.04608365822050 * turbidity - 0.04586025928522,
        }
    }

    /// The share of the light of a wavelength in nanometres that arrives.
    fn transmittance(&self, wavelength: f64) -> f64 {
        let (mass, micrometres) = (self.mass, wavelength / 1000.0);
        let rayleigh = 0.008735 * mass * pow(micrometres, -4.08);
        let aerosols = self.beta * mass * pow(micrometres, -1.3);
        let ozone = 0.35 * mass * interpolate(OZONE, wavelength);
        // Two centimetres of precipitable water.
        let vapour = 2.0 * mass * interpolate(WATER, wavelength);
        let vapour = 0.2385 * vapour / pow(1.0 + 20.07 * vapour, 0.45);
        exp(-(rayleigh + aerosols + ozone + vapour))
    }
}

/// [`RADIANCE`] at a wavelength in nanometres, zero outside of the table.
fn radiance(wavelength: f64) -> f64 {
    let at = (wavelength - 380.0) / 10.0;
    let last = RADIANCE.len() - 1;
    if !(0.0..=last as f64).contains(&at) {
        return 0.0;
    }
    let (low, t) = (at as usize, at - at.floor());
    RADIANCE[low] + (RADIANCE[(low + 1).min(last)] - RADIANCE[low]) * t
}

/// A table at a wavelength, linear between its entries and constant beyond its ends.
fn interpolate(table: &[[f64; 2]], wavelength: f64) -> f64 {
    let next = table.partition_point(|[at, _]| *at <= wavelength);
    match (next.checked_sub(1).map(|i| table[i]), table.get(next)) {
        (Some([at0, low]), Some([at1, high])) => low + (high - low) * (wavelength - at0) / (at1 - at0),
        (Some([_, value]), None) | (None, Some(&[_, value])) => value,
        (None, None) => 0.0,
    }
}
