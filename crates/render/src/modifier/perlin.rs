//! Heights of Sunflow's `perlin` modifier, with exact gradients by dual numbers where Sunflow takes differences of 1e-4.

use std::sync::LazyLock;

use jaspe_noise::math::sin;
use jaspe_noise::{ByteTable, Integer, Real};

/// The height at a point: function 0 is one octave of noise, 1 are veins, every other number is turbulence.
pub(super) fn height<R: Real>(function: i32, point: [R; 3]) -> R {
    let constant = R::constant;
    match function {
        0 => octave(point, 8.0) * constant(0.03),
        1 => {
            let phase = point[0] + constant(2.0) * turbulence(point);
            let wave = constant(0.5) + constant(0.5) * sin(phase * constant(1.6 * std::f64::consts::TAU));
            (wave * wave - constant(0.5)) * constant(0.01)
        }
        _ => turbulence(point) * constant(-0.10),
    }
}

/// Five octaves of noise by their absolute value.
fn turbulence<R: Real>(point: [R; 3]) -> R {
    [1.0, 2.0, 4.0, 8.0, 16.0]
        .iter()
        .fold(R::constant(-0.5), |sum, &frequency| sum + octave(point, frequency).abs() * R::constant(1.0 / frequency))
}

/// Noise of a frequency, turned by 45° about two axes so that its lattice does not show, and moved.
fn octave<R: Real>([x, y, z]: [R; 3], frequency: f64) -> R {
    let turn = R::constant(0.707);
    let (a, z) = (turn * (x - z), turn * (x + z));
    let (x, y) = (turn * (a - y), turn * (a + y));
    let frequency = R::constant(frequency);
    noise3([frequency * x + R::constant(100.0), frequency * y, frequency * z])
}

/// The tables of [`noise3`].
struct Tables {
    permutation: ByteTable,
    /// The edge code (see [`Real::edge_dot`]) of each corner's hash.
    edges: ByteTable,
}

/// Improved noise [Perlin 2002], but with the gradients 13 and 14 of the listing's sixteen exchanged (R33).
fn noise3<R: Real>(point: [R; 3]) -> R {
    // y−x and z−y are the exchanged ones, third and second from the end.
    const EDGE_CODES: [u8; 16] = [0, 9, 1, 8, 2, 11, 3, 10, 4, 13, 5, 12, 0, 9, 13, 12];
    static TABLES: LazyLock<Tables> = LazyLock::new(|| {
        let permutation = jaspe_noise::permutation(0);
        let edges = permutation.map(|hash| EDGE_CODES[usize::from(hash & 15)]);
        Tables { permutation: ByteTable::new(permutation), edges: ByteTable::new(edges) }
    });
    let Tables { permutation, edges } = &*TABLES;

    let one = R::constant(1.0);
    let next = |i: R::Int| i + R::Int::constant(1);
    let cell = point.map(R::floor);
    let [x, y, z] = std::array::from_fn(|axis| point[axis] - cell[axis]);
    let [i, j, k] = cell.map(R::to_int);
    let corner = |column: R::Int, [x, y]: [R; 2]| {
        let low = R::edge_dot(R::lookup(edges, column), x, y, z);
        let high = R::edge_dot(R::lookup(edges, next(column)), x, y, z - one);
        lerp(fade(z), low, high)
    };
    let side = |i: R::Int, x: R| {
        let row = R::lookup(permutation, i) + j;
        let low = corner(R::lookup(permutation, row) + k, [x, y]);
        let high = corner(R::lookup(permutation, next(row)) + k, [x, y - one]);
        lerp(fade(y), low, high)
    };
    lerp(fade(x), side(i, x), side(next(i), x - one))
}

fn lerp<R: Real>(t: R, a: R, b: R) -> R {
    a + t * (b - a)
}

/// 6t⁵ − 15t⁴ + 10t³.
fn fade<R: Real>(t: R) -> R {
    t * t * t * (t * (t * R::constant(6.0) - R::constant(15.0)) + R::constant(10.0))
}

#[cfg(test)]
mod tests {
    use jaspe_noise::Dual;

    use super::*;

    #[test]
    fn noise_agrees_with_the_check_values() {
        // Format reference, end of §7.1.
        assert!((noise3([0.3, 0.4, 0.5]) - 0.125_483_f64).abs() < 1e-6);
        assert!((noise3([10.3, -4.4, 7.5]) - 0.249_391_f64).abs() < 1e-6);
        assert!((noise3([10.3, -4.4, 7.5]) - 0.249_391_f32).abs() < 3e-6);
        assert_eq!(noise3([3.0, -4.0, 5.0]), 0.0_f64);
    }

    #[test]
    fn noise_is_the_improved_one_but_where_the_gradients_are_exchanged() {
        let improved = jaspe_noise::Noise::new(jaspe_noise::Basis::Improved, 0);
        let permutation = jaspe_noise::permutation(0).map(usize::from);
        let exchanged = |x: usize, y: usize, z: usize| {
            let hash = permutation[(permutation[(permutation[x & 255] + y) & 255] + z) & 255];
            matches!(hash & 15, 13 | 14)
        };
        let mut same = 0;
        for i in 0..4000_usize {
            let cell = [i % 20, i / 20 % 20, i / 400];
            let point = cell.map(|c| c as f64).map(|c| c + 0.3 + 0.02 * c);
            let cell = point.map(|coordinate| coordinate as usize);
            let corners = (0..8).map(|c| exchanged(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)));
            if corners.into_iter().all(|exchanged| !exchanged) {
                same += 1;
                assert!((noise3(point) - improved.value(point)).abs() < 1e-12, "{point:?}");
            }
        }
        assert!(same > 1000, "{same}");
    }

    #[test]
    fn gradients_agree_with_differences() {
        for function in [0, 1, 2] {
            let mut off = 0;
            for i in 0..200 {
                let point = [0.37 * f64::from(i), 3.0 - 0.21 * f64::from(i), 0.113 * f64::from(i)];
                let exact = height(function, Dual::<f32, 3>::point(point.map(|c| c as f32))).gradient;
                for axis in 0..3 {
                    let at = |step: f64| {
                        let mut moved = point.map(|c| f64::from(c as f32));
                        moved[axis] += step;
                        height(function, moved)
                    };
                    let difference = (at(1e-5) - at(-1e-5)) / 2e-5;
                    // Turbulence has edges, where differences mean nothing.
                    off += u32::from((difference - f64::from(exact[axis])).abs() > 4e-3);
                }
            }
            assert!(off <= 3, "function {function}: {off}");
        }
    }
}
