//! Clear skies after [Preetham 1999]: A. J. Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight",
//! SIGGRAPH 1999, in Sunflow's units.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use jaspe_noise::math::{cos, exp, sin};
use jaspe_scene::description::rgb_from_xyz;

use super::Sight;
use super::distribution::Distribution2d;
use crate::material::luminance;
use crate::math;

/// A sky without its sun.
#[derive(Debug)]
pub(super) struct Sky {
    /// What the local coordinates are measured along; the last axis points up.
    axes: [Vec3; 3],
    /// Unit vector towards the sun, in local coordinates.
    sun: Vec3,
    /// What a direction's height above the horizon makes of Y, x and y, the zenith's values included, for heights from 0
    /// to 1.
    by_height: Curve<1024>,
    /// What its angle from the sun makes of them, for angles from 0 to π.
    by_angle: Curve<512>,
    /// Below the horizon; without it, the horizon's sky goes on.
    ground: Option<Vec3>,
    daylight: Daylight,
}

/// The five coefficients of Perez's distribution F, each for luminance Y and chromaticities x and y.
struct Perez([Vec3; 5]);

/// [Preetham 1999] appendix A.2: each coefficient as slope and intercept over the turbidity, for Y, x and y.
const COEFFICIENTS: [[[f32; 2]; 3]; 5] = [
    [[0.17872, -1.46303], [-0.01925, -0.25922], [-0.01669, -0.26078]],
    [[-0.35540, 0.42749], [-0.06651, 0.00081], [-0.09495, 0.00921]],
    [[-0.02266, 5.32505], [-0.00041, 0.21247], [-0.00792, 0.21023]],
    [[0.12064, -2.57705], [-0.06409, -0.89887], [-0.04405, -1.65369]],
    [[-0.06696, 0.37027], [-0.00325, 0.04517], [-0.01092, 0.05291]],
];

/// [Preetham 1999] appendix A.2: x and y at the zenith as polynomials, the highest power first, of the sun's angle from
/// there; these are the factors of the turbidity's square, the turbidity, and 1.
const ZENITH: [[[f64; 4]; 3]; 2] = [
    [[0.00165, -0.00374, 0.00208, 0.0], [-0.02902, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25885]],
    [[0.00275, -0.00610, 0.00316, 0.0], [-0.04212, 0.08970, -0.04153, 0.00515], [0.15346, -0.26756, 0.06669, 0.26688]],
];

/// The least height above the horizon for which the model is evaluated.
const LEAST_HEIGHT: f32 = 0.001;

impl Sky {
    pub fn new(up: Vec3, east: Vec3, sundir: Vec3, turbidity: f32, ground: Option<Vec3>) -> Sky {
        let up = up.normalize_or(Vec3::Z);
        let across = east.cross(up).normalize_or(math::basis(up).0);
        let axes = [across, up.cross(across), up];
        let sun = to_local(axes, sundir.normalize_or(up));
        let angle = math::acos(sun.z.clamp(-1.0, 1.0));
        let perez = Perez::new(turbidity);
        let zenith = zenith(f64::from(turbidity), f64::from(angle)) / (perez.by_height(1.0) * perez.by_angle(angle));
        Sky {
            axes,
            sun,
            by_height: Curve::new(|height| zenith * perez.by_height(height.max(LEAST_HEIGHT))),
            by_angle: Curve::new(|part| perez.by_angle(PI * part)),
            ground,
            daylight: Daylight::new(),
        }
    }

    /// What is seen in a direction of the world.
    pub fn seen(&self, direction: Vec3) -> Vec3 {
        constrain(self.light(to_local(self.axes, direction)))
    }

    /// What comes from a direction in local coordinates; components may be negative. Black where the model fails.
    fn light(&self, direction: Vec3) -> Vec3 {
        if let (Some(ground), true) = (self.ground, direction.z < 0.0) {
            return ground;
        }
        let direction = Vec3 { z: direction.z.max(LEAST_HEIGHT), ..direction }.normalize_or_zero();
        let angle = math::acos(direction.dot(self.sun).clamp(-1.0, 1.0));
        let color = self.by_height.at(direction.z) * self.by_angle.at(angle * (1.0 / PI));
        let rgb = self.daylight.rgb(color.x, [color.y, color.z]);
        if rgb.is_finite() { rgb } else { Vec3::ZERO }
    }

