//! Nanoseconds a point and octave of each basis and sum, at each level: `cargo run --release --example speed`.

use std::hint::black_box;
use std::time::Instant;

use jaspe_noise::simd::{Level, machine_level};
use jaspe_noise::{Basis, Combine, Noise, Sum};

/// The time of a run that few others disturb (the first eighth of some runs), in nanoseconds a point.
fn time(points: usize, mut work: impl FnMut()) -> f64 {
    work();
    let mut times: Vec<f64> = (0..25)
        .map(|_| {
            let start = Instant::now();
            let mut rounds = 0;
            while start.elapsed().as_micros() < 2000 {
                work();
                rounds += 1;
            }
            start.elapsed().as_secs_f64() * 1e9 / (f64::from(rounds) * points as f64)
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 8]
}

fn main() {
    const COUNT: usize = 16_384;
    let mut state = 1u64;
    let mut coordinates = || -> Vec<f32> {
        (0..COUNT)
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                ((state >> 40) as f32 / (1 << 23) as f32 - 1.0) * 50.0
            })
            .collect()
    };
    let (x, y, z) = (coordinates(), coordinates(), coordinates());
    let mut values = vec![0.0; COUNT];
    let mut slopes = [(); 3].map(|()| vec![0.0; COUNT]);
    println!(
        "{:10} {:8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "basis", "level", "space", "plane", "four", "gradient", "sum of 7", "of 64", "single", "5 octaves"
    );
    for &basis in Basis::ALL {
        let noise = Noise::new(basis, 0);
        let sum = Sum::new(noise.clone(), Combine::Absolute, 7);
        for level in Level::ALL.into_iter().filter(|&level| level <= machine_level()) {
            let space = time(COUNT, || noise.fill_at(level, [&x, &y, &z], black_box(&mut values)));
            let plane = time(COUNT, || noise.fill_at(level, [&x, &y], black_box(&mut values)));
            let four = time(COUNT, || noise.fill_at(level, [&x, &y, &z, &x], black_box(&mut values)));
            let gradient = time(COUNT, || {
                let slopes = slopes.each_mut().map(Vec::as_mut_slice);
                noise.fill_with_gradient_at(level, [&x, &y, &z], black_box(&mut values), slopes);
            });
            let octave = time(7 * COUNT, || sum.fill_at(level, [&x, &y, &z], black_box(&mut values)));
            let small = time(COUNT, || {
                for start in (0..COUNT).step_by(64) {
                    let at = start..start + 64;
                    let points = [&x[at.clone()], &y[at.clone()], &z[at.clone()]];
                    noise.fill_at(level, points, black_box(&mut values[at]));
                }
            });
            let single = time(COUNT, || {
                for i in 0..COUNT {
                    values[i] = noise.at([black_box(x[i]), black_box(y[i]), black_box(z[i])]);
                }
            });
            let five = Sum::new(noise.clone(), Combine::Plain, 5);
            let single_sum = time(COUNT, || {
                for i in 0..COUNT {
                    values[i] = five.at([black_box(x[i]), black_box(y[i]), black_box(z[i])]);
                }
            });
            println!(
                "{:10} {:8} {space:9.3} {plane:9.3} {four:9.3} {gradient:9.3} {octave:9.3} {small:9.3} {single:9.3} {single_sum:9.3}",
                basis.name(),
                level.name()
            );
        }
    }
}
