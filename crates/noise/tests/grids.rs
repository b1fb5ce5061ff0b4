//! Uniform grids against the evaluation point by point.

use jaspe_noise::simd::Level;
use jaspe_noise::{Basis, Combine, Field, Grid, Noise, Raster, Sum, Warp};

/// A point of a grid.
fn point_of<const D: usize>(grid: &Grid<D>, index: usize) -> [f32; D] {
    let mut rest = index;
    std::array::from_fn(|axis| {
        let at = rest % grid.count[axis];
        rest /= grid.count[axis];
        grid.coordinate(axis, at)
    })
}

/// The coordinates along an axis of a grid.
fn along<const D: usize>(grid: &Grid<D>, axis: usize) -> Vec<f32> {
    (0..grid.count[axis]).map(|index| grid.coordinate(axis, index)).collect()
}

/// The sums on a grid, point by point.
fn point_by_point<const D: usize>(sum: &Sum, grid: &Grid<D>) -> Vec<f32> {
    (0..grid.len()).map(|index| sum.value(point_of(grid, index))).collect()
}

/// Holds a grid to the evaluation point by point, and every level to the scalar one.
fn check<const D: usize>(sum: &Sum, grid: &Grid<D>, bound: f32) {
    let expected = point_by_point(sum, grid);
    let mut reference = vec![f32::MAX; grid.len()];
    sum.fill_grid_at(Level::Scalar, grid, &mut reference);
    for (i, (value, expected)) in reference.iter().zip(&expected).enumerate() {
        let same = value.is_nan() && expected.is_nan() || (value - expected).abs() <= bound;
        assert!(same, "{sum:?} on {grid:?}, point {i}: {value}, {expected}");
    }
    for level in Level::ALL {
        let mut values = vec![f32::MAX; grid.len()];
        sum.fill_grid_at(level, grid, &mut values);
        let wrong = values.iter().zip(&reference).position(|(a, b)| a.to_bits() != b.to_bits() && !a.is_nan());
        assert_eq!(wrong, None, "{sum:?} on {grid:?} at {level:?}");
    }
}

#[test]
fn grids_are_within_rounding_of_points_and_the_same_at_every_level() {
    for &basis in Basis::ALL {
        for &combine in Combine::ALL {
            for period in [[0; 3], [3, 0, 7]] {
                let Ok(noise) = Noise::new(basis, 3).with_period(period) else { continue };
                let sum = Sum::new(noise, combine, 3);
                let by_cells = matches!(basis, Basis::Improved | Basis::Classic | Basis::Lattice | Basis::Value);
                let several = if matches!(combine, Combine::Plain | Combine::Absolute) { 1.75 } else { 17.5 };
                let bound = if by_cells { 2e-6 * several } else { 0.0 };
                check(&sum, &Grid { origin: [-1.3, 2.0, 255.1], step: [0.05, 0.1, 0.22], count: [41, 23, 9] }, bound);
                check(&sum, &Grid { origin: [-7.7, -3.9], step: [0.2, 0.24], count: [67, 18] }, bound);
                check(&sum, &Grid { origin: [-7.7], step: [0.01], count: [130] }, bound);
                // Too wide for cells, or backwards: point by point.
                check(&sum, &Grid { origin: [0.5, 0.5], step: [0.7, 0.1], count: [19, 7] }, bound);
                check(&sum, &Grid { origin: [0.5, 0.5], step: [-0.1, 0.0], count: [19, 2] }, bound);
            }
        }
    }
}

#[test]
fn grids_of_any_kind_have_values() {
    let sum = Sum::new(Noise::new(Basis::Improved, 0), Combine::Plain, 2);
    for origin in [3e7, -1e20, f32::MAX, f32::NAN, f32::INFINITY] {
        check(&sum, &Grid { origin: [0.0, origin], step: [0.1, 0.1], count: [20, 3] }, 4e-6);
        let grid = Grid { origin: [origin, 0.0, 0.3], step: [0.1, 0.1, 0.2], count: [20, 3, 2] };
        check(&sum, &grid, 4e-6);
        check_gradient(&sum, &grid, 4e-6);
    }
    check(&sum, &Grid { origin: [0.0; 4], step: [0.3; 4], count: [5, 3, 4, 2] }, 0.0);
    check(&sum, &Grid { origin: [0.0; 2], step: [f32::NAN, 0.1], count: [3, 2] }, 0.0);
    let empty = Grid { origin: [0.0; 2], step: [0.1; 2], count: [0, 7] };
    sum.fill_grid(&empty, &mut []);
    sum.fill_grid_with_gradient(&empty, &mut [], [&mut [], &mut []]);
    sum.fill_grid_filtered(&empty, 0.5, &mut []);
    assert!(empty.is_empty());
    let none = Sum::new(Noise::new(Basis::Improved, 0), Combine::Plain, 0);
    check(&none, &Grid { origin: [0.0; 2], step: [0.1; 2], count: [9, 7] }, 0.0);
    check_gradient(&none, &Grid { origin: [0.0; 2], step: [0.1; 2], count: [9, 7] }, 0.0);
}

