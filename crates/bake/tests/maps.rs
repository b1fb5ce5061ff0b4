//! What every map of every material promises.

use jaspe_bake::{Bake, BakeError, Loop, Map, MapArray, NormalConvention, Settings};
use jaspe_noise::Dual;
use jaspe_texture::Texture;
use jaspe_texture::declare::Value;

fn materials() -> impl Iterator<Item = Texture> {
    assert_eq!(Texture::ALL.len(), 6);
    Texture::ALL.iter().map(|declaration| Texture::build(declaration.name, &[]).unwrap())
}

fn all_maps(size: u32) -> Settings {
    Settings { size, maps: Map::ALL.to_vec(), ..Settings::default() }
}

fn name(bake: &Bake) -> &'static str {
    bake.texture().declaration().name
}

/// The largest difference of channels between pixels one apart along an axis, sorted, and for the pairs across the border.
fn steps(map: &MapArray, size: usize, axis: usize) -> [Vec<f32>; 2] {
    let channels = map.map.declaration().channels;
    let pixel = |x: usize, y: usize| &map.values[channels * (y * size + x)..][..channels];
    let mut found = [Vec::new(), Vec::new()];
    for y in 0..size {
        for x in 0..size {
            let next = if axis == 0 { pixel((x + 1) % size, y) } else { pixel(x, (y + 1) % size) };
            let step = pixel(x, y).iter().zip(next).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            let at_border = [x, y][axis] == size - 1;
            found[usize::from(at_border)].push(step);
        }
    }
    found.iter_mut().for_each(|steps| steps.sort_by(f32::total_cmp));
    found
}

fn quantile(sorted: &[f32], part: f64) -> f32 {
    sorted[((sorted.len() - 1) as f64 * part) as usize]
}

#[test]
fn no_map_of_any_material_has_a_seam() {
    let size = 256;
    for texture in materials() {
        let bake = Bake::new(texture, all_maps(size)).unwrap();
        let arrays = bake.arrays(0, &()).unwrap();
        for map in &arrays.maps {
            for axis in 0..2 {
                let [within, across] = steps(map, size as usize, axis);
                let (place, seam) = (format!("{} {:?} axis {axis}", name(&bake), map.map), quantile(&across, 0.98));
                // Few pixels lie at the border: nearly all of them are within what is usual, and all within what occurs.
                assert!(seam <= quantile(&within, 0.999), "{place}: {seam} at the border");
                assert!(quantile(&across, 1.0) <= 1.05 * quantile(&within, 1.0) + 1e-3, "{place}");
                let mean = |steps: &[f32]| steps.iter().sum::<f32>() / steps.len() as f32;
                assert!(mean(&across) <= 1.5 * mean(&within) + 1e-3, "{place}");
            }
        }
    }
}

#[test]
fn a_seam_would_be_found() {
    let size = 128;
    let texture = Texture::build("stone", &[]).unwrap();
    let bake = Bake::new(texture, Settings { maps: vec![Map::Color], ..all_maps(size) }).unwrap();
    let mut arrays = bake.arrays(0, &()).unwrap();
    // Half of the picture from elsewhere.
    arrays.maps[0].values.rotate_right(3 * 128 * 40);
    let (upper, side) = (3 * 64 * 128, 3 * 128);
    for row in arrays.maps[0].values[..upper].chunks_exact_mut(side) {
        row[..side / 2].fill(0.1);
    }
    let [within, across] = steps(&arrays.maps[0], size as usize, 0);
    assert!(quantile(&across, 0.98) > quantile(&within, 0.98));
}

#[test]
fn the_field_repeats_after_a_tile() {
    for texture in materials() {
        for combine in ["absolute", "plain"] {
            for noise in ["improved", "classic", "lattice"] {
                let name = texture.declaration().name;
                let arguments = [("sum", Value::Choice(combine)), ("noise", Value::Choice(noise))];
                let texture = Texture::build(name, &arguments).unwrap();
                let bake = Bake::new(texture, all_maps(64)).unwrap();
                let cells = bake.cells();
                for i in 0..50 {
                    let point = [0.37 * f64::from(i), 0.61 * f64::from(i) - 3.0, 1.0 / 3.0];
                    let value = |x: f64, y: f64| {
                        let point = [point[0] + x * cells, point[1] + y * cells, point[2]];
                        bake.shown().value(point)
                    };
                    for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-2.0, 3.0)] {
                        let off = (value(x, y) - value(0.0, 0.0)).abs();
                        // Wood jumps from 1 to 0.
                        let off = if name == "wood" { off.min(1.0 - off) } else { off };
                        assert!(off < 1e-9, "{name} {noise} {combine} at {point:?}: {off}");
                    }
                }
            }
        }
    }
}

#[test]
fn pixels_past_the_border_are_those_of_the_next_tile() {
    for size in [64, 100] {
        for texture in materials() {
            let bake = Bake::new(texture, all_maps(size)).unwrap();
            let side = i64::from(size);
            for (x, y) in [(0, 0), (3, 17), (side - 1, side - 1)] {
                let here = bake.point(x, y).map(f64::to_bits);
                assert_eq!(bake.point(x + side, y).map(f64::to_bits), here);
                assert_eq!(bake.point(x - side, y + 2 * side).map(f64::to_bits), here);
            }
        }
    }
}