    /// Unfolds the sky onto the unit square with equal areas: u goes around, v from the zenith at 0 to the nadir at 1.
    pub fn unfold(&self, [u, v]: [f32; 2]) -> Sight {
        let local = Self::unfolded([u, v]);
        let [x, y, z] = self.axes;
        Sight { direction: x * local.x + y * local.y + z * local.z, radiance: self.light(local), stretch: 4.0 * PI }
    }

    /// The local direction of a point of the unit square.
    fn unfolded([u, v]: [f32; 2]) -> Vec3 {
        let z = 1.0 - 2.0 * v;
        let radius = (4.0 * v * (1.0 - v)).max(0.0).sqrt();
        Vec3::new(radius * cos(TAU * u), radius * sin(TAU * u), z)
    }

    /// Brightness over the unit square. The horizon is the edge of a row, so that no cell holds both sky and ground.
    pub fn distribution(&self) -> Distribution2d {
        const COLUMNS: usize = 128;
        const ROWS: usize = 64;
        let weight = |cell: usize| {
            let point = |du: f32, dv: f32| {
                let uv = [(cell % COLUMNS) as f32 + du, (cell / COLUMNS) as f32 + dv];
                self.light(Self::unfolded([uv[0] / COLUMNS as f32, uv[1] / ROWS as f32]))
            };
            let points = [point(0.25, 0.25), point(0.75, 0.25), point(0.25, 0.75), point(0.75, 0.75)];
            points.map(|color| luminance(color.abs())).iter().sum()
        };
        Distribution2d::new(COLUMNS, &(0..COLUMNS * ROWS).map(weight).collect::<Vec<f32>>())
    }
}

impl Perez {
    fn new(turbidity: f32) -> Perez {
        let mut coefficients =
            COEFFICIENTS.map(|all| Vec3::from_array(all.map(|[slope, intercept]| slope * turbidity + intercept)));
        // Air clearer than the model's (turbidity below 1.2) would make the horizon infinitely bright.
        coefficients[1] = coefficients[1].min(Vec3::ZERO);
        Perez(coefficients)
    }

    /// The first factor of F(θ, γ), for the height above the horizon, cos θ.
    fn by_height(&self, height: f32) -> Vec3 {
        let Perez([a, b, ..]) = *self;
        Vec3::ONE + a * exponentials(b / height)
    }

    /// The second factor of F(θ, γ), for the angle γ from the sun.
    fn by_angle(&self, gamma: f32) -> Vec3 {
        let Perez([_, _, c, d, e]) = *self;
        let cos_gamma = cos(gamma);
        Vec3::ONE + c * exponentials(d * gamma) + e * (cos_gamma * cos_gamma)
    }
}

/// A function on 0 to 1 as a table of `STEPS` steps, linear between its entries. With the tables a sky is looked up in half
/// the time that the formula takes; their relative error is below 3e-5.
#[derive(Debug)]
struct Curve<const STEPS: usize>(Vec<Vec3>);

impl<const STEPS: usize> Curve<STEPS> {
    fn new(value: impl Fn(f32) -> Vec3) -> Self {
        Curve((0..=STEPS).map(|i| value(i as f32 / STEPS as f32)).collect())
    }

    #[inline]
    fn at(&self, x: f32) -> Vec3 {
        let at = x * STEPS as f32;
        let i = (at as usize).min(STEPS - 1);
        let (low, high) = (self.0[i], self.0[i + 1]);
        low + (high - low) * (at - i as f32)
    }
}