#[test]
fn parts_of_a_grid_are_the_whole() {
    let sum = Sum::new(Noise::new(Basis::Improved, 5), Combine::Absolute, 3);
    let warp = Warp { source: sum.clone().into(), by: sum.clone().into(), amount: 0.2 };
    let axis = |count: usize, step: f32| (0..count).map(|i| i as f32 * step - 0.7).collect::<Vec<f32>>();
    let grids = [
        vec![axis(50, 0.1)],
        vec![axis(37, 0.1), axis(19, 0.07)],
        vec![axis(37, 0.1), axis(6, 0.07), axis(11, 0.13)],
        // Uneven, and point by point: backwards, or in four dimensions.
        vec![axis(9, 0.1), vec![0.0, 0.01, 0.2, 0.2, 0.21], axis(4, 0.1)],
        vec![axis(9, 0.1), vec![0.3, 0.1, 7.0], axis(4, 0.1)],
        vec![axis(9, 0.1), axis(3, 0.1), axis(4, 0.1), axis(5, 0.1)],
    ];
    for field in [Field::from(sum), Field::from(warp)] {
        for axes in &grids {
            let raster = Raster::new(field.clone(), axes.clone());
            let (planes, plane) = (raster.planes(), raster.plane_len());
            assert_eq!(planes * plane, axes.iter().map(Vec::len).product::<usize>());
            let mut whole = vec![f32::MAX; planes * plane];
            raster.fill(0..planes, &mut whole);
            for start in (0..planes).step_by(3) {
                let part = start..planes.min(start + 3);
                let mut values = vec![f32::MAX; part.len() * plane];
                raster.fill(part.clone(), &mut values);
                assert_eq!(values, whole[part.start * plane..part.end * plane], "{axes:?}, {part:?}");
            }
        }
    }
}

/// Holds the gradients of a grid to those of its points, and every level to the scalar one; the values are those without.
fn check_gradient<const D: usize>(sum: &Sum, grid: &Grid<D>, bound: f32) {
    let raster = Raster::new(sum.clone(), (0..D).map(|axis| along(grid, axis)).collect());
    let all = 0..raster.planes();
    let mut alone = vec![f32::MAX; grid.len()];
    raster.fill(all.clone(), &mut alone);
    let bits = |numbers: &[f32]| numbers.iter().map(|n| if n.is_nan() { 0 } else { n.to_bits() }).collect::<Vec<_>>();
    let mut reference = None;
    for level in Level::ALL {
        let mut outputs = vec![vec![f32::MAX; grid.len()]; D + 1];
        let (values, gradient) = outputs.split_first_mut().unwrap();
        let mut parts = gradient.iter_mut();
        let gradient: [&mut [f32]; D] = std::array::from_fn(|_| &mut parts.next().unwrap()[..]);
        raster.fill_with_gradient_at(level, all.clone(), values, gradient);
        assert!(bits(values) == bits(&alone), "{sum:?} on {grid:?} at {level:?}");
        let outputs_here = bits(&outputs.concat());
        assert!(&outputs_here == reference.get_or_insert(outputs_here.clone()), "{sum:?} on {grid:?} at {level:?}");
        for point in 0..grid.len() {
            let (_, expected) = sum.value_and_gradient(point_of(grid, point));
            for (slopes, expected) in outputs[1..].iter().zip(expected) {
                let slope = slopes[point];
                let same = slope.is_nan() && expected.is_nan() || (slope - expected).abs() <= bound;
                assert!(same, "{sum:?} on {grid:?}, point {point}: {slope}, {expected}");
            }
        }
    }
}

