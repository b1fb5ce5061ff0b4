//! FLIP: how visible the differences between two pictures are when one flips between them. 0 is invisible, 1 the most.
//!
//! [Andersson 2020] P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. Fairchild, "FLIP: A
//! Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. Section numbers
//! below are the paper's. The viewing conditions are its standard ones.

#![allow(
    clippy::disallowed_methods,
    reason = "a measure is printed to six digits; no pixel of a rendering depends on it"
)]

use jaspe_scene::srgb_decode;

/// Pixels per degree of the field of view: a monitor 0.7 m wide, 3840 pixels across, seen from 0.7 m.
const PIXELS_PER_DEGREE: f64 = 67.020_643;

type Color = [f64; 3];

/// One error per pixel. Both pictures are display-encoded, row by row, `width` pixels each.
#[must_use]
pub fn flip(reference: &[[f32; 3]], test: &[[f32; 3]], width: usize) -> Vec<f32> {
    let (reference, test) = (Opponent::new(reference, width), Opponent::new(test, width));
    let (seen_reference, seen_test) = (reference.seen(), test.seen());
    let (features_reference, features_test) = (reference.features(), test.features());
    let largest = largest_color_error();
    let one = |i: usize| {
        let color = color_error(seen_reference[i], seen_test[i], largest);
        let [edge, point] = [0, 1].map(|k| (features_reference[i][k] - features_test[i][k]).abs());
        // §4.4: the feature difference raises the colour difference; its exponent is 1/2.
        let feature = (edge.max(point) * std::f64::consts::FRAC_1_SQRT_2).sqrt();
        color.powf(1.0 - feature) as f32
    };
    (0..seen_reference.len()).map(one).collect()
}

/// A picture in the linear opponent space YCxCz (§4.1.1), one plane per channel.
struct Opponent {
    planes: [Vec<f64>; 3],
    width: usize,
}

impl Opponent {
    fn new(pixels: &[[f32; 3]], width: usize) -> Self {
        let mut planes = [const { Vec::new() }; 3];
        for pixel in pixels {
            let [x, y, z] = relative_xyz(pixel.map(|v| srgb_decode(f64::from(v))));
            let opponent = [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)];
            (0..3).for_each(|channel| planes[channel].push(opponent[channel]));
        }
        Opponent { planes, width }
    }

    /// §4.1.1 and §4.1.2: blurred as the eye blurs, then in L*a*b* with the Hunt effect.
    fn seen(&self) -> Vec<Color> {
        // Contrast sensitivity of each channel as a sum of Gaussians: (a, b) of table 1.
        let sensitivity: [&[[f64; 2]]; 3] = [&[[1.0, 0.0047]], &[[1.0, 0.0053]], &[[34.1, 0.04], [13.5, 0.025]]];
        let [y, cx, cz] = [0, 1, 2].map(|channel| self.blurred(&self.planes[channel], sensitivity[channel]));
        let back = |i: usize| {
            let luminance = (y[i] + 16.0) / 116.0;
            let xyz = [luminance + cx[i] / 500.0, luminance, luminance - cz[i] / 200.0];
            hunt(linear_rgb(xyz).map(|v| v.clamp(0.0, 1.0)))
        };
        (0..y.len()).map(back).collect()
    }

    fn blurred(&self, plane: &[f64], gaussians: &[[f64; 2]]) -> Vec<f64> {
        use std::f64::consts::PI;
        // Three standard deviations of the widest Gaussian.
        let radius = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i64;
        let mut blurred = vec![0.0; plane.len()];
        let mut total = 0.0;
        for [a, b] in gaussians {
            let at = |i: i64| (-(PI * i as f64 / PIXELS_PER_DEGREE).powi(2) / b).exp();
            let kernel: Vec<f64> = (-radius..=radius).map(at).collect();
            let weight = a * (PI / b).sqrt();
            let sum: f64 = kernel.iter().sum();
            total += weight * sum * sum;
            let part = convolve(plane, self.width, &kernel, &kernel);
            blurred.iter_mut().zip(part).for_each(|(blurred, part)| *blurred += weight * part);
        }
        blurred.iter_mut().for_each(|v| *v /= total);
        blurred
    }

    /// §4.2: strength of edges and of points in the achromatic channel.
    fn features(&self) -> Vec<[f64; 2]> {
        let deviation = 0.5 * 0.082 * PIXELS_PER_DEGREE;
        let radius = (3.0 * deviation).ceil() as i64;
        let along = || (-radius..=radius).map(|i| i as f64);
        let bell = |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
        let smooth = normalized(along().map(bell).collect());
        let first = normalized(along().map(|x| -x * bell(x)).collect());
        let second = normalized(along().map(|x| (x * x / (deviation * deviation) - 1.0) * bell(x)).collect());
        let plane: Vec<f64> = self.planes[0].iter().map(|y| (y + 16.0) / 116.0).collect();
        let strength = |kernel: &[f64]| -> Vec<f64> {
            let across = convolve(&plane, self.width, kernel, &smooth);
            let down = convolve(&plane, self.width, &smooth, kernel);
            across.iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
        };
        strength(&first).into_iter().zip(strength(&second)).map(|(edge, point)| [edge, point]).collect()
    }
}

