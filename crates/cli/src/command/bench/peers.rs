//! The same works by other noise crates, as their users would write them.

use std::hint::black_box;

use fastnoise_lite::{CellularDistanceFunction, CellularReturnType, FastNoiseLite, FractalType, NoiseType};

use super::noise::{Points, Row, STEP};
use super::stopwatch::Work;

/// The works of the crates that have such a noise.
pub fn works<'a>(row: Row, points: &'a Points) -> Vec<Work<'a>> {
    [noise_rs(row, points), noise_functions(row, points), libnoise(row, points), fastnoise(row, points)]
        .into_iter()
        .flatten()
        .chain(simdnoise(row))
        .collect()
}

/// A work that evaluates point by point.
fn each<'a>(name: &'static str, points: &'a Points, value: impl Fn([f32; 3]) -> f32 + 'a) -> Option<Work<'a>> {
    Some(Work { name, run: Box::new(move || points.each(&value)) })
}

fn noise_rs(row: Row, points: &Points) -> Option<Work<'_>> {
    use ::noise::core::worley::{ReturnType, distance_functions::euclidean};
    use ::noise::{Fbm, MultiFractal, NoiseFn, OpenSimplex, Perlin, Value, Worley};
    let name = "noise";
    match row {
        Row::Improved | Row::Single => {
            let noise = Perlin::new(0);
            each(name, points, move |point| noise.get(point.map(f64::from)) as f32)
        }
        Row::Octaves | Row::SingleOctaves => {
            let noise = Fbm::<Perlin>::new(0).set_octaves(5);
            each(name, points, move |point| noise.get(point.map(f64::from)) as f32)
        }
        Row::Simplex => {
            let noise = OpenSimplex::new(0);
            each(name, points, move |point| noise.get(point.map(f64::from)) as f32)
        }
        Row::Cellular => {
            let noise = Worley::new(0).set_distance_function(euclidean).set_return_type(ReturnType::Distance);
            each(name, points, move |point| noise.get(point.map(f64::from)) as f32)
        }
        Row::Value => {
            let noise = Value::new(0);
            each(name, points, move |point| noise.get(point.map(f64::from)) as f32)
        }
        _ => None,
    }
}

fn noise_functions(row: Row, points: &Points) -> Option<Work<'_>> {
    use noise_functions::{CellDistance, Noise as _, OpenSimplex2, Perlin, Value};
    let name = "noise-functions";
    match row {
        Row::Improved | Row::Single => each(name, points, |point| Perlin.sample3(point)),
        Row::Octaves | Row::SingleOctaves => {
            let noise = Perlin.fbm(5, 0.5, 2.0);
            each(name, points, move |point| noise.sample3(point))
        }
        Row::Simplex => each(name, points, |point| OpenSimplex2.sample3(point)),
        Row::Cellular => each(name, points, |point| CellDistance::default().sample3(point)),
        Row::Value => each(name, points, |point| Value.sample3(point)),
        _ => None,
    }
}

fn libnoise(row: Row, points: &Points) -> Option<Work<'_>> {
    use ::libnoise::{Generator, Source};
    let name = "libnoise";
    match row {
        Row::Improved | Row::Single => {
            let noise = Source::<3>::improved_perlin(0);
            each(name, points, move |point| noise.sample(point.map(f64::from)) as f32)
        }
        Row::Octaves | Row::SingleOctaves => {
            let noise = Source::<3>::improved_perlin(0).fbm(5, 1.0, 2.0, 0.5);
            each(name, points, move |point| noise.sample(point.map(f64::from)) as f32)
        }
        Row::Simplex => {
            let noise = Source::<3>::simplex(0);
            each(name, points, move |point| noise.sample(point.map(f64::from)) as f32)
        }
        Row::Cellular => {
            let noise = Source::<3>::worley(0);
            each(name, points, move |point| noise.sample(point.map(f64::from)) as f32)
        }
        Row::Value => {
            let noise = Source::<3>::value(0);
            each(name, points, move |point| noise.sample(point.map(f64::from)) as f32)
        }
        _ => None,
    }
}

fn fastnoise(row: Row, points: &Points) -> Option<Work<'_>> {
    let mut noise = FastNoiseLite::new();
    noise.set_frequency(Some(1.0));
    noise.set_noise_type(Some(match row {
        Row::Improved | Row::Single | Row::Octaves | Row::SingleOctaves => NoiseType::Perlin,
        Row::Simplex => NoiseType::OpenSimplex2,
        Row::Cellular => NoiseType::Cellular,
        Row::Value => NoiseType::Value,
        _ => return None,
    }));
    noise.set_cellular_distance_function(Some(CellularDistanceFunction::Euclidean));
    noise.set_cellular_return_type(Some(CellularReturnType::Distance));
    if matches!(row, Row::Octaves | Row::SingleOctaves) {
        noise.set_fractal_type(Some(FractalType::FBm));
        noise.set_fractal_octaves(Some(5));
    }
    each("fastnoise-lite", points, move |[x, y, z]| noise.get_noise_3d(x, y, z))
}

/// Its grids allocate their values.
fn simdnoise(row: Row) -> Option<Work<'static>> {
    use ::simdnoise::NoiseBuilder;
    const SIDE: usize = super::noise::SIDE;
    let run: Box<dyn FnMut()> = match row {
        Row::Grid => Box::new(|| {
            black_box(NoiseBuilder::gradient_3d(SIDE, SIDE, SIDE).with_freq(STEP).generate());
        }),
        Row::GridOctaves => Box::new(|| {
            black_box(NoiseBuilder::fbm_3d(SIDE, SIDE, SIDE).with_freq(STEP).with_octaves(5).generate());
        }),
        _ => return None,
    };
    Some(Work { name: "simdnoise", run })
}