#[test]
fn gradients_on_a_grid_are_those_of_its_points() {
    for &basis in Basis::ALL {
        for &combine in Combine::ALL {
            for period in [[0; 3], [3, 0, 7]] {
                let Ok(noise) = Noise::new(basis, 5).with_period(period) else { continue };
                let sum = Sum::new(noise, combine, 3);
                let by_cells = matches!(basis, Basis::Improved | Basis::Classic | Basis::Lattice | Basis::Value);
                let several = if matches!(combine, Combine::Plain | Combine::Absolute) { 3.0 } else { 30.0 };
                let bound = if by_cells { 2e-6 * several } else { 0.0 };
                check_gradient(
                    &sum,
                    &Grid { origin: [-1.31, 2.03, 25.1], step: [0.05, 0.1, 0.22], count: [41, 23, 9] },
                    bound,
                );
                check_gradient(&sum, &Grid { origin: [-7.73, -3.91], step: [0.2, 0.24], count: [67, 18] }, bound);
                check_gradient(&sum, &Grid { origin: [-7.73], step: [0.013], count: [130] }, bound);
                // Too wide for cells.
                check_gradient(&sum, &Grid { origin: [0.5, 0.5], step: [0.7, 0.1], count: [19, 7] }, 0.0);
            }
        }
    }
    let four = Grid { origin: [0.0; 4], step: [0.3; 4], count: [5, 3, 4, 2] };
    check_gradient(&Noise::new(Basis::Improved, 0).into(), &four, 0.0);
}

#[test]
fn footprints_on_a_grid_are_those_of_its_points() {
    let grid = Grid { origin: [-1.3, 0.2], step: [0.17, 0.31], count: [37, 5] };
    for &basis in Basis::ALL {
        for footprint in [0.0, 0.1, 0.7, 30.0] {
            for (combine, octaves) in [(Combine::Plain, 1), (Combine::Absolute, 4), (Combine::Ridged, 3)] {
                let noise = Noise::new(basis, 5);
                let sum = if octaves == 1 { noise.into() } else { Sum::new(noise, combine, octaves) };
                let mut filtered = vec![f32::MAX; grid.len()];
                sum.fill_grid_filtered(&grid, footprint, &mut filtered);
                let [mut values, mut x, mut y] = [(); 3].map(|_| vec![f32::MAX; grid.len()]);
                sum.fill_grid_filtered_with_gradient(&grid, footprint, &mut values, [&mut x, &mut y]);
                for i in 0..grid.len() {
                    let point = [grid.coordinate(0, i % 37), grid.coordinate(1, i / 37)];
                    let expected = sum.value_and_gradient_filtered(point, footprint);
                    assert_eq!((values[i], [x[i], y[i]]), expected, "{sum:?} at {point:?} through {footprint}");
                    assert_eq!(filtered[i], expected.0, "{sum:?} at {point:?} through {footprint}");
                }
            }
        }
    }
}

#[test]
#[should_panic(expected = "there is a derivative for each axis")]
fn gradients_have_as_many_parts_as_the_grid_has_axes() {
    let raster = Raster::new(Noise::new(Basis::Improved, 0), vec![vec![0.0, 1.0]; 2]);
    raster.fill_with_gradient(0..2, &mut [0.0; 4], [&mut [0.0; 4]]);
}

#[test]
fn large_grids_which_pass_the_caches_by_are_the_same() {
    let axis = |count: usize| (0..count).map(|i| i as f32 * 0.01).collect::<Vec<f32>>();
    let (width, height) = (2051, 2100);
    let raster = Raster::new(Noise::new(Basis::Improved, 0), vec![axis(width), axis(height)]);
    for level in Level::ALL {
        for shift in 0..2 {
            let mut whole = vec![f32::MAX; shift + width * height];
            raster.fill_at(level, 0..height, &mut whole[shift..]);
            let mut part = vec![f32::MAX; 7 * width];
            for (rows, values) in whole[shift..].chunks_exact(7 * width).enumerate().step_by(13) {
                raster.fill_at(level, 7 * rows..7 * rows + 7, &mut part);
                assert!(part == values, "{level:?}, rows from {}", 7 * rows);
            }
        }
    }
    let [mut whole, mut x, mut y] = [(); 3].map(|_| vec![f32::MAX; width * height]);
    raster.fill_with_gradient(0..height, &mut whole, [&mut x, &mut y]);
    let [mut part, mut part_x, mut part_y] = [(); 3].map(|_| vec![f32::MAX; 7 * width]);
    for row in (0..height).step_by(91) {
        raster.fill_with_gradient(row..row + 7, &mut part, [&mut part_x, &mut part_y]);
        let at = row * width..(row + 7) * width;
        assert!(part == whole[at.clone()] && part_x == x[at.clone()] && part_y == y[at], "rows from {row}");
    }
}

#[test]
fn a_coordinate_of_a_grid_is_rounded_once() {
    let grid = Grid { origin: [0.1], step: [0.02], count: [256] };
    assert_eq!(grid.coordinate(0, 255), (0.1f32 as f64 + 255.0 * 0.02f32 as f64) as f32);
}

#[test]
#[should_panic(expected = "there is a value for each point of the grid")]
fn a_slice_of_another_length_is_refused() {
    let grid = Grid { origin: [0.0; 2], step: [0.1; 2], count: [4, 4] };
    Noise::new(Basis::Improved, 0).fill_grid(&grid, &mut [0.0; 15]);
}