/// Scales the positive weights to the sum 1 and the negative ones to the sum −1.
fn normalized(mut kernel: Vec<f64>) -> Vec<f64> {
    let positive: f64 = kernel.iter().filter(|weight| **weight > 0.0).sum();
    let negative: f64 = -kernel.iter().filter(|weight| **weight < 0.0).sum::<f64>();
    kernel
        .iter_mut()
        .for_each(|weight| *weight /= if *weight > 0.0 { positive } else { negative.max(f64::MIN_POSITIVE) });
    kernel
}

/// Filters rows by one kernel and columns by another; the border's pixels go on beyond it.
fn convolve(plane: &[f64], width: usize, rows: &[f64], columns: &[f64]) -> Vec<f64> {
    let height = plane.len() / width.max(1);
    let (row_radius, column_radius) = (rows.len() / 2, columns.len() / 2);
    let mut between = vec![0.0; plane.len()];
    let mut padded = Vec::new();
    for (line, out) in plane.chunks_exact(width).zip(between.chunks_exact_mut(width)) {
        padded.clear();
        padded.extend(std::iter::repeat_n(line[0], row_radius));
        padded.extend_from_slice(line);
        padded.extend(std::iter::repeat_n(line[width - 1], row_radius));
        for (x, out) in out.iter_mut().enumerate() {
            *out = padded[x..x + rows.len()].iter().zip(rows).map(|(v, weight)| v * weight).sum();
        }
    }
    let mut result = vec![0.0; plane.len()];
    for (y, out) in result.chunks_exact_mut(width).enumerate() {
        for (k, weight) in columns.iter().enumerate() {
            let from = (y + k).saturating_sub(column_radius).min(height - 1);
            let line = &between[from * width..(from + 1) * width];
            out.iter_mut().zip(line).for_each(|(out, v)| *out += weight * v);
        }
    }
    result
}

/// Linear RGB to XYZ, divided by the white point.
fn relative_xyz([r, g, b]: Color) -> Color {
    [
        (10_135_552.0 * r + 8_788_810.0 * g + 4_435_075.0 * b) / 24_577_794.0 / WHITE[0],
        (2_613_072.0 * r + 8_788_810.0 * g + 887_015.0 * b) / 12_288_897.0 / WHITE[1],
        (1_425_312.0 * r + 8_788_810.0 * g + 70_074_185.0 * b) / 73_733_382.0 / WHITE[2],
    ]
}

/// The inverse of [`relative_xyz`].
fn linear_rgb(relative: Color) -> Color {
    let [x, y, z] = [0, 1, 2].map(|i| relative[i] * WHITE[i]);
    [
        3.241_003_275 * x - 1.537_398_934 * y - 0.498_615_861 * z,
        -0.969_224_334 * x + 1.875_930_071 * y + 0.041_554_224 * z,
        0.055_639_423 * x - 0.204_011_202 * y + 1.057_148_933 * z,
    ]
}

/// XYZ of RGB (1, 1, 1).
const WHITE: Color = [0.950_428_545, 1.0, 1.088_900_371];

/// Linear RGB to L*a*b*, colours fading with luminance (§4.1.2, the Hunt effect).
fn hunt(rgb: Color) -> Color {
    let delta: f64 = 6.0 / 29.0;
    let f = |t: f64| if t > delta.powi(3) { t.cbrt() } else { t / (3.0 * delta * delta) + 4.0 / 29.0 };
    let [x, y, z] = relative_xyz(rgb).map(f);
    let lightness = 116.0 * y - 16.0;
    [lightness, 500.0 * (x - y) * 0.01 * lightness, 200.0 * (y - z) * 0.01 * lightness]
}

/// The HyAB distance to the power 0.7 (§4.1.3).
fn distance(a: Color, b: Color) -> f64 {
    ((a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])).powf(0.7)
}

/// Between pure green and pure blue.
fn largest_color_error() -> f64 {
    distance(hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0]))
}

/// §4.1.3: the lower 40 % of the distances take 95 % of the range, because larger ones are hardly told apart.
fn color_error(a: Color, b: Color, largest: f64) -> f64 {
    let (knee, at_knee) = (0.4 * largest, 0.95);
    let distance = distance(a, b);
    if distance < knee {
        distance * at_knee / knee
    } else {
        at_knee + (distance - knee) / (largest - knee) * (1.0 - at_knee)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(shift: u32) -> Vec<[f32; 3]> {
        let pixel = |x: u32, y: u32| {
            let stripe = (x + shift) / 5 + y / 7;
            let blue = if (x + shift) % 11 < 4 { 200 } else { 5 * y };
            [stripe * 37 % 256, 4 * x, blue].map(|byte| byte as f32 / 255.0)
        };
        (0..48).flat_map(|y| (0..64).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
    }

    /// The expected values come from the authors' own code (LDR-FLIP, the same viewing conditions) in nv-flip 0.1.2.
    #[test]
    fn errors_agree_with_the_published_program() {
        let errors = flip(&pattern(0), &pattern(2), 64);
        let mean = errors.iter().sum::<f32>() / errors.len() as f32;
        let largest = errors.iter().copied().fold(0.0, f32::max);
        for (found, expected) in [
            (mean, 0.285_116_4),
            (largest, 0.818_078_94),
            (errors[0], 0.169_796_26),
            (errors[20 * 64 + 30], 0.306_445_93),
            (errors[47 * 64 + 63], 0.293_659_93),
        ] {
            assert!((found - expected).abs() < 1e-4, "expected {expected}, found {found}");
        }
    }
}