/// Luminance (in Sunflow's unit, 10 kcd/m²) and chromaticities x and y of the zenith, for the sun's angle from there.
fn zenith(turbidity: f64, angle: f64) -> Vec3 {
    let chi = (4.0 / 9.0 - turbidity / 120.0) * (std::f64::consts::PI - 2.0 * angle);
    let tangent = math::tan_degrees(chi.to_degrees());
    let luminance = 0.1 * ((4.0453 * turbidity - 4.9710) * tangent - 0.2155 * turbidity + 2.4192);
    let [x, y] = ZENITH.map(|polynomials| {
        let values = polynomials.map(|terms| terms.iter().fold(0.0, |sum, term| sum * angle + term));
        (values[0] * turbidity + values[1]) * turbidity + values[2]
    });
    // Once the sun is far below the horizon, the polynomial falls below zero: it is night.
    Vec3::new(luminance.max(0.0) as f32, x as f32, y as f32)
}

/// The spectra of daylight, [Wyszecki, Stiles 1982] ch. 3: a mean and the two main deviations from it.
#[derive(Debug)]
struct Daylight {
    /// Luminances Y of the mean and the deviations.
    luminance: [f32; 3],
    /// Their colours in linear sRGB.
    rgb: [Vec3; 3],
}

impl Daylight {
    /// Sunflow: `ChromaticitySpectrum`, whose three spectra have these tristimulus values.
    fn new() -> Daylight {
        let xyz =
            [[10246.121, 10676.695, 12372.502], [187.75537, 192.59651, 3482.8762], [213.14803, 76.29493, -235.71611]];
        Daylight { luminance: xyz.map(|[_, y, _]| y as f32), rgb: xyz.map(|xyz| rgb_from_xyz(xyz).into()) }
    }

    /// Linear sRGB of the daylight with luminance `Y` and chromaticities x and y.
    #[inline]
    fn rgb(&self, luminance: f32, [x, y]: [f32; 2]) -> Vec3 {
        // The weights of the deviations, all multiplied by the denominator that they share.
        let weights =
            [0.0241 + 0.2562 * x - 0.7341 * y, -1.3515 - 1.7703 * x + 5.9114 * y, 0.03 - 31.4424 * x + 30.0717 * y];
        let [w0, w1, w2] = weights;
        let own = self.luminance[0] * w0 + self.luminance[1] * w1 + self.luminance[2] * w2;
        (self.rgb[0] * w0 + self.rgb[1] * w1 + self.rgb[2] * w2) * (luminance / own)
    }
}

/// A colour out of gamut, lightened until no component is negative.
pub(super) fn constrain(color: Vec3) -> Vec3 {
    color - Vec3::splat(color.min_element().min(0.0))
}

fn to_local([x, y, z]: [Vec3; 3], v: Vec3) -> Vec3 {
    Vec3::new(v.dot(x), v.dot(y), v.dot(z))
}

fn exponentials(v: Vec3) -> Vec3 {
    Vec3::new(exp(v.x), exp(v.y), exp(v.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_agree_with_the_formula() {
        for turbidity in [1.7, 2.0, 4.0, 10.0] {
            let perez = Perez::new(turbidity);
            let by_height = Curve::<1024>::new(|height| perez.by_height(height.max(LEAST_HEIGHT)));
            let by_angle = Curve::<512>::new(|part| perez.by_angle(PI * part));
            for i in 0..=10_000 {
                let x = i as f32 / 10_000.0;
                let off = (by_angle.at(x) / perez.by_angle(PI * x) - 1.0).abs().max_element();
                assert!(off < 3e-5, "turbidity {turbidity}, angle {x}: {off}");
                let x = x.max(LEAST_HEIGHT);
                let off = (by_height.at(x) / perez.by_height(x) - 1.0).abs().max_element();
                assert!(off < 3e-5, "turbidity {turbidity}, height {x}: {off}");
            }
        }
    }

    #[test]
    fn constraining_lightens_colours_out_of_gamut_and_no_others() {
        assert_eq!(constrain(Vec3::new(-0.25, 0.5, 1.0)), Vec3::new(0.0, 0.75, 1.25));
        assert_eq!(constrain(Vec3::new(0.25, 0.5, 1.0)), Vec3::new(0.25, 0.5, 1.0));
    }
}