#[test]
fn heights_reach_from_zero_to_one() {
    for texture in materials() {
        let bake = Bake::new(texture, Settings { maps: vec![Map::Height], ..all_maps(100) }).unwrap();
        let arrays = bake.arrays(0, &()).unwrap();
        let values = &arrays.maps[0].values;
        let [low, high] = arrays.height_range;
        assert!(low < high, "{}", name(&bake));
        assert!(values.iter().any(|&value| value < 1e-6) && values.iter().any(|&value| value > 1.0 - 1e-6));
        // A height of the map is that of the texture, by the range.
        for (x, y) in [(0, 0), (99, 0), (41, 73)] {
            let cells: f64 = bake.shown().height(bake.point(x, y));
            let expected = (cells * bake.tile() / bake.cells() - low) / (high - low);
            let found = f64::from(values[(100 * y + x) as usize]);
            assert!((found - expected).abs() < 1e-4, "{}: {found}, {expected}", name(&bake));
        }
    }
}

fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    // Small angles: the sine will do.
    (dot(cross, cross) / (dot(a, a) * dot(b, b))).sqrt().to_degrees()
}

#[test]
fn normals_are_those_of_the_height_field() {
    for texture in materials() {
        for convention in [NormalConvention::OpenGl, NormalConvention::DirectX] {
            let settings = Settings { maps: vec![Map::Normal], normal: convention, ..all_maps(128) };
            let bake = Bake::new(texture.clone(), settings).unwrap();
            let arrays = bake.arrays(0, &()).unwrap();
            let up = if convention == NormalConvention::OpenGl { 1.0 } else { -1.0 };
            let mut strange = 0;
            for (i, pixel) in arrays.maps[0].values.chunks_exact(3).enumerate() {
                let point = bake.point(i as i64 % 128, i as i64 / 128);
                let single = bake.shown().height(Dual::point(point.map(|part| part as f32)));
                let double = bake.shown().height(Dual::point(point));
                let normal = |[x, y]: [f64; 2]| [-x, -up * y, 1.0];
                let slopes = [f64::from(single.gradient[0]), f64::from(single.gradient[1])];
                // As a file of 8 bits has it.
                let rounded =
                    [pixel[0], pixel[1], pixel[2]].map(|part| f64::from((255.0 * part).round()) / 127.5 - 1.0);
                assert!(angle(rounded, normal(slopes)) < 0.5, "{} at pixel {i}", name(&bake));
                let exact = [pixel[0], pixel[1], pixel[2]].map(|part| f64::from(part) * 2.0 - 1.0);
                strange += usize::from(angle(exact, normal([double.gradient[0], double.gradient[1]])) > 0.01);
            }
            // In double precision, too; but for the creases, where the last digit says which side a point is on.
            assert!(strange < 8, "{}: {strange} pixels", name(&bake));
        }
    }
}

#[test]
fn maps_do_not_depend_on_threads() {
    let texture = Texture::build("organic", &[]).unwrap();
    let bake = Bake::new(texture, all_maps(96)).unwrap();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bake.arrays(0, &()).unwrap())
    };
    assert_eq!(with(1), with(5));
}

#[test]
fn animations_return_to_their_beginning() {
    for name in ["fire", "water"] {
        let texture = Texture::build(name, &[]).unwrap();
        let animation = Some(Loop { frames: 24, first: 0, cells: 2 });
        let maps = vec![Map::Color, Map::Height];
        let bake = Bake::new(texture, Settings { animation, maps, ..all_maps(48) }).unwrap();
        let frames: Vec<_> = (0..=24).map(|frame| bake.arrays(frame, &()).unwrap()).collect();
        assert_eq!(frames[0], frames[24]);
        let between = |a: usize, b: usize| {
            let pairs = frames[a].maps[0].values.iter().zip(&frames[b].maps[0].values);
            pairs.map(|(a, b)| f64::from((a - b).abs())).sum::<f64>()
        };
        let usual = (1..23).map(|i| between(i, i + 1)).sum::<f64>() / 22.0;
        assert!(usual > 0.0 && between(23, 0) < 1.5 * usual, "{name}: {} and {usual}", between(23, 0));
        assert!(between(0, 12) > 2.0 * usual, "{name} moves");
        // Seamless at each time.
        let [within, across] = steps(&frames[7].maps[1], 48, 0);
        assert!(quantile(&across, 0.98) <= quantile(&within, 1.0));
    }
}

#[test]
fn detail_that_pixels_cannot_show_is_left_out() {
    let octaves = |size: u32| {
        let texture = Texture::build("organic", &[("depth", Value::Int(12))]).unwrap();
        Bake::new(texture, all_maps(size)).unwrap().shown().sum().octaves()
    };
    assert!(octaves(64) < octaves(256) && octaves(256) < octaves(2048));
    assert_eq!(octaves(16_384), 12);
}

#[test]
fn wrong_settings_are_told() {
    let error = |settings: Settings| Bake::new(Texture::build("stone", &[]).unwrap(), settings).err().unwrap();
    assert_eq!(error(all_maps(0)), BakeError::Size(0));
    assert_eq!(error(all_maps(16_385)).to_string(), "a size of 16385 pixels; it is from 1 to 16384");
    assert_eq!(error(Settings { maps: vec![], ..all_maps(8) }), BakeError::NoMaps);
    let twice = vec![Map::Color, Map::Normal, Map::Color];
    assert_eq!(error(Settings { maps: twice, ..all_maps(8) }), BakeError::Twice(Map::Color));
    for tile in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(error(Settings { tile: Some(tile), ..all_maps(8) }), BakeError::Tile(_)));
    }
    assert_eq!(
        error(Settings { tile: Some(100.0), ..all_maps(512) }).to_string(),
        "5000 noise cells along a side, where pixels can show 256"
    );
    let animation = Some(Loop { frames: 0, first: 0, cells: 1 });
    assert!(matches!(error(Settings { animation, ..all_maps(8) }), BakeError::Animation(_)));
}
