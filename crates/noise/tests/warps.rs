//! Domain warp: what it is, its gradients, and the same bits at every level.

mod common;

use common::random_bits;
use jaspe_noise::simd::Level;
use jaspe_noise::{Basis, Combine, Field, Noise, Sum, Warp};

/// A warp of a sum by a noise, and that one by another noise.
fn nested() -> Field {
    let sum = Sum::new(Noise::new(Basis::Improved, 1), Combine::Plain, 3);
    let inner = Warp { source: sum.into(), by: Noise::new(Basis::Simplex, 2).into(), amount: 0.3 };
    Warp { source: inner.into(), by: Noise::new(Basis::Value, 3).into(), amount: 0.5 }.into()
}

fn points(count: usize) -> Vec<[f64; 3]> {
    let mut bits = random_bits();
    let mut random = || ((bits() >> 40) as f64 / (1u64 << 23) as f64 - 1.0) * 20.0;
    (0..count).map(|_| [random(), random(), random()]).collect()
}

#[test]
fn a_warp_displaces_each_coordinate_by_its_field() {
    let (source, by) = (Noise::new(Basis::Improved, 0), Noise::new(Basis::Classic, 0));
    let warp = Field::from(Warp { source: source.clone().into(), by: by.clone().into(), amount: 0.7 });
    let still = Field::from(Warp { source: source.clone().into(), by: by.clone().into(), amount: 0.0 });
    for point in points(200) {
        let seen = |axis: f64| {
            let [x, y, z] = point;
            0.7 * by.value([x + axis * 17.31, y + axis * 59.77, z + axis * 91.13])
        };
        let displaced = [point[0] + seen(0.0), point[1] + seen(1.0), point[2] + seen(2.0)];
        assert_eq!(warp.value(point), source.value(displaced));
        assert_eq!(still.value(point), source.value(point));
    }
}

#[test]
fn gradients_of_warps_equal_central_differences() {
    let field = nested();
    let mut steepest = 0.0f64;
    for point in points(500) {
        let (value, gradient) = field.value_and_gradient(point);
        assert_eq!(value, field.value(point));
        for axis in 0..3 {
            let moved = |by: f64| {
                let mut moved = point;
                moved[axis] += by;
                field.value(moved)
            };
            let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((difference - gradient[axis]).abs() < 1e-6 * (1.0 + difference.abs()), "at {point:?}");
            steepest = steepest.max(difference.abs());
        }
    }
    assert!(steepest > 1.0, "{steepest}");
}

#[test]
fn warps_have_the_same_bits_at_every_level() {
    let field = nested();
    let points: Vec<[f32; 3]> = points(700).into_iter().map(|point| point.map(|part| part as f32)).collect();
    let columns: [Vec<f32>; 3] = std::array::from_fn(|axis| points.iter().map(|point| point[axis]).collect());
    let columns = columns.each_ref().map(Vec::as_slice);
    for level in Level::ALL {
        let (mut alone, mut values, mut slopes) = (vec![0.0; 700], vec![0.0; 700], [(); 3].map(|()| vec![0.0; 700]));
        field.fill_at(level, columns, &mut alone);
        field.fill_with_gradient_at(level, columns, &mut values, slopes.each_mut().map(Vec::as_mut_slice));
        for (i, &point) in points.iter().enumerate() {
            let (value, gradient) = field.value_and_gradient(point);
            assert_eq!((alone[i].to_bits(), values[i].to_bits()), (value.to_bits(), value.to_bits()), "{level:?}");
            assert_eq!(slopes.each_ref().map(|axis| axis[i]), gradient, "{level:?} at {point:?}");
        }
    }
}
